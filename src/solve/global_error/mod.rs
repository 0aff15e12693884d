//! The global error at the end of a run whose steps follow a tolerance.
//!
//! The local error of a step can be estimated, but its effect on the end cannot. Tops and mechanisms magnify it, and errors of velocity
//! grow into errors of position. A vibration out of phase errs at most by its amplitude. The difference to a comparison run with longer steps is
//! the error of the worse run, and a known multiple of the error of the better run (L. F. Richardson, 1911). If the error exceeds the
//! requested one, the run is repeated with a tolerance computed from it.

mod kept;
mod look_ahead;
mod trace;

use crate::step::size::ModelSize;
use crate::tolerances::global_error::{
    AIM, CHANGE, CHANGE_EARLY, CHANGE_WITH_EVENTS, FAR_APART, LOST, SATURATED, WITHIN,
};
pub use kept::Kept;
pub use look_ahead::LookAhead;
pub use trace::{Trace, Unseen};

use crate::tolerances::trace::TELLING;

use super::outcome::Counts;
use super::warning::Warning;
use base::snapshot::keep;

/// The global error of a run relative to its largest motion, and the effort of its estimate.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StepError {
    /// The error requested in the deck.
    pub asked: f64,
    /// The mean tolerance that the steps followed.
    pub tolerance: f64,
    /// The least of these tolerances. A run made again keeps it from the start, so it is not looser than the one judged.
    pub least: f64,
    /// The longest step allowed; `None` if only the controller limits it.
    pub longest: Option<f64>,
    /// The least tolerance and the longest step of the run before.
    pub before: (f64, Option<f64>),
    /// The estimated error of the run; `None` where no other run came to its end, or shorter steps bring runs with events no nearer to each other.
    pub estimate: Option<f64>,
    /// The difference to the run used for the estimate, relative to the largest motion; `None` if that run is no measure.
    pub difference: Option<f64>,
    /// The ratio of the error of that run to the error of this one.
    pub apart: f64,
    /// Number of runs besides the last, ...
    pub others: usize,
    /// ... of which so many have ended early.
    pub early: usize,
    /// The effort of these.
    pub effort: Counts,
}

keep!(StepError: Default { asked, tolerance, least, longest, before, estimate, difference, apart, others, early, effort });

impl StepError {
    /// The record of a run with this tolerance, without an estimate yet.
    pub fn new(asked: f64) -> StepError {
        StepError {
            asked,
            tolerance: asked,
            least: asked,
            longest: None,
            before: (asked, None),
            estimate: None,
            difference: None,
            apart: 1.0,
            others: 0,
            early: 0,
            effort: Counts::default(),
        }
    }

    /// Adds the effort of another run.
    pub fn add(&mut self, effort: Counts) {
        self.others += 1;
        let sum = &mut self.effort;
        sum.steps += effort.steps;
        sum.iterations += effort.iterations;
        sum.factorizations += effort.factorizations;
        sum.solves += effort.solves;
        sum.cuts += effort.cuts;
    }

    /// The tolerance of a run in place of one that has ended early because of this predicted error.
    pub fn in_place_of_early(&self, predicted: f64) -> f64 {
        let [least, most] = CHANGE_EARLY;
        self.tolerance * (AIM * self.asked / predicted).clamp(least, most)
    }

    /// The tolerance of a run in place of one with this estimated error. Errors that events leave show in runs far apart alone.
    pub fn in_place_of(&self, estimate: f64, meets_events: bool) -> f64 {
        let [least, most] = if meets_events { CHANGE_WITH_EVENTS } else { CHANGE };
        let wanted = AIM * self.asked / estimate;
        // Far from the error asked for, half the digits of an estimate are believed.
        self.tolerance * wanted.clamp(least.min(wanted.sqrt()), most)
    }

    /// True if a pilot run shows that the error of a complete run is small enough, or its steps are near enough to tell how large it is. A
    /// comparison run costs less than a further run. A pilot run that has nothing in common with the run shows nothing.
    pub fn is_judged_by(&self, run: &Kept, pilot: &Kept, size: ModelSize) -> bool {
        let (apart, difference) = (run.apart(pilot), run.difference(pilot, size));
        let estimate = difference / (apart - 1.0);
        !pilot.has_lost(run, size) && (apart < FAR_APART || estimate <= WITHIN * self.asked)
    }

    /// Estimates the error from the difference to another run. Returns the tolerance of a further run; `None` where this one is good enough,
    /// or no further one would be better.
    pub fn judge(&mut self, run: &Kept, other: &Kept, size: ModelSize) -> Option<f64> {
        let difference = run.difference(other, size);
        let told = run.is_told_by(other) && difference.is_finite();
        let last = std::mem::replace(&mut self.difference, told.then_some(difference));
        self.apart = run.apart(other);
        // Three runs show how fast errors fall that events leave.
        let last = last.filter(|_| run.meets_events(other));
        let nears = last.is_none_or(|last| TELLING * difference <= last);
        if let Some(last) = last.filter(|_| nears) {
            self.apart = self.apart.min(last / difference);
        }
        let estimate = difference / (self.apart - 1.0);
        let before = std::mem::replace(&mut self.estimate, (told && nears).then_some(estimate));
        if !told {
            return Some(self.without_comparison());
        }
        // Two runs with nothing in common hardly show how much shorter steps must be; several such runs show that no length suffices.
        let lost = difference > SATURATED;
        let hopeless = lost && self.others > 2 && before.is_some_and(|before| estimate > 0.5 * before);
        let tolerance = if lost { LOST * self.tolerance } else { self.in_place_of(estimate, run.meets_events(other)) };
        ((!nears || estimate > WITHIN * self.asked) && !hopeless).then_some(tolerance)
    }

    /// The tolerance of a further run if the comparison run failed: its steps, and maybe the steps of the run, do not follow the motion.
    pub fn without_comparison(&self) -> f64 {
        self.tolerance * LOST
    }

    /// The warning of a run whose error exceeds the requested one.
    pub fn warning(&self) -> Option<Warning> {
        let StepError { asked, estimate, difference, .. } = *self;
        if let (None, Some(difference)) = (estimate, difference) {
            return Some(Warning::RunsPart { asked, difference });
        }
        estimate.is_none_or(|estimate| estimate > WITHIN * asked).then_some(Warning::StepError { asked, estimate })
    }
}
