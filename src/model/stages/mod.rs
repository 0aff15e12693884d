//! `[[stages]]`: their order and times, and the deck as each of them sees it.

mod checks;
mod current;
mod merge;
mod sequence;

pub use checks::{check, check_names};
pub use current::CurrentStage;
pub use merge::merge;
pub use sequence::StageSequence;
