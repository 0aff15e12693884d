//! The version of the program.

use super::instructions::several;
use super::processor::{Level, built_for};
use std::sync::OnceLock;

/// The version, with its commit if known.
pub const VERSION: &str = env!("RDSOLVE_VERSION");

/// The instructions in use: the level, in a release; in other builds, products of matrices use all instructions of the processor.
pub fn instructions() -> String {
    match Level::BUILT_FOR {
        Some(level) if cfg!(feature = "portable") => level.name().to_owned(),
        _ => format!("built for {}", built_for()),
    }
}

/// The version with the instructions in use, and what else there is.
pub fn long() -> &'static str {
    static LONG: OnceLock<String> = OnceLock::new();
    LONG.get_or_init(|| match several() {
        Some(levels) => format!("{VERSION}, instructions {} of {}", built_for(), levels.join(", ")),
        None => format!("{VERSION}, built for {}", built_for()),
    })
}
