//! The march along a path of equilibria by arc length: the first step is one of load and sets the scale, the others are as
//! long as their iterations allow. Where a step passes something it must land on, the way there is found between its ends.

use super::Observer;
use super::arc::Condition;
use super::failure::Failure;
use super::march::{Outcome, Run, Step};
use super::step::{Stepper, Taken};
use crate::integrators::load_steps;
use crate::model::{ArcLength, Model, Passage, When};
use crate::state::State;
use std::sync::atomic::Ordering;

/// Iterations a step should take, the first being the prediction: more make it too long for what it costs, fewer too short.
/// Frames of slender beams take a third fewer iterations in all than with five; with eight roofs leave their path.
const DESIRED: f64 = 6.0;
/// A step grows or shrinks from one to the next by at most this.
const CHANGE: f64 = 2.0;
/// Cosine of the angle between steps beyond which they grow no more.
const STRAIGHT: f64 = 0.8;
/// Cosine below which a step may have left the path for another, and is tried at half the length; but so many times only: where
/// material begins to yield a path has kinks, which no step is too short for.
const BENT: f64 = 0.2;
const TRIES: usize = 3;
/// Iterations beyond which the first step is tried at half the load.
const HARD: usize = 12;
/// More steps are no path that anybody wants, unless the deck asks for them.
const MOST_STEPS: usize = 100_000;
/// Landings tried in a step before it is cut: what it passes may lie in another order than between straight lines.
const LANDINGS: usize = 8;

/// Something a step lands on.
struct Station {
    what: What,
    value: f64,
    /// Passages to come, of which the last counts.
    passes: usize,
    /// Side of the value on which the path is: −1, 1, or 0 where it has not left it.
    side: f64,
    ends: bool,
    /// Of the model's expectations.
    expects: Vec<usize>,
}

#[derive(Clone, Copy, PartialEq)]
enum What {
    Time,
    Displacement { node: usize, dof: usize },
}

/// The times and displacements that steps must land on.
struct Stations(Vec<Station>);

impl Stations {
    fn new(model: &Model, control: &ArcLength) -> Self {
        let mut all = Stations(Vec::new());
        all.add(What::Time, model.analysis.end_time, 1).ends = true;
        if let Some(stop) = control.stop {
            all.add(What::Displacement { node: stop.node, dof: stop.dof }, stop.value, stop.pass).ends = true;
        }
        for (index, expect) in model.expects.iter().enumerate() {
            match expect.when {
                When::Time(time) if time > 0.0 => all.add(What::Time, time, 1).expects.push(index),
                When::Passing(at) => {
                    let what = What::Displacement { node: at.node, dof: at.dof };
                    all.add(what, at.value, at.pass).expects.push(index);
                }
                _ => {}
            }
        }
        all
    }

    /// The station of this description, each kept once.
    fn add(&mut self, what: What, value: f64, passes: usize) -> &mut Station {
        let same = |s: &Station| s.what == what && s.value == value && s.passes == passes;
        let index = self.0.iter().position(same).unwrap_or_else(|| {
            self.0.push(Station { what, value, passes, side: 0.0, ends: false, expects: Vec::new() });
            self.0.len() - 1
        });
        &mut self.0[index]
    }

