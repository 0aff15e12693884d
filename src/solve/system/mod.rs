//! The equation of motion of a scene: residual, tangent and energies for any configuration of its nodes. Rigid bodies
//! enter here: the forces and matrices of elements at nodes attached to a body are transferred to the body's node.

pub mod assembly;
mod block_scatter;
mod build;
mod carry;
mod centrifugal;
pub mod connectivity;
pub mod constraint_schur;
pub mod contact_work;
mod contacts;
pub mod dependents;
mod destinations;
mod dofs;
mod element_stability;
pub mod energy;
mod equations;
mod excitation;
mod floating;
mod free_rotation;
mod gradients;
mod group;
mod independent_rows;
mod inertia;
mod joint_loads;
mod joint_tree;
pub mod joints;
pub mod kinks;
mod loads;
pub mod mass_damping;
mod mass_scaling;
mod mass_sources;
pub mod masses;
pub mod modal_damping;
mod multipliers;
mod node_sums;
pub mod parts;
mod penalties;
mod plane;
mod plane_motion;
pub(crate) mod reduced;
pub mod results;
mod scale;
mod schur_factor;
mod schur_group;
mod sliding;
mod tangent_weights;
mod thin_axes;
mod thread_partition;
mod turning_body;

/// Internal parts of assembly, for tests.
pub mod inner {
    pub use super::dependents::{Arms, Followers};
    pub use super::element_stability::{ElementScaling, scaling};
    pub use super::parts::{LumpedElement, NodalShare, NodeSpacing};
    pub use super::schur_factor::{SchurFactor, SparseFactor};
}

pub use carry::carry_history;
pub use centrifugal::CentrifugalLoad;
pub use contacts::{ContactState, ContactTouch, law_of, open_gap};
pub use dofs::{DofMap, NodeRows};
pub use equations::{Forces, System};
pub use excitation::{Excitation, Prescribed, between};
pub use floating::FloatingMass;
pub use group::Group;
pub use inertia::{ConsistentMass, Inertia};
pub use joints::JointState;
pub use loads::Loading;
pub use mass_scaling::{GoverningElement, MassScaling, ScaledPart, added_at, governing};
pub use mechanics::amplitude::Side;
pub use multipliers::Multipliers;
pub use parts::beam_sections::{
    SectionPlace, SectionPoint, elastic_stresses, judges_stresses, largest_elastic_strain, renew_stresses,
    section_points,
};
pub use parts::links::LinkState;
pub use parts::shell_shear::ShearBalance;
pub use parts::shells::ShellState;
pub use scale::Scale;
pub use sliding::{FrictionPlace, friction_places, slip};
pub use tangent_weights::TangentWeights;
pub use turning_body::{TurningBody, TurningStart};
