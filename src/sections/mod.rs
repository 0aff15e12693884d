//! Cross sections: shape → areas and moments → stiffnesses and inertias per length.

use crate::math::Mat3;

/// What a beam feels of its section, in section axes (x along the beam) about the centroid.
/// (N, Q_y, Q_z) = N·Γ + NM·κ, (T, M_y, M_z) = NMᵀ·Γ + M·κ.
#[derive(Debug, Clone, PartialEq)]
pub struct Stiffness {
    pub N: Mat3,
    pub M: Mat3,
    /// Nonzero where the shear centre is off the centroid.
    pub NM: Mat3,
    pub mass_per_length: f64,
    /// Rotary inertia per length, about the centroid.
    pub inertia_per_length: Mat3,
}
