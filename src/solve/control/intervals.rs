//! The output times and events that steps must end at, and the intervals between them.

use crate::context::Context;
use crate::march::March;
use crate::outcome::Outcome;
use crate::sample::Sample;
use crate::workspace::Workspace;
use base::snapshot::Keep;
use mechanics::amplitude::Side;
use mechanics::state::State;
use model::{AnalysisKind, Cadence, History, Model, When};

/// A controller that covers the time interval by interval.
pub trait CoverInterval: Keep {
    /// Prepares for a run from this state, or for going on from it after a jump of the loads.
    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State);

    /// Takes the state of a run to the end of an interval, from the place in it where the run is.
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
    /// True where a load, or the velocity of a prescribed motion, jumps at its end.
    pub jump: bool,
    /// True where runs are compared at its end.
    pub compared: bool,
}

impl Interval {
    /// The end of the k-th step, k = 1..=steps; the last is `to` exactly.
    pub fn time(&self, k: usize) -> f64 {
        if k == self.steps { self.to } else { self.from + (self.to - self.from) * (k as f64 / self.steps as f64) }
    }

    /// The remainder of the interval after a time, in steps no longer than `dt`.
    pub fn after(self, begin: f64, dt: f64) -> Interval {
        if begin <= self.from {
            return self;
        }
        Interval { from: begin, steps: steps_between([begin, self.to], dt), ..self }
    }
}

/// The output times of a run, and the intervals between the required ends of steps.
#[derive(Debug, Clone, Default)]
pub struct Schedule {
    /// The intervals that steps cover, one after the other.
    pub intervals: Vec<Interval>,
    /// Times inside them, in order; empty where steps end at all times.
    pub samples: Vec<Sample>,
}

/// A time with an output, a comparison or a jump.
struct Event {
    ending: Interval,
    /// True where a step must end at it, however well the motion is known inside steps.
    ends: bool,
}

impl Schedule {
    /// Divides [0, end] at jumps of loads, at output times, at times of expectations and at `compared` times. Each interval has steps no
    /// longer than the step of the deck. With `inside`, output times and the times of comparison lie inside steps.
    pub fn new(model: &Model, compared: impl Iterator<Item = f64>, inside: bool) -> Schedule {
        let mut events: Vec<Event> = compared.map(|time| comparison(time, !inside)).collect();
        add_output_times(model, &mut events, !inside);
        add_jumps_and_kinks(model, &mut events);
        divide(model, events)
    }

    /// The schedule with each interval cut into this number of equal ones, which shortens steps limited only by the ends of intervals.
    pub fn cut(mut self, pieces: usize) -> Schedule {
        let cut = |interval: &Interval| {
            let &Interval { from, to, steps, due, jump, compared } = interval;
            let last = pieces - 1;
            let time = move |k: usize| if k == pieces { to } else { from + (to - from) * (k as f64 / pieces as f64) };
            (0..pieces).map(move |k| Interval {
                from: time(k),
                to: time(k + 1),
                steps: steps.div_ceil(pieces),
                due: due && k == last,
                jump: jump && k == last,
                compared: compared && k == last,
            })
        };
        self.intervals = self.intervals.iter().flat_map(cut).collect();
        self
    }

    /// The schedule with intervals joined in pairs, also across kinks of loads. Jumps and times of comparison remain ends.
    pub fn in_pairs(mut self) -> Schedule {
        let mut joined = false;
        self.intervals.dedup_by(|next, kept| {
            joined = !(joined || kept.jump || kept.compared);
            if joined {
                *kept = Interval { from: kept.from, ..*next };
            }
            joined
        });
        self
    }

    /// The schedule with further ends of steps, in order.
    pub fn with_ends(mut self, ends: &[f64]) -> Schedule {
        let divided = |interval: &Interval| {
            let rounding = 1e-9 * (interval.to - interval.from);
            let (mut parts, mut rest) = (Vec::new(), *interval);
            let first = ends.partition_point(|end| *end <= interval.from + rounding);
            for &end in ends[first..].iter().take_while(|end| **end < interval.to - rounding) {
                if end > rest.from + rounding {
                    parts.push(Interval { to: end, due: false, jump: false, compared: false, ..rest });
                    rest.from = end;
                }
            }
            parts.push(rest);
            parts
        };
        self.intervals = self.intervals.iter().flat_map(divided).collect();
        self
    }

