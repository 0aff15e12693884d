//! Mechanisms: motions that nothing resists. Rounding may change a zero pivot to any value, so the elements decide instead of the matrix: a
//! mechanism is a motion that strains no element.

use crate::guards::mode::Mode;
use crate::strategy::stabilization::HeldByForces;
use crate::system::{DofMap, Group, System, TangentWeights, open_gap};
use crate::tolerances::mechanism::{ENERGY, FIRST_ITERATIONS, FORCE, MOVING};
use crate::tolerances::mode::ITERATIONS;
use base::math::{Vec6, angular, linear};
use base::names::short;
use linear::Solver;
use mechanics::elements::Moduli;
use mechanics::state::Configuration;
use model::Model;

/// The node and degree of freedom with the largest motion in a mechanism; `None` if elements resist every motion. `solver` holds the
/// factorized matrix of the configuration `now`. Forces count where they are given as `held`.
pub fn find(
    system: &System,
    dofs: &DofMap,
    solver: &mut Solver,
    now: &Configuration,
    (weights, held): (TangentWeights, Option<&HeldByForces>),
    length: f64,
) -> Option<(usize, usize)> {
    let is_strained = |mode: &Mode| {
        let mut motions = mode.motions(dofs);
        system.project(now.nodes, &mut motions);
        opens_joints(system, now, &motions, length) || strains_elements(system, now, weights, &motions, length)
    };
    let mode = Mode::scattered(dofs).softened(solver, dofs, length, FIRST_ITERATIONS)?;
    if is_strained(&mode) {
        return None;
    }
    // Forces hold and push parts with stiffnesses of one size, so the mode has to be pure before they decide.
    let mode = mode.softened(solver, dofs, length, ITERATIONS - FIRST_ITERATIONS)?;
    let is_resisted = is_strained(&mode) || held.is_some_and(|held| held.resist(&mode));
    if is_resisted { None } else { mode.largest(dofs) }
}

/// True if a joint resists the motion because the motion violates its constraint equations.
fn opens_joints(system: &System, now: &Configuration, motions: &[Vec6], length: f64) -> bool {
    let size = |motion: &Vec6| linear(motion).amax().max(length * angular(motion).amax());
    system.joints.iter().any(|joint| {
        let largest = joint.ends().map(|node| size(&motions[node])).fold(0.0, f64::max);
        joint.equations.iter().enumerate().any(|(k, equation)| {
            let gap = joint.opening(k, now.nodes, motions);
            let lever = if equation.is_rotational() { length } else { 1.0 };
            gap.abs() * lever > MOVING * largest.max(MOVING)
        })
    })
}

/// True where elements are strained, by their energy or by the forces on one of them.
pub fn strains_elements(
    system: &System,
    now: &Configuration,
    weights: TangentWeights,
    motions: &[Vec6],
    length: f64,
) -> bool {
    let mut strains = Strains { motions, length, energy: 0.0, terms: 0.0, largest: 0.0 };
    let mut K = Vec::new();
    for group in &system.groups {
        let (block, d, now) = (&group.block, group.block.dofs(), &group.configuration(now));
        let is_unilateral = group.kind.is_unilateral();
        each_pair(group, now, weights.rate, |_, nodes, K| strains.add(K, nodes, d, is_unilateral));
        for e in (0..block.len()).filter(|&e| !(is_unilateral && block.is_inactive(e, now))) {
            let nodes = block.nodes(e);
            K.clear();
            K.resize((d * nodes.len()).pow(2), 0.0);
            block.tangent(e, now, weights.rate, weights.moduli, &mut K);
            strains.add(&K, nodes, d, is_unilateral);
            // One element that resists suffices.
            if strains.largest > FORCE {
                return true;
            }
        }
    }
    strains.energy.abs() > ENERGY * strains.terms || strains.largest > FORCE
}

/// The energy and the forces of elements under a motion.
struct Strains<'a> {
    motions: &'a [Vec6],
    length: f64,
    /// Twice the energy of all elements, and the sum of the magnitudes of its terms.
    energy: f64,
    terms: f64,
    /// The largest force, of the terms that it is summed from.
    largest: f64,
}

