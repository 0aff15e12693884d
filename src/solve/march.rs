//! From 0 to the end time: steps land on the times asked for, are cut where they fail and grow again.

use super::accelerate::Anderson;
use super::derived::{Derived, Request, Wanted};
use super::explicit::Explicit;
use super::failure::Failure;
use super::frame::{Frame, Observer};
use super::joints::{self, Closing};
use super::motion::extent;
use super::own_length::{Free, OwnLength};
use super::pace::Pace;
use super::refresh::Refresh;
use super::search::Search;
use super::stations::{Stretch, stretches};
use super::step::{Stepper, Taken};
use crate::integrators::Stepping;
use crate::linear::TooLarge;
use crate::math::Vec3;
use crate::model::{AnalysisKind, Cadence, Method, Model, Part, StepLength, Update};
use crate::plan::Plan;
use crate::state::{Increment, Node, State};
use crate::system::energy::Balance;
use crate::system::{Drive, Forces, Loading, System};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How a run ended.
#[derive(Debug)]
pub enum Outcome {
    Done,
    /// The least step failed; results are valid up to `time`.
    Failed {
        time: f64,
        failure: Failure,
    },
    /// The flag was raised.
    Stopped {
        time: f64,
    },
    /// The observer could not write.
    Io(std::io::Error),
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    pub steps: usize,
    pub iterations: usize,
    pub factorizations: usize,
    pub solves: usize,
    pub cuts: usize,
}

/// A run of one scene.
pub struct Run<'a> {
    pub(super) stepper: Stepper<'a>,
    wanted: Wanted,
    pub(super) stop: &'a AtomicBool,
    pub counts: Counts,
    /// Time spent in the observer.
    pub observing: Duration,
    /// More energy was made than there was, when last looked at.
    growing: bool,
    /// Of a motion in time: in statics the work of a step is that of its ends, whatever lies between.
    pub balance: Balance,
    /// Where a path ended that never came to its `stop`: the displacement asked for.
    pub short_of_stop: Option<f64>,
    /// Steps in a row cut into many pieces, and those pieces.
    crawling: [usize; 2],
    derived: Derived,
}

/// A step as it is shown.
pub(super) struct Step<'s> {
    pub dt: f64,
    pub taken: &'s Taken,
    pub cuts: usize,
    /// Whatever the cadence says.
    pub due: bool,
    /// The run ends with it.
    pub last: bool,
    /// See [`Frame::passed`].
    pub passed: &'s [usize],
}

/// Halvings of a step that are ever tried; the deck's least step may stop earlier.
const DEEPEST: u32 = 40;
/// Pieces in which a step of the deck may be taken, without impacts to resolve and with: beyond that nobody waits for the end.
/// Without impacts steps in a row that are each cut into more than `MANY` count together.
const MOST_PIECES: [usize; 2] = [1024, 4096];
const MANY: usize = 32;

