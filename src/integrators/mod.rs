//! Time integration schemes: each is an unknown, three weights and an update.

pub mod wilson_theta;

pub use wilson_theta::WilsonTheta;

/// How a node's rotation follows from the rotation vector of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RotationUpdate {
    /// R ← exp(Θ~) R.
    Exponential,
    /// R ← (I + Θ~) R, made orthogonal again (61).
    FirstOrder,
    /// R ← (I + Θ~ + ½ Θ~Θ~) R, made orthogonal again (62).
    SecondOrder,
}

/// A scheme the deck can name.
#[derive(Debug, Clone, PartialEq)]
pub enum Scheme {
    WilsonTheta(WilsonTheta),
}
