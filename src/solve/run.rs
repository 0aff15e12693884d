//! A run of one scene from t = 0 to the end time.

use super::context::Context;
use super::control::Controller;
use super::derived::Wanted;
use super::energy_growth::checks_energy_growth;
use super::frame::Observer;
use super::march::March;
use super::outcome::{Counts, Outcome};
use super::recorder::Recorder;
use super::start::start;
use super::warning::Warnings;
use super::workspace::Workspace;
use crate::linear::TooLarge;
use crate::model::{AnalysisKind, Model};
use crate::plan::Plan;
use crate::state::State;
use crate::system::System;
use crate::system::energy::Balance;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// A run of one scene. Whatever its steps need is allocated when it is made.
pub struct Run<'a> {
    context: Context<'a>,
    workspace: Workspace,
    controller: Controller<'a>,
    recorder: Recorder,
    stop: &'a AtomicBool,
}

impl<'a> Run<'a> {
    /// Prepares a run that shows the `wanted` quantities; it ends early where `stop` is raised.
    ///
    /// # Errors
    /// There is no memory for the solver.
    pub fn new(
        model: &'a Model,
        system: &'a System,
        plan: &'a Plan,
        wanted: Wanted,
        stop: &'a AtomicBool,
    ) -> Result<Self, TooLarge> {
        let wants_energy = wanted.has(Wanted::ENERGY);
        // Load steps are judged by their work.
        let is_static = model.analysis.kind == AnalysisKind::Static;
        let wants_forces = is_static || wanted.has(Wanted::REACTIONS) || wants_energy || checks_energy_growth(model);
        let context = Context::new(model, plan, system, wants_forces, wants_energy);
        let mut workspace = Workspace::new(&context)?;
        let controller = Controller::new(&context, &mut workspace)?;
        let recorder = Recorder::new(model, wanted);
        Ok(Run { context, workspace, controller, recorder, stop })
    }

    /// Runs to the end, to a failure, or until stopped. Returns the outcome and the last state; none where the run did
    /// not start.
    pub fn run(&mut self, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        let Run { context: cx, workspace: ws, controller, recorder, stop } = self;
        let mut state = match start(cx, ws) {
            Ok(state) => state,
            Err(failure) => return (Outcome::Failed { time: 0.0, failure }, None),
        };
        recorder.begin(cx, &state);
        let mut march = March { cx, ws, state: &mut state, recorder, observer, stop };
        let mut outcome = controller.run(&mut march);
        if !matches!(outcome, Err(Outcome::Io(_))) {
            outcome = march.recorder.close(march.cx, march.ws, march.state, march.observer).and(outcome);
        }
        recorder.counts.factorizations = ws.factorizations;
        recorder.counts.solves = ws.solves;
        (outcome.err().unwrap_or(Outcome::Done), Some(state))
    }

    /// The effort of the run, once it has ended.
    pub fn counts(&self) -> Counts {
        self.recorder.counts
    }

    /// Time spent in the observer.
    pub fn observing(&self) -> Duration {
        self.recorder.observing
    }

    /// The balance of energy of a dynamic analysis.
    pub fn balance(&self) -> &Balance {
        &self.recorder.growth.balance
    }

    /// Largest departure from orthogonality of a truncated rotation update before it was corrected.
    pub fn rotation_drift(&self) -> f64 {
        self.workspace.rotation_drift
    }

    /// Largest gap of a joint at the end of a step, relative to the largest coordinate; `None` without joints.
    pub fn joint_violation(&self) -> Option<f64> {
        (!self.context.system.joints.is_empty()).then_some(self.workspace.joint_violation)
    }

    /// Doubts about the results.
    pub fn warnings(&self) -> &Warnings {
        &self.workspace.warnings
    }

    /// The displacement at the end of a path that did not reach its `stop`.
    pub fn short_of_stop(&self) -> Option<f64> {
        self.controller.short_of_stop()
    }
}