impl<'a> Run<'a> {
    /// # Errors
    /// There is no memory for the solver.
    pub fn new(
        model: &'a Model,
        system: &'a System,
        plan: &'a Plan,
        wanted: Wanted,
        stop: &'a AtomicBool,
    ) -> Result<Self, TooLarge> {
        let n = model.nodes.len();
        let (solver, assembly) = plan.build(system)?;
        let mut rides = vec![false; n];
        system.attachments.iter().filter(|a| a.rigid).for_each(|a| rides[a.node] = true);
        let mut held = vec![[false; 6]; n];
        let mut driven = vec![false; n];
        for h in &model.held {
            held[h.node][h.dof] = true;
            driven[h.node] |= h.motion.is_some();
        }
        // A node with nothing to move it stays where it is and costs nothing.
        let moves = |i: &usize| !rides[*i] && (driven[*i] || (0..6).any(|d| plan.is_unknown(*i, d)));
        let at_rest: Vec<Node> = model.nodes.iter().map(|node| Node::at_rest(node.x)).collect();
        // Load steps are long and few, and there is no mass to steady an old matrix; along a path an old one leads astray.
        let along = model.analysis.step_length.is_arc_length();
        let method = if along { Method::TangentStiffness } else { model.iteration.method };
        let mixes = system.yields() && method != Method::TangentStiffness;
        let update = match (model.analysis.kind, model.iteration.update) {
            _ if along => Update::Iteration,
            (AnalysisKind::Static, Update::Auto) if !mixes => Update::Iteration,
            (_, update) => update,
        };
        let length = extent(&at_rest);
        let weights = plan.directions.iter().map(|&(_, dof)| if dof < 3 { 1.0 } else { length });
        // Of multipliers: gaps.
        let gaps = system.joints.iter().flat_map(|joint| &joint.rows).map(|row| if row.turns() { length } else { 1.0 });
        let movers: Vec<usize> = (0..n).filter(moves).collect();
        let watched = is_watched(model);
        let explicit = (plan.explicit).then(|| Box::new(Explicit::new(model, plan, system, movers.len())));
        let closes = explicit.as_ref().is_none_or(|explicit| explicit.closes());
        let mut stepper = Stepper {
            model,
            plan,
            system,
            drive: Drive::new(model),
            solver,
            assembly,
            refresh: Refresh::new(method, update, plan.linear, plan.refresh_cost),
            search: (system.history > 0 && !along).then(|| Search::new(plan.directions.len(), n, system.multipliers())),
            anderson: mixes.then(|| Anderson::new(weights.chain(gaps))),
            path: None,
            follower: if model.analysis.kind == AnalysisKind::Dynamic { model.scheme.follower() } else { None },
            bases: None,
            composite: None,
            closing: (model.analysis.kind == AnalysisKind::Dynamic && !system.joints.is_empty() && closes)
                .then(|| Closing::new(plan, system, n))
                .transpose()?,
            length,
            origin: at_rest.first().map_or(Vec3::zeros(), |node| node.x),
            reach: length,
            trial: at_rest,
            increments: vec![Increment::ZERO; n],
            history: vec![0.0; system.history],
            forces: Forces::new(system, n).on_threads(plan.threads),
            r: vec![0.0; plan.unknowns],
            given: [Loading::default(), Loading::default(), Loading::default()],
            held: [Vec::new(), Vec::new(), Vec::new()],
            movers,
            explicit,
            leading: joints::leading(model, system),
            wants_forces: wanted.has(Wanted::REACTIONS) || wanted.has(Wanted::ENERGY) || watched,
            wants_energy: wanted.has(Wanted::ENERGY),
            mass_weight: 0.0,
            factorizations: 0,
            solves: 0,
            drift: 0.0,
            violation: 0.0,
            start_jump: 0.0,
        };
        if along {
            stepper.solver.expect_indefinite();
            stepper.path = Some(stepper.new_path());
        }
        Ok(Run {
            stepper,
            wanted,
            stop,
            counts: Counts::default(),
            observing: Duration::ZERO,
            growing: false,
            balance: Balance::default(),
            short_of_stop: None,
            crawling: [0; 2],
            derived: Derived::new(model),
        })
    }

    /// Largest departure from orthogonality that a truncated rotation update left to be mended.
    pub fn rotation_drift(&self) -> f64 {
        self.stepper.drift
    }

    /// Largest gap of a joint that the end of a step was left with, relative to the largest coordinate; `None`: no joints.
    pub fn joint_violation(&self) -> Option<f64> {
        (!self.stepper.system.joints.is_empty()).then_some(self.stepper.violation)
    }

    /// Largest change, relative, that initial velocities needed to agree with the joints.
    pub fn start_jump(&self) -> f64 {
        self.stepper.start_jump
    }

    /// Runs to the end, to a failure, or until stopped. The state it ends with is returned too.
    pub fn run(&mut self, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        let mut state = match self.stepper.start() {
            Ok(state) => state,
            Err(failure) => return (Outcome::Failed { time: 0.0, failure }, None),
        };
        let outcome = self.march(&mut state, observer);
        self.counts.factorizations = self.stepper.factorizations;
        self.counts.solves = self.stepper.solves;
        let end = match outcome {
            Ok(()) => Outcome::Done,
            Err(outcome) => outcome,
        };
        (end, Some(state))
    }

