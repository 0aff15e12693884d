//! The output times and events that steps must end at, and the intervals between them.

use crate::model::{Cadence, Model, When};
use crate::solve::context::Context;
use crate::solve::march::March;
use crate::solve::outcome::Outcome;
use crate::solve::workspace::Workspace;
use crate::state::State;

/// A controller that covers the time interval by interval.
pub trait CoverInterval {
    /// Prepares for a run from this state, or for going on from it after a jump of the loads.
    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State);

    /// Takes the state of a run to the end of an interval.
    ///
    /// # Errors
    /// The outcome that ends the run early.
    fn cover(&mut self, march: &mut March, interval: &Interval) -> Result<(), Outcome>;
}

/// An interval of time without events inside. It is covered in equal steps where their length is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Time of its beginning.
    pub from: f64,
    /// Time of its end.
    pub to: f64,
    /// Number of steps of the given length.
    pub steps: usize,
    /// True where its end is an output time.
    pub due: bool,
    /// True where a load jumps at its end.
    pub jump: bool,
}

impl Interval {
    /// The end of the k-th step, k = 1..=steps; the last is `to` exactly.
    pub fn time(&self, k: usize) -> f64 {
        if k == self.steps { self.to } else { self.from + (self.to - self.from) * (k as f64 / self.steps as f64) }
    }
}

/// Divides [0, end] at output times, at the times of expectations, at `others` and where loads jump, each interval into steps no
/// longer than the deck's.
pub fn intervals(model: &Model, others: impl Iterator<Item = f64>) -> Vec<Interval> {
    let mut out: Vec<Interval> = others.map(|time| ending(time, false, false)).collect();
    add_output_times(model, &mut out);
    add_jumps_and_kinks(model, &mut out);
    divide(model, out)
}

/// Number of times at which runs of one scene are compared.
pub const COMPARISONS: usize = 16;

/// The k-th time of comparison in a run of this length, k = 1..=[`COMPARISONS`]: spread evenly, but equidistant with no vibration, which
/// might pass through its extremes at all of them, where an error of phase does not show.
pub fn comparison_time(k: usize, end_time: f64) -> f64 {
    /// The part of the golden section of which multiples are spread most evenly between whole numbers.
    const GOLDEN: f64 = 0.618_033_988_749_895;
    end_time * ((k as f64 - 0.6 * (k as f64 * GOLDEN).fract()) / COMPARISONS as f64)
}

/// All times of comparison.
pub fn comparison_times(end_time: f64) -> impl Iterator<Item = f64> {
    (1..=COMPARISONS).map(move |k| comparison_time(k, end_time))
}

/// The intervals of a trial run, of which nothing is written.
pub fn trial_intervals(model: &Model) -> Vec<Interval> {
    let mut out: Vec<Interval> =
        comparison_times(model.analysis.end_time).map(|time| ending(time, false, false)).collect();
    add_jumps_and_kinks(model, &mut out);
    divide(model, out)
}

fn ending(to: f64, due: bool, jump: bool) -> Interval {
    Interval { from: 0.0, to, steps: 0, due, jump }
}

fn add_output_times(model: &Model, out: &mut Vec<Interval>) {
    let end = model.analysis.end_time;
    out.push(ending(end, true, false));
    if let Cadence::Interval(interval) = model.output.cadence {
        let count = (end / interval + 1e-9).floor() as usize;
        out.extend((1..=count).map(|k| ending(multiple(k, interval), true, false)));
    }
    for expect in &model.expects {
        if let When::Time(t) = expect.when {
            out.push(ending(t, true, false));
        }
    }
}

fn add_jumps_and_kinks(model: &Model, out: &mut Vec<Interval>) {
    let driving = || {
        let loads = model.loading.nodal.iter().filter_map(|load| load.amplitude);
        let pressures = model.loading.pressures.iter().filter_map(|load| load.amplitude);
        loads.chain(pressures).chain(model.loading.base_accelerations.iter().map(|base| base.amplitude))
    };
    for amplitude in driving() {
        out.extend(model.loading.amplitudes[amplitude].jumps().iter().map(|jump| ending(jump.time, false, true)));
    }
    if model.analysis.step_length.is_automatic() {
        // Steps must not miss what begins and ends within one, and error estimates hold for smooth motion.
        let motions = model
            .constraints
            .restraints
            .iter()
            .filter_map(|restraint| restraint.motion.as_ref())
            .map(|motion| motion.amplitude);
        for amplitude in motions.chain(driving()) {
            out.extend(model.loading.amplitudes[amplitude].kinks().into_iter().map(|time| ending(time, false, false)));
        }
    }
}

/// Puts the ends of intervals in order, each once, and counts steps between them.
fn divide(model: &Model, mut out: Vec<Interval>) -> Vec<Interval> {
    let (end, dt) = (model.analysis.end_time, model.analysis.nominal_step());
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * end;
    out.retain(|s| s.to > 1e-9 * end && s.to <= end * (1.0 + 1e-9));
    out.sort_by(|a, b| a.to.total_cmp(&b.to));
    out.dedup_by(|next, kept| {
        let one = same(next.to, kept.to);
        if one {
            kept.due |= next.due;
            kept.jump |= next.jump;
        }
        one
    });
    if let Some(last) = out.last_mut() {
        last.to = end;
    }
    let mut from = 0.0;
    for interval in &mut out {
        // A rounding error beyond a whole number of steps needs no extra step.
        let steps = (interval.to - from) / dt - 1e-9 * (interval.to / dt).max(1.0);
        interval.steps = steps.ceil().max(1.0) as usize;
        interval.from = from;
        from = interval.to;
    }
    out
}

/// The k-th multiple of the output interval, rounded once where the interval is one over a whole number: 0.009, not
/// 0.009000000000000001.
fn multiple(k: usize, interval: f64) -> f64 {
    let per_unit = (1.0 / interval).round();
    if (per_unit * interval - 1.0).abs() < 4.0 * f64::EPSILON { k as f64 / per_unit } else { k as f64 * interval }
}
