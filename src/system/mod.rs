//! The whole scene at once: what it owes and what it is worth.

pub mod energy;
