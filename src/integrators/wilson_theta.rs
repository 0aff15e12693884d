//! Wilson-θ.

#[derive(Debug, Clone, PartialEq)]
pub struct WilsonTheta {
    /// Equilibrium is written at t + θΔt.
    pub theta: f64,
    pub rotation: super::RotationUpdate,
}
