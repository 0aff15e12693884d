//! Loads as they act at an instant.

use crate::math::{Mat3, Vec3, skew};
use crate::model;
use crate::state::Node;

/// Loads at the instant of equilibrium.
#[derive(Debug, Clone, Default)]
pub struct Loading {
    /// Of the model's loads.
    pub factors: Vec<f64>,
    /// The model's pressures that follow, with their factors.
    pub pressures: Vec<f64>,
    /// The acceleration that every mass feels.
    pub field: Vec3,
}

/// Force and moment of a load; a follower turns with its node.
#[inline]
pub(super) fn load_on(load: &model::Load, factor: f64, node: &Node) -> (Vec3, Vec3) {
    let (f, m) = (factor * load.force, factor * load.moment);
    if load.follower {
        let R = node.R();
        (R * f, R * m)
    } else {
        (f, m)
    }
}

/// ∂(f, m)/∂θ of a follower, as internal force (with the sign of a stiffness).
pub(super) fn follower_stiffness(load: &model::Load, factor: f64, node: &Node) -> [Mat3; 2] {
    let (f, m) = load_on(load, factor, node);
    [skew(&f), skew(&m)]
}
