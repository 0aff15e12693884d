//! The model as plain data: what every later stage reads, and what building it writes.

mod analysis;
mod constraints;
mod expect;
mod loading;
mod model;
mod node;
mod output;
mod part;
mod passage;
mod step_length;
mod study;

pub use crate::deck::analysis::{AnalysisKind, Gyroscopic, Method, Update};
pub use crate::deck::beams::MassKind;
pub use crate::deck::supports::History;
pub use analysis::{Analysis, Iteration, Solution};
pub use constraints::{Constraints, DependentNode, Joint, Motion, Restraint};
pub use expect::{Expect, ExpectAt, Tolerance, When};
pub use loading::{BaseAcceleration, Damping, Load, Loading, NodalDamping, Pressure};
pub use model::{MeshFile, Model, Origin, Rigid};
pub use node::{Body, DIRECTIONS, Mass, Node};
pub use output::{Cadence, Output};
pub use part::{
    Bar, Beam, BeamElement, Contact, Drawing, Link, LinkKind, Part, PartKind, PartType, Shell, ShellElement,
};
pub use passage::Passage;
pub use step_length::{ArcLength, ERROR_TOLERANCE, FIRST_STEP, StepLength};
pub use study::{Choice, Quantity, Study};
