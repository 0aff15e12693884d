//! Linear buckling: factors λ of the loads at which K + λK' is singular. K is the stiffness of the state without these loads.
//!
//! K' is the rate of the tangent with the loads: K(σ) of the linear response, follower loads and joint forces. Differences between the
//! stresses of small loads and their opposite give K', in the geometry without loads. The deflection before buckling is neglected. For
//! slender parts the square of a rotation times the axial stiffness matters as much as its product with other rotations, and only their sum
//! is small.

use super::fault::ModesFault;
use super::linearized::Linearized;
use super::mode::ModeKind;
use super::mode::Modes;
use super::pencil::{Pencil, weights};
use super::rest::multipliers_at_rest;
use super::shape::Shapes;
use crate::system::assembly::Assembly;
use crate::system::{Group, Loading};
use crate::tolerances::buckling::{CLUSTER, FARTHEST, MODERATE, SEARCHES, SMALL, STEP, TOLERANCE, WIDTH};
use base::math::rotation::RotationUpdate;
use base::math::{Vec6, angular, linear};
use base::names::{joined, short};
use linear::eigen::{Converged, EigenPair, Lanczos, SymmetricOperator};
use linear::{Solver, Sparse};
use mechanics::state::{Configuration, Increment, Node};
use model::{AnalysisKind, Restraint};
use std::collections::HashSet;

/// Weights of the differences of sixth order between the states at 1, 2 and 3 steps and their opposites.
const DIFFERENCES: [f64; 3] = [45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0];

/// The operator −K⁻¹ K' in the metric of K; its eigenvalues are 1/λ.
struct Buckling<'p, 'a> {
    pencil: &'p mut Pencil<'a>,
    K: &'p Sparse,
    rate: &'p Sparse,
}

impl SymmetricOperator for Buckling<'_, '_> {
    fn dimension(&self) -> usize {
        self.K.rows()
    }

    fn apply(&mut self, x: &[&[f64]]) -> Vec<Vec<f64>> {
        let mut images = self.rate.products(x);
        images.iter_mut().flatten().for_each(|y| *y = -*y);
        self.pencil.solve_all(&mut images);
        images
    }

    fn metric(&mut self, x: &[f64], y: &mut [f64]) {
        self.K.multiply(x, y);
    }

    fn may_move(&mut self, x: &[f64]) -> bool {
        self.pencil.may_move(x)
    }

    fn is_stopped(&self) -> bool {
        self.pencil.at.is_stopped()
    }
}

/// Finds the lowest factors of the loads.
///
/// # Errors
/// The reason why there are none, or why some are missing.
pub fn buckling_modes(at: &Linearized, linear: (&mut Solver, &mut Assembly)) -> Result<Modes, ModesFault> {
    let is_stage = at.model.analysis.stage.is_some();
    let heats = factored_heats(at);
    let moved = at.model.constraints.restraints.iter().filter(|restraint| restraint.motion.is_some());
    if !is_stage && moved.count() > heats.len() {
        return Err(ModesFault::MovedSupport);
    }
    let mut unheated = at.state.clone();
    heats.iter().for_each(|&(number, _)| unheated.nodes[number] = Node::at_rest(at.model.nodes[number].x));
    let at = &Linearized { state: &unheated, ..*at };
    let wanted = match at.model.analysis.kind {
        AnalysisKind::Buckling(count) => count,
        _ => 1,
    };
    // The equilibrium of a stage's state is checked together with other modes.
    let rests = is_stage || multipliers_at_rest(at, (&mut *linear.0, &mut *linear.1)).is_some();
    let mut pencil = Pencil::new(*at, linear);
    let K = pencil.matrix(weights(0.0, 0.0));
    match pencil.factor(0.0) {
        Ok(0) => {}
        Ok(_) => return Err(ModesFault::UnstableUnloaded),
        Err(row) => return Err(pencil.singular(row)),
    }
    let response = Response::to_factored(&mut pencil, &heats);
    if response.is_nothing() {
        return Err(ModesFault::NoLoads);
    }
    let lowest = {
        let first = response.rate(SMALL / response.size(&pencil), &mut pencil);
        factors(&mut pencil, (&K, &first), 1)?
    };
    let Some(lowest) = lowest.first().map(|(lowest, _)| lowest.abs()) else { return Err(ModesFault::NoBuckling) };
    let rate = response.rate((STEP * lowest).min(STEP / response.size(&pencil)), &mut pencil);
    let found = factors(&mut pencil, (&K, &rate), wanted)?;
    let Some((lowest, _)) = found.first() else { return Err(ModesFault::NoBuckling) };
    let shapes = Shapes::new(&pencil);
    let list = found.iter().map(|(factor, vector)| shapes.buckling(&pencil, *factor, vector)).collect();
    let mut warnings = warnings_of(at, rests, (&found, wanted));
    warnings.extend(response.slackened(lowest.abs(), &pencil));
    let (factorizations, solves) = (pencil.factorizations, pencil.solves);
    Ok(Modes {
        kind: ModeKind::Buckling,
        list,
        masses: shapes.masses,
        unstable: 0,
        factorizations,
        solves,
        warnings,
        ..Modes::default()
    })
}

