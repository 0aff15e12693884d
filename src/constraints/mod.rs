//! Nodes that follow other nodes.

pub mod attachment;
