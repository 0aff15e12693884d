//! The stability of equilibria in statics: an equilibrium is stable where the tangent has no negative eigenvalue. Load control finds
//! equilibria beyond a buckling load as easily as before it, so they are counted at the end of each step. At the first negative eigenvalue,
//! the tangents at both ends of the step are combined, K(θ) = K₀ + θ (K₁ − K₀). The smallest θ with a negative eigenvalue gives the load,
//! exactly if stresses are proportional to it (linear buckling), and the softest mode there is the buckling mode.
//!
//! A load step that ends on an unstable branch is cut, because the stable path may bend away from it within the step. Where a short step
//! ends there too the path itself is unstable, and the run ends. Softening material and cases that cannot be judged cause warnings.
//!
//! The tangent of slipping contacts is not symmetric: a penetration larger by δ increases the friction by μ k δ, but a slip causes no
//! normal force. Its symmetric part may have negative eigenvalues although no motion grows; without negative eigenvalues no motion grows.
//! They therefore only raise a suspicion, and the determinant of the whole tangent decides.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::guard::{Guard, Iterate, Taken};
use crate::guards::out_of_plane::OutOfPlane;
use crate::guards::stability_tangent::{Criterion, Ends, Tangent};
use crate::linear_system::LinearSystem;
use crate::step::trial::{Step, TrialMotion};
use crate::strategy::refresh::Refresh;
use crate::system::Forces;
use crate::tolerances::stability::SHORTEST;
use crate::warning::{Instability, Remark, Warning};
use crate::workspace::Workspace;
use base::math::{Vec6, angular, linear};
use base::snapshot::{Keep, Snapshot, keep};
use linear::{Factorization, TooLarge};
use mechanics::state::Configuration;
use model::{Method, Update};

/// The watch over the equilibria of a static analysis.
pub struct Stability {
    /// Unstable modes are counted: until some were found.
    counts: bool,
    criterion: Criterion,
    /// A path of given arc length, which passes limit points.
    path: Option<Path>,
    /// A separate matrix, if the matrix of the iteration is kept over steps or is elastic.
    own: Option<Box<LinearSystem>>,
    /// Number of negative eigenvalues at the last equilibrium; an increase triggers the check of unsymmetric tangents.
    seen: usize,
    /// Findings at the end of a load step, until the step is accepted.
    found: Found,
    /// The motion out of the plane, if the analysis omits it, until it has buckled.
    sideways: Option<Box<OutOfPlane>>,
    /// The iteration to the last equilibrium of a load step.
    way: Way,
}

keep!(Stability { counts, path, own, seen, sideways } without { criterion, found, way });

/// The way of an iteration to an equilibrium of a load step.
struct Way {
    /// The increments after the first correction, by node.
    first: Vec<Vec6>,
    /// True where a tangent behind the first correction had negative eigenvalues.
    passes_unstable: bool,
}

impl Way {
    /// True if the equilibrium lies beyond an unstable branch, against the direction of the loads: it may be the mirror image of the
    /// correct one.
    fn has_turned_back(&self, cx: &Context, trial: &TrialMotion) -> bool {
        let way = self.first.iter().zip(&trial.increments).map(|(first, increment)| {
            let turns = angular(first).dot(&angular(&increment.q));
            linear(first).dot(&linear(&increment.q)) + cx.length * cx.length * turns
        });
        self.passes_unstable && way.sum::<f64>() < 0.0
    }
}

/// The findings at an equilibrium.
#[derive(Default)]
struct Found {
    /// The number of negative eigenvalues, where they were counted.
    negative: Option<usize>,
    instability: Option<Instability>,
    /// True if it is unstable only because material softens.
    softens: bool,
    /// True if a contact slips under arc-length control, which is not judged.
    slips: bool,
}

/// The record of a path under arc-length control.
struct Path {
    /// True where loads grow along it.
    grows: bool,
}

keep!(Path { grows });

