//! From the matrices of elements and masses to the matrix of the system, through slots computed once. What belongs to a
//! node that rides on another is carried over here, DᵀKD (58): the one place where elements meet bodies.

use super::{Forces, Loading, System, follower_stiffness};
use crate::linear::Solver;
use crate::math::Mat6;
use crate::state::Node;
use rayon::prelude::*;

/// A direction of a node that is no unknown.
pub const NONE: u32 = u32::MAX;

/// Row of each direction of each node in the system, or [`NONE`].
pub type Rows = [[u32; 6]];

/// Elements whose matrices are filled side by side before they are added, one after the other, in deck order.
const CHUNK: usize = 256;
/// Below this many elements threads cost more than they save.
const PARALLEL: usize = 1024;

/// Where every matrix goes. Constant over a run.
pub struct Assembly {
    groups: Vec<GroupSlots>,
    /// Per node that has a matrix of its own: inertia, nodal damping, follower loads, arms of riders.
    nodes: Vec<NodeSlots>,
    masses: Vec<MassSlots>,
    /// Per node: for riders, the nodes they end up on.
    roots: Vec<Vec<usize>>,
    threads: usize,
    /// C(r) and other unsymmetric terms are kept.
    unsymmetric: bool,
    scratch: Scratch,
}

struct GroupSlots {
    size: usize,
    elements: Vec<ElementSlots>,
    /// Slots of all direct elements, `size²` each.
    slots: Vec<u32>,
}

enum ElementSlots {
    /// No node rides: the matrix goes in as it is. Offset into [`GroupSlots::slots`].
    Direct(usize),
    /// Its matrix is carried over to these nodes first; slots of their 6×6 blocks.
    Carried { targets: Vec<usize>, slots: Vec<u32> },
}

struct NodeSlots {
    node: usize,
    targets: Vec<usize>,
    slots: Vec<u32>,
}

struct MassSlots {
    targets: Vec<usize>,
    slots: Vec<u32>,
}

/// Written by every tangent.
struct Scratch {
    /// Element matrices of a chunk.
    local: Vec<f64>,
    /// Per node, row-major in the node's own directions.
    own: Vec<Mat6>,
    /// Per node: for each root, how its motion moves the node.
    carry: Vec<Vec<Mat6>>,
    carried: Vec<Mat6>,
}

/// What a tangent is formed of.
#[derive(Debug, Clone, Copy)]
pub struct Weights {
    /// K counts (not for the mass matrix alone).
    pub stiffness: bool,
    /// ∂q̇/∂q, ∂q̈/∂q.
    pub rate: f64,
    pub acceleration: f64,
}

/// Which nodes a node's motion depends on: itself, or the roots it rides on (and itself for directions of its own).
pub fn roots(system: &System, nodes: usize) -> Vec<Vec<usize>> {
    let mut roots: Vec<Vec<usize>> = (0..nodes).map(|n| vec![n]).collect();
    for rider in &system.attachments {
        let mut of = roots[rider.master].clone();
        if !rider.rigid {
            of.push(rider.node);
        }
        roots[rider.node] = of;
    }
    roots
}

/// Nodes that are coupled with one another, one list per element or nodal matrix; riders replaced by their roots.
pub fn cliques(system: &System, nodes: usize) -> Vec<Vec<usize>> {
    let roots = roots(system, nodes);
    let mut cliques: Vec<Vec<usize>> = Vec::new();
    let mut add = |nodes: &[usize]| {
        let mut all: Vec<usize> = nodes.iter().flat_map(|&n| roots[n].iter().copied()).collect();
        all.sort_unstable();
        all.dedup();
        cliques.push(all);
    };
    for group in &system.groups {
        (0..group.block.len()).for_each(|e| add(group.block.nodes(e)));
    }
    system.consistent_masses().iter().for_each(|m| add(&m.nodes));
    (0..nodes).filter(|&n| roots[n] != [n]).for_each(|n| add(&[n]));
    cliques
}

