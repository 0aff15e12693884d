//! The recorder of accepted steps: it counts them, checks their energies and shows them to the observer.

use super::context::Context;
use super::derived::{Derived, Request, Wanted};
use super::effort::Effort;
use super::energy_growth::{EnergyGrowth, checks_energy_growth};
use super::events::Events;
use super::failure::Failure;
use super::frame::{Frame, Observer, ShownCase};
use super::handover::Handover;
use super::outcome::{Counts, Outcome};
use super::report::StepReport;
use super::row_gaps::RowGaps;
use super::sample::Sample;
use super::workspace::Workspace;
use crate::guards::breakage::Breakage;
use crate::linear_statics::AskedResults;
use crate::modes::Modes;
use crate::system::energy::{Balance, Energy, work_of_rounding};
use base::snapshot::keep;
use mechanics::state::State;
use model::{Cadence, Model};
use std::ops::Range;
use std::time::{Duration, Instant};

/// Finds the derived quantities that are asked for.
pub type FindDerived<'f> = &'f mut dyn FnMut(&AskedResults, &mut Derived);

/// The account of a run. It is allocated once.
pub struct Recorder {
    wanted: Wanted,
    /// The effort so far.
    pub counts: Counts,
    /// The effort of the stages before.
    before: Counts,
    /// True for a comparison run, which writes no tables.
    pub is_comparison: bool,
    /// Largest number of steps; a run with more steps fails.
    pub most_steps: usize,
    /// Time spent in the observer.
    pub observing: Duration,
    /// The balance of energy.
    pub growth: EnergyGrowth,
    /// Mechanical energy at t = 0, where energies are summed.
    initial_energy: Option<f64>,
    /// Failed elements and links.
    breakage: Breakage,
    /// Events that reduce the order of the error of steps.
    pub events: Events,
    /// The energy that parts failed before the current step had stored.
    pub eroded: f64,
    derived: Derived,
    /// The motions that rows show.
    pub row_gaps: RowGaps,
    tables: Pace,
    fields: Pace,
    /// True if tables were due inside the current step.
    looked_inside: bool,
    /// Length of the last step, where tables were not due at its end.
    pending: Option<f64>,
}

keep!(Recorder {
    counts, before, is_comparison, most_steps, growth, initial_energy, breakage, events, eroded, tables, fields, looked_inside, pending, derived,
    row_gaps,
} without { wanted, observing });

/// The progress of a cadence.
#[derive(Default)]
struct Pace {
    /// Time of the last output.
    last: f64,
}

keep!(Pace { last });

impl Pace {
    /// True if output is due at a step; `anyway` is true at t = 0 and at the end.
    fn is_due(&mut self, cadence: Cadence, (step, time): (usize, f64), anyway: bool) -> bool {
        let due = anyway
            || match cadence {
                Cadence::Steps(every) => step.is_multiple_of(every.max(1)),
                Cadence::Interval(_) => false,
                // A rounding error short of it is none.
                Cadence::Apart(apart) => time - self.last >= apart * (1.0 - 1e-9),
            };
        if due {
            self.last = time;
        }
        due
    }
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
    /// True where runs are compared at its end.
    pub compared: bool,
    /// True for the last step of the run.
    pub last: bool,
    /// Indices as in [`Frame::passed`].
    pub passed: &'s [usize],
}

impl AcceptedStep<'_> {
    fn effort(&self) -> Effort {
        let StepReport { iterations, factorizations, residual, error, .. } = *self.report;
        Effort { iterations, refactorizations: factorizations, residual, cuts: self.cuts, error }
    }
}

impl Recorder {
    /// A recorder that shows the `wanted` quantities.
    pub fn new(model: &Model, wanted: Wanted) -> Recorder {
        Recorder {
            wanted,
            counts: Counts::default(),
            before: Counts::default(),
            is_comparison: false,
            most_steps: usize::MAX,
            observing: Duration::ZERO,
            growth: EnergyGrowth::default(),
            initial_energy: None,
            breakage: Breakage::default(),
            events: Events::default(),
            eroded: 0.0,
            derived: Derived::new(model),
            row_gaps: RowGaps::new(model),
            tables: Pace::default(),
            fields: Pace::default(),
            looked_inside: false,
            pending: None,
        }
    }

