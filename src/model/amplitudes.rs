//! `[amplitudes.x]`: functions of time.

use super::plausibility::record_units::{check_record_units, conversion, shakes_alone, waits_for_motion};
use super::records::Record;
use super::report::{Owner, Report};
use super::stages::CurrentStage;
use super::values::keys;
use base::diagnostic::{At, Span};
use base::math::cubic_curve::{CubicCurve, CurveShape};
use base::names::short;
use deck::Deck;
use deck::amplitudes as words;
use deck::words::{Maybe, Table};
use mechanics::amplitude::{self, Amplitude};

/// Reads `[amplitudes]`, with the records that have been read for them. Each gives one, also those with errors, since others refer to them
/// by their index.
pub(super) fn amplitudes<'d>(
    deck: &'d Deck,
    stage: Option<CurrentStage<'d>>,
    records: &[Option<Record>],
    report: &mut Report<'d>,
) -> Vec<Amplitude> {
    let record = |index: usize| records.get(index).and_then(Option::as_ref);
    let all = deck.amplitudes.0.iter().enumerate();
    let read = all.map(|(index, (name, amplitude))| {
        let file = record(index);
        let waits = stage.and_then(|stage| stage.start_of_motion());
        let waits = waits.filter(|_| file.is_some_and(|record| waits_for_motion(deck, index, record)));
        if let (Some((time, name)), Some(file)) = (waits, &amplitude.file) {
            let message = format!("the record `{}` begins at t = {}, with stage `{name}`", file.value, short(time));
            report.note(&file.span, message, "`shift = 0.0` counts its times from t = 0");
        }
        let waits = waits.map(|(time, _)| time);
        let record = file.map(|record| (record, conversion(deck, index, record).unwrap_or(1.0)));
        let ends = [waits.is_some(), shakes_alone(deck, index)];
        let read = read_amplitude(&name.value, amplitude, (record, ends), report);
        // In place of one with errors: it begins at zero, as a motion has to.
        let read = read.unwrap_or(Amplitude::Ramp { start: 0.0, end: 1.0 });
        match waits.or_else(|| stage.map(|stage| stage.clock(&amplitude.stage))) {
            Some(clock) if clock > 0.0 => read.later(clock),
            _ => read,
        }
    });
    let read: Vec<Amplitude> = read.collect();
    check_record_units(deck, records, report);
    // The amplitudes of loads without one follow them.
    read.into_iter().chain(stage.iter().flat_map(CurrentStage::own_amplitudes)).collect()
}

fn read_amplitude<'d>(
    name: &str,
    amplitude: &'d At<Table<words::Amplitude>>,
    record: (Option<(&Record, f64)>, [bool; 2]),
    report: &mut Report<'d>,
) -> Option<Amplitude> {
    let a = amplitude;
    let owner = Owner::new(format!("amplitude `{name}`"), &a.span);
    let kind = report.require(&owner, "kind", &a.kind)?.value;
    let points = keys_of_tables(a);
    let waves = keys!(a; frequency, angular_frequency);
    let phase = keys!(a; phase, phase_degrees);
    let window = keys!(a; start, end);
    let start = a.start.as_ref().map_or(0.0, |start| start.value);
    let end = a.end.as_ref().map_or(f64::INFINITY, |end| end.value);
    if let Some(at) = &a.end
        && end <= start
    {
        report.error::<()>(&at.span, format!("`end` must come after `start`, which is {start}"));
    }
    match kind {
        words::AmplitudeKind::Table => {
            report.reject_unused("a table", &[&waves[..], &phase, &window].concat());
            of_points_or_file(&owner, a, record, report)
        }
        words::AmplitudeKind::Sine => {
            report.reject_unused("a sine", &points);
            let angular_frequency = angular_frequency(&owner, a, report)?;
            let phase = self::phase(&owner, a, report);
            Some(Amplitude::Sine { angular_frequency, phase, start, end })
        }
        words::AmplitudeKind::SineSquared => {
            report.reject_unused("a sine squared", &[&points[..], &phase].concat());
            let angular_frequency = angular_frequency(&owner, a, report)?;
            Some(Amplitude::SineSquared { angular_frequency, start, end })
        }
        words::AmplitudeKind::Ramp => {
            report.reject_unused("a ramp", &[&points[..], &waves, &phase].concat());
            report.require(&owner, "end", &a.end)?;
            Some(Amplitude::Ramp { start, end })
        }
        words::AmplitudeKind::Step => {
            report.reject_unused("a step", &[&points[..], &waves, &phase].concat());
            Some(Amplitude::Step { start, end })
        }
        words::AmplitudeKind::Constant => {
            report.reject_unused("a constant", &[&points[..], &waves, &phase, &window].concat());
            Some(Amplitude::Constant)
        }
        words::AmplitudeKind::Harmonic => {
            report.reject_unused("a harmonic", &[&points[..], &waves, &window].concat());
            Some(Amplitude::Harmonic { phase: self::phase(&owner, a, report) })
        }
    }
}

