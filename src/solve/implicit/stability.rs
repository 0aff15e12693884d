//! The stability of equilibria in statics: an equilibrium is stable where the tangent has no negative eigenvalue. Load control finds
//! equilibria beyond a buckling load as easily as before it, so they are counted at the end of each step. Where the first appears, the
//! tangents at the ends of the step are combined, K(θ) = K₀ + θ (K₁ − K₀): the smallest θ at which one eigenvalue is negative gives the
//! load, exactly where stresses grow with it (linear buckling), and the softest mode there is the mode of buckling.

use super::mechanism;
use super::mode::Mode;
use crate::elements::Moduli;
use crate::linear::TooLarge;
use crate::model::DIRECTIONS;
use crate::plan::Sideways;
use crate::solve::context::Context;
use crate::solve::linear_system::LinearSystem;
use crate::solve::warning::{Instability, Warning};
use crate::solve::workspace::Workspace;
use crate::state::{Configuration, Node, State};
use crate::system::assembly::TangentWeights;
use crate::system::{DofMap, Forces, Loading, System};

/// Number of bisections for the load at which the first eigenvalue is negative: 1e-5 of the step.
const BISECTIONS: usize = 17;

const WEIGHTS: TangentWeights =
    TangentWeights { stiffness: true, rate: 0.0, acceleration: 0.0, moduli: Moduli::Algorithmic };

/// The watch over the equilibria of a static analysis.
pub struct Stability {
    /// Negative eigenvalues are counted: under load control, where loads have a potential, until some were found.
    counts: bool,
    /// The motion out of the plane, where a plane motion leaves it out, until it has buckled.
    sideways: Option<Box<OutOfPlane>>,
}

/// The tangent of the motion out of the plane.
struct OutOfPlane {
    system: System,
    dofs: DofMap,
    matrix: LinearSystem,
    forces: Forces,
    /// True once the tangent at t = 0 has been found to hold the scene in its plane.
    held: bool,
}

/// A tangent to be formed: of the plane of motion, or out of it.
struct Tangent<'t> {
    system: &'t System,
    dofs: &'t DofMap,
    matrix: &'t mut LinearSystem,
    forces: &'t mut Forces,
}

impl Stability {
    /// The watch of a static analysis; `None` in dynamics, and where the tangent never changes.
    ///
    /// # Errors
    /// There is no memory for the motion out of the plane.
    pub fn for_statics(cx: &Context) -> Result<Option<Stability>, TooLarge> {
        if cx.is_dynamic() || cx.plan.linear {
            return Ok(None);
        }
        let sideways = match Sideways::new(cx.model, cx.system, cx.plan)? {
            Some(Sideways { system, dofs, solver, assembly }) => {
                let forces = Forces::new(&system, cx.model.nodes.len());
                let matrix = LinearSystem { solver, assembly };
                Some(Box::new(OutOfPlane { system, dofs, matrix, forces, held: false }))
            }
            None => None,
        };
        let counts = !cx.model.analysis.step_length.is_arc_length() && cx.system.loads_have_potential(cx.system.plane);
        Ok(Some(Stability { counts, sideways }))
    }

    /// Judges the equilibrium at the end of an accepted step, whose start is left in `ws.trial` and which began at the time `from`.
    /// Returns true where the matrix of the step has been overwritten.
    pub fn check(&mut self, cx: &Context, ws: &mut Workspace, state: &State, from: f64) -> bool {
        if self.sideways.as_mut().is_some_and(|out| !out.check(cx, ws, state, from)) {
            self.sideways = None;
        }
        // The matrix at hand is that of the last correction but one, whose motion differs by the square of the tolerance.
        if !self.counts || ws.matrix.solver.negative_eigenvalues() <= cx.system.multipliers() {
            return false;
        }
        let Workspace { matrix, forces, loads, trial, history, warnings, .. } = ws;
        let mut tangent = Tangent { system: cx.system, dofs: &cx.plan.dofs, matrix, forces };
        let loads = [&loads.start, &loads.end];
        if let Some(instability) = tangent.locate(cx, state, (trial, history), loads, from) {
            warnings.add(Warning::Unstable(instability));
            self.counts = false;
        }
        true
    }
}