    /// The station that the motion found from `state` passes first, but for one, and at which part of the motion.
    fn first_passed(&self, stepper: &Stepper, state: &State, to: f64, but: Option<usize>) -> Option<(usize, f64)> {
        let part = |station: &Station| {
            let (from, end) = station.ends(stepper, state, to);
            let over = |x: f64| station.side * (x - station.value);
            let passed = station.passes == 1 && over(from) > 0.0 && over(end) <= 0.0;
            passed.then(|| (station.value - from) / (end - from))
        };
        let others = self.0.iter().enumerate().filter(|(i, _)| Some(*i) != but);
        let passed = others.filter_map(|(i, station)| part(station).map(|part| (i, part)));
        passed.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Counts what the accepted motion passes; `landed` is passed by definition, whatever rounding says.
    fn pass(&mut self, stepper: &Stepper, state: &State, to: f64, landed: Option<usize>) {
        for (i, station) in self.0.iter_mut().enumerate() {
            let (_, end) = station.ends(stepper, state, to);
            let side = match landed == Some(i) {
                true => -station.side,
                false if end == station.value => station.side,
                false => (end - station.value).signum(),
            };
            if station.side * side < 0.0 {
                station.passes = station.passes.saturating_sub(1);
            }
            station.side = side;
        }
    }

    /// Whether the station that a step landed on is this one.
    fn ended_at(&self, stop: &Passage, landed: Option<usize>) -> bool {
        let what = What::Displacement { node: stop.node, dof: stop.dof };
        landed.is_some_and(|i| self.0[i].ends && self.0[i].what == what)
    }

    fn start(&mut self, stepper: &Stepper, state: &State) {
        for station in &mut self.0 {
            let (from, _) = station.ends(stepper, state, state.time);
            station.side = if from == station.value { 0.0 } else { (from - station.value).signum() };
        }
    }
}

impl Station {
    /// Its quantity at the ends of the motion found.
    fn ends(&self, stepper: &Stepper, state: &State, to: f64) -> (f64, f64) {
        match self.what {
            What::Time => (state.time, to),
            What::Displacement { node, dof } => {
                let start = &state.nodes[node];
                let from = start.moved(&stepper.model.nodes[node].x)[dof];
                // What rides has no increment.
                let moves = stepper.movers.binary_search(&node).is_ok();
                let way = if moves {
                    stepper.increments[node].q[dof]
                } else {
                    stepper.trial[node].relative_position(start)[dof]
                };
                (from, from + way)
            }
        }
    }
}

impl Run<'_> {
    /// Loads that do not begin at zero act at once.
    pub(super) fn settle(&mut self, state: &mut State) -> Result<(), Failure> {
        let stepper = &mut self.stepper;
        let scale = stepper.system.residual(&state.configuration(), &stepper.given[2], &mut stepper.forces);
        let left = stepper.gather(&scale);
        if left > stepper.model.iteration.tolerance { stepper.step(state, 0.0).map(|_| ()) } else { Ok(()) }
    }

