//! The error of steps, from runs with longer ones.

use rdsolve::math::Vec3;
use rdsolve::solve::Kept;
use rdsolve::solve::inner::{COMPARISONS, ModelSize};
use rdsolve::solve::{StepError, Warning};

/// Motions of these tests are far above rounding.
const SIZE: ModelSize = ModelSize { length: 1.0, rounding: 0.0 };

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
        error.judge(&run, &other, SIZE);
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

/// A pilot run with steps ten times as long has an error 39 times as large: differences of up to 5.8e-2 show an error below 1.5e-3. With steps so long that
/// a difference of 0.35 would show it, too, both runs have nothing in common.
#[test]
fn a_pilot_run_with_nothing_in_common_judges_no_run() {
    let error = StepError::new(1e-3);
    let judges = |steps: usize, difference: f64| {
        error.is_judged_by(&kept(steps, 0.0, false), &kept(10, difference, false), SIZE)
    };
    assert!(judges(100, 5e-2) && !judges(100, 6e-2));
    assert!(judges(1000, 0.29) && !judges(1000, 0.35));
}

/// A run with so many equal steps up to each of these times.
fn in_pieces(pieces: &[(f64, usize)]) -> Kept {
    let mut ends = vec![0.0];
    for &(until, steps) in pieces {
        let from = *ends.last().unwrap();
        ends.extend((1..=steps).map(|n| from + (until - from) * n as f64 / steps as f64));
    }
    Kept { ends, between: [0.0, 1.0], ..kept(1, 0.0, false) }
}

/// A pilot run has 10 and 100 steps in both halves. Its errors may come from the second half, whose ratio counts: 4^0.8 for steps half as long. The sums
/// over both halves follow the first one.
#[test]
fn a_ratio_counts_by_the_worst_end_of_a_run() {
    let pilot = in_pieces(&[(0.5, 10), (1.0, 100)]);
    let pieces = |steps| in_pieces(&[(0.5, 80), (1.0, steps)]);
    let apart = pieces(200).apart(&pilot);
    assert!((apart - 4f64.powf(0.8)).abs() < 1e-9, "{apart}");
    // Steps of the second half that are as long as those of the pilot run, or longer, tell no error, however short those of the first half are.
    assert!(pieces(200).is_told_by(&pilot) && !pieces(101).is_told_by(&pilot) && !pieces(50).is_told_by(&pilot));
    let mut error = StepError::new(1e-3);
    assert!(error.judge(&pieces(50), &pilot, SIZE).is_some() && error.estimate.is_none(), "{error:?}");
}

/// Errors of the first half grow longer: they count three times as much as those of the second half. One interval has steps of both halves, which
/// moves the border by a twentieth of the run at most, and the ratio by less than a tenth.
#[test]
fn errors_of_the_first_half_count_three_times() {
    let pilot = in_pieces(&[(0.5, 40), (1.0, 40)]);
    for [first, second] in [[80, 160], [48, 320]] {
        let apart = in_pieces(&[(0.5, first), (1.0, second)]).apart(&pilot);
        let [early, late] = [first, second].map(|steps| (steps as f64 / 40.0).powf(1.6));
        let added = 1.0 / (0.75 / early + 0.25 / late);
        assert!((apart - added).abs() < 0.1 * added, "{apart} and {added}");
    }
}

/// Far from the error asked for, half the digits of an estimate are believed; nearer to it, tolerances fall to a quarter at most.
#[test]
fn far_estimates_lower_the_tolerance_by_a_root() {
    let next = |estimate: f64| StepError::new(1e-3).in_place_of(estimate, false);
    assert!((next(6e-2) - 1e-4).abs() < 1e-15 && next(5e-3) == 2.5e-4 && next(1.8e-3) == 0.6 / 1.8 * 1e-3);
}

/// Errors of first order fall with the length of steps: 1.5 times as long, they are 1.5 times as large.
#[test]
fn events_leave_errors_in_the_ratio_of_lengths() {
    let [run, pilot] = [30, 20].map(|steps| kept(steps, 0.0, true));
    assert!((run.apart(&pilot) - 1.5).abs() < 1e-9, "{}", run.apart(&pilot));
    let [fine, coarse] = [90, 20].map(|steps| kept(steps, 0.0, true));
    assert_eq!(fine.apart(&coarse), 2.0);
}
