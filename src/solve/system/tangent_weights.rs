//! The weights with which the matrices of a scene are added up.

use mechanics::elements::Moduli;

/// The weights of the terms of a tangent.
#[derive(Debug, Clone, Copy)]
pub struct TangentWeights {
    /// True where K is formed; false for the mass matrix alone.
    pub stiffness: bool,
    /// Factor ∂q̇/∂q of the damping.
    pub rate: f64,
    /// Factor ∂q̈/∂q of the mass.
    pub acceleration: f64,
    /// [`mechanics::integrators::Coefficients::turning`].
    pub turning: Option<f64>,
    /// Moduli of the materials in K.
    pub moduli: Moduli,
}