    /// To the end time, to where the deck stops it, or through its number of steps.
    pub(super) fn follow(
        &mut self,
        state: &mut State,
        observer: &mut dyn Observer,
        balance: Option<f64>,
        control: &ArcLength,
    ) -> Result<(), Outcome> {
        let analysis = &self.stepper.model.analysis;
        let least = analysis.least_step / control.first;
        // The first step is one of load, and there is none before.
        let begin = self.stepper.drive.begin();
        if begin >= analysis.end_time {
            return Err(Outcome::Failed { time: state.time, failure: Failure::Idle { time: state.time } });
        }
        let mut stations = Stations::new(self.stepper.model, control);
        stations.start(&self.stepper, state);
        // Length of the first step, and that of the next over it.
        let (mut unit, mut size, mut cuts, mut bent) = (None, 1.0, 0, 0);
        loop {
            if self.stop.load(Ordering::Relaxed) {
                return Err(Outcome::Stopped { time: state.time });
            }
            let (to, condition) = match unit {
                None => (begin + size * control.first, None),
                Some(unit) => (state.time, Some(Condition::Arc(size * unit))),
            };
            let found = self.stepper.find(state, to, condition, &stations);
            let motion = self.stepper.motion();
            let (taken, landed) = match found {
                Ok(_) if motion.cosine < BENT && bent < TRIES && 0.5 * size >= least => {
                    (size, cuts, bent) = (0.5 * size, cuts + 1, bent + 1);
                    self.counts.cuts += 1;
                    continue;
                }
                // Nothing tells yet whether a step of load has left the path, but how hard it was to find.
                Ok((ref taken, _)) if unit.is_none() && taken.iterations > HARD && 0.5 * size >= least => {
                    (size, cuts) = (0.5 * size, cuts + 1);
                    self.counts.cuts += 1;
                    continue;
                }
                Ok(found) => found,
                Err(failure) => {
                    let unheld = unit.is_none()
                        && self.stepper.system.history == 0
                        && matches!(failure, Failure::Singular { .. });
                    (size, cuts) = (0.5 * size, cuts + 1);
                    if size < least || unheld {
                        return Err(Outcome::Failed { time: state.time, failure });
                    }
                    self.counts.cuts += 1;
                    continue;
                }
            };
            stations.pass(&self.stepper, state, taken.to, landed);
            self.stepper.keep_motion(&motion);
            let dt = taken.to - state.time;
            // A first step may have been cut short where it passed something, even before loads begin.
            let whole = control.first / (taken.to - begin).abs().max(least * control.first);
            if (unit.is_some() || taken.to > begin) && *unit.get_or_insert(motion.length * whole) == 0.0 {
                let failure = Failure::Idle { time: state.time };
                return Err(Outcome::Failed { time: state.time, failure });
            }
            let accepted = self.stepper.accept(state, &load_steps::coefficients(), taken.to);
            accepted.map_err(|failure| Outcome::Failed { time: state.time, failure })?;
            let ends = landed.is_some_and(|i| stations.0[i].ends)
                || control.steps.is_some_and(|steps| self.counts.steps + 1 >= steps);
            let passed = landed.map_or(&[][..], |i| &stations.0[i].expects);
            let due = landed.is_some() || ends;
            self.show(state, observer, balance, &Step { dt, taken: &taken, cuts, due, last: ends, passed })?;
            if ends {
                self.short_of_stop = control.stop.filter(|stop| !stations.ended_at(stop, landed)).map(|stop| {
                    let Passage { node, dof, .. } = stop;
                    state.nodes[node].moved(&self.stepper.model.nodes[node].x)[dof]
                });
                return Ok(());
            }
            if self.counts.steps >= control.steps.unwrap_or(MOST_STEPS) {
                let failure = Failure::Endless { steps: self.counts.steps };
                return Err(Outcome::Failed { time: state.time, failure });
            }
            if landed.is_none() {
                let mut change = (DESIRED / taken.iterations as f64).sqrt().clamp(1.0 / CHANGE, CHANGE);
                if cuts > 0 || motion.cosine < STRAIGHT {
                    change = change.min(1.0);
                }
                size = (size * change).min(control.growth);
            }
            (cuts, bent) = (0, 0);
        }
    }
}

impl Stepper<'_> {
    /// A step to `to`, or as long as the condition says; cut short at the first station it passes, which is returned.
    fn find(
        &mut self,
        state: &State,
        to: f64,
        condition: Option<Condition>,
        stations: &Stations,
    ) -> Result<(Taken, Option<usize>), Failure> {
        let scheme = load_steps::coefficients();
        self.predict(state, &scheme);
        let mut taken = self.equilibrate(state, &scheme, to, condition)?;
        let mut landed = None;
        for _ in 0..LANDINGS {
            let Some((index, part)) = stations.first_passed(self, state, taken.to, landed) else {
                return Ok((taken, landed));
            };
            let station = &stations.0[index];
            let (from, _) = station.ends(self, state, taken.to);
            let (to, condition) = match station.what {
                What::Time => (station.value, None),
                What::Displacement { node, dof } => {
                    let to = state.time + part * (taken.to - state.time);
                    (to, Some(Condition::Motion { node, dof, by: station.value - from }))
                }
            };
            self.shorten(state, part);
            let more = self.equilibrate(state, &scheme, to, condition)?;
            taken = Taken {
                iterations: taken.iterations + more.iterations,
                refactorizations: taken.refactorizations + more.refactorizations,
                ..more
            };
            landed = Some(index);
        }
        Err(self.no_way())
    }
}