impl Assembly {
    pub fn new(system: &System, rows: &Rows, solver: &Solver, threads: usize) -> Self {
        let nodes = rows.len();
        let roots = roots(system, nodes);
        let spare = solver.spare() as u32;
        let slot = |i: u32, j: u32| match (i, j) {
            (NONE, _) | (_, NONE) => spare,
            (i, j) => solver.slot(i as usize, j as usize).map_or(spare, |s| s as u32),
        };
        let block_slots = |targets: &[usize]| {
            let mut slots = Vec::with_capacity(36 * targets.len() * targets.len());
            for &a in targets {
                for &b in targets {
                    for i in 0..6 {
                        slots.extend((0..6).map(|j| slot(rows[a][i], rows[b][j])));
                    }
                }
            }
            slots
        };
        let targets_of = |nodes: &[usize]| {
            let mut targets: Vec<usize> = Vec::new();
            for root in nodes.iter().flat_map(|&n| &roots[n]) {
                if !targets.contains(root) {
                    targets.push(*root);
                }
            }
            targets
        };
        let direct = |nodes: &[usize]| nodes.iter().all(|&n| roots[n] == [n]);

        let mut most = 0;
        let groups = system
            .groups
            .iter()
            .map(|group| {
                let (block, d) = (&group.block, group.block.dofs());
                let size = if block.is_empty() { 0 } else { d * block.nodes(0).len() };
                let mut slots = Vec::new();
                let elements = (0..block.len())
                    .map(|e| {
                        let nodes = block.nodes(e);
                        if direct(nodes) {
                            let at = slots.len();
                            for i in 0..size {
                                let row = rows[nodes[i / d]][i % d];
                                slots.extend((0..size).map(|j| slot(row, rows[nodes[j / d]][j % d])));
                            }
                            return ElementSlots::Direct(at);
                        }
                        let targets = targets_of(nodes);
                        most = most.max(targets.len());
                        ElementSlots::Carried { slots: block_slots(&targets), targets }
                    })
                    .collect();
                GroupSlots { size, elements, slots }
            })
            .collect::<Vec<_>>();

        let mut has_own = vec![false; nodes];
        system.inertias.iter().for_each(|i| has_own[i.node] = true);
        system.nodal_damping.iter().for_each(|d| has_own[d.node] = true);
        system.loads.iter().filter(|l| l.follower).for_each(|l| has_own[l.node] = true);
        system.attachments.iter().for_each(|r| has_own[r.master] = true);
        let own = (0..nodes).filter(|&n| has_own[n]).map(|node| {
            let targets = roots[node].clone();
            NodeSlots { node, slots: block_slots(&targets), targets }
        });
        let own = own.collect();
        let masses = system.consistent_masses().iter().map(|mass| {
            let targets = targets_of(&mass.nodes);
            MassSlots { slots: block_slots(&targets), targets }
        });
        let masses: Vec<MassSlots> = masses.collect();
        let most = masses.iter().map(|m| m.targets.len()).chain(roots.iter().map(Vec::len)).fold(most, usize::max);
        let local = groups.iter().map(|g| g.size * g.size * g.elements.len().min(CHUNK)).max().unwrap_or(0);
        Assembly {
            groups,
            nodes: own,
            masses,
            threads,
            unsymmetric: !solver.symmetric(),
            scratch: Scratch {
                local: vec![0.0; local],
                own: vec![Mat6::zeros(); nodes],
                carry: roots.iter().map(|r| vec![Mat6::identity(); r.len()]).collect(),
                carried: vec![Mat6::zeros(); most * most],
            },
            roots,
        }
    }

