//! The part of a record that samples miss, against closed forms.

use rdsolve::amplitude::{Amplitude, StraightLines};
use rdsolve::model::inner::missed;
use std::f64::consts::{PI, TAU};

/// A sine of period 1 with 100 points.
fn sine() -> Amplitude {
    let points = (0..=1000).map(|k| 0.01 * f64::from(k)).map(|time| [time, (TAU * time).sin()]);
    Amplitude::Table(StraightLines::new(points.collect()))
}

/// Lines through n samples a period miss 1 + ⅓(2 + cos θ) − 4(1 − cos θ)/θ² of the mean square of a sine, θ = 2π/n.
#[test]
fn lines_through_samples_miss_a_known_part() {
    for n in [4.0, 5.0, 10.0, 20.0] {
        let theta = 2.0 * PI / n;
        let exact = 1.0 + (2.0 + theta.cos()) / 3.0 - 4.0 * (1.0 - theta.cos()) / (theta * theta);
        let (spacing, missed) = missed(&sine(), 1.0 / n, [0.0, 10.0]).unwrap();
        assert!((spacing - 0.01).abs() < 1e-9, "{spacing}");
        // A hundred points of the table are lines themselves.
        assert!((missed / exact - 1.0).abs() < 0.02 || (missed - exact).abs() < 1e-5, "{n}: {missed}, {exact}");
    }
}

#[test]
fn samples_at_the_points_miss_nothing() {
    assert_eq!(missed(&sine(), 0.01, [0.0, 10.0]), None);
    assert_eq!(missed(&sine(), 0.005, [0.0, 10.0]), None);
}

/// A ramp to a constant is no record, however steep, and a blow between two samples is missed whole.
#[test]
fn blows_between_samples_are_missed() {
    let table = |points: &[[f64; 2]]| Amplitude::Table(StraightLines::new(points.to_vec()));
    assert_eq!(missed(&table(&[[0.0, 0.0], [1e-6, 1.0], [1.0, 1.0]]), 0.1, [0.0, 1.0]), None);
    let blow = table(&[[0.0, 0.0], [0.02, 0.0], [0.03, 1.0], [0.04, 0.0], [1.0, 0.0]]);
    let (_, part) = missed(&blow, 0.1, [0.0, 1.0]).unwrap();
    assert!((part - 1.0).abs() < 1e-12, "{part}");
}
