//! The choice of the factorization, and its cost relative to an iteration.

use linear::{Factorization, Structure};
use model::Gyroscopic;

/// The factorization for this structure: LU where the deck wants gyroscopic terms in the matrix, else the cheaper one. Load steps
/// with slipping contacts need the unsymmetric part of friction to converge: no inertia restrains a slipping part.
pub fn kind(structure: &Structure, gyroscopic: Gyroscopic, slips_in_load_steps: bool) -> Factorization {
    match gyroscopic {
        Gyroscopic::Left => Factorization::BlockLu,
        Gyroscopic::Auto if slips_in_load_steps => Factorization::BlockLu,
        Gyroscopic::Auto | Gyroscopic::Right => Factorization::choose(structure),
    }
}

/// Cost of forming and factorizing a matrix, in units of one residual and one solve, measured on chains of beams and on space frames
/// (benches/iteration.rs). It is a number of the plan instead of a measured time, so a deck always takes the same path.
pub fn refresh_cost(kind: Factorization) -> f64 {
    match kind {
        Factorization::BlockLu => 3.0,
        Factorization::Cholesky => 6.0,
    }
}
