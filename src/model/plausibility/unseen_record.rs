//! Time steps that are longer than the spacing of the record that they sample.

use crate::data::StepLength;
use crate::plausibility::usage::amplitudes_over_time;
use crate::report::Report;
use crate::scene::Scene;
use base::names::{short, to_digits};
use mechanics::amplitude::Amplitude;
use mechanics::integrators::{Scheme, Stepping};

/// The part of the mean square of a record that may lie between the samples of a run. A sine has it with six samples a period, whose straight
/// lines miss its peaks by up to 13 %.
const MOST: f64 = 0.01;

/// Warns of fixed steps of a dynamic analysis that sample a table more coarsely than its points, where they miss a part of it.
pub fn check_unseen_records(scene: &Scene, scheme: &dyn Scheme, amplitudes: &[Amplitude], report: &mut Report) {
    let (StepLength::Fixed { step }, true) = (&scene.analysis.step_length, scene.analysis.is_dynamic()) else { return };
    let stages = match scheme.stepping() {
        Stepping::OneStage | Stepping::Verlet => 1,
        Stepping::Composite(_) => 2,
        Stepping::DiagonallyImplicit(tableau) => tableau.stages(),
        Stepping::RungeKutta(tableau) => tableau.stages(),
    };
    let used = amplitudes_over_time(scene.deck);
    let apart = step / stages as f64;
    let times = [scene.analysis.begin, scene.analysis.end_time];
    let tables = scene.deck.amplitudes.0.iter().zip(amplitudes).filter(|((name, _), _)| used.contains(name.as_str()));
    for ((name, words), amplitude) in tables {
        let Some((spacing, missed)) = missed(amplitude, apart, times).filter(|(_, missed)| *missed > MOST) else {
            continue;
        };
        let what = words.file.as_ref().map_or("table", |_| "record");
        let message = format!(
            "a step of {} samples the {what} of amplitude `{}`, whose points are about {} apart: {} % of its mean square lies between the samples",
            short(*step),
            name.value,
            to_digits(spacing, 3),
            to_digits(100.0 * missed, 2)
        );
        let hint = format!("give `time_step` = {} or less", to_digits(spacing * stages as f64, 3));
        report.warn(&name.span, message, hint);
    }
}

/// The mean distance of the points of a table within a run, and the part of its mean square that samples so far `apart` miss. Lines join the
/// samples. `None` where samples are as close as the points.
pub fn missed(amplitude: &Amplitude, apart: f64, [begin, end]: [f64; 2]) -> Option<(f64, f64)> {
    let points = amplitude.points()?;
    let inside: Vec<&[f64; 2]> = points.iter().filter(|[time, _]| begin <= *time && *time <= end).collect();
    // Zeros before and after a record do not count as its points.
    let first = inside.iter().position(|[_, value]| *value != 0.0)?;
    let last = inside.iter().rposition(|[_, value]| *value != 0.0)?;
    let acting = &inside[first.saturating_sub(1)..(last + 2).min(inside.len())];
    let spacing = (acting.last()?[0] - acting.first()?[0]) / (acting.len() - 1).max(1) as f64;
    if spacing <= 0.0 || spacing >= 0.999 * apart {
        return None;
    }
    let sample = |count: f64| (begin + count * apart).min(end);
    let line = |time: f64| {
        let count = ((time - begin) / apart).floor();
        let [a, b] = [sample(count), sample(count + 1.0)];
        let [from, to] = [a, b].map(|time| amplitude.value(time));
        if b > a { from + (to - from) * (time - a) / (b - a) } else { from }
    };
    // Simpson's rule over the points is exact for lines, and the kinks at samples between two points are hardly felt.
    let square = |value: &dyn Fn(f64) -> f64, [a, b]: [f64; 2]| {
        let [low, mid, high] = [a, 0.5 * (a + b), b].map(|time| value(time).powi(2));
        (b - a) / 6.0 * (low + 4.0 * mid + high)
    };
    let pieces = || acting.windows(2).map(|pair| [pair[0][0], pair[1][0]]);
    let whole: f64 = pieces().map(|piece| square(&|time| amplitude.value(time), piece)).sum();
    let between: f64 = pieces().map(|piece| square(&|time| amplitude.value(time) - line(time), piece)).sum();
    (whole > 0.0).then(|| (spacing, between / whole))
}
