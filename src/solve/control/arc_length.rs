//! Arc-length control along an equilibrium path: the first step is a load step and sets the scale, the others are as long as their
//! iterations allow. If a step passes a target that must be hit, the arc to the target is found between the ends of the step.

use super::targets::{TargetQuantity, Targets};
use crate::context::Context;
use crate::failure::Failure;
use crate::march::March;
use crate::outcome::Outcome;
use crate::recorder::AcceptedStep;
use crate::report::StepReport;
use crate::step::equilibrium::EquilibriumSolver;
use crate::step::residual;
use crate::step::trial::{Stage, Step};
use crate::strategy::arc_length::{ArcLengthConstraint, Condition, PathCondition, StepMotion};
use crate::tolerances::arc_length::{
    BENT, CHANGE, CREEPING_STEPS, CREEPS, DESIRED, DESIRED_WITH_HISTORY, HARD, MOST_STEPS, MOST_TARGETS, PASSES,
    STRAIGHT, TRIES,
};
use crate::workspace::Workspace;
use base::snapshot::keep;
use mechanics::integrators::load_steps;
use mechanics::state::State;
use model::{ArcLength, DisplacementTarget};

/// Leads a static analysis along its equilibrium path.
pub struct ArcLengthController {
    solver: EquilibriumSolver,
    constraint: ArcLengthConstraint,
    path: ArcLength,
    targets: Targets,
    /// Start of the change of loads or prescribed motion.
    begin: f64,
    /// Desired number of iterations of a step.
    desired: f64,
    /// Length of the first step, once it is known.
    unit: Option<f64>,
    /// Ratio of the next step length to the first one, and the least allowed ratio.
    size: f64,
    least: f64,
    /// Cutbacks before the current step, and those due to a sharp bend.
    cuts: usize,
    bent: usize,
    /// Number of steps, and the displacement then, at which the path has last come on by a noticeable part.
    marked: usize,
    mark: f64,
    /// The displacement at the end of a path that did not reach its `stop`.
    pub short_of_stop: Option<f64>,
}

keep!(ArcLengthController {
    solver, constraint, targets, unit, size, cuts, bent, marked, mark, short_of_stop
} without { path, begin, desired, least });

/// An equilibrium, with its target if it lies at one.
struct Found {
    report: StepReport,
    reached: Option<usize>,
    motion: StepMotion,
}

impl ArcLengthController {
    /// A controller of the deck's path.
    pub fn new(cx: &Context, ws: &mut Workspace, solver: EquilibriumSolver, path: &ArcLength) -> ArcLengthController {
        ArcLengthController {
            solver,
            constraint: ArcLengthConstraint::new(cx, ws),
            targets: Targets::new(cx.model, path),
            // Loads of earlier stages have begun before.
            begin: cx.excitation.begin().max(cx.model.analysis.begin),
            unit: None,
            desired: if cx.system.history > 0 { DESIRED_WITH_HISTORY } else { DESIRED },
            size: 1.0,
            least: cx.model.analysis.least_step / path.first,
            cuts: 0,
            bent: 0,
            marked: 0,
            mark: 0.0,
            short_of_stop: None,
            path: path.clone(),
        }
    }

    /// Runs from the beginning, or from the current place of a resumed run.
    ///
    /// # Errors
    /// The outcome that ends it early.
    pub fn run(&mut self, march: &mut March) -> Result<(), Outcome> {
        if !march.resumes {
            self.apply_initial_loads(march)?;
            march.notify_start()?;
            if let Some(watch) = march.stop_watch.as_deref_mut() {
                watch.begin(march.cx, march.ws, march.state);
            }
            if self.begin >= march.cx.model.analysis.end_time {
                return Err(march.failed(Failure::NoLoadIncrement { time: march.state.time }));
            }
            self.targets.start(march.cx, march.ws, march.state);
        }
        self.follow(march)
    }

    /// Finds the equilibrium under loads that do not start at zero and therefore act suddenly.
    ///
    /// # Errors
    /// No equilibrium is found under them.
    fn apply_initial_loads(&mut self, march: &mut March) -> Result<(), Outcome> {
        let March { cx, ws, state, .. } = march;
        let scale = cx.system.residual(&state.configuration(), &ws.loads.instant, &mut ws.forces);
        if ws.residual.gather(cx, &ws.forces, &scale) > cx.model.solution.iteration.tolerance {
            let scheme = load_steps::coefficients();
            let settled = self.solver.stage(cx, ws, state, &Stage::from(&scheme), 0.0);
            settled.map_err(|failure| march.failed(failure))?;
        }
        Ok(())
    }