impl Stability {
    /// The watch of a static analysis whose tangent changes.
    ///
    /// # Errors
    /// There is no memory for a separate matrix, or for the motion out of the plane.
    pub fn new(cx: &Context) -> Result<Stability, TooLarge> {
        let on_path = cx.model.analysis.step_length.is_arc_length();
        let criterion = match cx.plan.kind {
            _ if cx.system.has_potential(cx.system.plane) => Criterion::Eigenvalues,
            Factorization::BlockLu => Criterion::Determinant,
            Factorization::Cholesky => Criterion::SymmetricPart,
        };
        let (method, update) = Refresh::rule(cx);
        let kept = update != Update::Iteration || method == Method::InitialLoad;
        let own = match kept || cx.system.history > 0 {
            true => Some(cx.plan.build(cx.system)?),
            false => None,
        };
        Ok(Stability {
            // Along a path limit points change the sign of a determinant too.
            counts: !on_path || criterion == Criterion::Eigenvalues,
            criterion,
            path: on_path.then_some(Path { grows: true }),
            own: own.map(|(solver, assembly)| Box::new(LinearSystem::new(solver, assembly))),
            seen: 0,
            found: Found::default(),
            sideways: OutOfPlane::new(cx)?.map(Box::new),
            way: Way { first: vec![Vec6::zeros(); cx.model.nodes.len()], passes_unstable: false },
        })
    }

    /// Looks at the equilibrium at the end of a step. Under arc-length control `grows` is true if loads grow. With `cuts`, an unstable step
    /// is cut anyway, so its buckling time is not searched.
    fn look(
        &mut self,
        cx: &Context,
        (matrix, forces): (&mut LinearSystem, &mut Forces),
        ends: &Ends,
        grows: Option<bool>,
        cuts: bool,
    ) {
        if !self.counts {
            return;
        }
        let Stability { found, own, path, seen, .. } = self;
        let (is_own, before, end) = (own.is_some(), *seen, &ends.configurations[1]);
        let matrix = own.as_deref_mut().unwrap_or(matrix);
        matrix.make_room(cx, end);
        let mut tangent =
            Tangent { system: cx.system, dofs: &cx.plan.dofs, matrix, forces, springs: &[], criterion: self.criterion };
        // The current matrix belongs to the last correction but one, whose motion differs by the square of the tolerance.
        if is_own {
            tangent.form(end, ends.loads[1]);
            // A plastic plateau has no stiffness, which is no buckling.
            if tangent.matrix.solver.factor().is_err() {
                return;
            }
        }
        let negative = tangent.matrix.solver.negative_eigenvalues().saturating_sub(cx.system.multipliers());
        found.negative = Some(negative);
        // At a limit point one mode becomes unstable, and loads go back.
        let turned = |path: &mut Path| grows.is_some_and(|grows| std::mem::replace(&mut path.grows, grows) != grows);
        let explained = path.as_mut().map_or(0, |path| before + usize::from(turned(path)));
        let suspicious = match self.criterion {
            Criterion::Determinant => negative > before || tangent.count() > 0,
            _ => negative > explained,
        };
        if !suspicious {
            return;
        }
        tangent.matrix.overwritten = true;
        found.softens = cx.system.history > 0 && tangent.is_stable_with_elastic_moduli(ends);
        let looked = match self.criterion {
            Criterion::Eigenvalues if cuts && !found.softens && !cx.system.rubs() && tangent.turns_unstable(ends) => {
                Ok(Some(Instability { certain: true, ..Instability::default() }))
            }
            _ => locate(cx, &mut tangent, ends, negative > before, path.is_some()),
        };
        match looked {
            Ok(instability) => found.instability = instability,
            Err(NotJudged) => found.slips = true,
        }
        if path.is_some() && !is_own {
            // Reports of each step contain the negative pivots of the equilibrium.
            tangent.form(end, ends.loads[1]);
            tangent.matrix.overwritten = tangent.matrix.solver.factor().is_err();
        }
    }
}

impl Guard for Stability {
    /// Records the first increments, and whether later tangents have negative eigenvalues. The first tangent is omitted: until the first
    /// correction, prescribed motion strains only the adjacent elements.
    fn at_iterate(&mut self, cx: &Context, ws: &Workspace, _step: &Step, iterate: &Iterate) -> Result<(), Failure> {
        if self.path.is_some() {
            return Ok(());
        }
        if iterate.number == 1 {
            self.way.first.iter_mut().zip(&ws.trial.increments).for_each(|(first, increment)| *first = increment.q);
            self.way.passes_unstable = false;
        } else if iterate.new_matrix {
            self.way.passes_unstable |= ws.matrix.solver.negative_eigenvalues() > cx.system.multipliers();
        }
        Ok(())
    }