/// The nodes that stand for strains of temperature with a factor, and their displacements: those of all temperatures, or in a stage of those
/// that begin there.
fn factored_heats(at: &Linearized) -> Vec<(usize, f64)> {
    let heats = at.model.parts.iter().filter_map(|part| part.heat());
    let numbers: HashSet<usize> = heats.flat_map(|heat| heat.numbers).flatten().collect();
    let stage = at.model.analysis.stage.as_ref();
    let moved = at.model.constraints.restraints.iter().filter(|restraint| numbers.contains(&restraint.node));
    let begins = |amplitude: usize| stage.is_none_or(|stage| stage.own_amplitude == amplitude);
    let motion =
        |held: &Restraint| held.motion.as_ref().filter(|motion| begins(motion.amplitude)).map(|motion| motion.scale);
    moved.filter_map(|held| Some((held.node, motion(held)?))).collect()
}

/// Warnings about the factors found and wanted, in words; the scene may not rest without loads.
fn warnings_of(at: &Linearized, rests: bool, (found, wanted): (&[Factor], usize)) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(part) = at.model.parts.iter().find(|part| part.kind().is_floating()) {
        warnings.push(format!(
            "superelement `{}` keeps its stiffness under compression: buckling inside of it is not found. Replace it by beams, by shells or by several superelements",
            part.name()
        ));
    }
    if let Some(of) = at.model.reductions.iter().find(|of| of.is_linear()) {
        warnings.push(format!(
            "{} keeps its stiffness under compression because it is reduced: buckling inside of it is not found. Leave `reduced` out, or let it have its geometric stiffness: 100 unknowns of interface and modes at most, and no `geometric_stiffness = false`",
            of.title
        ));
    }
    if !rests {
        warnings.push(
            "without the loads the scene is not in equilibrium, because parts have prestress. Factors are those of the given geometry with this \
             prestress. Let a static stage find the equilibrium first (`[[stages]]`)"
                .to_owned(),
        );
    }
    if let Some((nearest, _)) = found.first().filter(|(factor, _)| *factor < 0.0) {
        warnings.push(format!(
            "nothing within reach buckles under these loads. The factors are negative: the reversed loads buckle the structure at {} times their \
             value. Reverse the loads if they have the wrong sign",
            short(-nearest)
        ));
    } else if found.len() < wanted {
        warnings.push(format!(
            "{} factors were found, and no more within reach: further ones are much larger, or their modes stiffen. Give `modes` = {}",
            found.len(),
            found.len()
        ));
    }
    if !at.has_potential() {
        warnings.push(
            "follower loads, moments about axes fixed in space, and links with unsymmetric matrices have no potential: factors use the symmetric part of their stiffness. They miss \
             flutter; look for it with `kind = \"modal\"` and `damped = true` under these loads"
                .to_owned(),
        );
    }
    warnings
}

/// A factor of the loads with its vector.
type Factor = (f64, Vec<f64>);