impl OutOfPlane {
    /// Judges an equilibrium; returns false where there is nothing to be watched any more.
    fn check(&mut self, cx: &Context, ws: &mut Workspace, state: &State, from: f64) -> bool {
        let OutOfPlane { system, dofs, matrix, forces, held } = self;
        let mut tangent = Tangent { system, dofs, matrix, forces };
        let Workspace { loads, trial, history, warnings, .. } = ws;
        if !*held {
            // What is not held out of its plane at all is meant to be plane.
            tangent.form(trial, history, &loads.start);
            let now = Configuration { nodes: trial, history, dt: 0.0 };
            let solver = &mut tangent.matrix.solver;
            let free = solver.factor().is_err()
                || solver.negative_eigenvalues() > 0
                || mechanism::find(system, dofs, solver, &now, WEIGHTS, cx.length).is_some();
            if free {
                return false;
            }
            *held = true;
        }
        tangent.form(&state.nodes, history, &loads.end);
        if tangent.matrix.solver.factor().is_ok() && tangent.matrix.solver.negative_eigenvalues() == 0 {
            return true;
        }
        match tangent.locate(cx, state, (trial, history), [&loads.start, &loads.end], from) {
            Some(instability) => {
                warnings.add(Warning::UnstableOutOfPlane(instability));
                false
            }
            None => true,
        }
    }
}

impl Tangent<'_> {
    /// Writes the tangent into the matrix.
    fn form(&mut self, nodes: &[Node], history: &[f64], loads: &Loading) {
        let now = Configuration { nodes, history, dt: 0.0 };
        self.system.residual(&now, loads, self.forces);
        self.matrix.assembly.tangent(self.system, &now, loads, self.forces, WEIGHTS, &mut self.matrix.solver);
    }

    /// The number of negative eigenvalues beyond those of multipliers; `None` where the matrix is singular.
    fn negative(&mut self) -> Option<usize> {
        let solver = &mut self.matrix.solver;
        solver.factor().ok().map(|()| solver.negative_eigenvalues().saturating_sub(self.system.multipliers()))
    }

    /// The first instability in the step; `None` where the tangent at its end shows none.
    fn locate(
        &mut self,
        cx: &Context,
        state: &State,
        (start, history): (&[Node], &[f64]),
        loads: [&Loading; 2],
        from: f64,
    ) -> Option<Instability> {
        self.form(&state.nodes, history, loads[1]);
        let end = self.matrix.solver.values().to_vec();
        let modes = self.negative().unwrap_or(1);
        if modes == 0 {
            return None;
        }
        self.form(start, history, loads[0]);
        let begin = self.matrix.solver.values().to_vec();
        let (mut stable, mut unstable) = (0.0, 1.0);
        let combine = |tangent: &mut Self, theta: f64| {
            let values = tangent.matrix.solver.values().iter_mut();
            values.zip(&begin).zip(&end).for_each(|((k, k0), k1)| *k = k0 + theta * (k1 - k0));
            tangent.negative()
        };
        if combine(self, 0.0) == Some(0) {
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (stable + unstable);
                match combine(self, middle) {
                    Some(0) => stable = middle,
                    _ => unstable = middle,
                }
            }
        }
        combine(self, unstable);
        let mode = Mode::softest(&mut self.matrix.solver, self.dofs, cx.length);
        let (label, direction) = match mode.and_then(|mode| mode.largest(self.dofs)) {
            Some((node, dof)) => (cx.model.nodes[node].label.clone(), DIRECTIONS[dof]),
            None => (String::new(), ""),
        };
        let time = from + unstable * (state.time - from);
        Some(Instability { time, modes, seen: state.time, label, direction })
    }
}
