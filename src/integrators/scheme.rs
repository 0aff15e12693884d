//! What a time integration scheme says of itself.

use std::fmt;
use std::sync::Arc;

use super::coefficients::Coefficients;
use super::tableau::Tableau;
use crate::math::rotation::RotationUpdate;
use crate::words::kinds::{Given, Kind};

/// A scheme with its parameters.
pub trait Scheme: fmt::Debug + Send + Sync {
    /// As the deck writes it.
    fn word(&self) -> &'static str;

    /// The scheme with its parameters, in words.
    fn in_words(&self) -> String;

    /// What the reader of its results must know; `None`: nothing.
    fn note(&self) -> Option<&'static str> {
        None
    }

    /// The order of its error in the time step.
    fn order(&self) -> usize {
        2
    }

    /// How it takes a step.
    fn stepping(&self) -> Stepping<'_> {
        Stepping::OneStage
    }

    /// For a step of length Δt; of a composite scheme the first stage, of Runge-Kutta schemes the prediction of the motion.
    fn coefficients(&self, dt: f64) -> Coefficients;

    /// Where the scheme's formulas run on an algorithmic acceleration a instead of the q̈ of equilibrium: the weights of (a, q̈ at
    /// the start, q̈ at the end of the step) in a at the end of the step.
    fn algorithmic_acceleration(&self) -> Option<[f64; 3]> {
        None
    }

    /// True where a step solves for nothing but M a = r: there is no stiffness matrix.
    fn is_explicit(&self) -> bool {
        matches!(self.stepping(), Stepping::Verlet | Stepping::RungeKutta(_))
    }
}

/// How a scheme takes a step.
#[derive(Clone, Copy)]
pub enum Stepping<'a> {
    /// Implicit: equilibrium is solved for once, by the scheme's coefficients.
    OneStage,
    /// Implicit, in two stages, in each of which equilibrium is solved for.
    Composite(&'a dyn TwoStages),
    /// Explicit, by central differences in the form of velocity Verlet: one evaluation of the forces a step, and a length that is limited by
    /// stability.
    Verlet,
    /// Explicit, of high order, with an embedded estimate of the error.
    RungeKutta(&'static Tableau),
}

/// A scheme of two stages: one of its own, then backward differences over the start, the instant between the stages, and the end.
pub trait TwoStages {
    /// The part of the step that the first stage covers.
    fn split(&self) -> f64;

    /// The weights of backward differences at the end of a step of length Δt.
    fn backward(&self, dt: f64) -> Backward;

    /// The second stage, from the motion between the stages. In place of v and a it takes b₀ q₀ and b₀ v₀ + b₁ v, with q₀ the
    /// increment of the first stage, v₀ the velocity it began with, v the one it ended with, b of [`TwoStages::backward`].
    fn second(&self, dt: f64) -> Coefficients;
}

/// Derivative at the end of the second stage from values at the start of the step, between the stages, and at the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Backward {
    pub start: f64,
    pub between: f64,
    pub end: f64,
}

/// A scheme that the deck can name.
pub type SchemeKind = Kind<Make>;

/// Makes a scheme of its keys. Where a key is wrong the scheme has its default, and the error is collected.
#[derive(Debug)]
pub struct Make {
    pub scheme: fn(&mut Given, RotationUpdate) -> Arc<dyn Scheme>,
    /// The scheme leaves open how rotations follow from their increments.
    pub rotation_update: bool,
}