    /// Follows the path to the end time, to where the deck stops it, or through its number of steps.
    ///
    /// # Errors
    /// The outcome that ends the run early.
    fn follow(&mut self, march: &mut March) -> Result<(), Outcome> {
        loop {
            march.pause(self)?;
            let Some(found) = self.find_or_cut(march)? else { continue };
            let dt = found.report.to - march.state.time;
            self.accept(march, &found)?;
            let ends = found.reached.is_some_and(|i| self.targets.0[i].ends)
                || self.path.steps.is_some_and(|steps| march.recorder.counts.steps + 1 >= steps);
            self.notify(march, &found, dt, ends)?;
            if ends {
                if let (Some(watch), Some(stop)) = (march.stop_watch.as_deref_mut(), &self.path.stop) {
                    watch.recall(self.targets.is_stop(stop, found.reached));
                }
                self.short_of_stop = self.path.stop.filter(|stop| !self.targets.is_stop(stop, found.reached)).map(
                    |DisplacementTarget { node, dof, .. }| {
                        march.state.nodes[node].moved(&march.cx.model.nodes[node].x)[dof]
                    },
                );
                return Ok(());
            }
            let steps = march.recorder.counts.steps;
            if steps >= self.path.steps.unwrap_or(MOST_STEPS) {
                return Err(march.failed(Failure::TooManySteps { steps }));
            }
            self.choose_size(&found);
            self.check_progress(march)?;
        }
    }

    /// Ends a path that creeps: many steps that lead nowhere, as where hinges without hardening open and close. Steps shorter than the first are
    /// sooner too many.
    ///
    /// # Errors
    /// [`Failure::PathCreeps`].
    fn check_progress(&mut self, march: &mut March) -> Result<(), Outcome> {
        let moved = |node: usize| march.state.nodes[node].moved(&march.cx.model.nodes[node].x);
        let now = match &self.path.stop {
            Some(stop) => moved(stop.node)[stop.dof],
            None => (0..march.state.nodes.len()).map(|node| moved(node).amax()).fold(0.0, f64::max),
        };
        let (steps, scale) = (march.recorder.counts.steps, now.abs().max(self.mark.abs()));
        let most = CREEPING_STEPS[usize::from(self.size >= 1.0)];
        if (now - self.mark).abs() >= CREEPS * scale {
            (self.marked, self.mark) = (steps, now);
        } else if steps >= self.marked + most {
            let from = self.mark;
            return Err(march.failed(Failure::PathCreeps { steps: steps - self.marked, from, to: now }));
        }
        Ok(())
    }

    /// Finds the next equilibrium; `None` where the step is to be tried again at half the length.
    ///
    /// # Errors
    /// The failure, where no shorter step is left or none would help.
    fn find_or_cut(&mut self, march: &mut March) -> Result<Option<Found>, Outcome> {
        let March { cx, ws, state, .. } = march;
        let (to, condition) = match self.unit {
            // The first step is one of load: there is no arc before it.
            _ if self.path.increment.is_some() => (state.time, self.next_displacement(cx, state)),
            None => (self.begin + self.size * self.path.first, None),
            Some(unit) => (state.time, Some(Condition::Arc(self.size * unit))),
        };
        let found = self.find(cx, ws, state, to, condition);
        let motion = self.constraint.motion(cx, &ws.trial);
        let may_cut = 0.5 * self.size >= self.least;
        match found {
            Ok(_) if motion.cosine < BENT && self.bent < TRIES && may_cut => self.bent += 1,
            // A first step has no direction to compare with; only its iterations show whether it was too long.
            Ok((ref report, _)) if self.unit.is_none() && report.iterations > HARD && may_cut => {}
            Ok((report, reached)) => return Ok(Some(Found { report, reached, motion })),
            Err(failure) => {
                let unrestrained =
                    cx.system.history == 0 && matches!(failure, Failure::Singular { at_start: true, .. });
                if !may_cut || unrestrained || failure.is_final() {
                    return Err(march.failed_step(self, failure));
                }
            }
        }
        (self.size, self.cuts) = (0.5 * self.size, self.cuts + 1);
        march.count_cut();
        Ok(None)
    }

    /// The displacement of the next step towards `stop`, which the last step passes a little, so that it ends there.
    fn next_displacement(&self, cx: &Context, state: &State) -> Option<Condition> {
        let (stop, increment) = (self.path.stop?, self.path.increment?);
        let left = stop.value - state.nodes[stop.node].moved(&cx.model.nodes[stop.node].x)[stop.dof];
        let most = self.size * increment;
        let by = if left.abs() <= most * (1.0 + PASSES) { left * (1.0 + PASSES) } else { most.copysign(left) };
        Some(Condition::Displacement { node: stop.node, dof: stop.dof, by })
    }