    /// The schedule up to a time inside.
    pub fn until(mut self, end: f64) -> Schedule {
        self.intervals.retain(|interval| interval.from < end);
        self.samples.retain(|sample| sample.time < end);
        if let Some(last) = self.intervals.last_mut().filter(|last| last.to > end) {
            last.to = end;
        }
        self
    }

    /// The times of a trial run, which writes no results.
    pub fn of_trial(model: &Model, compared: impl Iterator<Item = f64>, inside: bool) -> Schedule {
        let mut events: Vec<Event> = compared.map(|time| comparison(time, !inside)).collect();
        add_jumps_and_kinks(model, &mut events);
        divide(model, events)
    }
}

/// Number of times for the comparison of two runs of one model.
pub const COMPARISONS: usize = 16;

/// The k-th time of comparison in a run between these times, k = 1..=[`COMPARISONS`]. The times are spread evenly but not equidistant: a
/// vibration could pass its extremes at equidistant times, which would hide its phase error.
pub fn comparison_time(k: usize, [begin, end]: [f64; 2]) -> f64 {
    /// The golden section: the fractional parts of its multiples are spread most evenly.
    const GOLDEN: f64 = 0.618_033_988_749_895;
    begin + (end - begin) * ((k as f64 - 0.6 * (k as f64 * GOLDEN).fract()) / COMPARISONS as f64)
}

/// All times of comparison in a run between these times.
pub fn comparison_times(ends: [f64; 2]) -> impl Iterator<Item = f64> + use<> {
    (1..=COMPARISONS).map(move |k| comparison_time(k, ends))
}

fn at(to: f64, due: bool, ends: bool) -> Event {
    Event { ending: Interval { from: 0.0, to, steps: 0, due, jump: false, compared: false }, ends }
}

fn comparison(to: f64, ends: bool) -> Event {
    let mut event = at(to, false, ends);
    event.ending.compared = true;
    event
}

fn add_output_times(model: &Model, out: &mut Vec<Event>, ends: bool) {
    let end = model.analysis.end_time;
    out.push(at(end, true, true));
    if let Cadence::Interval(interval) = model.output.cadence {
        let multiples = |time: f64| (time / interval + 1e-9).floor() as usize;
        out.extend(
            (multiples(model.analysis.begin) + 1..=multiples(end)).map(|k| at(multiple(k, interval), true, ends)),
        );
    }
    for expect in &model.expects {
        if let When::Time(t) = expect.when {
            out.push(at(t, true, ends));
        }
    }
}

fn add_jumps_and_kinks(model: &Model, out: &mut Vec<Event>) {
    let driving = || {
        let loads = model.loading.nodal.iter().filter_map(|load| load.amplitude);
        let pressures = model.loading.pressures.iter().filter_map(|load| load.amplitude);
        let turning = model.loading.centrifugal.iter().filter_map(|load| load.amplitude);
        let gravity = model.loading.gravity_amplitude;
        loads
            .chain(pressures)
            .chain(turning)
            .chain(gravity)
            .chain(model.loading.base_accelerations.iter().map(|base| base.amplitude))
    };
    for amplitude in driving() {
        out.extend(model.loading.amplitudes[amplitude].jumps().iter().map(|jump| {
            let mut event = at(jump.time, false, true);
            event.ending.jump = true;
            event
        }));
    }
    if model.analysis.step_length.is_automatic() {
        // Steps must not miss events that begin and end within one step, and error estimates hold only for smooth motion.
        let motions = model
            .constraints
            .restraints
            .iter()
            .filter_map(|restraint| restraint.motion.as_ref())
            .map(|motion| motion.amplitude);
        for amplitude in motions.chain(driving()) {
            out.extend(model.loading.amplitudes[amplitude].kinks().into_iter().map(|time| at(time, false, true)));
        }
    }
}

