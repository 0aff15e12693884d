//! The error of a run under way, from its difference to a pilot run with longer steps.
//!
//! The steps give the ratio a of the errors of both runs. Their difference D then gives the error E = D/(a - 1) of the run so far. The error at
//! the end follows from its growth. The tolerance of the rest of the run rises if this error will be far below the one asked for, and falls if it will
//! be too large. A run ends early where a new one with shorter steps costs less than its rest.

use super::kept::Kept;
use crate::control::COMPARISONS;
use crate::step::size::ModelSize;
use crate::tolerances::global_error::{AIM, FAR_APART, SATURATED, WITHIN};
use crate::tolerances::look_ahead::{
    FASTEST, FUTILE, FUTILE_EARLY, JUDGED_AT, LOWEST, MOST, NEAREST, PREDICTED_AT, WORTH,
};
use crate::tolerances::trace::TELLING;
use base::snapshot::keep;

/// Predicts the error of a run, and adapts the tolerance of its rest.
pub struct LookAhead<'o> {
    pilot: &'o Kept,
    /// The error asked for.
    asked: f64,
    /// The length of the model.
    size: ModelSize,
    /// True if the run may end early.
    may_end: bool,
    /// True if the run is a comparison run across kinks, of the run that stands here as pilot run.
    bound: bool,
    /// The tolerance of the first steps, that of later ones, and a new one that the controller has not received yet.
    first: f64,
    tolerance: f64,
    changed: Option<f64>,
    /// The least tolerance so far.
    least: f64,
    /// The time so far, and the integral over it of the excess over the first tolerance.
    time: f64,
    excess: f64,
    /// The time of the last look.
    looked: f64,
    /// The predicted error, if it is too large.
    predicted: Option<f64>,
}

