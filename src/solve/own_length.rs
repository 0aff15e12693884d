//! Steps that find their own length, as long as is stable or as an error allows: the loop that all of them share.

use super::march::{Run, Step};
use super::stations::Stretch;
use super::step::{Stepper, Taken};
use super::{Failure, Observer, Outcome};
use crate::state::State;
use std::sync::atomic::Ordering;

/// What finds the length of steps.
pub trait OwnLength {
    /// The length of the next step, where `left` is left to where one must land.
    ///
    /// # Errors
    /// There is none.
    fn propose(&mut self, stepper: &mut Stepper, state: &State, left: f64) -> Result<f64, Failure>;

    /// Takes a step, of which the proposal was `length`; `None` where nothing was taken but the next proposal will be better.
    ///
    /// # Errors
    /// As for [`Stepper::step`], and [`Failure::Inaccurate`]; `state` is untouched.
    fn take(
        &mut self,
        stepper: &mut Stepper,
        state: &mut State,
        to: f64,
        length: f64,
    ) -> Result<Option<Taken>, Failure>;

    /// A step of `dt` failed otherwise than by its error, which has said how long a step may be.
    fn went_wrong(&mut self, stepper: &mut Stepper, dt: f64);
}

impl Run<'_> {
    /// Through a stretch in steps of equal length, landing on its end, as long as nothing asks for another.
    pub(super) fn follow_length(
        &mut self,
        state: &mut State,
        stretch: &Stretch,
        own: &mut dyn OwnLength,
        observer: &mut dyn Observer,
        balance: Option<f64>,
    ) -> Result<(), Outcome> {
        let analysis = &self.stepper.model.analysis;
        let mut cuts = 0;
        while state.time < stretch.to {
            if self.stop.load(Ordering::Relaxed) {
                return Err(Outcome::Stopped { time: state.time });
            }
            let left = stretch.to - state.time;
            let length = own.propose(&mut self.stepper, state, left);
            let length = length.map_err(|failure| Outcome::Failed { time: state.time, failure })?;
            let pieces = (left / length * (1.0 - 1e-9)).ceil().max(1.0);
            let target = if pieces == 1.0 { stretch.to } else { state.time + left / pieces };
            let dt = target - state.time;
            match own.take(&mut self.stepper, state, target, length) {
                Ok(Some(taken)) => {
                    let at_end = state.time >= stretch.to;
                    let last = at_end && stretch.to >= analysis.end_time * (1.0 - 1e-9);
                    let step = Step { dt, taken: &taken, cuts, due: at_end && stretch.due, last, passed: &[] };
                    self.show(state, observer, balance, &step)?;
                    cuts = 0;
                }
                Ok(None) => {}
                Err(failure) => {
                    // The difference of two times is a length only to rounding.
                    if length <= analysis.least_step || dt <= analysis.least_step {
                        return Err(Outcome::Failed { time: state.time, failure });
                    }
                    if !matches!(failure, Failure::Inaccurate { .. }) {
                        own.went_wrong(&mut self.stepper, dt);
                    }
                    cuts += 1;
                    self.counts.cuts += 1;
                }
            }
        }
        Ok(())
    }
}

/// Of explicit schemes.
pub struct Free;

impl OwnLength for Free {
    fn propose(&mut self, stepper: &mut Stepper, state: &State, left: f64) -> Result<f64, Failure> {
        // Where a shorter one is asked for, what refuses the least says why.
        let length = stepper.proposed(state, left)?;
        Ok(length.max(stepper.model.analysis.least_step))
    }

    fn take(
        &mut self,
        stepper: &mut Stepper,
        state: &mut State,
        to: f64,
        length: f64,
    ) -> Result<Option<Taken>, Failure> {
        let taken = stepper.step(state, to)?;
        stepper.went_well(length);
        Ok(Some(taken))
    }

    fn went_wrong(&mut self, stepper: &mut Stepper, dt: f64) {
        stepper.went_wrong(dt);
    }
}