    /// Sums the energy at the start of the run, or of a stage. Energy that a stage adds or removes at its start is external work.
    pub fn begin(&mut self, cx: &Context, state: &mut State, handover: Option<&Handover>) {
        self.breakage.begin(cx.system, state);
        self.events.begin(cx, state);
        self.eroded = state.work.material.eroded;
        let sums = !cx.is_dynamic() || self.wanted.has(Wanted::ENERGY) || checks_energy_growth(cx.model);
        let sum = |state: &State, initial: Option<f64>| Energy::of(cx.system, state, initial, cx.plan.threads);
        let mut energy = sums.then(|| sum(state, None));
        self.initial_energy = energy.map(|energy| energy.mechanical);
        self.growth.begin(Balance::default(), state.time);
        if !sums {
            self.growth.begin_without_balance((cx.model, cx.plan, cx.system), state);
        }
        if let Some(Handover { counts, missed, initial_energy, .. }) = handover {
            (self.counts, self.before) = (*counts, *counts);
            if let Some(initial) = initial_energy.filter(|_| sums) {
                state.work.external += missed - sum(state, Some(initial)).numerical;
            }
            let balance = Balance::after(*missed + state.work.verlet_energy_offset, state.work.external);
            self.growth.begin(balance, state.time);
            if sums {
                self.initial_energy = Some(missed - sum(state, Some(0.0)).numerical);
                energy = Some(sum(state, self.initial_energy));
            }
        }
        self.growth.balance.rounding =
            work_of_rounding(cx.system, &cx.model.loading, &state.nodes, cx.model.analysis.duration());
        if let Some(energy) = energy.filter(|_| !cx.is_dynamic()) {
            self.growth.balance.update(&energy);
        }
    }

    /// Mechanical energy at the reference of the balance; `None` if energies are not summed.
    pub fn initial_energy(&self) -> Option<f64> {
        self.initial_energy
    }

    /// The number of failed elements and links; `None` if none can fail.
    pub fn broken(&self) -> Option<usize> {
        self.breakage.count()
    }

    /// The mutable initial energy, for checkpoints.
    pub fn initial_energy_mut(&mut self) -> &mut Option<f64> {
        &mut self.initial_energy
    }

    /// The effort without the previous stages.
    pub fn own(&self) -> Counts {
        let Counts { steps, iterations, factorizations, solves, cuts } = self.before;
        Counts {
            steps: self.counts.steps - steps,
            iterations: self.counts.iterations - iterations,
            factorizations: self.counts.factorizations - factorizations,
            solves: self.counts.solves - solves,
            cuts: self.counts.cuts - cuts,
        }
    }

    /// Adds the work of the solver in this stage to the work of the previous stages.
    pub fn count_work(&mut self, ws: &Workspace) {
        self.counts.factorizations = self.before.factorizations + ws.factorizations;
        self.counts.solves = self.before.solves + ws.solves;
    }

