//! Tables of positions and velocities for prescribed motion: straight lines between samples have no acceleration, or one that jumps at each
//! sample. Supports and joints therefore follow splines between the corners of the table.

use super::data::Analysis;
use super::report::Report;
use super::stages::CurrentStage;
use base::math::cubic_curve::{CubicCurve, CurveShape};
use base::names::short;
use deck::Deck;
use deck::amplitudes::AmplitudeKind;
use deck::supports::History;
use deck::words::Maybe;
use mechanics::amplitude::{Amplitude, Side};
use std::collections::{BTreeMap, HashMap};

/// Overshoot of a curve for a note, relative to the range of the segment; eight samples per period give 0.04.
const OVERSHOOT: f64 = 0.05;
/// Velocities that jump by less than this part of the largest do not count.
const FELT: f64 = 1e-2;

/// Adds curves to the amplitudes for the tables that prescribe positions or velocities in a run with inertia. Returns their indices by those of
/// the tables.
pub(super) fn motion_curves(
    deck: &Deck,
    stage: Option<CurrentStage>,
    analysis: &Analysis,
    amplitudes: &mut Vec<Amplitude>,
    report: &mut Report,
) -> HashMap<usize, usize> {
    let any_dynamic = stage.map_or(analysis.is_dynamic(), |stage| stage.sequence.first_dynamic().is_some());
    let mut curves = HashMap::new();
    if !any_dynamic {
        return curves;
    }
    for (index, is_position) in of_motions(deck) {
        let words = &deck.amplitudes.0[index].1;
        let is_table = words.kind.as_ref().is_some_and(|kind| kind.value == AmplitudeKind::Table);
        if is_table
            && words.interpolation.is_none()
            && let Some(points) = amplitudes[index].points()
        {
            let curve = CubicCurve::new(points.to_vec(), CurveShape::SplineWithCorners);
            if curve.is_finite() && !curve.is_straight() {
                curves.insert(index, amplitudes.len());
                amplitudes.push(Amplitude::Curve(curve));
            }
        }
        if analysis.is_dynamic() {
            let used = curves.get(&index).copied().unwrap_or(index);
            if is_position {
                check_corners(deck, index, (&amplitudes[used], analysis), report);
            }
            check_overshoot(deck, index, &amplitudes[used], report);
        }
    }
    curves
}

/// Indices of the amplitudes that supports and joints take for positions or velocities, with true where one takes it for positions.
fn of_motions(deck: &Deck) -> BTreeMap<usize, bool> {
    let motions = deck.supports.iter().filter_map(|support| support.motion.as_ref());
    let motions = motions.flat_map(|motions| motions.each()).flatten();
    let history = |history: &Maybe<History>| history.as_ref().map_or(History::Displacement, |history| history.value);
    let of_supports = motions.map(|motion| (&motion.amplitude, history(&motion.history)));
    let of_joints = deck.joints.iter().filter_map(|joint| joint.motion.as_ref());
    let of_joints = of_joints.map(|motion| match (&motion.position, &motion.velocity) {
        (Some(_), _) => (&motion.amplitude, History::Displacement),
        (None, Some(_)) => (&motion.amplitude, History::Velocity),
        (None, None) => (&motion.amplitude, History::Acceleration),
    });
    let mut found = BTreeMap::new();
    for (name, history) in of_supports.chain(of_joints).filter(|(_, history)| *history != History::Acceleration) {
        if let Some(index) = name.as_ref().and_then(|name| deck.amplitudes.position(name)) {
            *found.entry(index).or_insert(false) |= history == History::Displacement;
        }
    }
    found
}

/// Warns of velocity jumps within the run, and notes an overshooting curve.
fn check_corners(deck: &Deck, index: usize, (amplitude, analysis): (&Amplitude, &Analysis), report: &mut Report) {
    let (name, words) = &deck.amplitudes.0[index];
    let slack = 1e-9 * analysis.end_time;
    let is_inside = |time: f64| time > analysis.begin + slack && time < analysis.end_time - slack;
    let rates = |time: f64| [Side::Before, Side::After].map(|side| amplitude.rate(time, side));
    let all: Vec<(f64, f64)> = amplitude
        .slope_jumps()
        .into_iter()
        .map(|time| (time, rates(time)))
        .map(|(time, [before, after])| (time, (after - before).abs()))
        .collect();
    let largest = amplitude.kinks().into_iter().flat_map(rates).fold(0.0, |most: f64, rate| most.max(rate.abs()));
    let corners: Vec<f64> = all
        .into_iter()
        .filter(|&(time, jump)| is_inside(time) && jump > FELT * largest)
        .map(|(time, _)| time)
        .collect();
    if let Some(first) = corners.first() {
        let more = match corners.len() - 1 {
            0 => String::new(),
            1 => " and once more".to_owned(),
            more => format!(" and {more} times more"),
        };
        let message = format!(
            "amplitude `{}` prescribes positions whose velocity jumps at t = {}{more}",
            name.value,
            short(*first)
        );
        let is_table = words.kind.as_ref().is_some_and(|kind| kind.value == AmplitudeKind::Table);
        let remedy = match is_table {
            true => {
                "`interpolation = \"monotone\"` rounds corners without overshoot, \"cubic\" follows samples of a smooth motion"
            }
            false => "a table with `interpolation = \"monotone\"` starts and stops smoothly",
        };
        report.warn(&name.span, message, format!("the force is an impulse there, which no table shows: {remedy}"));
    }
}

/// Notes a curve that overshoots its points.
fn check_overshoot(deck: &Deck, index: usize, amplitude: &Amplitude, report: &mut Report) {
    let name = &deck.amplitudes.0[index].0;
    let Amplitude::Curve(curve) = amplitude else { return };
    if let Some((part, [from, to])) = curve.overshoot().filter(|(part, _)| *part > OVERSHOOT) {
        let message = format!(
            "the curve of amplitude `{}` goes beyond its points between t = {} and {} by {} % of their range",
            name.value,
            short(from),
            short(to),
            (100.0 * part).round()
        );
        report.note(&name.span, message, "`interpolation = \"monotone\"` does not, \"linear\" has corners");
    }
}