    /// Forms the matrix of the step in `solver`: K + rate·C + acceleration·M at the motion of `nodes`, where
    /// `forces` is the residual. A symmetric solver receives the symmetric part.
    pub fn tangent(
        &mut self,
        system: &System,
        nodes: &[Node],
        loading: &Loading,
        forces: &Forces,
        weights: Weights,
        solver: &mut Solver,
    ) {
        let unsymmetric = self.unsymmetric;
        // Both triangles meet in one slot of a symmetric matrix.
        let share = if unsymmetric { 1.0 } else { 0.5 };
        let values = solver.values();
        values.fill(0.0);
        self.carry_over(system, nodes);
        if weights.stiffness {
            self.add_elements(system, nodes, weights.rate, share, unsymmetric, values);
        }
        self.add_nodes(system, nodes, loading, forces, weights, share, values);
        let mut local = [Mat6::zeros(); 25];
        for (mass, slots) in system.consistent_masses().iter().zip(&self.masses) {
            let n = mass.nodes.len();
            let w = weights.acceleration + system.mass_damping * weights.rate;
            for (block, m) in local.iter_mut().zip(&mass.m) {
                *block = Mat6::zeros();
                block.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
                *block *= w * m;
            }
            let carried = &mut self.scratch.carried;
            carry(&mass.nodes, &slots.targets, &self.roots, &self.scratch.carry, |i, j| local[i * n + j], carried);
            add_blocks(carried, &slots.slots, slots.targets.len(), share, unsymmetric, values);
        }
    }

    /// How each rider moves with its roots, by the chain of arms.
    fn carry_over(&mut self, system: &System, nodes: &[Node]) {
        for rider in &system.attachments {
            let D = rider.D(nodes);
            for k in 0..self.roots[rider.master].len() {
                self.scratch.carry[rider.node][k] = D * self.scratch.carry[rider.master][k];
            }
            if !rider.rigid {
                let own = self.roots[rider.node].len() - 1;
                let free = rider.dofs.map(|taken| if taken { 0.0 } else { 1.0 });
                self.scratch.carry[rider.node][own] = Mat6::from_diagonal(&free.into());
            }
        }
    }

