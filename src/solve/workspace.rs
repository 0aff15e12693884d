//! The workspace of a step: plain data, allocated once, without behaviour.

use super::context::Context;
use super::linear_system::LinearSystem;
use super::slip_watch::SlipWatch;
use super::warning::{Remark, Warnings};
use crate::modes::ResponseSoFar;
use crate::step::correct::Correction;
use crate::step::load_steps::LoadSteps;
use crate::step::residual::Residual;
use crate::step::trial::TrialMotion;
use crate::system::{Forces, Loading, Prescribed};
use base::snapshot::{Keep, Snapshot, keep};
use linear::{Solver, TooLarge};
use mechanics::state::{Node, State};

/// The data of the current step.
pub struct Workspace {
    /// The motion to the instant of equilibrium; of explicit steps, to their end.
    pub trial: TrialMotion,
    /// The motion to the end of an implicit step; after the step its nodes are those at the start.
    pub end: TrialMotion,
    /// History variables at the end of the step.
    pub history: Vec<f64>,
    /// Residual forces of the trial motion, and the multipliers of joints.
    pub forces: Forces,
    /// Forces out of balance by unknown: the right-hand side of a linear system.
    pub residual: Residual,
    /// The solution of that system.
    pub correction: Correction,
    /// Loads.
    pub loads: AtTimes<Loading>,
    /// Prescribed motion, in the order of the model's restraints; at the instant of equilibrium displacements count
    /// from the start of the step.
    pub prescribed: PrescribedStep,
    /// Largest coordinate of a node at the start of the step, counted from the first node at t = 0. The rounding of
    /// distances is measured by it.
    pub reach: f64,
    /// The data that load steps pass to later ones.
    pub load_steps: LoadSteps,
    /// The matrix of the step: its tangent, or the matrix of masses and joints.
    pub matrix: LinearSystem,
    /// Number of factorizations so far.
    pub factorizations: usize,
    /// Number of solutions of a linear system so far.
    pub solves: usize,
    /// Largest departure from orthogonality of a truncated rotation update before it was corrected, over all steps.
    pub rotation_drift: f64,
    /// Largest gap of a joint at the end of a step, relative to `reach`, over all steps.
    pub joint_violation: f64,
    /// The warnings of the run so far.
    pub warnings: Warnings,
    /// Slip that begins again after rest.
    slips: SlipWatch,
    /// The computed part of a frequency response.
    pub response: ResponseSoFar,
}

keep!(Workspace {
    trial,
    end,
    history,
    forces,
    residual,
    correction,
    loads,
    prescribed,
    reach,
    load_steps,
    matrix,
    factorizations,
    solves,
    rotation_drift,
    joint_violation,
    warnings,
    slips,
    response,
});

/// An excitation at the three times that a step needs.
#[derive(Default)]
pub struct AtTimes<T> {
    /// Its value at the start of the step.
    pub start: T,
    /// Its value at the end of the step.
    pub end: T,
    /// Its value at the instant where equilibrium is written.
    pub instant: T,
}

/// The prescribed motion of a step.
#[derive(Default)]
pub struct PrescribedStep {
    /// At the start of the step.
    pub start: Vec<Prescribed>,
    /// At the end of the step.
    pub end: Vec<Prescribed>,
    /// At the instant where equilibrium is written, displacements counted from the start of the step.
    pub instant: Vec<Prescribed>,
    /// The increments over the step, with the rates that increments have at its end.
    pub moved: Vec<Prescribed>,
}

keep!(PrescribedStep { start, end, instant, moved });

impl<T: Keep> Keep for AtTimes<T> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let AtTimes { start, end, instant } = self;
        [start, end, instant].into_iter().for_each(|value| value.keep(snapshot));
    }
}

impl Workspace {
    /// # Errors
    /// There is no memory for the solver.
    pub fn new(cx: &Context) -> Result<Workspace, TooLarge> {
        let (solver, assembly) = cx.plan.build(cx.system)?;
        let warnings = warnings_of(cx, &solver);
        Ok(Workspace {
            trial: TrialMotion::new(cx),
            end: TrialMotion::new(cx),
            history: vec![0.0; cx.system.history],
            forces: Forces::new(cx.system, cx.model.nodes.len()).on_threads(cx.plan.threads),
            residual: Residual::new(cx),
            correction: Correction::new(cx),
            loads: AtTimes::default(),
            prescribed: PrescribedStep::default(),
            reach: cx.length,
            load_steps: LoadSteps::default(),
            matrix: LinearSystem::new(solver, assembly),
            factorizations: 0,
            solves: 0,
            rotation_drift: 0.0,
            joint_violation: 0.0,
            warnings,
            slips: SlipWatch::new(cx),
            response: ResponseSoFar::default(),
        })
    }

    /// Forgets everything about earlier runs of the same scene. The matrix keeps its memory, for each run forms it before the first use; the
    /// caller counts the factorizations and solves.
    pub fn begin_run(&mut self, cx: &Context) {
        let Workspace {
            trial, end, history, forces, residual, correction, loads, prescribed, reach, load_steps, ..
        } = self;
        trial.begin_run(cx);
        end.begin_run(cx);
        history.fill(0.0);
        *forces = Forces::new(cx.system, cx.model.nodes.len()).on_threads(cx.plan.threads);
        (*residual, *correction) = (Residual::new(cx), Correction::new(cx));
        (*loads, *prescribed) = (AtTimes::default(), PrescribedStep::default());
        (*reach, *load_steps) = (cx.length, LoadSteps::default());
        (self.rotation_drift, self.joint_violation) = (0.0, 0.0);
        self.warnings = warnings_of(cx, &self.matrix.solver);
        self.slips = SlipWatch::new(cx);
        self.response = ResponseSoFar::default();
    }

    /// Places all nodes, those too that no step moves.
    pub fn place(&mut self, nodes: &[Node]) {
        [&mut self.trial, &mut self.end].into_iter().for_each(|motion| motion.nodes.copy_from_slice(nodes));
    }
}

impl Workspace {
    /// Records slip in a step of length `dt` to this state; the initial history of the step is still available.
    pub fn note_slip(&mut self, cx: &Context, state: &State, dt: f64) {
        self.slips.note(cx, &self.history, state, dt);
    }

    /// Looks inside a step whose slip has been recorded, which is no further step.
    pub fn inside_step<R>(&mut self, look: impl FnOnce(&mut Self) -> R) -> R {
        let slips = std::mem::take(&mut self.slips);
        let found = look(self);
        self.slips = slips;
        found
    }

    /// Warns of friction that the run has not resolved.
    pub fn warn_of_friction(&mut self, cx: &Context) {
        self.warnings.extend(self.slips.throws(cx));
        self.warnings.extend(self.slips.warning(cx));
    }
}

/// The remarks at the begin of a run, and room for all contacts.
fn warnings_of(cx: &Context, solver: &Solver) -> Warnings {
    let mut warnings = Warnings::default();
    warnings.touched.reserve(cx.model.parts.iter().filter(|part| part.kind().is_unilateral()).count());
    if solver.stats().in_file {
        warnings.remark(Remark::FactorInFile(solver.scratch()));
    }
    warnings
}