/// The keys of tables, and where they are written.
fn keys_of_tables(a: &words::Amplitude) -> [(&'static str, Option<&Span>); 11] {
    keys!(a; points, file, columns, time_step, rows, unit, before, after, scale, shift, interpolation)
}

/// The phase in radians.
fn phase<'d>(owner: &Owner<'d>, a: &'d words::Amplitude, report: &mut Report<'d>) -> f64 {
    match (&a.phase, &a.phase_degrees) {
        (Some(_), Some(degrees)) => {
            let message = format!("{} takes `phase` or `phase_degrees`, not both", owner.what);
            report.error::<()>(&degrees.span, message);
            0.0
        }
        (Some(radians), None) => radians.value,
        (None, degrees) => degrees.as_ref().map_or(0.0, |degrees| degrees.value.to_radians()),
    }
}

/// A table through the points of the deck or of a file. Values of a file have a factor. A record that `waits` for the motion is zero before. A
/// record that `shakes` the ground alone falls to zero behind its end.
fn of_points_or_file<'d>(
    owner: &Owner<'d>,
    a: &'d At<Table<words::Amplitude>>,
    (record, ends): (Option<(&Record, f64)>, [bool; 2]),
    report: &mut Report<'d>,
) -> Option<Amplitude> {
    let of_file = keys!(a; columns, time_step, rows, unit);
    if a.file.is_some() {
        report.reject_unused("a table from a file", &keys!(a; points));
        let (record, factor) = record?;
        let points = record.points.iter().map(|[time, value]| [*time, value * factor]);
        return table(a, (points.collect(), ends), report);
    }
    report.reject_unused("a table without a file", &of_file);
    let points = report.require(owner, "points", &a.points)?;
    let points = report.rising("points", "time", points)?;
    table(a, (points, [false; 2]), report)
}

/// A table with the scale and shift of the deck, and with jumps to zero at its ends if the deck asks for them.
fn table<'d>(
    a: &'d At<Table<words::Amplitude>>,
    (mut points, [waits, shakes]): (Vec<[f64; 2]>, [bool; 2]),
    report: &mut Report<'d>,
) -> Option<Amplitude> {
    let is_zero = |beyond: &Maybe<words::Beyond>| beyond.as_ref().is_some_and(|at| at.value == words::Beyond::Zero);
    let number = |given: &Maybe<f64>, default: f64| given.as_ref().map_or(default, |given| given.value);
    let (scale, shift) = (number(&a.scale, 1.0), number(&a.shift, 0.0));
    points.iter_mut().for_each(|[time, value]| (*time, *value) = (*time + shift, *value * scale));
    if is_zero(&a.before) || waits && a.before.is_none() && points[0][1] != 0.0 {
        points.insert(0, [points[0][0], 0.0]);
    }
    if is_zero(&a.after) {
        points.push([points[points.len() - 1][0], 0.0]);
    } else if shakes
        && a.after.is_none()
        && let [.., [before, _], [last, value]] = points[..]
        && value != 0.0
    {
        // The instrument of a record went on after it: the next value is zero.
        points.push([2.0 * last - before, 0.0]);
    }
    let is_steep = |pair: &[[f64; 2]]| {
        let slope = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        pair[1][0] > pair[0][0] && !slope.is_finite()
    };
    let beyond = "values and slopes of this table must be below 1e308";
    let place = a.scale.as_ref().map_or(&a.span, |scale| &scale.span);
    if points.iter().flatten().any(|number| !number.is_finite()) || points.windows(2).any(is_steep) {
        return report.error(place, beyond);
    }
    let shape = match a.interpolation.as_ref().map(|interpolation| interpolation.value) {
        Some(words::Interpolation::Cubic) => CurveShape::Spline,
        Some(words::Interpolation::Natural) => CurveShape::Natural,
        Some(words::Interpolation::Clamped) => CurveShape::Clamped,
        Some(words::Interpolation::Monotone) => CurveShape::Monotone,
        Some(words::Interpolation::Linear) | None => {
            return Some(Amplitude::Table(amplitude::StraightLines::new(points)));
        }
    };
    let curve = CubicCurve::new(points, shape);
    if curve.is_finite() { Some(Amplitude::Curve(curve)) } else { report.error(place, beyond) }
}

/// Radians per time.
fn angular_frequency<'d>(owner: &Owner<'d>, a: &'d words::Amplitude, report: &mut Report<'d>) -> Option<f64> {
    match (&a.frequency, &a.angular_frequency) {
        (Some(_), Some(angular)) => {
            report.error(&angular.span, format!("{} takes `frequency` or `angular_frequency`, not both", owner.what))
        }
        (None, Some(_)) => report.positive("angular_frequency", &a.angular_frequency),
        _ if report.is_spoiled(owner.span, "angular_frequency") => None,
        _ => report.require_positive(owner, "frequency", &a.frequency).map(|hertz| std::f64::consts::TAU * hertz),
    }
}
