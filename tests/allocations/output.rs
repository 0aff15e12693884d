//! Rows are written without allocating. Counted on the thread of the test alone: the harness, which waits beside it, allocates
//! when it comes to run, on a busy machine in the middle of the count.

use super::allocations;
use crate::scene;
use rdsolve::output::Files;
use rdsolve::output::expect::Expectations;
use rdsolve::output::progress::Progress;
use rdsolve::solve::Observer;

#[test]
fn nothing_is_allocated_per_row() {
    let dir = tempfile::tempdir().unwrap();
    let mut model = scene::model();
    model.nodes[2].label = "elbow".into();
    let state = scene::state(&model, 0.7);
    let extras = scene::Extras::at(0.7);
    let mut files = Files::open(dir.path(), &model).unwrap();
    let (mut expectations, mut progress) = (Expectations::new(&model), Progress::new(true));
    let mut round = |steps| {
        for step in steps {
            let frame = extras.frame(&model, &state, step);
            files.on_step(&frame).unwrap();
            expectations.on_step(&frame).unwrap();
            progress.on_step(&frame).unwrap();
        }
    };
    round(0..2);
    let before = allocations();
    round(2..2000);
    assert_eq!(allocations() - before, 0);
}
