//! Steps by central differences that are refused.

use rdsolve::diagnostic::Source;
use rdsolve::model;
use rdsolve::plan::Plan;
use rdsolve::solve::Failure;
use rdsolve::solve::inner::{CentralDifferenceStepper, Context, Workspace, start};
use rdsolve::system::System;
use std::sync::atomic::AtomicBool;

static NEVER: AtomicBool = AtomicBool::new(false);

/// Steps that are refused, here by the limit, are not counted, before the first step and after it; the accelerations by which
/// a blow is told are those of the steps that were taken.
#[test]
fn refused_steps_are_not_counted() {
    let dt = 0.1;
    let text = format!(
        r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = {dt}
[integrator]
scheme = "central-difference"
[[bodies]]
name = "bob"
center = [1.0, 0.0, 0.0]
mass = 1.0
inertia = [0.1, 0.1, 0.1]
[[joints]]
name = "pivot"
kind = "ball"
from = {{ body = "bob", point = [0.0, 0.0, 0.0] }}
to = {{ ground = [0.0, 0.0, 0.0] }}
[[links]]
name = "spring"
from = {{ ground = [1.0, 1.0, 0.0] }}
to = {{ body = "bob" }}
law = "table"
points = [[-1.0, -1e4], [0.0, 0.0], [1.0, 2e4]]
[environment]
gravity = [0.0, -9.81, 0.0]
[output]
interval = 1.0
"#
    );
    let source = Source::new("deck.toml", &text, &[]);
    let (model, problems) = model::read(&source);
    let drawn: Vec<String> = problems.iter().map(|problem| problem.draw(&source, false)).collect();
    let model = model.unwrap_or_else(|| panic!("{}", drawn.join("\n")));
    let system = System::new(&model).unwrap();
    let plan = Plan::new(&model, &system, 1);
    let cx = Context::new(&model, &plan, &system, [true, false], &NEVER);
    let mut ws = Workspace::new(&cx).unwrap();
    let mut stepper = CentralDifferenceStepper::new(&cx).unwrap();
    let mut state = start(&cx, &mut ws).unwrap();
    stepper.restart(&cx, &mut ws, &mut state);
    let mut largest = state.work.accelerations;
    for taken in 0..3 {
        for _ in 0..2 {
            let to = state.time + dt;
            let failure = stepper.step(&cx, &mut ws, &mut state, to).unwrap_err();
            assert!(matches!(failure, Failure::Unstable { .. }), "{failure}");
            assert_eq!(stepper.critical.counts(), [taken, taken]);
        }
        let to = state.time + 0.02 * dt;
        stepper.step(&cx, &mut ws, &mut state, to).unwrap();
        largest = largest.max(state.work.accelerations);
    }
    assert!(largest > 0.0);
    assert!(stepper.critical.is_struck(4.01 * largest) && !stepper.critical.is_struck(4.0 * largest));
}
