//! What load steps keep.

use crate::allocations::allocations;
use rdsolve::solve::inner::{LoadSteps, Peak, SuddenLoads};
use rdsolve::system::{Loading, Prescribed, Scale};

/// The copy keeps its own memory, which is at hand before the step: a step allocates nothing.
#[test]
fn sudden_loads_are_copied_into_the_memory_at_hand() {
    let of = |value: f64| {
        let jump = Loading { factors: vec![value; 3], pressures: vec![value; 2], ..Loading::default() };
        LoadSteps { sudden: Some(SuddenLoads::new(value, 2.0 * value, jump)), ..LoadSteps::default() }
    };
    let (mut own, other) = (of(1.0), LoadSteps { careful: true, doubtful: Some((3.0, 4.0)), ..of(5.0) });
    let before = allocations();
    own.copy_from(&other);
    assert_eq!(allocations(), before);
    assert_eq!(format!("{own:?}"), format!("{other:?}"));
    own.copy_from(&LoadSteps::default());
    assert!(own.sudden.is_none() && !own.careful);
    own.copy_from(&other);
    assert_eq!(format!("{own:?}"), format!("{other:?}"));
}

#[test]
fn forces_of_the_run_count_where_nothing_acts_any_more() {
    let mut none = Peak::default();
    none.begin_step(&Loading { factors: vec![0.0], ..Loading::default() }, &[], 1.0);
    assert!(none.is_unstressed(1.0) && !none.is_unstressed(1e-3) && none.scale(Scale::default()) == Scale::default());
    let loads = |factor: f64| Loading { factors: vec![factor, 0.0], ..Loading::default() };
    let of = |force: f64| Scale { force, moment: 0.0 };
    // A body that a support moves, and that was stressed before: half of its force out of balance is no equilibrium.
    let mut moved = Peak::default();
    moved.begin_step(&loads(1.0), &[], 1.0);
    moved.scale(of(30.0));
    moved.keep(1e-9);
    let support = Prescribed { u: 1e-3, ..Prescribed::default() };
    moved.begin_step(&loads(0.0), &[support], 1.0);
    for (force, unstressed) in [(15.0, false), (1e-3, false), (3e-9, true)] {
        moved.scale(of(force));
        assert_eq!(moved.is_unstressed(0.5), unstressed, "{force}");
        assert!(!moved.is_unstressed(0.05), "{force}");
    }
    let mut peak = Peak::default();
    for (factor, own, measure) in
        [(1.0, 30.0, 30.0), (0.5, 15.0, 15.0), (1e-9, 3e-8, 3e-8), (1e-16, 3e-9, 30.0), (0.0, 1e-9, 30.0)]
    {
        peak.begin_step(&loads(factor), &[], 1.0);
        assert_eq!(peak.scale(of(own)), of(measure), "{factor}");
        peak.keep(1e-9);
    }
}
