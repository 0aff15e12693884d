//! What is computed, and how.

use super::step_length::{FIRST_STEP, StepLength};
use crate::deck::analysis::{AnalysisKind, Gyroscopic, Method, Update};
use crate::integrators::Scheme;
use std::sync::Arc;

/// What is computed over which time.
#[derive(Debug, Clone)]
pub struct Analysis {
    pub kind: AnalysisKind,
    pub end_time: f64,
    pub step_length: StepLength,
    /// A cutback never makes a step shorter than this.
    pub least_step: f64,
    /// Omit out-of-plane motion from the unknowns where nothing can cause it.
    pub plane: bool,
}

impl Analysis {
    /// The length of step that samples and studies are planned with: that of fixed steps, or else about that of the first.
    pub fn nominal_step(&self) -> f64 {
        match &self.step_length {
            StepLength::Fixed { step } => *step,
            StepLength::ErrorControlled { first, .. } => *first,
            StepLength::StabilityLimited { .. } => FIRST_STEP * self.end_time,
            StepLength::ArcLength(arc) => arc.first,
        }
    }
}

/// How the equations of motion are integrated and solved.
#[derive(Debug, Clone)]
pub struct Solution {
    pub scheme: Arc<dyn Scheme>,
    pub iteration: Iteration,
}

/// How nonlinear equations are solved in a step.
#[derive(Debug, Clone)]
pub struct Iteration {
    pub method: Method,
    pub update: Update,
    pub gyroscopic: Gyroscopic,
    /// Relative, on residual and increment.
    pub tolerance: f64,
    /// Iterations in a step before a cutback.
    pub limit: usize,
}
