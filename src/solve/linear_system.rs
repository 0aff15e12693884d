//! A matrix with its factorization, and the one protocol by which systems with joints are solved.

use crate::linear::Solver;
use crate::snapshot::keep;
use crate::system::Multipliers;
use crate::system::assembly::Assembly;

/// A sparse matrix with the assembly that fills it and its factors.
pub struct LinearSystem {
    /// The sparse matrix with its factorization.
    pub solver: Solver,
    /// The slots of the matrices of elements and nodes.
    pub assembly: Assembly,
}

keep!(LinearSystem { solver } without { assembly });

impl LinearSystem {
    /// Solves for nodal unknowns and multipliers together. `rhs` holds the forces on the nodal unknowns and becomes the
    /// correction. Its last entries, those of the multipliers, are written from the gaps and become δλ/s, ready for
    /// [`Multipliers::add`].
    #[inline]
    pub fn solve_augmented(&mut self, multipliers: &Multipliers, rhs: &mut [f64]) {
        let directions = rhs.len() - multipliers.gaps.len();
        multipliers.write_rhs(&mut rhs[directions..]);
        self.solver.solve(rhs);
        multipliers.subtract_gaps(&mut rhs[directions..]);
    }
}