    fn march(&mut self, state: &mut State, observer: &mut dyn Observer) -> Result<(), Outcome> {
        let initial = (self.wanted.has(Wanted::ENERGY) || is_watched(self.stepper.model))
            .then(|| self.stepper.system.energy(state, None, self.stepper.plan.threads));
        let balance = initial.map(|e| e.mechanical);
        let still = Taken { iterations: 0, refactorizations: 0, residual: 0.0, to: 0.0 };
        let first = Step { dt: 0.0, taken: &still, cuts: 0, due: true, last: false, passed: &[] };
        if let StepLength::ArcLength(control) = &self.stepper.model.analysis.step_length {
            self.settle(state).map_err(|failure| Outcome::Failed { time: 0.0, failure })?;
            self.show(state, observer, balance, &first)?;
            return self.follow(state, observer, balance, control);
        }
        self.show(state, observer, balance, &first)?;
        let model = self.stepper.model;
        let mut own: Option<Box<dyn OwnLength>> = match model.analysis.step_length {
            StepLength::StabilityLimited { .. } => Some(Box::new(Free)),
            StepLength::ErrorControlled { .. } if self.stepper.explicit.is_some() => Some(Box::new(Free)),
            StepLength::ErrorControlled { tolerance, .. } => {
                Some(Box::new(Pace::new(model, tolerance, self.stepper.length, state)))
            }
            StepLength::Fixed { .. } | StepLength::ArcLength(_) => None,
        };
        for stretch in stretches(model) {
            if let Some(own) = &mut own {
                self.follow_length(state, &stretch, own.as_mut(), observer, balance)?;
            } else {
                for k in 1..=stretch.steps {
                    self.advance(state, &stretch, k, observer, balance)?;
                }
            }
            if stretch.jump {
                self.stepper.jump(state).map_err(|failure| Outcome::Failed { time: state.time, failure })?;
            }
        }
        Ok(())
    }

    /// One step of the deck, in as many pieces as it takes. Pieces are halves of halves, so they end where the step ends.
    fn advance(
        &mut self,
        state: &mut State,
        stretch: &Stretch,
        k: usize,
        observer: &mut dyn Observer,
        balance: Option<f64>,
    ) -> Result<(), Outcome> {
        let (from, to) = (state.time, stretch.time(k));
        let whole = 1u64 << DEEPEST;
        let (mut at, mut piece, mut cuts, mut successes, mut pieces) = (0u64, whole, 0, 0, 0);
        // Of the step as the deck has it: gaps of joints shrink with the step, and say less and less.
        let mut apart = None;
        let mut cause = None;
        let impacts = self.stepper.system.has_contacts();
        let most = MOST_PIECES[usize::from(impacts)];
        while at < whole {
            if self.stop.load(Ordering::Relaxed) {
                return Err(Outcome::Stopped { time: state.time });
            }
            let next = at + piece;
            let target = if next == whole { to } else { from + (to - from) * (next as f64 / whole as f64) };
            let dt = target - state.time;
            match self.stepper.step(state, target) {
                Ok(taken) => {
                    at = next;
                    successes += 1;
                    pieces += 1;
                    let last = at == whole;
                    let due = last && k == stretch.steps && stretch.due;
                    // No other step comes within rounding of the end.
                    let ends = last && to >= self.stepper.model.analysis.end_time * (1.0 - 1e-9);
                    let step = Step { dt, taken: &taken, cuts, due, last: ends, passed: &[] };
                    self.show(state, observer, balance, &step)?;
                    cuts = 0;
                    let [steps, before] = self.crawling;
                    if before + pieces >= most
                        && !last
                        && let Some(cause) = cause
                    {
                        let (steps, pieces, cause) = (steps + 1, before + pieces, Box::new(cause));
                        return Err(Outcome::Failed {
                            time: state.time,
                            failure: Failure::Crawling { steps, pieces, dt, cause },
                        });
                    }
                    // Two pieces taken and a longer one fits: try it.
                    if successes >= 2 && piece < whole && at.is_multiple_of(2 * piece) {
                        piece *= 2;
                        successes = 0;
                    }
                }
                Err(failure) => {
                    let half = 0.5 * dt;
                    // A structure that nothing holds is not helped by smaller loads; one that yields may be.
                    let analysis = &self.stepper.model.analysis;
                    let unheld = analysis.kind == AnalysisKind::Static
                        && self.stepper.system.history == 0
                        && state.time == 0.0
                        && matches!(failure, Failure::Singular { .. });
                    let is_apart = matches!(failure, Failure::Apart { .. });
                    if is_apart && apart.is_none() {
                        apart = Some(failure.clone());
                    }
                    if piece == 1 || half < analysis.least_step || unheld {
                        let failure = apart.filter(|_| is_apart).unwrap_or(failure);
                        return Err(Outcome::Failed { time: state.time, failure });
                    }
                    cause = Some(failure);
                    piece /= 2;
                    cuts += 1;
                    successes = 0;
                    self.counts.cuts += 1;
                }
            }
        }
        let [steps, before] = self.crawling;
        self.crawling = if pieces > MANY && !impacts { [steps + 1, before + pieces] } else { [0; 2] };
        Ok(())
    }

