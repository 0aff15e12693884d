//! The analysis and the solution procedure.

use super::modes::{ModeExtent, ModesAsked};
use super::response::{ResponseAsked, ResponseMethod};
use super::stage::RunStage;
use super::step_length::{FIRST_STEP, StepLength};
use deck::analysis::{Gyroscopic, Method, Update};
use mechanics::integrators::Scheme;
use std::sync::Arc;

/// The kind of the analysis, its time and its steps.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// The kind of computation.
    pub kind: AnalysisKind,
    /// True for a static analysis with infinitesimal displacements.
    pub is_linear: bool,
    /// Time at the beginning: 0, or where the stage before ends.
    pub begin: f64,
    /// Time at the end, of the run or of the stage.
    pub end_time: f64,
    /// The stage; `None` for a deck without stages.
    pub stage: Option<RunStage>,
    /// The way steps get their lengths.
    pub step_length: StepLength,
    /// The requested error of the results; `None` where the deck gives mesh and steps.
    pub accuracy: Option<f64>,
    /// Least length of a step after cutbacks.
    pub least_step: f64,
    /// True where the unknowns omit out-of-plane motion without excitation.
    pub plane: bool,
}

/// The kind of analysis. Load steps without inertia lead to the state about which modes and responses are found.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum AnalysisKind {
    /// Motion in time.
    #[default]
    Dynamic,
    /// Load steps without inertia.
    Static,
    /// Natural modes.
    Modal(ModesAsked),
    /// So many modes of buckling.
    Buckling(usize),
    /// The steady response to harmonic loads and motions.
    Response(ResponseAsked),
}

impl Analysis {
    /// True where masses matter: in motion in time, in natural modes and responses.
    pub fn has_inertia(&self) -> bool {
        !self.is_static() && !self.buckles()
    }

    /// True for motion in time.
    pub fn is_dynamic(&self) -> bool {
        self.kind == AnalysisKind::Dynamic
    }

    /// True for an analysis by load steps alone.
    pub fn is_static(&self) -> bool {
        self.kind == AnalysisKind::Static
    }

    /// True for a static analysis with infinitesimal displacements.
    pub fn is_linear(&self) -> bool {
        self.is_linear
    }

    /// True where modes of buckling are found.
    pub fn buckles(&self) -> bool {
        matches!(self.kind, AnalysisKind::Buckling(_))
    }

    /// True where modes or a response are found about a state.
    pub fn has_modes(&self) -> bool {
        !self.is_dynamic() && !self.is_static()
    }

    /// The frequency response that is computed.
    pub fn response(&self) -> Option<&ResponseAsked> {
        match &self.kind {
            AnalysisKind::Response(response) => Some(response),
            _ => None,
        }
    }

    /// The modes that are found.
    pub fn extent(&self) -> ModeExtent {
        match &self.kind {
            AnalysisKind::Dynamic | AnalysisKind::Static => ModeExtent::Count(0),
            AnalysisKind::Modal(asked) => asked.extent,
            AnalysisKind::Buckling(count) => ModeExtent::Count(*count),
            AnalysisKind::Response(response) => response.extent,
        }
    }

    /// True where damping and gyroscopic moments enter the modes, with the spin of bodies.
    pub fn damps_modes(&self) -> bool {
        matches!(self.kind, AnalysisKind::Modal(ModesAsked { damped: true, .. }) | AnalysisKind::Response(_))
    }

    /// The speeds of rotation over which modes are found.
    pub fn speeds(&self) -> &[f64] {
        match &self.kind {
            AnalysisKind::Modal(asked) => &asked.speeds,
            _ => &[],
        }
    }

    /// True where modes are found, and listed.
    pub fn lists_modes(&self) -> bool {
        self.has_modes() && self.response().is_none_or(|response| response.method == ResponseMethod::Modal)
    }

    /// True where the motion of the stage before goes on in this one as it was.
    pub fn goes_on(&self) -> bool {
        self.stage.as_ref().is_some_and(|stage| stage.goes_on)
    }

    /// True where an earlier stage is dynamic, so that the initial state contains discretization errors.
    pub fn follows_motion(&self) -> bool {
        self.stage.as_ref().is_some_and(|stage| stage.follows_motion)
    }

    /// True where the motion goes on and only loads come, go or jump.
    pub fn loads_alone_change(&self) -> bool {
        self.stage.as_ref().is_some_and(|stage| stage.loads_alone_change)
    }

    /// True where a longer `end_time` keeps all earlier results: fixed time steps, in a deck without stages.
    pub fn can_be_longer(&self) -> bool {
        let steps_are_given = matches!(self.step_length, StepLength::Fixed { .. });
        self.is_dynamic() && steps_are_given && self.stage.is_none()
    }

    /// How long it lasts.
    pub fn duration(&self) -> f64 {
        self.end_time - self.begin
    }

    /// The step length for sampling and studies: the fixed step, or about the first one.
    pub fn nominal_step(&self) -> f64 {
        match &self.step_length {
            StepLength::Fixed { step } => *step,
            StepLength::ErrorControlled { first, .. } => *first,
            StepLength::StabilityLimited { .. } => FIRST_STEP * self.duration(),
            StepLength::ArcLength(arc) => arc.first,
        }
    }
}

/// The integration scheme and the iteration.
#[derive(Debug, Clone)]
pub struct Solution {
    /// The time integration scheme.
    pub scheme: Arc<dyn Scheme>,
    /// The reason for the scheme, where the deck names none and its automatic steps leave the choice.
    pub choice: Option<String>,
    /// The masses of shells, bars and beams in motion, in all dynamic stages the same.
    pub masses: ElementMasses,
    /// The equilibrium iteration.
    pub iteration: Iteration,
}

impl Solution {
    /// True where the program has chosen the scheme.
    pub fn is_chosen(&self) -> bool {
        self.choice.is_some()
    }
}

/// The masses of deformable elements in motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ElementMasses {
    /// Those of the sections.
    OfSections,
    /// Rotary inertia is raised, so that thickness does not limit steps of central differences.
    Rotary,
    /// Rotary inertia and mass are raised, so that each element has at least this critical time step of central differences.
    ForStep(f64),
}

/// The solution of the nonlinear equations of a step.
#[derive(Debug, Clone)]
pub struct Iteration {
    /// The moduli and acceleration of the iteration.
    pub method: Method,
    /// The rule for forming the matrix anew.
    pub update: Update,
    /// The side of the equation on which gyroscopic terms stand.
    pub gyroscopic: Gyroscopic,
    /// Relative tolerance of residual and correction.
    pub tolerance: f64,
    /// True where the deck gives no tolerance: the error of the step may then end the iteration earlier.
    pub follows_step: bool,
    /// Largest number of iterations in a step before a cutback.
    pub limit: usize,
}

impl Iteration {
    /// The default of `limit`, except with the initial load method.
    pub const LIMIT: usize = 20;
}
