//! Integration in time. `solve` shows each accepted step to an [`Observer`]; it knows nothing of files.
//!
//! The files build on each other. At the bottom are data: the constants of a run ([`context`]) and the workspace of a step ([`workspace`]).
//! Then come parts of steps common to all schemes, the implicit and explicit schemes, the controllers of the step length, and the run.

#![warn(missing_docs)]

mod context;
mod control;
mod derived;
mod effort;
mod energy_growth;
mod events;
mod explicit;
mod failure;
mod frame;
mod friction_warnings;
mod global_error;
mod global_error_control;
mod guards;
mod handover;
mod initial_transient;
mod jumps;
mod linear_statics;
mod linear_system;
mod march;
mod memory_ahead;
pub mod modes;
mod modes_at_end;
mod no_convergence;
mod node_chunks;
mod out_of_reach;
mod outcome;
pub mod plan;
mod recorder;
mod report;
mod row_gaps;
mod run;
mod sample;
mod slip_watch;
mod start;
mod start_of_stage;
mod step;
mod stop_request;
mod stop_watch;
mod strategy;
mod sudden_loads;
pub mod system;
mod throws;
mod time_stepper;
mod tolerances;
mod warning;
mod workspace;
mod yielded;

/// Internal parts of steps, for tests.
pub mod inner {
    pub use crate::context::{Context, at_rest};
    pub use crate::control::COMPARISONS;
    pub use crate::explicit::CentralDifferenceStepper;
    pub use crate::friction_warnings::{ContactThrows, SlipBegins};
    pub use crate::global_error::LookAhead;
    pub use crate::no_convergence::NoConvergence;
    pub use crate::start::start;
    pub use crate::step::load_steps::{LoadSteps, Peak};
    pub use crate::step::size::ModelSize;
    pub use crate::strategy::anderson::Anderson;
    pub use crate::strategy::rotated_matrix::RotatedMatrix;
    pub use crate::sudden_loads::SuddenLoads;
    pub use crate::system::inner::*;
    pub use crate::tolerances::rotated_matrix::MANY;
    pub use crate::warning::{Instability, Remark};
    pub use crate::workspace::Workspace;
}

pub use crate::system::{ContactState, ContactTouch, JointState};
pub use crate::system::{LinkState, SectionPlace, SectionPoint, ShellState, elastic_stresses};
pub use control::comparison_times;
pub use derived::{Derived, Wanted};
pub use effort::Effort;
pub use failure::{Failure, NamedResidual};
pub use frame::{Frame, Observer, OtherRun, ShownCase};
pub use global_error::{Kept, StepError};
pub use guards::breakage::Broken;
pub use guards::contacts::settling_energy;
pub use handover::{Handover, share_plane};
pub use outcome::{Counts, Outcome};
pub use run::Run;
pub use warning::{Warning, Warnings};