    /// Counts a step, computes the wanted quantities and shows it.
    ///
    /// # Errors
    /// [`Outcome::Io`] if the observer cannot write, [`Outcome::Failed`] if energy grows.
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
        if self.counts.steps - self.before.steps > self.most_steps {
            return Err(Outcome::Failed { time: state.time, failure: Failure::ErrorTooLarge { dt: step.dt } });
        }
        let (due, drawn) = self.is_due(cx.model, step, state.time);
        self.spend(step);
        self.breakage.look(cx, state);
        self.events.look(cx, state);
        self.pending = (!due).then_some(step.dt);
        // Reading the clock twice costs a twentieth of a step of two bodies.
        let began = (due || drawn).then(Instant::now);
        let (model, system, threads, balance) = (cx.model, cx.system, cx.plan.threads, self.initial_energy);
        let (excitation, begins) = (&cx.excitation, step.dt == 0.0);
        // The balance uses the ends of steps, even if tables are due inside.
        let instead = std::mem::take(&mut self.looked_inside) && self.wanted.has(Wanted::ENERGY);
        let watched = match () {
            () if instead => Wanted::ENERGY.at_every_step(),
            () if checks_energy_growth(model) => Wanted::ENERGY,
            () => Wanted::NOTHING,
        };
        let shown = due || step.compared;
        let request =
            Request { model, system, excitation, state, loads: None, begins, due: shown, drawn, balance, threads };
        self.derived.compute(self.wanted | watched, &request);
        let scene = (model, cx.plan, system);
        let failure = self.growth.check(scene, state, self.derived.energy, balance, step.last);
        self.derived.broken.extend_from_slice(self.breakage.new_ones());
        observer.on_step(&self.frame(cx, ws, state, step, [due, drawn])).map_err(Outcome::Io)?;
        if due {
            self.row_gaps.look(state.time, &state.nodes);
            self.derived.effort = Effort::default();
        }
        if let Some(began) = began {
            self.observing += began.elapsed();
        }
        failure.map_or(Ok(()), |failure| Err(Outcome::Failed { time: state.time, failure }))
    }

    /// Shows a solution of a linear analysis, whose derived quantities `compute` finds; returns these. Quantities in `besides` are computed
    /// where tables are due.
    ///
    /// # Errors
    /// [`Outcome::Io`] where the observer cannot write.
    pub fn notify_case(
        &mut self,
        (cx, ws, state): (&Context, &Workspace, &State),
        observer: &mut dyn Observer,
        (step, case): (&AcceptedStep, ShownCase),
        (besides, compute): (Wanted, FindDerived<'_>),
    ) -> Result<&Derived, Outcome> {
        self.counts.steps += 1;
        self.counts.iterations += step.report.iterations;
        let (due, drawn) = self.is_due(cx.model, step, state.time);
        self.spend(step);
        let began = Instant::now();
        compute(&AskedResults { wanted: self.wanted | besides, due: due || step.compared, drawn }, &mut self.derived);
        let frame = Frame { case: Some(case), ..self.frame(cx, ws, state, step, [due, drawn]) };
        observer.on_step(&frame).map_err(Outcome::Io)?;
        if due {
            self.derived.effort = Effort::default();
        }
        self.observing += began.elapsed();
        Ok(&self.derived)
    }

    /// Shows the state at a sample inside the last step of length `dt`, before the step itself is shown, and counts its effort.
    ///
    /// # Errors
    /// [`Outcome::Io`] where the observer cannot write.
    pub fn notify_inside(
        &mut self,
        cx: &Context,
        ws: &Workspace,
        state: &State,
        observer: &mut dyn Observer,
        (report, dt, sample): (&StepReport, f64, &Sample),
    ) -> Result<(), Outcome> {
        self.counts.iterations += report.iterations;
        let (due, compared) = (sample.due && !self.is_comparison, sample.compared);
        let began = due.then(Instant::now);
        let step = &AcceptedStep { dt, report, cuts: 0, due, compared, last: false, passed: &[] };
        self.spend(step);
        let (model, system, threads, balance) = (cx.model, cx.system, cx.plan.threads, self.initial_energy);
        let (excitation, begins) = (&cx.excitation, step.dt == 0.0);
        let request = Request {
            model,
            system,
            excitation,
            state,
            loads: None,
            begins,
            due: due || compared,
            drawn: false,
            balance,
            threads,
        };
        self.derived.compute(self.wanted, &request);
        self.looked_inside = true;
        let frame = self.frame(cx, ws, state, step, [due, false]);
        observer.on_step(&Frame { step: frame.step + 1, inside: true, ..frame }).map_err(Outcome::Io)?;
        if due {
            self.row_gaps.look(state.time, &state.nodes);
            self.derived.effort = Effort::default();
        }
        if let Some(began) = began {
            self.observing += began.elapsed();
        }
        Ok(())
    }

    /// Shows the last accepted step again if it was not due and no step follows, so that tables end with it.
    ///
    /// # Errors
    /// [`Outcome::Io`] where the observer cannot write.
    pub fn close(
        &mut self,
        cx: &Context,
        ws: &Workspace,
        state: &State,
        observer: &mut dyn Observer,
    ) -> Result<(), Outcome> {
        let Some(dt) = self.pending.take().filter(|_| !self.is_comparison) else { return Ok(()) };
        let report = &StepReport::begin(0.0);
        let step = &AcceptedStep { dt, report, cuts: 0, due: true, compared: false, last: false, passed: &[] };
        let (model, system, threads, balance) = (cx.model, cx.system, cx.plan.threads, self.initial_energy);
        let (excitation, begins) = (&cx.excitation, step.dt == 0.0);
        let request = Request {
            model,
            system,
            excitation,
            state,
            loads: None,
            begins,
            due: true,
            drawn: false,
            balance,
            threads,
        };
        self.derived.compute(self.wanted, &request);
        observer.on_step(&self.frame(cx, ws, state, step, [true, false])).map_err(Outcome::Io)
    }

    /// Shows the modes about a state that has been shown.
    ///
    /// # Errors
    /// [`Outcome::Io`] where the observer cannot write.
    pub fn notify_modes(
        &mut self,
        cx: &Context,
        ws: &Workspace,
        state: &State,
        observer: &mut dyn Observer,
        modes: &Modes,
    ) -> Result<(), Outcome> {
        let began = Instant::now();
        let report = &StepReport::begin(0.0);
        let step = &AcceptedStep { dt: 0.0, report, cuts: 0, due: true, compared: false, last: true, passed: &[] };
        let frame = Frame { modes: Some(modes), ..self.frame(cx, ws, state, step, [true, true]) };
        observer.on_modes(&frame).map_err(Outcome::Io)?;
        self.observing += began.elapsed();
        Ok(())
    }

    /// Shows rows of the response of modes that have been shown.
    ///
    /// # Errors
    /// [`Outcome::Io`] where the observer cannot write.
    pub fn notify_response(
        &mut self,
        cx: &Context,
        ws: &Workspace,
        state: &State,
        observer: &mut dyn Observer,
        (modes, rows): (&Modes, Range<usize>),
    ) -> Result<(), Outcome> {
        let began = Instant::now();
        let report = &StepReport::begin(0.0);
        let step = &AcceptedStep { dt: 0.0, report, cuts: 0, due: true, compared: false, last: true, passed: &[] };
        let frame = Frame { modes: Some(modes), rows, ..self.frame(cx, ws, state, step, [true, false]) };
        observer.on_response(&frame).map_err(Outcome::Io)?;
        self.observing += began.elapsed();
        Ok(())
    }

    /// Decides whether tables are due, and whether fields are drawn; fields are drawn at the end too.
    fn is_due(&mut self, model: &Model, step: &AcceptedStep, time: f64) -> (bool, bool) {
        let (output, at) = (&model.output, (self.counts.steps, time));
        if self.is_comparison {
            return (false, false);
        }
        let due = self.tables.is_due(output.cadence, at, step.due);
        let is_first = self.counts.steps == 0;
        // The beginning of a stage looks like the end of the one before.
        let begins_stage = self.before.steps > 0 && self.counts.steps == self.before.steps;
        let files = output.fields.filter(|_| !begins_stage);
        let drawn = files.is_some_and(|files| self.fields.is_due(files.cadence, at, is_first || step.last));
        (due, drawn)
    }

    /// Adds the effort of a step to the effort since the last tables.
    fn spend(&mut self, step: &AcceptedStep) {
        self.derived.effort = self.derived.effort.and(step.effort());
    }

    fn frame<'f>(
        &'f self,
        cx: &Context<'f>,
        ws: &Workspace,
        state: &'f State,
        step: &AcceptedStep<'f>,
        [due, drawn]: [bool; 2],
    ) -> Frame<'f> {
        let &AcceptedStep { dt, compared, last, passed, .. } = step;
        // Each multiplier adds one negative pivot.
        let negative = || ws.matrix.solver.negative_eigenvalues().saturating_sub(cx.system.multipliers());
        Frame {
            model: cx.model,
            state,
            step: self.counts.steps,
            dt,
            effort: step.effort(),
            due,
            drawn,
            last,
            inside: false,
            compared,
            reactions: if self.wanted.has_now(Wanted::REACTIONS, due || compared, false) {
                &state.reactions
            } else {
                &[]
            },
            derived: &self.derived,
            modes: None,
            case: None,
            rows: 0..0,
            passed,
            negative_pivots: cx.model.analysis.step_length.is_arc_length().then(negative),
        }
    }
}
