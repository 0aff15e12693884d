//! The version of the program.

use super::processor::BUILT_FOR;
use std::sync::OnceLock;

/// The version, with the commit that it was built from where that was known.
pub const VERSION: &str = env!("RDSOLVE_VERSION");

/// The same with the instructions that it was built for.
pub fn long() -> &'static str {
    static LONG: OnceLock<String> = OnceLock::new();
    LONG.get_or_init(|| format!("{VERSION}, built for {BUILT_FOR}"))
}
