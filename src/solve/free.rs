//! Steps of explicit schemes that find their own length: as long as is stable, or as an error allows.

use super::march::{Run, Step};
use super::stations::Stretch;
use super::{Failure, Observer, Outcome};
use crate::state::State;
use std::sync::atomic::Ordering;

impl Run<'_> {
    /// Through a stretch in steps that land on its end.
    pub(super) fn follow_itself(
        &mut self,
        state: &mut State,
        stretch: &Stretch,
        observer: &mut dyn Observer,
        balance: Option<f64>,
    ) -> Result<(), Outcome> {
        let analysis = &self.stepper.model.analysis;
        let least = analysis.least_step;
        let mut cuts = 0;
        while state.time < stretch.to {
            if self.stop.load(Ordering::Relaxed) {
                return Err(Outcome::Stopped { time: state.time });
            }
            let left = stretch.to - state.time;
            let length = self.stepper.proposed(state, left);
            let length = length.map_err(|failure| Outcome::Failed { time: state.time, failure })?;
            let pieces = (left / length * (1.0 - 1e-9)).ceil().max(1.0);
            let target = if pieces == 1.0 { stretch.to } else { state.time + left / pieces };
            let dt = target - state.time;
            match self.stepper.step(state, target) {
                Ok(taken) => {
                    self.stepper.went_well(length);
                    let at_end = state.time >= stretch.to;
                    let last = at_end && stretch.to >= analysis.end_time * (1.0 - 1e-9);
                    let step = Step { dt, taken: &taken, cuts, due: at_end && stretch.due, last, passed: &[] };
                    self.show(state, observer, balance, &step)?;
                    cuts = 0;
                }
                Err(failure) => {
                    if dt <= least {
                        return Err(Outcome::Failed { time: state.time, failure });
                    }
                    // What is too inaccurate has said how long a step may be.
                    if !matches!(failure, Failure::Inaccurate { .. }) {
                        self.stepper.went_wrong(dt);
                    }
                    cuts += 1;
                    self.counts.cuts += 1;
                }
            }
        }
        Ok(())
    }
}
