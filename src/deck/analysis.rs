//! `[analysis]`, `[integrator]` and `[iteration]`: how long, by which scheme, how each step is solved.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::kinds::Kinds;
use super::words::{Maybe, NumberOrAuto, Table};
use crate::integrators::SCHEMES;
use crate::integrators::scheme::{Make, SchemeKind};
use crate::math::rotation::RotationUpdate;

/// What is computed and over what time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Analysis {
    #[schemars(required)]
    pub kind: Maybe<AnalysisKind>,
    /// What leads a static analysis on. Default: "time".
    pub control: Maybe<Control>,
    /// The run goes from t = 0 to this time; with arc-length, until the load first comes to it.
    #[schemars(required)]
    pub end_time: Maybe<f64>,
    /// Time per step; "auto": as long as `error_tolerance` lets it be, and with central-difference as is stable. With arc-length, that of the first step, from which the
    /// length of the others follows.
    #[schemars(required)]
    pub time_step: Maybe<NumberOrAuto>,
    /// With an automatic step: how far displacements may be off for the length of the steps, relative to the largest.
    /// Default: 1e-3.
    pub error_tolerance: Maybe<f64>,
    /// A step that does not converge is halved, but not below this. Default: time_step / 2^20; with an automatic step
    /// end_time / 10^9.
    pub least_step: Maybe<f64>,
    /// With arc-length: where the run ends, unless `end_time` is reached before.
    pub stop: Maybe<Table<Passage>>,
    /// With arc-length: the run ends after so many steps, wherever it is. Default: after 100000 it fails.
    pub steps: Maybe<u64>,
    /// With arc-length: steps grow to at most so many times the first, in displacements. Default: no limit.
    pub growth: Maybe<f64>,
    /// Leave out motion out of a plane where nothing can cause it. Default: "auto".
    pub plane: Maybe<Plane>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Control {
    /// Time goes on in given steps.
    Time,
    /// Steps have a length in displacements; time is the load's and follows, so it may fall and rise again: through limit
    /// points, snap-through and snap-back.
    ArcLength,
}

/// A displacement on its way through a value: a step lands on it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Passage {
    /// Name of a point or body.
    #[schemars(required)]
    pub at: Maybe<String>,
    #[schemars(required)]
    pub quantity: Maybe<Displacement>,
    #[schemars(required)]
    pub value: Maybe<f64>,
    /// Which time it passes the value, either way. Default: 1.
    pub pass: Maybe<u64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Displacement {
    Ux,
    Uy,
    Uz,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AnalysisKind {
    /// Motion in time.
    #[default]
    Dynamic,
    /// Load stepping without inertia; loads without an amplitude grow linearly from 0 to 1 at the end time.
    Static,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Plane {
    /// Left out where nothing can cause it.
    Auto,
    /// Always kept.
    Off,
}

/// The time integration scheme, with its parameters beside it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Integrator {
    /// How rotations follow from their increments in a step. Default: "exponential", which is exact. Not with runge-kutta.
    pub rotation_update: Maybe<RotationUpdate>,
}

impl Kinds for Integrator {
    const CHOOSER: &'static str = "scheme";
    const ABOUT: &'static str = "The scheme that integrates the motion in time. Default: \"wilson-theta\".";
    const REQUIRED: bool = false;
    type Make = Make;

    fn list() -> &'static [&'static SchemeKind] {
        &SCHEMES
    }
}

/// How the equations of a step are solved.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Iteration {
    /// Which moduli the matrix is formed with where material yields. Default: "auto".
    pub method: Maybe<Method>,
    /// When the matrix is formed and factorised anew. Default: "auto".
    pub update: Maybe<Update>,
    /// Where the gyroscopic term of bodies stands: the answer is the same. Default: "auto".
    pub gyroscopic: Maybe<Gyroscopic>,
    /// Relative, on residual and increment. Default: 1e-8.
    pub tolerance: Maybe<f64>,
    /// Iterations in a step before it is cut. Default: 20; 200 with initial-load.
    pub limit: Maybe<u64>,
}

/// Which moduli the stiffness matrix is formed with where material yields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Newton's method with the algorithmic (consistent) tangent.
    TangentStiffness,
    /// The elastic matrix is kept; plastic stresses go to the right-hand side.
    InitialLoad,
    /// The cheaper of the two, by counts of operations and the contraction observed.
    #[default]
    Auto,
}

impl Method {
    /// As the deck writes it.
    pub fn word(self) -> &'static str {
        match self {
            Method::TangentStiffness => "tangent-stiffness",
            Method::InitialLoad => "initial-load",
            Method::Auto => "auto",
        }
    }
}

/// Where the gyroscopic term of bodies stands; its derivative is not symmetric.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Gyroscopic {
    /// In the matrix if that is unsymmetric anyway.
    #[default]
    Auto,
    /// In the matrix, which is then unsymmetric: fewer iterations.
    Left,
    /// In the residual alone: the matrix may be symmetric.
    Right,
}

/// When the matrix is formed and factorised anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Update {
    /// In every iteration.
    Iteration,
    /// Once in every step.
    Step,
    /// When convergence has slowed so far that a factorisation costs less than the iterations it saves.
    #[default]
    Auto,
    /// Once in the run.
    Never,
}