keep!(LookAhead<'_> { first, tolerance, changed, least, time, excess, looked, predicted } without { pilot, asked, size, may_end, bound });

impl<'o> LookAhead<'o> {
    /// Nothing predicted yet of a run with this tolerance, whose error is to be as asked.
    pub fn new(pilot: &'o Kept, (asked, tolerance): (f64, f64), size: ModelSize, may_end: bool) -> Self {
        let (time, looked) = (pilot.between[0], pilot.between[0]);
        let (first, least, changed, excess, predicted, bound) = (tolerance, tolerance, None, 0.0, None, false);
        LookAhead {
            pilot,
            asked,
            size,
            may_end,
            bound,
            first,
            tolerance,
            changed,
            least,
            time,
            excess,
            looked,
            predicted,
        }
    }

    /// Ends a comparison run with steps twice as long across kinks where its difference no longer bounds the error of `run`. No order holds across a
    /// kink, which adds an error. So the ratio of both errors is at least that of smooth loads.
    pub fn bound(run: &'o Kept, asked: f64, size: ModelSize) -> Self {
        LookAhead { bound: true, ..LookAhead::new(run, (asked, asked), size, true) }
    }

    /// The predicted error of a run that is to end early.
    pub fn predicted(&self) -> Option<f64> {
        self.predicted
    }

    /// The tolerance of later steps, once after each change.
    pub fn new_tolerance(&mut self) -> Option<f64> {
        self.changed.take()
    }

    /// The mean tolerance of the steps so far; the tolerance itself, bit for bit, where it has not changed.
    pub fn mean_tolerance(&self) -> f64 {
        let past = self.time - self.pilot.between[0];
        if past > 0.0 { self.first + self.excess / past } else { self.first }
    }

    /// The least tolerance of the steps so far.
    pub fn least_tolerance(&self) -> f64 {
        self.least
    }

    /// Counts the steps up to this time.
    pub fn advance(&mut self, time: f64) {
        self.excess += (self.tolerance - self.first) * (time - self.time);
        self.time = time;
    }

    /// Judges the run at one of its times of comparison.
    pub fn look(&mut self, run: &Kept) {
        if self.bound {
            // The root mean square over all times is at least this part of that so far.
            let part = (run.times as f64 / COMPARISONS as f64).sqrt();
            let least = run.difference_over(self.pilot, self.size, run.times) * part / (self.pilot.most_apart() - 1.0);
            self.predicted = (least > WITHIN * self.asked).then_some(least);
            return;
        }
        if !(PREDICTED_AT..COMPARISONS).contains(&run.times) {
            return;
        }
        let apart = run.apart_so_far(self.pilot);
        let half = run.times / 2;
        let [before, difference] = [half, run.times].map(|times| run.difference_over(self.pilot, self.size, times));
        if apart <= TELLING || before <= 0.0 || !difference.is_finite() {
            return;
        }
        // Recent steps tell the ratio of the errors that this tolerance makes.
        let recent = run.apart_since(self.pilot, self.looked);
        self.looked = run.end();
        let [past, longer] = [COMPARISONS, half].map(|times| run.times as f64 / times as f64);
        let growth = (difference / before).log(longer).clamp(0.0, FASTEST);
        let rest = Rest::new((past, growth), difference, [apart, recent], f64::from(run.power - 1));
        let predicted = rest.error();
        // The root mean square over all times is at least this part of that so far.
        let is_lost = difference / (apart - 1.0) * past.sqrt() > WITHIN * self.asked;
        let most = if run.times < JUDGED_AT { FUTILE_EARLY } else { FUTILE };
        let is_futile = predicted > most * self.asked && rest.is_dearer(self.asked);
        // A comparison run will judge a run far from the pilot run.
        if self.may_end && apart < FAR_APART && (is_lost || is_futile) {
            self.predicted = Some(predicted);
            return;
        }
        // The difference of two runs with nothing in common gives no error.
        if difference > SATURATED || !recent.is_finite() {
            return;
        }
        // The least ratio of all intervals tells the error at the end. The difference may grow faster yet.
        let at_most = difference * past.powf(-growth.max(1.0) - 1.0);
        let needed = (1.0 + at_most / (AIM * self.asked)).max(NEAREST);
        let raised = (recent / needed * self.tolerance).min(MOST * self.asked);
        if raised > WORTH * self.tolerance {
            self.change(raised);
        } else if let Some(factor) = rest.lowered(self.asked) {
            self.change(factor * self.tolerance);
        }
    }

    fn change(&mut self, tolerance: f64) {
        self.tolerance = tolerance;
        self.least = self.least.min(tolerance);
        self.changed = Some(tolerance);
    }
}

/// The error at the end of a run, after this `past` part of its time.
struct Rest {
    past: f64,
    /// The order of the scheme.
    order: f64,
    /// The errors at the end by the steps so far, and by the rest with the tolerance of recent steps.
    of_past: f64,
    of_rest: f64,
}

impl Rest {
    /// The prediction from a difference that grows with this power of time, if the errors of the pilot run are `apart` times those of the run so
    /// far and `recent` times those of its rest. The faster errors grow, the more the steps so far matter.
    fn new((past, growth): (f64, f64), difference: f64, [apart, recent]: [f64; 2], order: f64) -> Rest {
        let at_end = difference * past.powf(-growth);
        let left = (1.0 - past).powf(growth.max(1.0));
        let [of_past, of_rest] = [(1.0 - left) / apart, left / if recent.is_finite() { recent } else { apart }];
        let per = at_end / ((1.0 / (of_past + of_rest)).max(TELLING) - 1.0) / (of_past + of_rest);
        Rest { past, order, of_past: per * of_past, of_rest: per * of_rest }
    }

    fn error(&self) -> f64 {
        self.of_past + self.of_rest
    }

    /// The factor on the tolerance of the rest, if a smaller tolerance is needed and keeps the error within the accepted one.
    fn lowered(&self, asked: f64) -> Option<f64> {
        let factor = ((AIM * asked - self.of_past) / self.of_rest).max(LOWEST);
        let is_needed = self.error() > asked && factor < 1.0 / WORTH;
        (is_needed && self.of_past + factor * self.of_rest <= WITHIN * asked).then_some(factor)
    }

    /// True if no smaller tolerance of the rest suffices, or the rest with it takes longer than a whole run with smaller errors.
    fn is_dearer(&self, asked: f64) -> bool {
        let longer = |factor: f64| factor.powf(-1.0 / self.order);
        let of_rest = self.lowered(asked).map(|factor| (1.0 - self.past) * longer(factor));
        of_rest.is_none_or(|of_rest| of_rest > longer(AIM * asked / self.error()))
    }
}
