//! A run of one scene, from 0 to the end time.

use super::context::Context;
use super::control::Controller;
use super::derived::Wanted;
use super::energy_growth::is_watched;
use super::frame::Observer;
use super::march::March;
use super::outcome::{Counts, Outcome};
use super::recorder::Recorder;
use super::start::start;
use super::workspace::Workspace;
use crate::linear::TooLarge;
use crate::model::Model;
use crate::plan::Plan;
use crate::state::State;
use crate::system::System;
use crate::system::energy::Balance;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// A run of one scene. All that its steps need is allocated when it is made.
pub struct Run<'a> {
    context: Context<'a>,
    workspace: Workspace,
    controller: Controller<'a>,
    recorder: Recorder,
    stop: &'a AtomicBool,
    /// See [`Run::start_jump`].
    velocity_change: f64,
}

impl<'a> Run<'a> {
    /// The run ends early where `stop` is raised.
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
        let wants_forces = wanted.has(Wanted::REACTIONS) || wants_energy || is_watched(model);
        let context = Context::new(model, plan, system, wants_forces, wants_energy);
        let mut workspace = Workspace::new(&context)?;
        let controller = Controller::new(&context, &mut workspace)?;
        let recorder = Recorder::new(model, wanted);
        Ok(Run { context, workspace, controller, recorder, stop, velocity_change: 0.0 })
    }

    /// Runs to the end, to a failure, or until stopped. The state it ends with is returned too.
    pub fn run(&mut self, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        let Run { context: cx, workspace: ws, controller, recorder, stop, velocity_change } = self;
        let mut state = match start(cx, ws) {
            Ok((state, change)) => {
                *velocity_change = change;
                state
            }
            Err(failure) => return (Outcome::Failed { time: 0.0, failure }, None),
        };
        recorder.begin(cx, &state);
        let mut march = March { cx, ws, state: &mut state, recorder, observer, stop };
        let outcome = controller.run(&mut march);
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

    /// The balance of energies of a motion in time.
    pub fn balance(&self) -> &Balance {
        &self.recorder.growth.balance
    }

    /// The largest departure from orthogonality that a truncated rotation update left to be mended.
    pub fn rotation_drift(&self) -> f64 {
        self.workspace.rotation_drift
    }

    /// The largest gap of a joint that the end of a step was left with, relative to the largest coordinate; `None`: no joints.
    pub fn joint_violation(&self) -> Option<f64> {
        (!self.context.system.joints.is_empty()).then_some(self.workspace.joint_violation)
    }

    /// The largest change, relative to the largest velocity, that initial velocities needed to agree with the joints.
    pub fn start_jump(&self) -> f64 {
        self.velocity_change
    }

    /// Where a path ended that never came to its `stop`: the displacement asked for.
    pub fn short_of_stop(&self) -> Option<f64> {
        self.controller.short_of_stop()
    }
}
