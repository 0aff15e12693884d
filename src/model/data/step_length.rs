//! How the steps of a run get their lengths: all alike, by their error, by what is stable, or along a path of equilibria.

use super::passage::Passage;

/// The relative error that automatic steps allow the displacements of a run unless the deck says otherwise.
pub const ERROR_TOLERANCE: f64 = 1e-3;
/// The first automatic step, as a part of the whole run.
pub const FIRST_STEP: f64 = 5e-3;
/// Automatic steps of central differences as a part of the critical time step. Beam elements that bend far are lost at 0.9
/// already, at 0.86 not: what is stable as the scene lies may grow where its stiffness swings.
pub(super) const SAFE: f64 = 0.8;
/// The same where links or contacts may stiffen: they cut steps, and a mode at a part p of the limit has up to 1/(1 − p²) of its
/// energy at a step, which a shorter one takes for all there is.
pub(super) const SAFE_WHERE_STRUCK: f64 = 0.5;

/// How the steps of a run get their lengths.
#[derive(Debug, Clone, PartialEq)]
pub enum StepLength {
    /// Steps are as long as this, or a little shorter where they end at an output time.
    Fixed { step: f64 },
    /// Steps follow an estimate of their error: that of the displacements at the end of the run, relative to the largest, is to
    /// be the tolerance. The first step that is tried is as long as `first`.
    ErrorControlled { tolerance: f64, first: f64 },
    /// Steps are as long as central differences are stable: this part of the critical time step.
    StabilityLimited { fraction: f64 },
    /// Steps are arcs of a path of equilibria of a static analysis; the time follows, and may fall.
    ArcLength(ArcLength),
}

/// Steps along a path of equilibria.
#[derive(Debug, Clone, PartialEq)]
pub struct ArcLength {
    /// The first step, which is one of the time, that is of the load, and sets the length of the others.
    pub first: f64,
    /// Where the path ends, unless `end_time` is reached before.
    pub stop: Option<Passage>,
    /// The run ends after so many steps, wherever it is.
    pub steps: Option<usize>,
    /// The longest arc over that of the first step.
    pub growth: f64,
}

impl StepLength {
    /// True where a run finds the lengths of its time steps by itself.
    pub fn is_automatic(&self) -> bool {
        matches!(self, StepLength::ErrorControlled { .. } | StepLength::StabilityLimited { .. })
    }

    pub fn is_arc_length(&self) -> bool {
        matches!(self, StepLength::ArcLength(_))
    }
}
