//! How a study is run, where it writes, and why there may be none.

use crate::diagnostic::Diagnostic;
use std::io;
use std::path::PathBuf;

/// Below the folder of a study, that of its runs: one for each setting, by number, ...
pub const RUNS: &str = "runs";
/// ... or the deck as it is, and with a part rigid, by number.
pub const AS_IT_IS: &str = "as_it_is";
pub const RIGID: &str = "rigid_";

/// How a study is run.
#[derive(Debug, Clone)]
pub struct Options {
    pub deck: PathBuf,
    /// The user's own `--set` arguments.
    pub sets: Vec<String>,
    /// For study.csv and the runs.
    pub folder: PathBuf,
    pub threads: usize,
    /// Runs of each setting, of which the least time counts.
    pub repeats: usize,
    /// A setting is run again only while its runs have taken less than so many seconds together.
    pub budget: f64,
    pub quiet: bool,
}

/// Why there is no study.
#[derive(Debug)]
pub enum StudyFault {
    /// What is asked for makes no sense with this deck.
    Deck(Vec<Diagnostic>),
    Io(io::Error),
}

impl From<io::Error> for StudyFault {
    fn from(error: io::Error) -> Self {
        StudyFault::Io(error)
    }
}
