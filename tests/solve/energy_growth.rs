//! Implicit steps whose motion gains energy out of nothing end the run.

use crate::support::{read_deck, run};
use rdsolve::solve::{Failure, Outcome};

/// A mass 1 on a spring of 100, let go with the velocity 1, in steps of `step`, by Newmark's scheme with γ = 1/2 and `beta`.
fn oscillator(step: f64, beta: f64) -> String {
    format!(
        r#"
[analysis]
kind = "dynamic"
end_time = 40.0
time_step = {step}
[integrator]
scheme = "newmark"
gamma = 0.5
beta = {beta}
[points]
mass = [0.0, 0.0, 0.0]
[[masses]]
at = "mass"
mass = 1.0
[[links]]
name = "spring"
from = {{ ground = [-1e4, 0.0, 0.0] }}
to = {{ node = "mass" }}
stiffness = 100.0
[[supports]]
at = "mass"
fix = ["uy", "uz"]
[[initial]]
at = "mass"
velocity = [1.0, 0.0, 0.0]
"#
    )
}

/// Linear acceleration, β = 1/6, is stable up to ω Δt = √12, Δt = 0.346: beyond, amplitudes grow without end, and the run fails. Below, and with the trapezoidal rule at any step, the run is sound.
#[test]
fn an_implicit_scheme_beyond_its_limit_ends_the_run() {
    let outcome = |step: f64, beta: f64| run(&read_deck(&oscillator(step, beta)), &mut |_| Vec::new()).outcome;
    for (step, beta) in [(0.2, 1.0 / 6.0), (0.36, 0.25), (2.0, 0.25)] {
        assert!(matches!(outcome(step, beta), Outcome::Done), "{step} {beta}");
    }
    match outcome(0.36, 1.0 / 6.0) {
        Outcome::Failed { failure: Failure::EnergyGrowth { ratio, kept_until, explicit: false }, .. } => {
            assert!(ratio > 1000.0 && kept_until < 40.0, "{ratio} {kept_until}");
        }
        other => panic!("{other:?}"),
    }
}
