//! The matrix of the iteration: formed when due, and rotated with the model.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::mechanism_watch::MechanismWatch;
use crate::report::StepReport;
use crate::step::trial::Step;
use crate::strategy::refresh::Refresh;
use crate::strategy::rotated_matrix::RotatedMatrix;
use crate::strategy::stabilization::{self, HeldByForces, Unheld};
use crate::system::TangentWeights;
use crate::workspace::Workspace;
use base::snapshot::keep;
use mechanics::elements::Moduli;
use mechanics::integrators::Coefficients;
use mechanics::state::{Configuration, Node};
use model::Update;

/// The current matrix; its values are in the workspace.
pub struct IterationMatrix {
    /// The rule that decides when it is renewed.
    pub refresh: Refresh,
    /// The rotation of the matrix with the model, if used.
    rotated: Option<RotatedMatrix>,
    mechanisms: MechanismWatch,
    /// The factor of the mass in it.
    pub mass_weight: f64,
    /// The first matrix of a load step, where it was singular and a stabilized one has led on.
    unheld: Option<Unheld>,
    /// True if the current matrix is stabilized.
    is_stabilized: bool,
    /// True if the current matrix has elastic moduli because a pivot of the tangent vanished.
    has_yielded: bool,
}

keep!(IterationMatrix { refresh, rotated, mechanisms, mass_weight } without { unheld, is_stabilized, has_yielded });

impl IterationMatrix {
    /// No matrix yet, with the rule of the deck.
    pub fn new(cx: &Context) -> IterationMatrix {
        let (_, update) = Refresh::rule(cx);
        IterationMatrix {
            refresh: Refresh::new(cx),
            rotated: RotatedMatrix::new(cx).filter(|_| update != Update::Iteration),
            mechanisms: MechanismWatch::new(cx),
            mass_weight: 0.0,
            unheld: None,
            is_stabilized: false,
            has_yielded: false,
        }
    }

    /// Forms and factorizes the matrix for the trial motion when due; returns whether it did. `previous` is the iterate whose stresses are
    /// extrapolated.
    ///
    /// # Errors
    /// [`Failure::Singular`] if the matrix cannot be factorized, [`Failure::Stopped`] if a signal arrived meanwhile.
    pub fn refresh(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: &Step,
        previous: Option<&[Node]>,
        report: &mut StepReport,
    ) -> Result<bool, Failure> {
        let key = key(step.stage.scheme, step.dt());
        if !self.refresh.due(report.iterations, key) {
            return Ok(false);
        }
        let may_stabilize = report.iterations == 0 && stabilization::may_help(cx);
        self.form(cx, ws, step, previous, may_stabilize)?;
        if let Some(rotated) = &mut self.rotated {
            rotated.note(&ws.trial.nodes);
        }
        match self.is_stabilized {
            // It leads one correction alone; the next matrix has the forces of joints in it.
            true => self.refresh.rejected(),
            false => self.refresh.done(key),
        }
        report.factorizations += 1;
        Ok(true)
    }

    /// Forms and factorizes the matrix. If it is singular because all resisting parts have yielded, the elastic matrix replaces it. If it
    /// is singular because joints exert no forces yet, a stabilized matrix replaces it.
    fn form(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: &Step,
        previous: Option<&[Node]>,
        may_stabilize: bool,
    ) -> Result<(), Failure> {
        let scheme = step.stage.scheme;
        let (rate, acceleration) = scheme.weights();
        self.mass_weight = acceleration;
        let now = Configuration { previous, ..step.at_instant(&ws.trial.nodes) };
        ws.matrix.make_room(cx, &now);
        let openings = self.mechanisms.look(cx, step.state, &ws.prescribed.instant, &now);
        let mut moduli = self.refresh.moduli();
        (self.is_stabilized, self.has_yielded) = (false, false);
        loop {
            let weights = TangentWeights { stiffness: true, rate, acceleration, turning: scheme.turning, moduli };
            let (matrix, loads) = (&mut ws.matrix, &ws.loads.instant);
            matrix.assembly.tangent(cx.system, &now, loads, &mut ws.forces, weights, &mut matrix.solver);
            if let Some(unheld) = self.unheld.as_ref().filter(|_| self.is_stabilized) {
                unheld.add_springs(cx, &mut matrix.solver);
            }
            let held = self.unheld.as_ref().map(|unheld| HeldByForces {
                // A factorization overwrites it.
                assembled: matrix.solver.matrix(cx.plan.dofs.nodal_dofs().len()),
                springs: unheld.stiffness,
            });
            ws.factorizations += 1;
            let failure = match matrix.factor(cx) {
                Ok(false) => return Err(Failure::Stopped),
                // The next matrix tells whether anything holds.
                Ok(true) if self.is_stabilized => return Ok(()),
                Ok(true) => {
                    let weights = (weights, held.as_ref());
                    match self.mechanisms.search(cx, &mut matrix.solver, &now, weights, openings) {
                        Ok(()) => {
                            // A part standing on its joints has the stiffness of a hanging part with opposite sign, so only the negative
                            // pivots show that it falls.
                            let falls = |_: &mut Unheld| matrix.solver.negative_eigenvalues() > cx.system.multipliers();
                            return self.unheld.take_if(falls).map_or(Ok(()), |unheld| Err(unheld.failure));
                        }
                        Err(failure) => failure,
                    }
                }
                Err(_) if moduli == Moduli::Algorithmic && cx.system.history > 0 => {
                    (moduli, self.has_yielded) = (Moduli::Elastic, true);
                    continue;
                }
                Err(singular) => self.mechanisms.singular(cx, &now, singular.row, openings),
            };
            if !may_stabilize || self.is_stabilized || openings.any() {
                return Err(failure);
            }
            self.unheld = Some(Unheld::new(cx, &ws.residual.values, failure));
            self.is_stabilized = true;
        }
    }

