//! Linear statics: K u = f at t = 0, one factorization for all load cases or time steps.
//!
//! Forces and reactions follow from the matrix itself. Results of elements are their derivatives along the motion, so that elements need no
//! second set of formulas.

mod derivatives;
mod equations;
mod instants;
mod lead;
mod supports;
mod yielding;

pub use derivatives::AskedResults;
pub use lead::lead;