/// Puts events in order, each once, parts those inside steps from the ends of intervals, and counts steps between these.
fn divide(model: &Model, mut events: Vec<Event>) -> Schedule {
    let (begin, end, dt) = (model.analysis.begin, model.analysis.end_time, model.analysis.nominal_step());
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * end;
    events.retain(|event| event.ending.to > begin + 1e-9 * end && event.ending.to <= end * (1.0 + 1e-9));
    events.sort_by(|a, b| a.ending.to.total_cmp(&b.ending.to));
    events.dedup_by(|next, kept| {
        let one = same(next.ending.to, kept.ending.to);
        if one {
            kept.ending.due |= next.ending.due;
            kept.ending.jump |= next.ending.jump;
            kept.ending.compared |= next.ending.compared;
            kept.ends |= next.ends;
        }
        one
    });
    if let Some(last) = events.last_mut() {
        (last.ending.to, last.ends) = (end, true);
    }
    let sample =
        |&Event { ending: Interval { to: time, due, compared, .. }, .. }: &Event| Sample { time, due, compared };
    let samples = events.iter().filter(|event| !event.ends).map(sample).collect();
    let mut intervals: Vec<Interval> = events.iter().filter(|event| event.ends).map(|event| event.ending).collect();
    let mut from = begin;
    for interval in &mut intervals {
        interval.steps = steps_between([from, interval.to], dt);
        interval.from = from;
        from = interval.to;
    }
    Schedule { intervals: parted(intervals, &kicks(model), 1e-9 * end), samples }
}

/// Sorted times of jumps in the velocity or the acceleration of a prescribed motion; the work is computed separately before and after
/// them.
fn kicks(model: &Model) -> Vec<f64> {
    let mut all = Vec::new();
    if model.analysis.kind != AnalysisKind::Dynamic {
        return all;
    }
    for motion in model.constraints.restraints.iter().filter_map(|restraint| restraint.motion.as_ref()) {
        let amplitude = &model.loading.amplitudes[motion.amplitude];
        let of_side = |time: f64, side: Side| match motion.history {
            History::Displacement => [amplitude.rate(time, side), amplitude.second_rate(time, side)],
            History::Velocity => [amplitude.rate(time, side), 0.0],
            History::Acceleration => [0.0; 2],
        };
        let is_kick = |time: &f64| of_side(*time, Side::Before) != of_side(*time, Side::After);
        all.extend(amplitude.kinks().into_iter().filter(is_kick));
        if motion.history != History::Displacement {
            all.extend(amplitude.jumps().iter().map(|jump| jump.time));
        }
    }
    all.sort_by(f64::total_cmp);
    all
}

/// The intervals, with ends where steps end at such times; times within a step, and at the end of the run, part nothing.
fn parted(intervals: Vec<Interval>, times: &[f64], slack: f64) -> Vec<Interval> {
    let mut out = Vec::with_capacity(intervals.len());
    let last = intervals.len().saturating_sub(1);
    for (i, mut rest) in intervals.into_iter().enumerate() {
        let within = [rest.from, rest.to].map(|end| times.partition_point(|time| *time <= end + slack));
        for &time in &times[within[0]..within[1]] {
            let k = ((time - rest.from) / (rest.to - rest.from) * rest.steps as f64).round() as usize;
            if (rest.time(k) - time).abs() > slack || k == 0 {
                continue;
            }
            if k == rest.steps {
                rest.jump |= i < last;
            } else {
                let at = rest.time(k);
                out.push(Interval { to: at, steps: k, due: false, jump: true, compared: false, ..rest });
                rest = Interval { from: at, steps: rest.steps - k, ..rest };
            }
        }
        out.push(rest);
    }
    out
}

/// The number of steps no longer than `dt`. A rounding error beyond a whole number needs no extra step.
fn steps_between([from, to]: [f64; 2], dt: f64) -> usize {
    let steps = (to - from) / dt - 1e-9 * (to / dt).max(1.0);
    steps.ceil().max(1.0) as usize
}

/// The k-th multiple of the output interval, rounded once where the interval is one over a whole number: 0.009, not
/// 0.009000000000000001.
fn multiple(k: usize, interval: f64) -> f64 {
    let per_unit = (1.0 / interval).round();
    if (per_unit * interval - 1.0).abs() < 4.0 * f64::EPSILON { k as f64 / per_unit } else { k as f64 * interval }
}
