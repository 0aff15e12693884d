//! Query that stops a computation early.

/// Tells whether a factorization is to end before it is done. It is asked from several threads.
pub type StopQuery<'a> = &'a (dyn Fn() -> bool + Sync);