impl Strains<'_> {
    /// Adds the energy and forces of an element with the tangent `K`, row-major with `d` degrees of freedom for each of its nodes.
    fn add(&mut self, K: &[f64], nodes: &[usize], d: usize, is_unilateral: bool) {
        // Translation as a whole strains no element, unless one of its nodes is a number and no place; without it motions have the digits of
        // strains.
        let mut common = if is_unilateral { Vec6::zeros() } else { self.motions[nodes[0]] };
        for direction in (0..3).filter(|&direction| !is_free(K, d, direction)) {
            common[direction] = 0.0;
        }
        let whole = |j: usize| self.motions[nodes[j / d]][j % d];
        let own = |j: usize| if j % d < 3 { whole(j) - common[j % d] } else { whole(j) };
        let floor = |j: usize| if j % d < 3 { MOVING } else { MOVING / self.length };
        for (i, row) in K.chunks(d * nodes.len()).enumerate() {
            let sum = |of: &dyn Fn(usize) -> f64| row.iter().enumerate().map(|(j, k)| k * of(j)).sum::<f64>();
            let size = |of: &dyn Fn(usize) -> f64| row.iter().enumerate().map(|(j, k)| k.abs() * of(j)).sum::<f64>();
            let force = sum(&own);
            let size_of_force = size(&|j| own(j).abs().max(floor(j)));
            if size_of_force > 0.0 {
                self.largest = self.largest.max(force.abs() / size_of_force);
            }
            self.energy += own(i) * force;
            self.terms += whole(i).abs() * size(&|j| whole(j).abs());
        }
    }
}

/// True if an equal displacement of all nodes in this direction changes no force of an element. `K` is its tangent, row-major with `d`
/// degrees of freedom for each node.
fn is_free(K: &[f64], d: usize, direction: usize) -> bool {
    let width = K.len().isqrt();
    K.chunks(width.max(1)).all(|row| {
        let along = || row.iter().skip(direction).step_by(d);
        along().sum::<f64>().abs() <= FORCE * along().map(|k| k.abs()).sum::<f64>()
    })
}

/// Calls `act` with the element, the nodes and the tangent of each contact pair of a group with changing pairs.
fn each_pair(group: &Group, now: &Configuration, rate: f64, mut act: impl FnMut(usize, &[usize], &[f64])) {
    let Some(wandering) = group.wandering() else { return };
    let partners = wandering.partners(now.nodes);
    let mut room = vec![0.0; (6 * partners.most_nodes()).pow(2)];
    wandering.pair_tangents(&partners, now, rate, &mut room, &mut |place, K| {
        act(partners.pairs[place][0], partners.nodes(place), K);
    });
}

/// The number of elements that currently exert no force: open or slack links and tension-only bars, and contacts with a gap. Groups with
/// changing contact pairs are omitted: their elements have no separate tangent.
pub fn open_elements(system: &System, now: &Configuration) -> usize {
    let open = |group: &Group| {
        let now = &group.configuration(now);
        (0..group.block.len()).filter(|&e| group.block.is_inactive(e, now)).count()
    };
    system.groups.iter().filter(|group| group.wandering().is_none()).map(open).sum()
}

/// The name, in quotes, of a part that is open or slack `now` and was not in `before`, if given.
pub fn opened_part(
    model: &Model,
    system: &System,
    before: Option<&Configuration>,
    now: &Configuration,
) -> Option<String> {
    system.groups.iter().find_map(|group| {
        let block = &group.block;
        let (before, now) = (before.map(|before| group.configuration(before)), group.configuration(now));
        let was_open = |e: usize| before.as_ref().is_some_and(|before| block.is_inactive(e, before));
        let e = (0..block.len()).find(|&e| block.is_inactive(e, &now) && !was_open(e))?;
        Some(format!("`{}`", group.part_of(e, model).name()))
    })
}

/// The name, in quotes, of an open or slack part at a node or at its dependent nodes, with the gap of a contact. Such a part currently
/// exerts no force: an open link, a slack rope or a contact with a gap.
pub fn open_part(model: &Model, system: &System, now: &Configuration, node: usize) -> Option<String> {
    let follows = |of: usize| system.rigid_links.iter().any(|link| link.node == of && link.master == node);
    let mut K = Vec::new();
    system.groups.iter().find_map(|group| {
        let (block, now) = (&group.block, &group.configuration(now));
        let mut touching = Vec::new();
        each_pair(group, now, 0.0, |e, _, _| touching.push(e));
        let mut is_open = |&e: &usize| {
            let nodes = block.nodes(e);
            // The unlisted part that counts the turns of a joint never exerts a force.
            if !group.part_of(e, model).is_listed() || !nodes.iter().any(|&of| of == node || follows(of)) {
                return false;
            }
            K.clear();
            K.resize((block.dofs() * nodes.len()).pow(2), 0.0);
            if touching.contains(&e) {
                return false;
            }
            if !block.is_inactive(e, now) {
                block.tangent(e, now, 0.0, Moduli::Algorithmic, &mut K);
            }
            K.iter().all(|&k| k == 0.0)
        };
        let e = (0..block.len()).find(|e| is_open(e))?;
        let gap = open_gap(group, now.history).map_or_else(String::new, |gap| format!(" (its gap is {})", short(gap)));
        Some(format!("`{}`{gap}", group.part_of(e, model).name()))
    })
}
