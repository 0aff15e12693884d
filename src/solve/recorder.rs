//! The recorder of accepted steps: it counts them, checks their energies and shows them to the observer.

use super::context::Context;
use super::derived::{Derived, Request, Wanted};
use super::energy_growth::{EnergyGrowth, checks_energy_growth};
use super::frame::{Frame, Observer};
use super::outcome::{Counts, Outcome};
use super::report::StepReport;
use super::workspace::Workspace;
use crate::model::{Cadence, Model};
use crate::state::State;
use crate::system::energy::Energy;
use std::time::{Duration, Instant};

/// The account of a run. It is allocated once.
pub struct Recorder {
    wanted: Wanted,
    /// The effort so far.
    pub counts: Counts,
    /// Time spent in the observer.
    pub observing: Duration,
    /// The balance of energy.
    pub growth: EnergyGrowth,
    /// Mechanical energy at t = 0, where energies are summed.
    initial_energy: Option<f64>,
    derived: Derived,
}

/// An accepted step as the recorder receives it.
pub struct AcceptedStep<'s> {
    /// Length of the step.
    pub dt: f64,
    /// The report of the step.
    pub report: &'s StepReport,
    /// Cutbacks before it.
    pub cuts: usize,
    /// True where its end is an output time, whatever the cadence says.
    pub due: bool,
    /// True for the last step of the run.
    pub last: bool,
    /// Indices as in [`Frame::passed`].
    pub passed: &'s [usize],
}

impl Recorder {
    /// A recorder that shows the `wanted` quantities.
    pub fn new(model: &Model, wanted: Wanted) -> Recorder {
        Recorder {
            wanted,
            counts: Counts::default(),
            observing: Duration::ZERO,
            growth: EnergyGrowth::default(),
            initial_energy: None,
            derived: Derived::new(model),
        }
    }

    /// Sums the energy at the start of the run.
    pub fn begin(&mut self, cx: &Context, state: &State) {
        if self.wanted.has(Wanted::ENERGY) || checks_energy_growth(cx.model) {
            self.initial_energy = Some(Energy::of(cx.system, state, None, cx.plan.threads).mechanical);
        }
    }

    /// Counts a step, computes the wanted quantities and shows it.
    ///
    /// # Errors
    /// [`Outcome::Io`] where the observer cannot write, [`Outcome::Failed`] where energy grows.
    pub fn notify(
        &mut self,
        cx: &Context,
        ws: &Workspace,
        state: &State,
        observer: &mut dyn Observer,
        step: &AcceptedStep,
    ) -> Result<(), Outcome> {
        if step.report.iterations > 0 {
            self.counts.steps += 1;
            self.counts.iterations += step.report.iterations;
        }
        let (due, drawn) = self.is_due(cx.model, step);
        // Reading the clock twice costs a twentieth of a step of two bodies.
        let began = (due || drawn || self.wanted.has(Wanted::EVERY_STEP)).then(Instant::now);
        let (model, system, threads, balance) = (cx.model, cx.system, cx.plan.threads, self.initial_energy);
        let watched = if checks_energy_growth(model) { Wanted::ENERGY } else { Wanted::NOTHING };
        let request = Request { model, system, state, due, drawn, balance, threads };
        self.derived.compute(self.wanted | watched, &request);
        let scene = (model, cx.plan, system);
        let failure = self.growth.check(scene, state, self.derived.energy, balance, step.last);
        observer.on_step(&self.frame(cx, ws, state, step, due)).map_err(Outcome::Io)?;
        if let Some(began) = began {
            self.observing += began.elapsed();
        }
        failure.map_or(Ok(()), |failure| Err(Outcome::Failed { time: state.time, failure }))
    }

    /// Decides whether tables are due, and whether fields are drawn; fields are drawn by steps and at the end.
    fn is_due(&self, model: &Model, step: &AcceptedStep) -> (bool, bool) {
        let due = match model.output.cadence {
            Cadence::Steps(every) => self.counts.steps.is_multiple_of(every.max(1)),
            Cadence::Interval(_) => false,
        };
        let drawn =
            model.output.fields.is_some_and(|every| self.counts.steps.is_multiple_of(every.max(1)) || step.last);
        (due || step.due, drawn)
    }

    fn frame<'f>(
        &'f self,
        cx: &Context<'f>,
        ws: &Workspace,
        state: &'f State,
        step: &AcceptedStep<'f>,
        due: bool,
    ) -> Frame<'f> {
        let &AcceptedStep { dt, report, cuts, last, passed, .. } = step;
        // Each multiplier has a negative pivot of its own.
        let negative = || ws.matrix.solver.negative_eigenvalues().saturating_sub(cx.system.multipliers());
        Frame {
            model: cx.model,
            state,
            step: self.counts.steps,
            dt,
            iterations: report.iterations,
            refactorizations: report.factorizations,
            residual: report.residual,
            cuts,
            due,
            last,
            reactions: if due && self.wanted.has(Wanted::REACTIONS) { &state.reactions } else { &[] },
            derived: &self.derived,
            passed,
            negative_pivots: cx.model.analysis.step_length.is_arc_length().then(negative),
        }
    }
}