    /// Judges the equilibrium of a load step: refused is one on an unstable branch, where a shorter step may not end there, and one at
    /// buckling.
    fn before_end(&mut self, cx: &Context, ws: &mut Workspace, step: &Step) -> Result<(), Failure> {
        self.found = Found::default();
        if self.path.is_some() {
            return Ok(());
        }
        let turned_back = self.way.has_turned_back(cx, &ws.trial);
        let Workspace { matrix, forces, loads, trial, .. } = ws;
        let end = Configuration { nodes: &trial.nodes, history: &step.state.history, dt: step.dt(), previous: None };
        let start = Configuration { nodes: &step.state.nodes, dt: 0.0, ..end };
        let ends =
            Ends { configurations: [start, end], loads: [&loads.start, &loads.end], times: [step.state.time, step.to] };
        let analysis = &cx.model.analysis;
        let shortest = (SHORTEST * analysis.nominal_step()).max(2.0 * analysis.least_step);
        let cuts = step.dt() > shortest;
        self.look(cx, (matrix, forces), &ends, None, cuts);
        match self.found.instability.take_if(|found| found.certain && !found.already && !self.found.softens) {
            Some(_) if cuts => Err(Failure::UnstableStep),
            Some(instability) => Err(Failure::Buckles(instability)),
            None if turned_back && cuts && self.seen == 0 && self.criterion == Criterion::Eigenvalues => {
                Err(Failure::UnstableStep)
            }
            None => Ok(()),
        }
    }

    /// Records the equilibrium at the end of the step. Along a path of given arc length it is judged here, for nothing refuses it.
    fn after_step(&mut self, cx: &Context, ws: &mut Workspace, taken: &Taken) {
        let Taken { state, from, grows } = *taken;
        if from == 0.0 && cx.system.plane.is_some() && !cx.system.joints.is_empty() {
            ws.warnings.remark(Remark::Jointed);
        }
        if self.sideways.as_mut().is_some_and(|out| !out.check(cx, ws, state, from)) {
            self.sideways = None;
        }
        if self.path.is_some() {
            let Workspace { matrix, forces, loads, end, history, .. } = ws;
            let [start, end] = [(&end.nodes, 0.0), (&state.nodes, state.time - from)]
                .map(|(nodes, dt)| Configuration { nodes, history, dt, previous: None });
            let ends =
                Ends { configurations: [start, end], loads: [&loads.start, &loads.end], times: [from, state.time] };
            self.look(cx, (matrix, forces), &ends, Some(grows), false);
        }
        let Found { negative, instability, slips, .. } = std::mem::take(&mut self.found);
        self.seen = negative.unwrap_or(self.seen);
        if slips {
            ws.warnings.remark(Remark::Slipping);
        }
        if let Some(instability) = instability {
            ws.warnings.add(Warning::Unstable(instability));
            self.counts = false;
        }
    }

    fn keep(&mut self, snapshot: &mut Snapshot) {
        Keep::keep(self, snapshot);
    }
}

/// A path of given arc length on which something slips: its limit points change the sign of the determinant too.
struct NotJudged;

/// The first instability in a step after one was suspected; `appeared`, `on_path` as for [`locate_in_doubt`].
fn locate(
    cx: &Context,
    tangent: &mut Tangent,
    ends: &Ends,
    appeared: bool,
    on_path: bool,
) -> Result<Option<Instability>, NotJudged> {
    let in_doubt = tangent.criterion == Criterion::SymmetricPart || cx.system.rubs();
    match tangent.criterion {
        Criterion::Eigenvalues | Criterion::SymmetricPart if in_doubt => {
            locate_in_doubt(cx, tangent, ends, appeared, on_path)
        }
        _ => Ok(tangent.locate(cx, ends)),
    }
}

/// The first instability in a step whose tangent need not be symmetric, after the symmetric part has raised the suspicion. `appeared`: more of
/// its eigenvalues are negative than at the start of the step; `on_path`: the step is one of a path of given arc length.
fn locate_in_doubt(
    cx: &Context,
    tangent: &mut Tangent,
    ends: &Ends,
    appeared: bool,
    on_path: bool,
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
        if on_path {
            return Err(NotJudged);
        }
        if !appeared && tangent.unstable_modes_at_end(ends) == Some(0) {
            return Ok(None);
        }
    }
    Ok(tangent.locate(cx, ends))
}

/// A matrix stored in full, for one evaluation of the determinant of a model that is solved with the symmetric part; `None` if memory is
/// short.
fn whole_matrix(cx: &Context, now: &Configuration) -> Option<LinearSystem> {
    let built = cx.plan.build_unsymmetric(cx.system, &cx.system.partners(now.nodes));
    built.ok().map(|(solver, assembly)| LinearSystem::new(solver, assembly))
}
