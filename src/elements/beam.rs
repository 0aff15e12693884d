//! stub
pub const DEFAULT_ORDER: usize = 3;
