//! Factor and solve allocate nothing once each road has been taken.

mod structures;

use rdsolve::linear::{Kind, Solver};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use structures::{Random, Values, chain, entries, fill, frame, slots};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: passes every call on to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Relaxed);
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
        for kind in [Kind::Block, Kind::Cholesky] {
            let mut solver = Solver::new(&structure, kind, 1);
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
            let before = ALLOCATIONS.load(Relaxed);
            round();
            assert_eq!(ALLOCATIONS.load(Relaxed) - before, 0, "{kind:?}");
        }
    }
}
