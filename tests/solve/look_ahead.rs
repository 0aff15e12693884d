//! The error of a run under way: when the tolerance of its rest falls, when it begins again, and what a checkpoint keeps.

use rdsolve::math::Vec3;
use rdsolve::snapshot::{Keep, Snapshot};
use rdsolve::solve::Kept;
use rdsolve::solve::inner::{COMPARISONS, LookAhead, ModelSize};

const ASKED: f64 = 1e-3;
/// Ratio of the errors of a pilot run with steps twice as long, by a scheme of third order.
fn apart() -> f64 {
    8f64.powf(0.8)
}

/// A run of steps of this length up to one of the times of comparison. Its difference to a run without errors is `at_end` as root mean square over
/// the whole run, and this mean over the first n times is proportional to n.
fn run(length: f64, times: usize, at_end: f64) -> Kept {
    let error = |k: usize| at_end / COMPARISONS as f64 * ((3 * k * (k - 1) + 1) as f64).sqrt();
    let end = times as f64 / COMPARISONS as f64;
    Kept {
        displacements: (1..=times).flat_map(|k| [Vec3::x(), error(k) * Vec3::y()]).collect(),
        times,
        ends: (0..=(end / length).round() as usize).map(|n| n as f64 * length).collect(),
        power: 4,
        between: [0.0, 1.0],
        ..Kept::default()
    }
}

fn pilot() -> Kept {
    run(1.0 / 80.0, COMPARISONS, 0.0)
}

/// A run that will err by `predicted` times the error asked for, as far as one of the times of comparison.
fn part(times: usize, predicted: f64) -> Kept {
    run(1.0 / 160.0, times, predicted * ASKED * (apart() - 1.0))
}

fn ahead(pilot: &Kept) -> LookAhead<'_> {
    LookAhead::new(pilot, (ASKED, ASKED), ModelSize { length: 1.0, rounding: 0.0 }, true)
}

/// The factor on the tolerance, and the predicted error over that asked for if the run ends, after one look.
fn seen(times: usize, predicted: f64) -> [Option<f64>; 2] {
    let pilot = pilot();
    let mut ahead = ahead(&pilot);
    ahead.look(&part(times, predicted));
    [ahead.new_tolerance(), ahead.predicted()].map(|value| value.map(|value| value / ASKED))
}

/// The first quarter of a linear growth makes a quarter of the error. The rest then needs the factor (0.6 - 1.2/4)/(1.2·3/4) = 1/3 for an error of
/// 1.2. One of 1.9 needs 0.09, and gets the least factor, 0.25, since that leaves 0.83.
#[test]
fn the_tolerance_falls_where_the_rest_suffices() {
    let [factor, ends] = seen(4, 1.2);
    assert!(factor.is_some_and(|factor| (factor - 1.0 / 3.0).abs() < 1e-9) && ends.is_none(), "{factor:?} {ends:?}");
    for (times, predicted) in [(4, 1.9), (6, 1.7), (8, 1.7), (6, 2.1)] {
        assert_eq!(seen(times, predicted), [Some(0.25), None], "{times} {predicted}");
    }
    // An error a little below that asked for needs nothing.
    assert_eq!(seen(4, 0.95), [None, None]);
}

/// A prediction ends the run above six times the error asked for after a quarter, and above four times this error after three eighths.
#[test]
fn a_hopeless_run_ends_early() {
    for (times, predicted) in [(4, 6.1), (6, 4.1), (8, 4.1), (10, 4.1)] {
        let [factor, ends] = seen(times, predicted);
        assert!(ends.is_some_and(|error| (error - predicted).abs() < 1e-9) && factor.is_none(), "{ends:?} {factor:?}");
    }
    for (times, predicted) in [(4, 5.9), (5, 5.0), (6, 3.9)] {
        assert_eq!(seen(times, predicted), [None, None], "{times}");
    }
}

/// The least tolerance counts for a run made again, and a run resumed after the fall has it.
#[test]
fn a_checkpoint_keeps_a_lowered_tolerance() {
    let pilot = pilot();
    let mut whole = ahead(&pilot);
    whole.advance(0.25);
    assert_eq!(whole.least_tolerance(), ASKED);
    whole.look(&part(4, 1.9));
    assert_eq!(whole.least_tolerance(), 0.25 * ASKED);
    let mut taken = Snapshot::taken();
    whole.keep(&mut taken);
    let mut resumed = ahead(&pilot);
    let mut given = Snapshot::of(taken.into_bytes());
    resumed.keep(&mut given);
    assert!(given.is_used_up());
    for run in [&mut whole, &mut resumed] {
        assert_eq!(run.new_tolerance(), Some(0.25 * ASKED));
        run.advance(0.75);
        assert_eq!(run.least_tolerance(), 0.25 * ASKED);
        // One third of the time had the tolerance asked for, and two thirds had a quarter of it.
        assert!((run.mean_tolerance() - 0.5 * ASKED).abs() < 1e-12, "{}", run.mean_tolerance());
    }
}
