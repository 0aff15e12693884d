//! Stub: replaced at merge.
pub mod link;
