//! The equation of motion of a scene: residual, tangent, energies, for any state of its nodes. Bodies are seen here for
//! the first time: what an element does to a node that rides on a body is handed to the body.

pub mod assembly;
mod block_scatter;
mod build;
pub mod constraint_schur;
mod contacts;
mod dofs;
pub mod energy;
mod equations;
mod excitation;
mod group;
mod inertia;
pub mod joints;
mod loads;
pub mod masses;
mod multipliers;
mod plane;
pub mod results;
mod scale;
mod thread_partition;
mod watched;

pub use contacts::ContactState;
pub use dofs::{DofMap, NodeRows};
pub use equations::{Forces, System};
pub use excitation::{Excitation, Prescribed, Side, between};
pub use group::Group;
pub use inertia::Inertia;
pub use joints::JointState;
pub use loads::Loading;
pub use multipliers::Multipliers;
pub use results::{LinkState, SectionPoint, ShellState};
pub use scale::Scale;
