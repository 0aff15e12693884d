//! The choice of step lengths: fixed, by error, by the stability limit, or along an equilibrium path.

use super::displacement_target::DisplacementTarget;

/// Relative error of displacements that automatic steps allow over a run, unless the deck says otherwise.
pub const ERROR_TOLERANCE: f64 = 1e-3;
/// First automatic step, as a fraction of the run.
pub const FIRST_STEP: f64 = 5e-3;
/// Least number of automatic steps of central differences, where little or nothing resists: loads must still be resolved.
pub const FEWEST_STEPS: f64 = 50.0;
/// Automatic steps of central differences, as a fraction of the critical time step. Beam elements in large bending are unstable at 0.9 and
/// stable at 0.86: with an oscillating stiffness, motion may grow below the critical time step of each configuration.
pub const SAFE: f64 = 0.8;
/// The fraction where links or contacts may stiffen the model and cut steps. A mode at the fraction p of the limit has up to 1/(1 − p²) of
/// its energy at an instant; a shorter step makes this excess permanent.
pub const SAFE_WHERE_STRUCK: f64 = 0.5;

/// The choice of step lengths.
#[derive(Debug, Clone, PartialEq)]
pub enum StepLength {
    /// Steps have this length, or are a little shorter where they end at an output time.
    Fixed {
        /// The length of a step, in units of time.
        step: f64,
    },
    /// Steps follow an estimate of their error.
    ErrorControlled {
        /// The error of displacements at the end of the run, relative to the largest, that is aimed at.
        tolerance: f64,
        /// The length of the first trial step, in units of time.
        first: f64,
    },
    /// Steps are a fraction of the critical time step of central differences.
    StabilityLimited {
        /// The fraction, below 1: with an oscillating stiffness, motion may grow although each configuration is stable.
        fraction: f64,
    },
    /// Steps are arcs of an equilibrium path of a static analysis; the time follows, and may decrease.
    ArcLength(ArcLength),
}

/// Steps along an equilibrium path.
#[derive(Debug, Clone, PartialEq)]
pub struct ArcLength {
    /// Increment of the time (the load) in the first step; its arc is the unit of the other lengths.
    pub first: f64,
    /// The final displacement of the path, unless `end_time` is reached before.
    pub stop: Option<DisplacementTarget>,
    /// Number of steps after which the run ends wherever it is.
    pub steps: Option<usize>,
    /// Size of the displacement of `stop` in each step, in place of an arc.
    pub increment: Option<f64>,
    /// Longest arc, as a multiple of the first step.
    pub growth: f64,
}

impl StepLength {
    /// True where the run chooses its time steps.
    pub fn is_automatic(&self) -> bool {
        matches!(self, StepLength::ErrorControlled { .. } | StepLength::StabilityLimited { .. })
    }

    /// True for steps along an equilibrium path.
    pub fn is_arc_length(&self) -> bool {
        matches!(self, StepLength::ArcLength(_))
    }
}
