//! Stress from strain at a point: laws of normal stress ([`uniaxial`]), and J2 plasticity with isotropic and kinematic hardening, rate-independent or viscous.
//!
//! One law serves three stress states; it answers and does not remember. Backward Euler over the step, with the tangent of exactly that
//! (13)-(18); any increment converges. The caller owns the history variables: zeros at the start, then the values of the last accepted
//! state. Strains are small or co-rotated; thickness change is left out.

mod constants;
mod dissipation;
pub mod failure;
pub mod hardening;
mod law;
pub mod models;
pub mod overstress;
mod response;
mod return_mapping;
pub mod stress_state;
pub mod uniaxial;

pub use constants::ElasticConstants;
pub use dissipation::Dissipation;
pub use failure::FailureCriterion;
pub use hardening::Hardening;
pub use law::{FAILED_STIFFNESS, MaterialLaw};
pub use overstress::{Overstress, Viscosity};
pub use response::{Ask, MaterialHistory, PointResponse, Spent};
pub use stress_state::{FibreStress, PlaneStress, StressState, Uniaxial};
