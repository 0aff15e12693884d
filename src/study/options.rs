//! The options of a study, the names of its folders, and the reasons why there may be none.

use super::cost::Cost;
use base::diagnostic::Diagnostic;
use std::io;
use std::path::PathBuf;

/// The folder of the runs, below that of the study; in it, a grid has a folder for each setting, by number from 1.
pub const RUNS: &str = "runs";
/// The folder of the original deck beside those with rigid parts.
pub const AS_IT_IS: &str = "as_it_is";
/// The beginning of the folder of a run with a part rigid; the number of the part follows.
pub const RIGID: &str = "rigid_";

/// The options of a study apart from its settings.
#[derive(Debug, Clone)]
pub struct Options {
    /// The path of the deck.
    pub deck: PathBuf,
    /// The user's own `--set` arguments.
    pub sets: Vec<String>,
    /// The folder that the study writes into.
    pub folder: PathBuf,
    /// The number of threads of each run.
    pub threads: usize,
    /// The number of runs of each setting; the least time counts.
    pub repeats: usize,
    /// The time, in seconds, that the runs of a setting may take together before it is run again.
    pub budget: f64,
    /// The cost that the picture draws errors against.
    pub axis: Cost,
    /// True where no progress is shown.
    pub quiet: bool,
    /// The level of instructions of all runs, equal to the level of the study.
    pub instructions: &'static str,
}

/// The reason why there is no study.
#[derive(Debug)]
pub enum StudyFault {
    /// The options contradict this deck.
    Deck(Vec<Diagnostic>),
    /// A file could not be read or written, a run could not be started, or a signal came before the first run was done.
    Io(io::Error),
}

impl From<io::Error> for StudyFault {
    fn from(error: io::Error) -> Self {
        StudyFault::Io(error)
    }
}
