//! `[amplitudes.x]`: functions of time.

use super::report::{Owner, Report};
use super::values::span;
use crate::amplitude::Amplitude;
use crate::deck::Deck;
use crate::deck::amplitudes as words;
use crate::deck::words::{Maybe, Table};
use crate::diagnostic::At;

/// Reads `[amplitudes]`. Each gives one, also those with errors, since others refer to them by their index.
pub(super) fn amplitudes<'d>(deck: &'d Deck, report: &mut Report<'d>) -> Vec<Amplitude> {
    let read = deck.amplitudes.0.iter().map(|(name, amplitude)| read_amplitude(&name.value, amplitude, report));
    read.map(|amplitude| amplitude.unwrap_or(Amplitude::Constant)).collect()
}

fn read_amplitude<'d>(
    name: &str,
    amplitude: &'d At<Table<words::Amplitude>>,
    report: &mut Report<'d>,
) -> Option<Amplitude> {
    let a = amplitude;
    let owner = Owner::new(format!("amplitude `{name}`"), &a.span);
    let kind = report.require(&owner, "kind", &a.kind)?.value;
    let points = [("points", span(&a.points)), ("before", span(&a.before)), ("after", span(&a.after))];
    let waves = [("frequency", span(&a.frequency)), ("angular_frequency", span(&a.angular_frequency))];
    let phase = [("phase", span(&a.phase))];
    let window = [("start", span(&a.start)), ("end", span(&a.end))];
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
            let points = report.require(&owner, "points", &a.points)?;
            report.rising("time", points).map(|points| table(a, points))
        }
        words::AmplitudeKind::Sine => {
            report.reject_unused("a sine", &points);
            let angular_frequency = angular_frequency(&owner, a, report)?;
            let phase = a.phase.as_ref().map_or(0.0, |phase| phase.value);
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
    }
}

/// A table that jumps to zero at its ends where the deck says so.
fn table(a: &words::Amplitude, mut points: Vec<[f64; 2]>) -> Amplitude {
    let is_zero = |beyond: &Maybe<words::Beyond>| beyond.as_ref().is_some_and(|at| at.value == words::Beyond::Zero);
    if is_zero(&a.before) {
        points.insert(0, [points[0][0], 0.0]);
    }
    if is_zero(&a.after) {
        points.push([points[points.len() - 1][0], 0.0]);
    }
    Amplitude::Table { points }
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