    fn add_elements(
        &mut self,
        system: &System,
        nodes: &[Node],
        rate: f64,
        share: f64,
        unsymmetric: bool,
        values: &mut [f64],
    ) {
        for (group, slots) in system.groups.iter().zip(&self.groups) {
            let (block, length) = (&group.block, slots.size * slots.size);
            for first in (0..block.len()).step_by(CHUNK) {
                let last = (first + CHUNK).min(block.len());
                let local = &mut self.scratch.local[..length * (last - first)];
                if self.threads > 1 && block.len() >= PARALLEL {
                    local
                        .par_chunks_mut(length)
                        .enumerate()
                        .for_each(|(k, K)| block.tangent(first + k, nodes, rate, K));
                } else {
                    local.chunks_mut(length).enumerate().for_each(|(k, K)| block.tangent(first + k, nodes, rate, K));
                }
                for (e, K) in (first..last).zip(local.chunks(length)) {
                    match &slots.elements[e] {
                        ElementSlots::Direct(at) => {
                            let slots = &slots.slots[*at..at + length];
                            if unsymmetric {
                                for (k, &slot) in K.iter().zip(slots) {
                                    values[slot as usize] += k;
                                }
                            } else {
                                add_symmetric(K, slots, group.block.dofs() * block.nodes(e).len(), values);
                            }
                        }
                        ElementSlots::Carried { targets, slots } => {
                            let (d, carried) = (block.dofs(), &mut self.scratch.carried);
                            let n = block.nodes(e).len();
                            let pair = |a: usize, b: usize| {
                                let mut k = Mat6::zeros();
                                for i in 0..d {
                                    for j in 0..d {
                                        k[(i, j)] = K[(d * a + i) * d * n + d * b + j];
                                    }
                                }
                                k
                            };
                            carry(block.nodes(e), targets, &self.roots, &self.scratch.carry, pair, carried);
                            add_blocks(carried, slots, targets.len(), share, unsymmetric, values);
                        }
                    }
                }
            }
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn add_nodes(
        &mut self,
        system: &System,
        nodes: &[Node],
        loading: &Loading,
        forces: &Forces,
        weights: Weights,
        share: f64,
        values: &mut [f64],
    ) {
        let (unsymmetric, own) = (self.unsymmetric, &mut self.scratch.own);
        for slots in &self.nodes {
            own[slots.node] = Mat6::zeros();
        }
        let of_motion = (weights.rate, weights.acceleration);
        for inertia in &system.inertias {
            let gyroscopic = unsymmetric && weights.stiffness;
            own[inertia.node] += inertia.tangent(&nodes[inertia.node], of_motion, system.mass_damping, gyroscopic);
        }
        for damping in &system.nodal_damping {
            for i in 0..3 {
                own[damping.node][(i, i)] += weights.rate * damping.translation;
                own[damping.node][(3 + i, 3 + i)] += weights.rate * damping.rotation;
            }
        }
        if weights.stiffness {
            for (load, factor) in system.loads.iter().zip(&loading.factors).filter(|(l, _)| l.follower) {
                let [f, m] = follower_stiffness(load, *factor, &nodes[load.node]);
                let mut force = own[load.node].fixed_view_mut::<3, 3>(0, 3);
                force += f;
                let mut moment = own[load.node].fixed_view_mut::<3, 3>(3, 3);
                moment += m;
            }
            for (rider, f) in system.attachments.iter().zip(&forces.on_riders) {
                let mut moment = own[rider.master].fixed_view_mut::<3, 3>(3, 3);
                moment -= rider.arm_stiffness(nodes, f);
            }
        }
        for slots in &self.nodes {
            if slots.targets == [slots.node] {
                add_blocks(&own[slots.node..=slots.node], &slots.slots, 1, share, unsymmetric, values);
                continue;
            }
            let carried = &mut self.scratch.carried;
            carry(&[slots.node], &slots.targets, &self.roots, &self.scratch.carry, |_, _| own[slots.node], carried);
            add_blocks(carried, &slots.slots, slots.targets.len(), share, unsymmetric, values);
        }
    }
}

/// K̂ = 𝒯ᵀ K 𝒯 over the targets, with `pair(a, b)` the element's 6×6 block of its nodes a and b.
fn carry(
    nodes: &[usize],
    targets: &[usize],
    roots: &[Vec<usize>],
    maps: &[Vec<Mat6>],
    pair: impl Fn(usize, usize) -> Mat6,
    carried: &mut [Mat6],
) {
    let m = targets.len();
    carried[..m * m].fill(Mat6::zeros());
    let place = |root: usize| targets.iter().position(|&t| t == root).unwrap_or(0);
    for (a, &node_a) in nodes.iter().enumerate() {
        for (b, &node_b) in nodes.iter().enumerate() {
            let k = pair(a, b);
            for (&root_a, T_a) in roots[node_a].iter().zip(&maps[node_a]) {
                let left = T_a.tr_mul(&k);
                for (&root_b, T_b) in roots[node_b].iter().zip(&maps[node_b]) {
                    carried[place(root_a) * m + place(root_b)] += left * T_b;
                }
            }
        }
    }
}

fn add_blocks(blocks: &[Mat6], slots: &[u32], m: usize, share: f64, unsymmetric: bool, values: &mut [f64]) {
    for (pair, slots) in slots.chunks(36).enumerate() {
        let (a, b) = (pair / m, pair % m);
        for i in 0..6 {
            for j in 0..6 {
                let whole = unsymmetric || (a == b && i == j);
                values[slots[6 * i + j] as usize] += if whole { 1.0 } else { share } * blocks[pair][(i, j)];
            }
        }
    }
}

fn add_symmetric(K: &[f64], slots: &[u32], size: usize, values: &mut [f64]) {
    for i in 0..size {
        values[slots[i * size + i] as usize] += K[i * size + i];
        for j in 0..i {
            values[slots[i * size + j] as usize] += 0.5 * (K[i * size + j] + K[j * size + i]);
        }
    }
}
