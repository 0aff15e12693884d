//! The stability of equilibria in statics: an equilibrium is stable where the tangent has no negative eigenvalue. Load control finds
//! equilibria beyond a buckling load as easily as before it, so they are counted at the end of each step. Where the first appears, the
//! tangents at the ends of the step are combined, K(θ) = K₀ + θ (K₁ − K₀): the smallest θ at which one eigenvalue is negative gives the
//! load, exactly where stresses grow with it (linear buckling), and the softest mode there is the mode of buckling.
//!
//! The tangent of what slips is not symmetric: a point that is pressed deeper by δ is held back by μ k δ more, and nothing pushes it out for
//! that. Its symmetric part may then have negative eigenvalues where nothing grows; where it has none, nothing does. So these only raise the
//! suspicion, which the determinant of the whole tangent settles.

use super::out_of_plane::OutOfPlane;
use super::tangent::{Criterion, Ends, Tangent};
use crate::linear::{Factorization, TooLarge};
use crate::snapshot::keep;
use crate::solve::context::Context;
use crate::solve::linear_system::LinearSystem;
use crate::solve::warning::{Instability, Remark, Warning};
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
        if from == 0.0 && cx.system.plane.is_some() && !cx.system.joints.is_empty() {
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
        match locate(cx, &mut tangent, &ends, negative > before, self.path.is_some()) {
            Ok(Some(instability)) => {
                warnings.add(Warning::Unstable(instability));
                self.counts = false;
            }
            Ok(None) => {}
            Err(NotJudged) => warnings.remark(Remark::Slipping),
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

/// A path of given arc length on which something slips: its limit points change the sign of the determinant too.
struct NotJudged;

/// The first instability in a step after one was suspected; `appeared`, `along` as for [`locate_in_doubt`].
fn locate(
    cx: &Context,
    tangent: &mut Tangent,
    ends: &Ends,
    appeared: bool,
    along: bool,
) -> Result<Option<Instability>, NotJudged> {
    let in_doubt = tangent.criterion == Criterion::SymmetricPart || cx.system.rubs();
    match tangent.criterion {
        Criterion::Eigenvalues | Criterion::SymmetricPart if in_doubt => {
            locate_in_doubt(cx, tangent, ends, appeared, along)
        }
        _ => Ok(tangent.locate(cx, ends)),
    }
}

/// The first instability in a step whose tangent need not be symmetric, after the symmetric part has raised the suspicion. `appeared`: more of
/// its eigenvalues are negative than at the start of the step; `along`: the step is one of a path of given arc length.
fn locate_in_doubt(
    cx: &Context,
    tangent: &mut Tangent,
    ends: &Ends,
    appeared: bool,
    along: bool,
) -> Result<Option<Instability>, NotJudged> {
    let mut whole = match tangent.matrix.solver.is_symmetric() {
        true => whole_matrix(cx, &ends.configurations[1]),
        false => None,
    };
    let Tangent { system, dofs, springs, criterion, .. } = *tangent;
    let matrix = whole.as_mut().unwrap_or(&mut *tangent.matrix);
    let mut tangent = Tangent { system, dofs, matrix, forces: &mut *tangent.forces, springs, criterion };
    tangent.criterion = tangent.criterion_between(ends);
    if tangent.criterion == Criterion::Determinant {
        if along {
            return Err(NotJudged);
        }
        if !appeared && tangent.unstable_modes_at_end(ends) == Some(0) {
            return Ok(None);
        }
    }
    Ok(tangent.locate(cx, ends))
}

/// A matrix that is stored in full, for one look at the determinant of a scene that is solved by the symmetric part; `None` where there is
/// no memory for it.
fn whole_matrix(cx: &Context, now: &Configuration) -> Option<LinearSystem> {
    let built = cx.plan.build_unsymmetric(cx.system, &cx.system.partners(now.nodes));
    built.ok().map(|(solver, assembly)| LinearSystem::new(solver, assembly))
}
