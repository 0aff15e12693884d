//! Which factorisation, and what it costs against an iteration.

use crate::linear::{Kind, Structure};
use crate::model::Gyroscopic;

pub fn kind(structure: &Structure, gyroscopic: Gyroscopic) -> Kind {
    match gyroscopic {
        Gyroscopic::Left => Kind::Block,
        Gyroscopic::Auto | Gyroscopic::Right => Kind::choose(structure),
    }
}

/// Residuals-with-solves that one forming and factorising is worth: measured on chains of beams and on space frames (see
/// benches/iteration.rs). A number of the plan, not of the clock, so that the same deck takes the same path.
pub fn refresh_cost(kind: Kind) -> f64 {
    match kind {
        Kind::Block => 3.0,
        Kind::Cholesky => 6.0,
    }
}
