//! The numbers of an explicit Runge-Kutta scheme.

/// The terms of a sum over stages that are not zero: (stage, weight).
pub type StageWeights = &'static [(usize, f64)];

/// The numbers of a scheme. Stages count from 0, at the start of the step; the last is the end of the step, which the next
/// one begins with.
#[derive(Debug, PartialEq)]
pub struct Tableau {
    /// Order of the scheme.
    pub order: usize,
    /// Times of the stages after the first, as fractions of the step.
    pub c: &'static [f64],
    /// Weights of earlier rates in the motion of each stage.
    pub a: &'static [StageWeights],
    /// Weights of the rates of all stages at the end of the step.
    pub b: StageWeights,
    /// Differences to the embedded schemes; where there are two, e₁²/√(e₁² + e₂²/100) is the error.
    pub errors: &'static [StageWeights],
    /// The error of a step decreases with this power of its length.
    pub error_order: f64,
}

impl Tableau {
    /// Evaluations of a step, the one at its end included.
    pub fn stages(&self) -> usize {
        self.c.len() + 2
    }
}
