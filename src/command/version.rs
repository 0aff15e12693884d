//! The version of the program.

/// The version, with the commit that it was built from where that was known.
pub const VERSION: &str = env!("RDSOLVE_VERSION");
