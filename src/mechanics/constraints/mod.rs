//! Kinematic constraints between nodes, by elimination (rigid links) or by Lagrange multipliers (joints).

pub mod angle;
pub mod given_angle;
pub mod joint;
pub mod joints;
mod relative_turn;
pub mod rigid_link;