    pub(super) fn show(
        &mut self,
        state: &State,
        observer: &mut dyn Observer,
        balance: Option<f64>,
        step: &Step,
    ) -> Result<(), Outcome> {
        let model = self.stepper.model;
        let &Step { dt, taken, cuts, due, last, passed } = step;
        if taken.iterations > 0 {
            self.counts.steps += 1;
            self.counts.iterations += taken.iterations;
        }
        let due = due
            || match model.output.cadence {
                Cadence::Steps(every) => self.counts.steps.is_multiple_of(every.max(1)),
                Cadence::Interval(_) => false,
            };
        // Fields are drawn by steps, and at the end.
        let drawn = model.output.fields.is_some_and(|every| self.counts.steps.is_multiple_of(every.max(1)) || last);
        // Two looks at the clock are a twentieth of a step of two bodies.
        let began = (due || drawn || self.wanted.has(Wanted::EVERY_STEP)).then(Instant::now);
        let (system, threads) = (self.stepper.system, self.stepper.plan.threads);
        let watched = if is_watched(model) { Wanted::ENERGY } else { Wanted::NOTHING };
        let request = Request { model, system, state, due, drawn, balance, threads };
        self.derived.compute(self.wanted | watched, &request);
        let failure = self.watch(state, balance, last);
        let frame = Frame {
            model,
            state,
            step: self.counts.steps,
            dt,
            iterations: taken.iterations,
            refactorizations: taken.refactorizations,
            residual: taken.residual,
            cuts,
            due,
            last,
            reactions: if due && self.wanted.has(Wanted::REACTIONS) { &state.reactions } else { &[] },
            derived: &self.derived,
            passed,
            // Each multiplier brings one of its own.
            negative_pivots: (self.stepper.path.as_ref())
                .map(|_| self.stepper.solver.negative_eigenvalues().saturating_sub(self.stepper.system.multipliers())),
        };
        observer.on_step(&frame).map_err(Outcome::Io)?;
        if let Some(began) = began {
            self.observing += began.elapsed();
        }
        failure.map_or(Ok(()), |failure| Err(Outcome::Failed { time: state.time, failure }))
    }

    /// Sums the balance of energies up. Central differences that have made more than there was have failed; while there is next to
    /// nothing yet that says little, unless it is by far. What there was does not depend on the times of output: work is looked at
    /// in every step, and energies are where links may let some go.
    fn watch(&mut self, state: &State, balance: Option<f64>, last: bool) -> Option<Failure> {
        const FAR: f64 = 100.0;
        let Stepper { model, system, plan, .. } = &self.stepper;
        if model.analysis.kind != AnalysisKind::Dynamic {
            return None;
        }
        self.balance.work(state.work.external);
        let letting_go =
            || (is_watched(model) && may_let_go(model)).then(|| system.energy(state, balance, plan.threads));
        self.balance.see(&self.derived.energy.or_else(letting_go)?);
        let Balance { made, had, plastic, .. } = self.balance;
        // What plastic flow takes too much of does not move.
        let most = if last && made > plastic { had } else { FAR * had };
        // A load that begins at rest moves things before it has done work: what grows does so in the next step too.
        let grows = is_watched(self.stepper.model) && had > 0.0 && made > most;
        let went_on = std::mem::replace(&mut self.growing, grows) || last;
        (grows && went_on).then(|| Failure::Growing { made: made / had })
    }
}

/// Energies are summed whoever wants them: nothing else tells of motion that grows though the scene as it lies is stable.
fn is_watched(model: &Model) -> bool {
    matches!(model.scheme.stepping(), Stepping::Verlet) && model.analysis.kind == AnalysisKind::Dynamic
}

/// Some links store less than nothing where they give way.
fn may_let_go(model: &Model) -> bool {
    model.parts.iter().any(Part::may_release)
}
