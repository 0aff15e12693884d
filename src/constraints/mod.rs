//! Stub: replaced at merge.