/// The lowest positive factors, ascending; where there are none within reach the negative ones, the nearest to zero first. K is
/// factorised when they are found.
fn factors(pencil: &mut Pencil, (K, rate): (&Sparse, &Sparse), wanted: usize) -> Result<Vec<Factor>, ModesFault> {
    let threads = pencil.at.plan.threads > 1;
    pencil.factor(0.0).map_err(|row| pencil.singular(row))?;
    let mut operator = Buckling { pencil: &mut *pencil, K, rate };
    let mut lanczos = Lanczos::new(&mut operator, WIDTH, threads);
    let mut goal = wanted;
    let mut searches = 0;
    while searches < SEARCHES {
        let mut operator = Buckling { pencil: &mut *pencil, K, rate };
        let limit = lanczos.applications + 60 * goal + 600;
        let Converged { thetas, next } =
            lanczos.converge(&mut operator, goal, TOLERANCE, limit).ok_or_else(|| pencil.not_converged(goal))?;
        let whole = thetas.len() < goal || next.is_none();
        let reached = thetas.last().map_or(0.0, |theta| 1.0 / theta.abs());
        let least = least(thetas.first());
        let found = thetas.iter().filter(|theta| **theta > least).count();
        // Factors of reversed loads count too.
        if found < wanted && !whole && goal < 4 * wanted + 24 {
            goal += (wanted - found).max(goal / 2);
            continue;
        }
        let next = next.map_or(f64::INFINITY, |theta| 1.0 / theta.abs());
        if whole {
            return Ok(lowest(lanczos.into_pairs(), wanted));
        }
        if next - reached <= 1e-4 * reached {
            searches += usize::from(goal > 4 * wanted + CLUSTER);
            goal += 1;
            continue;
        }
        // The space is the largest thing beside the factor.
        lanczos.narrow();
        let there = pencil.factor_along(rate, reached + 0.1 * (next - reached));
        pencil.factor(0.0).map_err(|row| pencil.singular(row))?;
        let missing = there.unwrap_or(found).saturating_sub(found);
        if missing == 0 {
            return Ok(lowest(lanczos.into_pairs(), wanted));
        }
        searches += 1;
        goal += missing;
        let mut operator = Buckling { pencil: &mut *pencil, K, rate };
        lanczos.start(&mut operator, missing);
    }
    Err(ModesFault::Missed { found: wanted, there: goal })
}

/// The size of 1/λ below which it is rounding of the largest.
fn least(largest: Option<&f64>) -> f64 {
    FARTHEST * largest.map_or(0.0, |theta| theta.abs())
}

/// The lowest positive factors of some pairs, or where there are none the negative ones, the nearest to zero first.
fn lowest(pairs: Vec<EigenPair>, wanted: usize) -> Vec<Factor> {
    let least = least(pairs.first().map(|pair| &pair.theta));
    let mut factors: Vec<Factor> =
        pairs.into_iter().filter(|pair| pair.theta.abs() > least).map(|pair| (1.0 / pair.theta, pair.vector)).collect();
    factors.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let (mut found, reversed): (Vec<_>, Vec<_>) = factors.into_iter().partition(|(factor, _)| *factor > 0.0);
    if found.is_empty() {
        found = reversed;
    }
    found.truncate(wanted);
    found
}

/// The linear response to unit loads.
struct Response {
    /// Small motions of all nodes.
    motions: Vec<Vec6>,
    multipliers: Vec<f64>,
}

impl Response {
    /// The response to the loads and temperatures that have the factor; K is factorised. Forces are linear in temperature where nothing moves.
    fn to_factored(pencil: &mut Pencil, heats: &[(usize, f64)]) -> Response {
        let mut heated = pencil.nodes.clone();
        for &(number, displacement) in heats {
            let increment = Increment { q: Vec6::ith(0, displacement), ..Increment::ZERO };
            heated[number].advance(&pencil.nodes[number], &increment, RotationUpdate::Exponential);
        }
        let forces = |pencil: &mut Pencil, loading: &Loading, nodes: &[Node]| -> Vec<f64> {
            let Pencil { at, forces, .. } = pencil;
            let now = Configuration { nodes, history: &at.state.history, dt: 0.0, previous: None };
            at.system.residual(&now, loading, forces);
            at.plan.dofs.nodal_dofs().iter().map(|&(node, dof)| forces.on_nodes[node][dof]).collect()
        };
        let (base, with) = (pencil.at.loading, pencil.at.loading.plus(1.0, pencil.at.factored));
        let nodes = pencil.nodes.clone();
        let (before, mut f) = (forces(pencil, base, &nodes), forces(pencil, &with, &heated));
        f.iter_mut().zip(before).for_each(|(f, before)| *f -= before);
        let multipliers = pencil.respond(&mut f);
        let mut motions = pencil.at.motions(&pencil.nodes, &f);
        heats.iter().for_each(|&(number, displacement)| motions[number][0] = displacement);
        Response { motions, multipliers }
    }

