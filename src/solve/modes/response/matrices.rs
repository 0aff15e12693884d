//! The matrices of a motion about a state, gyroscopic moments among them.

use super::super::gyroscopic::Gyroscopic;
use super::super::pencil::{Pencil, weights};
use linear::Sparse;

/// K, C and M over the unknowns of nodes, without the equations of joints.
pub struct Matrices {
    /// Stiffness, with the terms of an unsteady spin.
    pub K: Sparse,
    /// Damping and gyroscopic moments.
    pub C: Sparse,
    /// Mass.
    pub M: Sparse,
}

impl Matrices {
    /// Matrices of a pencil, which has an unsymmetric solver if they are unsymmetric.
    pub fn of(pencil: &mut Pencil, gyroscopic: &Gyroscopic) -> Matrices {
        let (plain, with_rates) = (pencil.matrix(weights(0.0, 0.0)), pencil.matrix(weights(1.0, 0.0)));
        let n = plain.rows();
        let rates = Sparse::from_entries(n, |visit| gyroscopic.entries(&mut |i, j, [rate, _]| visit(i, j, rate)));
        let turns = Sparse::from_entries(n, |visit| gyroscopic.entries(&mut |i, j, [_, turn]| visit(i, j, turn)));
        let C = Sparse::sum(&[(1.0, &with_rates), (-1.0, &plain), (1.0, &rates)]);
        Matrices { K: Sparse::sum(&[(1.0, &plain), (1.0, &turns)]), C, M: pencil.mass.clone() }
    }
}