    /// Why a load step has failed that began with a stabilized matrix: nothing holds the scene. `None` for other steps.
    pub fn unheld(&mut self) -> Option<Failure> {
        self.unheld.take().map(|unheld| unheld.failure)
    }

    /// True if the current matrix is stabilized: its correction is applied, but says nothing about convergence.
    pub fn is_stabilized(&self) -> bool {
        self.is_stabilized
    }

    /// True if a pivot of the tangent vanished because all resisting parts have yielded.
    pub fn has_yielded(&self) -> bool {
        self.has_yielded
    }

    /// Solves for the correction due to the residual and the gaps of joints.
    ///
    /// # Errors
    /// [`Failure::Singular`] if the matrix is stabilized and the correction moves unrestrained parts too far.
    pub fn solve(&mut self, cx: &Context, ws: &mut Workspace) -> Result<(), Failure> {
        let Workspace { matrix, forces, residual, correction, trial, .. } = ws;
        correction.values.copy_from_slice(&residual.values);
        let solve = |r: &mut [f64]| matrix.solve_augmented(&forces.multipliers, r);
        rotate(&mut self.rotated, &trial.nodes, &mut correction.values, solve);
        ws.solves += 1;
        let goes_far = self.is_stabilized && !stabilization::stays_in_place(cx, &ws.correction.values);
        self.unheld.take_if(|_| goes_far).map_or(Ok(()), |unheld| Err(unheld.failure))
    }

    /// As [`IterationMatrix::solve`] with the matrix carried along to the configuration `nodes`, for residuals without gaps.
    pub fn solve_at(&mut self, ws: &mut Workspace, nodes: &[Node]) {
        let Workspace { matrix, residual, correction, .. } = ws;
        correction.values.copy_from_slice(&residual.values);
        rotate(&mut self.rotated, nodes, &mut correction.values, |r| matrix.solver.solve(r));
        ws.solves += 1;
    }

    /// Discards the matrix, which belongs to a rejected motion or to other loads.
    pub fn discard(&mut self) {
        self.refresh.rejected();
        if let Some(rotated) = &mut self.rotated {
            rotated.rest();
        }
    }

    /// Records that another iteration, with its own refresh rule, has formed the matrix for a step of length `dt`.
    pub fn note_formed(&mut self, scheme: &Coefficients, dt: f64) {
        self.refresh.done(key(scheme, dt));
    }

    /// The name of the part that has opened or gone slack last, in quotes.
    pub fn opened_part(&self) -> Option<String> {
        self.mechanisms.opened()
    }
}

/// Solves in the configuration of the current matrix for right-hand sides in the configuration `nodes`.
fn rotate(rotated: &mut Option<RotatedMatrix>, nodes: &[Node], r: &mut [f64], solve: impl FnOnce(&mut [f64])) {
    let Some(rotated) = rotated else { return solve(r) };
    let turns = rotated.take_back(nodes, r);
    solve(r);
    if turns {
        rotated.carry_along(nodes, r);
    }
}

/// The length of the step, or the time over which its rates are formed: the matrix depends on it besides the motion.
fn key(scheme: &Coefficients, dt: f64) -> f64 {
    if scheme.rate[0] > 0.0 { 1.0 / scheme.rate[0] } else { dt }
}
