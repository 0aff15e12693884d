//! The exit codes of the program.

use std::process::ExitCode;

/// How the program ends; scripts rely on the numbers of these exit codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// The command has succeeded.
    Done = 0,
    /// The program itself has a fault.
    Internal = 1,
    /// The command line makes no sense, or a folder with files in it may not be overwritten.
    Usage = 2,
    /// The deck has errors, which have been shown.
    DeckInvalid = 3,
    /// No step could be taken any more, or an equilibrium is unstable; results are valid up to the time named.
    NotConverged = 4,
    /// A comparison failed, or an expected value or a required `stop` was missed.
    CheckFailed = 5,
    /// A file could not be read or written.
    InputOutput = 6,
    /// The memory of the machine, or the limit of this process, does not hold the scene.
    TooLittleMemory = 7,
    /// A signal has stopped the run, whose files are whole up to then (`EX_TEMPFAIL` of sysexits.h).
    Stopped = 75,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}
