//! Nodes that follow other nodes, by elimination or by multipliers.

pub mod joint;
pub mod joints;
pub mod rigid_link;
