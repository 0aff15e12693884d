//! Nonlinear dynamics of structures made of rigid bodies and deformable parts.
//!
//! ```text
//!  text ──▶ deck ──▶ model ──▶ plan ──▶ solve ──▶ output
//!           words     meaning    machine   motion     files
//!  below them, used by them, knowing nothing of them:
//!  constraints  elements  integrators  │  state  sections  amplitude  linear  │  math  names  diagnostic
//! ```

pub mod amplitude;
pub mod command;
pub mod constraints;
pub mod deck;
pub mod diagnostic;
pub mod elements;
pub mod integrators;
pub mod linear;
pub mod math;
pub mod model;
pub mod names;
pub mod output;
pub mod plan;
pub mod sections;
pub mod solve;
pub mod state;
pub mod system;
