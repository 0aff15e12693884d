//! Factor and solve allocate nothing once each road has been taken.

use super::allocations;
use crate::structures::{Random, Values, chain, entries, fill, frame, slots};
use rdsolve::linear::{Factorization, Solver};

#[test]
fn nothing_is_allocated_after_the_first_time() {
    let mut random = Random(5);
    for structure in [chain(20, 6), chain(20, 3), frame(4, 4, 4, 6)] {
        for kind in [Factorization::BlockLu, Factorization::Cholesky] {
            let mut solver = Solver::new(&structure, kind, 1).unwrap();
            let matrices = [Values::Definite, Values::Indefinite]
                .map(|values| slots(&solver, &entries(&structure, values, &mut random)));
            let mut b = vec![1.0; structure.sizes.iter().sum()];
            let mut round = || {
                for matrix in &matrices {
                    fill(&mut solver, matrix);
                    solver.factor().unwrap();
                    solver.solve(&mut b);
                    solver.values().fill(0.0);
                    solver.factor().unwrap_err();
                }
            };
            round();
            let before = allocations();
            round();
            assert_eq!(allocations() - before, 0, "{kind:?}");
        }
    }
}
