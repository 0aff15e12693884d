//! A matrix with its factorisation, and the one protocol by which systems with joints are solved.

use crate::linear::Solver;
use crate::system::Multipliers;
use crate::system::assembly::Assembly;

/// A sparse matrix, the slots its entries go to, and its factors.
pub struct LinearSystem {
    pub solver: Solver,
    pub assembly: Assembly,
}

impl LinearSystem {
    /// Solves for directions and multipliers together. `rhs` holds the forces on the directions and becomes the correction; its
    /// last entries, which belong to the multipliers, are made of the gaps and become δλ/s, ready for [`Multipliers::add`].
    #[inline]
    pub fn solve_augmented(&mut self, multipliers: &Multipliers, rhs: &mut [f64]) {
        let directions = rhs.len() - multipliers.gaps.len();
        multipliers.write_rhs(&mut rhs[directions..]);
        self.solver.solve(rhs);
        multipliers.subtract_gaps(&mut rhs[directions..]);
    }
}
