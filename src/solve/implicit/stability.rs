//! The stability of equilibria in statics: an equilibrium is stable where the tangent has no negative eigenvalue. Load control finds
//! equilibria beyond a buckling load as easily as before it, so they are counted at the end of each step. Where the first appears, the
//! tangents at the ends of the step are combined, K(θ) = K₀ + θ (K₁ − K₀): the smallest θ at which one eigenvalue is negative gives the
//! load, exactly where stresses grow with it (linear buckling), and the softest mode there is the mode of buckling.

use super::out_of_plane::OutOfPlane;
use super::tangent::{Criterion, Ends, Tangent};
use crate::linear::{Factorization, TooLarge};
use crate::plan::deforms_in_plane;
use crate::snapshot::keep;
use crate::solve::context::Context;
use crate::solve::linear_system::LinearSystem;
use crate::solve::warning::{Remark, Warning};
use crate::solve::workspace::Workspace;
use crate::state::{Configuration, State};

/// The watch over the equilibria of a static analysis.
pub struct Stability {
    /// Unstable modes are counted: until some were found.
    counts: bool,
    criterion: Criterion,
    /// A path of given arc length, which passes limit points.
    path: Option<Path>,
    /// A matrix of its own where that of the iteration is kept over steps, or is elastic.
    own: Option<Box<LinearSystem>>,
    /// Negative eigenvalues at the last equilibrium, by which tangents that are not symmetric are known to be looked at.
    seen: usize,
    /// The motion out of the plane, where a plane motion leaves it out, until it has buckled.
    sideways: Option<Box<OutOfPlane>>,
}

keep!(Stability { counts, path, own, seen, sideways } without { criterion });

/// What was seen of a path.
struct Path {
    /// True where loads grow along it.
    grows: bool,
}

keep!(Path { grows });

impl Stability {
    /// The watch of a static analysis; `None` in dynamics, and where the tangent never changes. `kept`: the matrix of the iteration is not
    /// the tangent at the end of each step.
    ///
    /// # Errors
    /// There is no memory for the motion out of the plane.
    pub fn for_statics(cx: &Context, kept: bool) -> Result<Option<Stability>, TooLarge> {
        if cx.is_dynamic() || cx.plan.linear {
            return Ok(None);
        }
        let along = cx.model.analysis.step_length.is_arc_length();
        let criterion = match cx.plan.kind {
            _ if cx.system.loads_have_potential(cx.system.plane) => Criterion::Eigenvalues,
            Factorization::BlockLu => Criterion::Determinant,
            Factorization::Cholesky => Criterion::SymmetricPart,
        };
        let own = match kept || cx.system.history > 0 {
            true => Some(cx.plan.build(cx.system)?),
            false => None,
        };
        Ok(Some(Stability {
            // Along a path limit points change the sign of a determinant too.
            counts: !along || criterion == Criterion::Eigenvalues,
            criterion,
            path: along.then_some(Path { grows: true }),
            own: own.map(|(solver, assembly)| Box::new(LinearSystem::new(solver, assembly))),
            seen: 0,
            sideways: OutOfPlane::new(cx)?.map(Box::new),
        }))
    }

    /// Judges the equilibrium at the end of an accepted step, whose start is left in `ws.trial` and which began at the time `from`. `grows`:
    /// loads grow along the path there, which only a path of given arc length may not do.
    /// Returns true where the matrix of the step has been overwritten.
    pub fn check(&mut self, cx: &Context, ws: &mut Workspace, state: &State, from: f64, grows: bool) -> bool {
        if from == 0.0 && deforms_in_plane(cx.system) && !cx.system.joints.is_empty() {
            ws.warnings.remark(Remark::Jointed);
        }
        if self.sideways.as_mut().is_some_and(|out| !out.check(cx, ws, state, from)) {
            self.sideways = None;
        }
        if !self.counts {
            return false;
        }
        let Workspace { matrix, forces, loads, trial, history, warnings, .. } = ws;
        let end = Configuration { nodes: &state.nodes, history, dt: state.time - from, lead: None };
        let own = self.own.is_some();
        let matrix = self.own.as_deref_mut().unwrap_or(matrix);
        matrix.make_room(cx, &end);
        let mut tangent =
            Tangent { system: cx.system, dofs: &cx.plan.dofs, matrix, forces, springs: &[], criterion: self.criterion };
        // The matrix at hand is that of the last correction but one, whose motion differs by the square of the tolerance.
        if own {
            tangent.form(&end, &loads.end);
            // A plastic plateau has no stiffness, which is no buckling.
            if tangent.matrix.solver.factor().is_err() {
                return false;
            }
        }
        let negative = tangent.matrix.solver.negative_eigenvalues().saturating_sub(cx.system.multipliers());
        let before = std::mem::replace(&mut self.seen, negative);
        // At a limit point one mode becomes unstable, and loads go back.
        let explained = self
            .path
            .as_mut()
            .map_or(0, |path| before + usize::from(std::mem::replace(&mut path.grows, grows) != grows));
        let suspicious = match self.criterion {
            Criterion::Determinant => negative > before || tangent.count() > 0,
            _ => negative > explained,
        };
        if !suspicious {
            return false;
        }
        let start = Configuration { nodes: trial, history, dt: 0.0, lead: None };
        let ends = Ends { configurations: [start, end], loads: [&loads.start, &loads.end], times: [from, state.time] };
        if let Some(instability) = tangent.locate(cx, &ends) {
            warnings.add(Warning::Unstable(instability));
            self.counts = false;
        }
        if self.path.is_some() && !own {
            // The negative pivots of the equilibrium are told of each step.
            tangent.form(&end, &loads.end);
            tangent.matrix.solver.factor().is_err()
        } else {
            !own
        }
    }
}