    /// Finds the equilibrium at the time `to`, or where the condition holds. The step ends at the first target that it passes; its index is
    /// returned.
    fn find(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        to: f64,
        condition: Option<Condition>,
    ) -> Result<(StepReport, Option<usize>), Failure> {
        let scheme = load_steps::coefficients();
        let mut step = Step { state, stage: Stage::from(&scheme), to };
        self.solver.newton.predict(cx, ws, &step);
        let mut report = self.equilibrate(cx, ws, step, condition)?;
        let mut reached = None;
        for _ in 0..MOST_TARGETS {
            let Some((index, part)) = self.targets.first_passed(cx, ws, state, report.to, reached) else {
                return Ok((report, reached));
            };
            let target = &self.targets.0[index];
            let (from, _) = target.ends_of_motion(cx, ws, state, report.to);
            let (to, condition) = match target.quantity {
                TargetQuantity::Time => (target.value, None),
                TargetQuantity::Displacement { node, dof } => {
                    let to = state.time + part * (report.to - state.time);
                    (to, Some(Condition::Displacement { node, dof, by: target.value - from }))
                }
            };
            shorten(cx, ws, state, part);
            step.to = to;
            report = report.then(self.equilibrate(cx, ws, step, condition)?);
            reached = Some(index);
        }
        Err(residual::no_equilibrium(cx, &ws.forces))
    }

    fn equilibrate(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: Step,
        condition: Option<Condition>,
    ) -> Result<StepReport, Failure> {
        let constraint = &mut self.constraint;
        let path = condition.map(|condition| PathCondition { constraint, condition });
        self.solver.equilibrate(cx, ws, step, path)
    }

    /// Accepts the equilibrium that was found.
    fn accept(&mut self, march: &mut March, found: &Found) -> Result<(), Outcome> {
        let March { cx, ws, state, .. } = march;
        let to = found.report.to;
        self.targets.pass(cx, ws, state, to, found.reached);
        self.constraint.keep_motion(cx, &ws.trial, &found.motion);
        self.solver.grows = self.constraint.loads_grow(cx, &ws.trial);
        // A first step may have ended early at a target, even before loads begin.
        let whole = self.path.first / (to - self.begin).abs().max(self.least * self.path.first);
        let is_one = self.unit.is_some() || self.path.increment.is_some() || to > self.begin;
        if is_one && *self.unit.get_or_insert(found.motion.length * whole) == 0.0 {
            let time = state.time;
            return Err(march.failed(Failure::NoLoadIncrement { time }));
        }
        let accepted = self.solver.accept(cx, ws, state, &Stage::from(&load_steps::coefficients()), to);
        accepted.map_err(|failure| march.failed(failure))
    }

    fn notify(&mut self, march: &mut March, found: &Found, dt: f64, ends: bool) -> Result<(), Outcome> {
        let passed = found.reached.map_or(&[][..], |i| &self.targets.0[i].expects);
        let due = found.reached.is_some() || ends;
        march.notify(&AcceptedStep {
            dt,
            report: &found.report,
            cuts: self.cuts,
            due,
            compared: false,
            last: ends,
            passed,
        })
    }

    /// Chooses the size of the next step by the iterations of this one, unless this ended at a target.
    fn choose_size(&mut self, found: &Found) {
        if self.path.increment.is_some() {
            self.size = if self.cuts > 0 { self.size } else { (2.0 * self.size).min(1.0) };
        } else if found.reached.is_none() {
            let mut change = (self.desired / found.report.iterations as f64).sqrt().clamp(1.0 / CHANGE, CHANGE);
            if self.cuts > 0 || found.motion.cosine < STRAIGHT {
                change = change.min(1.0);
            }
            self.size = (self.size * change).min(self.path.growth);
        }
        (self.cuts, self.bent) = (0, 0);
    }
}

/// Shortens the motion found to a fraction, the start of the search for a point inside.
fn shorten(cx: &Context, ws: &mut Workspace, state: &State, part: f64) {
    for &node in &cx.independent_nodes {
        ws.trial.increments[node].q *= part;
    }
    let values = ws.forces.multipliers.values.iter_mut().zip(&state.multipliers);
    values.for_each(|(value, start)| *value = start + part * (*value - start));
}
