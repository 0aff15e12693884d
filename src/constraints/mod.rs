//! Nodes that follow other nodes, by elimination or by multipliers.

pub mod rigid_link;
pub mod joint;
pub mod joints;