    /// True where the loads move nothing and load no joint.
    fn is_nothing(&self) -> bool {
        self.motions.iter().all(|motion| *motion == Vec6::zeros()) && self.multipliers.iter().all(|value| *value == 0.0)
    }

    /// The largest motion, displacements relative to the size of the scene.
    fn size(&self, pencil: &Pencil) -> f64 {
        let origin = pencil.nodes.first().map(|node| node.x).unwrap_or_default();
        let length = pencil.nodes.iter().map(|node| (node.x - origin).norm()).fold(f64::MIN_POSITIVE, f64::max);
        let size = |motion: &Vec6| (linear(motion).norm() / length).max(angular(motion).norm());
        self.motions.iter().map(size).fold(f64::MIN_POSITIVE, f64::max)
    }

    /// The rate of the tangent with the load factor, by differences at multiples of the factors ±ε.
    fn rate(&self, epsilon: f64, pencil: &mut Pencil) -> Sparse {
        let mut sum = Vec::new();
        for (steps, weight) in [1.0, 2.0, 3.0].into_iter().zip(DIFFERENCES) {
            for sign in [1.0, -1.0] {
                let factor = sign * steps * epsilon;
                let loads = pencil.at.loading.plus(factor, pencil.at.factored);
                let nodes = self.moved(factor, pencil);
                let base = pencil.at.state.multipliers.iter().zip(&self.multipliers);
                let multipliers: Vec<f64> = base.map(|(m, rate)| m + rate * factor).collect();
                pencil.add_stressed(sign * weight / epsilon, (&nodes, &loads, &multipliers), &mut sum);
            }
        }
        pencil.summed(&sum)
    }

    /// Cables slackened or tightened by the loads up to the lowest factor, in words.
    fn slackened(&self, lowest: f64, pencil: &Pencil) -> Vec<String> {
        let factor = lowest.min(MODERATE / self.size(pencil));
        let moved = self.moved(factor, pencil);
        let at = |nodes: &[Node], group: &Group, e: usize| {
            let now = Configuration { nodes, history: &pencil.at.state.history, dt: 0.0, previous: None };
            group.block.is_inactive(e, &group.configuration(&now))
        };
        let mut names = [Vec::new(), Vec::new()];
        for group in pencil.at.system.groups.iter().filter(|group| !group.kind.is_unilateral()) {
            for e in 0..group.block.len() {
                let states = [at(&pencil.nodes, group, e), at(&moved, group, e)];
                let name = format!("`{}`", group.part_of(e, pencil.at.model).name());
                if states[0] != states[1] && !names[usize::from(states[0])].contains(&name) {
                    names[usize::from(states[0])].push(name);
                }
            }
        }
        let [slack, taut] = names.map(|names| joined(&names.iter().map(String::as_str).collect::<Vec<_>>()));
        let mut said = Vec::new();
        if !slack.is_empty() {
            said.push(format!(
                "the loads slacken {slack}, whose stiffness still counts, so factors are too high. Remove these parts, pretension cables \
                 (`free_length`), or find modes of the loaded state (`kind = \"modal\"`)"
            ));
        }
        if !taut.is_empty() {
            said.push(format!(
                "{taut} carry no force without the loads, but do under them: their stiffness is omitted, and factors may be too low. Pretension cables \
                 (`free_length`), or find modes of the loaded state (`kind = \"modal\"`)"
            ));
        }
        said
    }

    /// The nodes at a load factor.
    fn moved(&self, factor: f64, pencil: &Pencil) -> Vec<Node> {
        let start = &pencil.nodes;
        let mut nodes = start.clone();
        let of = |motion: &Vec6| Increment { q: motion * factor, ..Increment::ZERO };
        let mut increments: Vec<Increment> = self.motions.iter().map(of).collect();
        for ((node, start), increment) in nodes.iter_mut().zip(start).zip(&increments) {
            node.advance(start, increment, RotationUpdate::Exponential);
        }
        for dependent in &pencil.at.system.rigid_links {
            dependent.move_with_master(&mut nodes, &mut increments, &start[dependent.node]);
        }
        nodes
    }
}
