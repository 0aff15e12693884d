//! Which factorisation, and what it costs against an iteration.

use crate::linear::{Factorization, Structure};
use crate::model::Gyroscopic;

pub fn kind(structure: &Structure, gyroscopic: Gyroscopic) -> Factorization {
    match gyroscopic {
        Gyroscopic::Left => Factorization::BlockLu,
        Gyroscopic::Auto | Gyroscopic::Right => Factorization::choose(structure),
    }
}

/// Residuals-with-solves that one forming and factorising is worth: measured on chains of beams and on space frames (see
/// benches/iteration.rs). A number of the plan, not of the clock, so that the same deck takes the same path.
pub fn refresh_cost(kind: Factorization) -> f64 {
    match kind {
        Factorization::BlockLu => 3.0,
        Factorization::Cholesky => 6.0,
    }
}
