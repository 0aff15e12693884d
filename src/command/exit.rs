//! How the program ends.

use std::process::ExitCode;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    Done = 0,
    /// A fault of the program itself.
    Internal = 1,
    Usage = 2,
    DeckInvalid = 3,
    /// Results are valid up to the time named.
    NotConverged = 4,
    /// A comparison or an expected value failed.
    CheckFailed = 5,
    InputOutput = 6,
    /// By a signal.
    Stopped = 75,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}
