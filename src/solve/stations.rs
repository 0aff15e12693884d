//! The times that steps must land on.

use crate::model::{Cadence, Model, When};

/// A stretch of equal steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    pub from: f64,
    pub to: f64,
    pub steps: usize,
    /// Its end is an output time.
    pub due: bool,
    /// A load jumps at its end.
    pub jump: bool,
}

impl Stretch {
    /// End of the k-th step, k = 1..=steps; the last lands on `to` exactly.
    pub fn time(&self, k: usize) -> f64 {
        if k == self.steps { self.to } else { self.from + (self.to - self.from) * (k as f64 / self.steps as f64) }
    }
}

/// Cuts [0, end] at output times, at the times of expectations and where loads jump, each stretch into steps no longer than the deck's.
pub fn stretches(model: &Model) -> Vec<Stretch> {
    let (end, dt) = (model.analysis.end_time, model.analysis.nominal_step());
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * end;
    let station = |to: f64, due: bool, jump: bool| Stretch { from: 0.0, to, steps: 0, due, jump };
    let mut out = vec![station(end, true, false)];
    if let Cadence::Interval(interval) = model.output.cadence {
        let count = (end / interval + 1e-9).floor() as usize;
        out.extend((1..=count).map(|k| station(multiple(k, interval), true, false)));
    }
    for expect in &model.expects {
        if let When::Time(t) = expect.when {
            out.push(station(t, true, false));
        }
    }
    let driving = || {
        let loads = model.loads.iter().filter_map(|load| load.amplitude);
        let pressures = model.pressures.iter().filter_map(|load| load.amplitude);
        loads.chain(pressures).chain(model.base_accelerations.iter().map(|base| base.amplitude))
    };
    for amplitude in driving() {
        out.extend(model.amplitudes[amplitude].jumps().iter().map(|jump| station(jump.time, false, true)));
    }
    if model.analysis.step_length.is_automatic() {
        // Nothing that begins and ends within a step may be missed, and errors are those of smooth motion.
        let motions = model.held.iter().filter_map(|held| held.motion.as_ref()).map(|motion| motion.amplitude);
        for amplitude in motions.chain(driving()) {
            out.extend(model.amplitudes[amplitude].kinks().into_iter().map(|time| station(time, false, false)));
        }
    }
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
    for stretch in &mut out {
        // A rounding error beyond a whole number of steps asks for no extra step.
        let steps = (stretch.to - from) / dt - 1e-9 * (stretch.to / dt).max(1.0);
        stretch.steps = steps.ceil().max(1.0) as usize;
        stretch.from = from;
        from = stretch.to;
    }
    out
}

/// k times the interval, rounded once where the interval is one over a whole number: 0.009, not 0.009000000000000001.
fn multiple(k: usize, interval: f64) -> f64 {
    let per_unit = (1.0 / interval).round();
    if (per_unit * interval - 1.0).abs() < 4.0 * f64::EPSILON { k as f64 / per_unit } else { k as f64 * interval }
}
