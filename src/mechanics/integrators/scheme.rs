//! The description of a time integration scheme.

use std::fmt;
use std::sync::Arc;

use super::coefficients::Coefficients;
use super::stage_tableau::StageTableau;
use super::tableau::Tableau;
use base::math::rotation::RotationUpdate;
use base::words::kinds::{Given, Kind};

/// A scheme with its parameters.
pub trait Scheme: fmt::Debug + Send + Sync {
    /// The deck's word for it.
    fn word(&self) -> &'static str;

    /// The scheme with its parameters, in words.
    fn in_words(&self) -> String;

    /// A note for readers of the results; `None` if there is none.
    fn note(&self) -> Option<&'static str> {
        None
    }

    /// The order of its error in the time step.
    fn order(&self) -> usize {
        2
    }

    /// Kind of step.
    fn stepping(&self) -> Stepping<'_> {
        Stepping::OneStage
    }

    /// The coefficients for a step of length Δt: the first stage of a composite scheme, the prediction of Runge-Kutta
    /// schemes.
    fn coefficients(&self, dt: f64) -> Coefficients;

    /// Weights of (a, q̈ at the start, q̈ at the end of the step) in a at the end, for schemes with an algorithmic acceleration a.
    fn algorithmic_acceleration(&self) -> Option<[f64; 3]> {
        None
    }

    /// True where a step solves for nothing but M a = r: there is no stiffness matrix.
    fn is_explicit(&self) -> bool {
        matches!(self.stepping(), Stepping::Verlet | Stepping::RungeKutta(_))
    }
}

/// Kind of step of a scheme.
#[derive(Clone, Copy)]
pub enum Stepping<'a> {
    /// Implicit: equilibrium is solved for once, by the scheme's coefficients.
    OneStage,
    /// Implicit with two stages, each solved for equilibrium.
    Composite(&'a dyn TwoStages),
    /// Implicit, in several stages with one matrix, each from the start of the step.
    DiagonallyImplicit(&'static StageTableau),
    /// Explicit, by central differences in the form of velocity Verlet: one evaluation of the forces a step, and a length that is limited by
    /// stability.
    Verlet,
    /// Explicit, of high order, with an embedded estimate of the error.
    RungeKutta(&'static Tableau),
}

/// A scheme of two stages: the first by its own formulas, the second by backward differences over start, intermediate instant and end.
pub trait TwoStages {
    /// The part of the step that the first stage covers.
    fn split(&self) -> f64;

    /// The weights of backward differences at the end of a step of length Δt.
    fn backward(&self, dt: f64) -> Backward;

    /// The second stage, from the motion between the stages. In place of v and a it uses b₀ q₀ and b₀ v₀ + b₁ v, with b from
    /// [`TwoStages::backward`]. q₀ is the increment of the first stage, v₀ and v are the velocities at its start and end.
    fn second(&self, dt: f64) -> Coefficients;
}

/// Weights of the derivative at the end of the second stage: of the values at the start of the step, between the
/// stages, and at the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Backward {
    /// Weight of the value at the start of the step.
    pub start: f64,
    /// Weight of the value between the stages.
    pub between: f64,
    /// Weight of the value at the end.
    pub end: f64,
}

/// A scheme that the deck can name.
pub type SchemeKind = Kind<MakeScheme>;

/// Makes a scheme of its keys. Where a key is wrong the scheme has its default, and the error is collected.
#[derive(Debug)]
pub struct MakeScheme {
    /// Makes the scheme from its keys and the rotation update.
    pub scheme: fn(&mut Given, RotationUpdate) -> Arc<dyn Scheme>,
    /// True where the deck may choose how rotations follow from their increments.
    pub rotation_update: bool,
}
