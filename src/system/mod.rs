//! The equation of motion of a scene: residual, tangent and energies for any configuration of its nodes. Rigid bodies
//! enter here: the forces and matrices of elements at nodes attached to a body are transferred to the body's node.

pub mod assembly;
mod block_scatter;
mod build;
mod carry;
pub mod constraint_schur;
mod contacts;
pub mod dependents;
mod dofs;
pub mod energy;
mod equations;
mod excitation;
mod free_rotation;
mod group;
mod inertia;
mod joint_loads;
mod joint_tree;
pub mod joints;
mod loads;
pub mod masses;
mod multipliers;
pub mod parts;
mod plane;
mod plane_motion;
pub mod results;
mod scale;
mod schur_factor;
mod tangent_weights;
mod thread_partition;
mod turning_body;

pub use carry::carry_history;
pub use contacts::ContactState;
pub use dofs::{DofMap, NodeRows};
pub use equations::{Forces, System};
pub use excitation::{Excitation, Prescribed, Side, between};
pub use group::Group;
pub use inertia::Inertia;
pub use joints::JointState;
pub use loads::Loading;
pub use multipliers::Multipliers;
pub use parts::beam_sections::{SectionPlace, SectionPoint};
pub use parts::links::LinkState;
pub use parts::shells::ShellState;
pub use scale::Scale;
pub use tangent_weights::TangentWeights;
pub use turning_body::{TurningBody, TurningStart};
