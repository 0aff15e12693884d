//! Angles in degrees in place of radians.

use crate::report::Report;
use base::diagnostic::Span;
use base::names::short;
use deck::Deck;
use deck::amplitudes::Amplitude;
use deck::joints::Joint;
use deck::supports::{History, Motion};
use deck::words::Maybe;
use deck::words::kinds::OneOf;
use mechanics::constraints::joints::kind::Coordinate;
use std::f64::consts::TAU;

/// Angles in degrees are mostly multiples of this, and radians hardly ever.
const MULTIPLE: f64 = 15.0;
/// Limits and rests beyond a turn are rare; in degrees they are multiples of this, and so are the other angles. Motions by so many radians are a
/// note.
const FINE_MULTIPLE: f64 = 5.0;

/// Warns of angles that are whole multiples of 15 beyond a turn, as degrees are and radians are not.
pub fn check_angles(deck: &Deck, report: &mut Report) {
    let joints = deck.joints.iter().filter(|joint| is_angle(joint));
    for joint in joints {
        for (what, place, value) in resting(joint) {
            check(value, FINE_MULTIPLE, what, place, report);
        }
        if let Some(motion) = &joint.motion
            && let Some(position) = &motion.position
        {
            let value = position.value * largest(deck, &motion.amplitude);
            check(value, MULTIPLE, "the angle of this joint", &position.span, report);
        }
    }
    let motions = deck.supports.iter().filter_map(|support| support.motion.as_ref());
    for motion in motions.flat_map(|motions| [&motions.rx, &motions.ry, &motions.rz]).flatten() {
        if is_position(motion) {
            let value = motion.scale.as_ref().map_or(1.0, |scale| scale.value) * largest(deck, &motion.amplitude);
            check(value, MULTIPLE, "the rotation of this support", &motion.span, report);
        }
    }
    for (_, amplitude) in &deck.amplitudes.0 {
        if let Some(phase) = amplitude.phase.as_ref().filter(|phase| is_degrees(phase.value, MULTIPLE)) {
            let message = format!("the phase is {} radians, which looks like degrees", short(phase.value));
            report.warn(&phase.span, message, "`phase_degrees` takes degrees");
        }
    }
}

fn is_angle(joint: &OneOf<Joint>) -> bool {
    let own = joint.kind.as_ref().and_then(|kind| kind.make.coordinates.first().copied());
    joint.coordinate.as_ref().map_or(own, |coordinate| Some(coordinate.value)) == Some(Coordinate::Angle)
}

fn is_position(motion: &Motion) -> bool {
    motion.history.as_ref().is_none_or(|history| history.value == History::Displacement)
}

/// The angles of a joint at rest.
fn resting(joint: &Joint) -> Vec<(&'static str, &Span, f64)> {
    let limits = joint
        .limits
        .iter()
        .flat_map(|limits| limits.value.0.map(|limit| ("a limit of this joint", &limits.span, limit)));
    // One of both is enough to be told.
    let worst = limits.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
    let rest = joint.rest.as_ref().map(|rest| ("the rest of this joint", &rest.span, rest.value));
    worst.into_iter().chain(rest).collect()
}

/// The largest value of a table in the deck; 1 for all else.
fn largest(deck: &Deck, name: &Maybe<String>) -> f64 {
    let amplitude: Option<&Amplitude> = name.as_ref().and_then(|name| {
        let index = deck.amplitudes.position(name)?;
        Some(&**deck.amplitudes.0[index].1)
    });
    let Some(amplitude) = amplitude else { return 1.0 };
    let Some(points) = &amplitude.points else { return 1.0 };
    let scale = amplitude.scale.as_ref().map_or(1.0, |scale| scale.value);
    points.iter().map(|point| point.value.0[1].abs()).fold(0.0, f64::max) * scale
}

fn is_degrees(value: f64, multiple: f64) -> bool {
    let turns = value / multiple;
    value.abs() > TAU && value.abs() <= 720.0 && (turns - turns.round()).abs() < 1e-9
}

fn check(value: f64, multiple: f64, what: &str, place: &Span, report: &mut Report) {
    let turns = (10.0 * value / TAU).round() / 10.0;
    let hint = || format!("{} degrees are {} radians", short(value), short(value.to_radians()));
    if is_degrees(value, multiple) {
        let message = format!("{what} is {} radians, {turns} turns, and looks like degrees", short(value));
        report.warn(place, message, hint());
    } else if is_degrees(value, FINE_MULTIPLE) {
        report.note(place, format!("{what} is {} radians, {turns} turns", short(value)), hint());
    }
}
