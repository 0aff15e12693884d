//! Factor and solve allocate nothing once each road has been taken.

mod structures;

use rdsolve::linear::{Factorization, Solver};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use structures::{Random, Values, chain, entries, fill, frame, slots};

struct Counting;

thread_local! {
    // Of the test's own thread: that of the harness allocates when it comes to run. Constant and without a destructor, so
    // that the allocator may use it at any time.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: passes every call on to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

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
            let before = ALLOCATIONS.get();
            round();
            assert_eq!(ALLOCATIONS.get() - before, 0, "{kind:?}");
        }
    }
}
