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
}

impl Stretch {
    /// End of the k-th step, k = 1..=steps; the last lands on `to` exactly.
    pub fn time(&self, k: usize) -> f64 {
        if k == self.steps { self.to } else { self.from + (self.to - self.from) * (k as f64 / self.steps as f64) }
    }
}

/// Cuts [0, end] at output times and at the times of expectations, each stretch into steps no longer than the deck's.
pub fn stretches(model: &Model) -> Vec<Stretch> {
    let (end, dt) = (model.analysis.end_time, model.analysis.time_step);
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * end;
    let mut times: Vec<(f64, bool)> = vec![(end, true)];
    if let Cadence::Interval(interval) = model.output.cadence {
        let count = (end / interval + 1e-9).floor() as usize;
        times.extend((1..=count).map(|k| (k as f64 * interval, true)));
    }
    for expect in &model.expects {
        if let When::Time(t) = expect.when {
            times.push((t, true));
        }
    }
    times.retain(|&(t, _)| t > 1e-9 * end && t <= end * (1.0 + 1e-9));
    times.sort_by(|a, b| a.0.total_cmp(&b.0));
    times.dedup_by(|a, b| same(a.0, b.0));
    if let Some(last) = times.last_mut() {
        last.0 = end;
    }
    let mut from = 0.0;
    let mut out = Vec::new();
    for (to, due) in times {
        // A rounding error beyond a whole number of steps asks for no extra step.
        let steps = ((to - from) / dt - 1e-9 * (to / dt).max(1.0)).ceil().max(1.0) as usize;
        out.push(Stretch { from, to, steps, due });
        from = to;
    }
    out
}
