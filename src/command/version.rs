//! The version of the program.

use super::instructions::several;
use super::processor::built_for;
use std::sync::OnceLock;

/// The version, with the commit that it was built from where that was known.
pub const VERSION: &str = env!("RDSOLVE_VERSION");

/// The instructions in use. A build that stands alone leaves products of matrices to what the processor has besides; a release does not.
pub fn instructions() -> String {
    if cfg!(feature = "portable") { format!("{}, release", built_for()) } else { built_for().to_owned() }
}

/// The version with the instructions in use, and what else there is.
pub fn long() -> &'static str {
    static LONG: OnceLock<String> = OnceLock::new();
    LONG.get_or_init(|| match several() {
        Some(levels) => format!("{VERSION}, instructions {} of {}", built_for(), levels.join(", ")),
        None => format!("{VERSION}, built for {}", built_for()),
    })
}
