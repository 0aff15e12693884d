//! The error of steps, from runs with longer ones.

use rdsolve::math::Vec3;
use rdsolve::solve::Kept;
use rdsolve::solve::inner::COMPARISONS;
use rdsolve::solve::{StepError, Warning};

/// A run of so many equal steps in which one node moves by 1 and the position of another is out by `error`.
fn kept(steps: usize, error: f64, met_events: bool) -> Kept {
    Kept {
        displacements: (0..COMPARISONS).flat_map(|_| [Vec3::x(), error * Vec3::y()]).collect(),
        times: COMPARISONS,
        ends: (0..=steps).map(|n| n as f64 / steps as f64).collect(),
        power: 3,
        met_events,
        ..Kept::default()
    }
}

/// Judges four runs whose steps halve from run to run, with these differences between one and the next.
fn judged(differences: [f64; 3], met_events: bool) -> StepError {
    let mut error = StepError::new(1e-3);
    let mut at = 0.0;
    let mut other = kept(10, at, met_events);
    for (k, difference) in differences.into_iter().enumerate() {
        at += difference;
        let run = kept(20 << k, at, met_events);
        error.judge(&run, &other, 1.0);
        other = run;
    }
    error
}

/// Differences that fall by 1.25 from run to run leave 1/1.25 + 1/1.25² + ... = 4 times the last one.
#[test]
fn events_leave_the_error_that_three_runs_show() {
    let [first, second] = [6e-3, 6e-3 / 1.25];
    let error = judged([first, second, second / 1.25], true);
    let left = 4.0 * second / 1.25;
    assert!((error.estimate.unwrap() - left).abs() < 1e-9 * left, "{error:?}");
    // Without events the orders of the steps hold.
    assert!(judged([first, second, second / 1.25], false).estimate.unwrap() < 0.3 * left);
    // Differences that fall faster than events let them tell what they told.
    let fast = judged([8e-3, 2e-3, 5e-4], true);
    assert!((fast.estimate.unwrap() - 5e-4).abs() < 1e-12, "{fast:?}");
}

#[test]
fn runs_that_come_no_nearer_have_no_estimate() {
    let error = judged([6e-3, 3e-3, 2.9e-3], true);
    assert_eq!(error.estimate, None);
    assert!(
        matches!(error.warning(), Some(Warning::RunsPart { difference, .. }) if (difference - 2.9e-3).abs() < 1e-9)
    );
}
