//! Nonlinear dynamics of structures made of rigid bodies and deformable parts.
//!
//! ```text
//!  text ──▶ deck ──▶ model ──▶ plan ──▶ solve ──▶ results
//!           words     meaning    machine   motion     files
//!  below them, used by them, knowing nothing of them:  base  linear  mechanics
//! ```
//!
//! Each arrow is one function, and nothing flows back. [`model::Model`] and [`plan::Plan`] never change, and [`state::State`]
//! changes when a step is accepted. All other changing data belongs to the workspace of a step. Everything moves as
//! nodes: a rigid body is a node with inertia, and an element sees nodes only. Forces and matrices at nodes rigidly attached
//! to a body are transferred to the body's node in one place, [`system::assembly`]. An integration scheme is a handful of
//! numbers, [`integrators::Coefficients`]. A [`study`] stands above all that: it runs the program itself many times.
//!
//! Formulas and code share their symbols. "(58)" is equation 58 of Rojek & Kleiber, Nonlinear dynamic FE analysis of
//! structures consisting of rigid and deformable parts, Part I (1993).
//!
//! | Thing | In formulas | In code |
//! |---|---|---|
//! | position, rotation vector of a step | x, Θ | `x`, `theta` |
//! | rotation from the undeformed state | R, unit quaternion | `R()`, `rotation` |
//! | velocity, angular; accelerations | v, ω; a, α | `v`, `omega`; `a`, `alpha` |
//! | increment of a step and its rates | q, q̇, q̈ | `q`, `d`, `dd` |
//! | tangent, mass, inertia in the body and now | K, m, J₀, J | `K`, `mass`, `J0`, `J` |
//! | arm of a rigid link, its constraint matrix | S, D | `S`, `D` |
//! | gradient of constraint equations, multipliers | G, λ | `G`, `lambda` |
//! | stress, relative to the back stress X; plastic multiplier | σ, ξ; Δλ | `stress`, `relative`, `back`; `multiplier` |
//! | strains, stress resultants, section stiffness | Γ, κ; n, m; C | `gamma`, `kappa`; `n`, `m`; `C` |
//!
//! A vector without a suffix is global.

#![warn(missing_docs)]

pub mod command;

pub use base::{diagnostic, math, names, quantities, snapshot, text_file, words};
pub use mechanics::{amplitude, constraints, elements, integrators, materials, sections, solids, state};
pub use model::{mesh, record};
pub use results as output;
pub use solve::{modes, plan, system};
pub use {deck, linear, model, solve, study, sweep};
