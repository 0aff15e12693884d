//! Integration in time. `solve` shows each accepted step to an [`Observer`]; it knows nothing of files.
//!
//! The files stand from the bottom up: what a run reads ([`context`]) and what a step writes ([`workspace`]), both
//! plain data; the parts of a step that all schemes share; the implicit and the explicit schemes; the controllers of
//! the step length; the run on top.

#![warn(missing_docs)]

mod breakage;
mod commit;
mod contacts;
mod context;
mod control;
mod derived;
mod drifting_rotations;
mod effort;
mod energy_growth;
mod events;
mod explicit;
mod failure;
mod frame;
mod handover;
mod implicit;
mod initial_transient;
mod joints;
mod jumps;
mod large_strains;
mod linear_system;
mod links;
mod load_steps;
mod march;
pub mod modes;
mod modes_at_end;
mod motion;
mod node_chunks;
mod outcome;
pub mod plan;
mod projection;
mod recorder;
mod report;
mod residual;
mod run;
mod sample;
mod search;
mod size;
mod start;
mod start_of_stage;
mod stop_request;
mod stop_watch;
mod sudden_loads;
pub mod system;
mod time_stepper;
mod tolerances;
mod trials;
mod warning;
mod work;
mod workspace;

pub use crate::system::{ContactState, ContactTouch, JointState};
pub use crate::system::{LinkState, SectionPlace, SectionPoint, ShellState};
pub use breakage::Broken;
pub use contacts::settling_energy;
pub use derived::{Derived, Wanted};
pub use effort::Effort;
pub use failure::{Failure, NamedResidual};
pub use frame::{Frame, Observer, OtherRun};
pub use handover::{Handover, share_plane};
pub use outcome::{Counts, Outcome};
pub use run::Run;
pub use trials::StepError;
pub use warning::{Warning, Warnings};
