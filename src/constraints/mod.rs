//! Nodes that follow other nodes, by elimination or by multipliers.

pub mod attachment;
pub mod joint;
pub mod joints;
