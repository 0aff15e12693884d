//! Assembly of the matrices of elements, nodes and joints into the matrix of the system, through slots computed once.
//! Matrices at dependent nodes are projected onto independent nodes here, DᵀKD (58): the one place where elements meet
//! rigid bodies.

use super::block_scatter::BlockScatter;
use super::dofs::DofMap;
use super::equations::{Forces, System};
use super::group::Group;
use super::joints::{self, Diagonal};
use super::loads::{Loading, follower_stiffness};
use crate::elements::{ElementBlock, Moduli};
use crate::linear::Solver;
use crate::math::{Mat3, Mat6};
use crate::state::{Configuration, Node};
use rayon::prelude::*;

/// Number of elements whose matrices are formed side by side before they are added, one after the other, in deck order.
const CHUNK: usize = 256;

/// The destination of every matrix. All but `scratch` is constant over a run.
pub struct Assembly {
    /// Destinations of the elements, by group.
    groups: Vec<Vec<Destination>>,
    /// Destinations of the matrices of nodes: inertia, nodal damping, follower loads, arms of dependent nodes.
    nodes: Vec<(usize, Destination)>,
    masses: Vec<Destination>,
    /// Destinations of the faces under follower pressure, in their order.
    faces: Vec<Destination>,
    joints: Vec<Destination>,
    diagonals: Vec<Diagonal>,
    scatter: Scatter,
    blocks: BlockScatter,
    /// For each node the independent nodes that it moves with: itself, or its masters in the end.
    independent_nodes: Vec<Vec<usize>>,
    threads: bool,
    /// True where the gyroscopic matrix C(r) (37) is part of the tangent; it is in the residual always.
    gyroscopic: bool,
    scratch: Scratch,
}

/// The destination of a local matrix.
struct Destination {
    /// The independent nodes that it is projected onto first; empty where no node is dependent.
    targets: Vec<usize>,
    entries: Entries,
    /// A range of [`BlockScatter`] in place of entries, where the matrix is scattered by blocks.
    blocks: [u32; 2],
}

/// The entries of a local matrix that reach the system's: ranges of [`Scatter`].
#[derive(Clone, Copy)]
struct Entries {
    from: usize,
    /// Start of the entries that meet their transposes in one slot of a symmetric matrix: each adds half.
    halves: usize,
    to: usize,
}

/// Pairs of a position in the local matrix and a slot of the system's.
struct Scatter(Vec<[u32; 2]>);

impl Scatter {
    /// Adds the slots of a local matrix; `entry(k)` gives the row and the column of its k-th number, where both are
    /// unknowns.
    fn push(&mut self, solver: &Solver, length: usize, entry: impl Fn(usize) -> Option<(usize, usize)>) -> Entries {
        let from = self.0.len();
        let mut add = |half: bool| {
            for k in 0..length {
                let Some((i, j)) = entry(k) else { continue };
                if (solver.is_symmetric() && i != j) != half {
                    continue;
                }
                if let Some(slot) = solver.slot(i, j) {
                    self.0.push([k as u32, slot as u32]);
                }
            }
            self.0.len()
        };
        let halves = add(false);
        let to = add(true);
        Entries { from, halves, to }
    }

    #[inline]
    fn add(&self, local: &[f64], entries: Entries, values: &mut [f64]) {
        for &[k, slot] in &self.0[entries.from..entries.halves] {
            values[slot as usize] += local[k as usize];
        }
        for &[k, slot] in &self.0[entries.halves..entries.to] {
            values[slot as usize] += 0.5 * local[k as usize];
        }
    }
}

/// Finds the destinations of local matrices, one after the other.
struct Destinations<'a> {
    dofs: &'a DofMap,
    solver: &'a Solver,
    independent_nodes: &'a [Vec<usize>],
    scatter: Scatter,
    blocks: BlockScatter,
    /// Largest number of nodes that a matrix is projected onto.
    most: usize,
}

impl<'a> Destinations<'a> {
    fn new(dofs: &'a DofMap, solver: &'a Solver, independent_nodes: &'a [Vec<usize>]) -> Self {
        let most = independent_nodes.iter().map(Vec::len).max().unwrap_or(0);
        Destinations {
            dofs,
            solver,
            independent_nodes,
            scatter: Scatter(Vec::new()),
            blocks: BlockScatter::new(),
            most,
        }
    }

    /// The destination of a matrix over 6×6 blocks of independent nodes, each column-major; `keep` says which entries
    /// of a block count.
    fn projected(&mut self, of: &[usize], keep: &dyn Fn(usize, usize) -> bool) -> Destination {
        let mut targets: Vec<usize> = Vec::new();
        for independent in of.iter().flat_map(|&n| &self.independent_nodes[n]) {
            if !targets.contains(independent) {
                targets.push(*independent);
            }
        }
        let (m, dofs) = (targets.len(), self.dofs);
        self.most = self.most.max(m);
        let entry = |k: usize| {
            let (block, i, j) = (k / 36, k % 6, k / 6 % 6);
            let (row, column) = (targets[block / m], targets[block % m]);
            if keep(i, j) { dofs.row(row, i).zip(dofs.row(column, j)) } else { None }
        };
        let entries = self.scatter.push(self.solver, 36 * m * m, entry);
        Destination { targets, entries, blocks: [0; 2] }
    }

    /// The destination of an element's matrix with `d` degrees of freedom a node, row-major.
    fn local(&mut self, of: &[usize], d: usize) -> Destination {
        if of.iter().any(|&n| self.independent_nodes[n] != [n]) {
            return self.projected(of, &|_, _| true);
        }
        let dofs = self.dofs;
        let firsts = || of.iter().map(|&n| dofs.of(n).first_of_six()).collect::<Option<Vec<usize>>>();
        if let (6, Some(rows)) = (d, firsts()) {
            let from = self.blocks.len() as u32;
            if self.blocks.push(self.solver, &rows) {
                let none = Entries { from: 0, halves: 0, to: 0 };
                return Destination { targets: Vec::new(), entries: none, blocks: [from, self.blocks.len() as u32] };
            }
        }
        let size = d * of.len();
        let row = |i: usize| dofs.row(of[i / d], i % d);
        let entries = self.scatter.push(self.solver, size * size, |k| row(k / size).zip(row(k % size)));
        Destination { targets: Vec::new(), entries, blocks: [0; 2] }
    }

    /// The destinations of the matrices of nodes, which inertia, nodal damping, follower loads and arms have. Inertia
    /// and damping couple neither translations with one another nor with rotations; arms and followers do.
    fn nodal(&mut self, system: &System) -> Vec<(usize, Destination)> {
        let nodes = self.independent_nodes.len();
        let (mut has_own, mut is_full) = (vec![false; nodes], vec![false; nodes]);
        system.inertias.iter().for_each(|i| has_own[i.node] = true);
        system.nodal_damping.iter().for_each(|d| has_own[d.node] = true);
        system.loads.iter().filter(|l| l.follower).for_each(|l| is_full[l.node] = true);
        system.rigid_links.iter().for_each(|r| is_full[r.master] = true);
        let apart = |i: usize, j: usize| i == j || (i > 2 && j > 2);
        let with_own = (0..nodes).filter(|&n| has_own[n] || is_full[n]);
        let destination = |n: usize| {
            let full = is_full[n] || self.independent_nodes[n] != [n];
            let mut destination = self.projected(&[n], &|i, j| full || apart(i, j));
            if self.independent_nodes[n] == [n] {
                destination.targets.clear();
            }
            (n, destination)
        };
        with_own.map(destination).collect()
    }
}

/// Buffers that every tangent writes.
struct Scratch {
    /// Matrices of the elements of a chunk.
    local: Vec<f64>,
    own: Vec<Mat6>,
    /// For each node and each of its independent nodes, the matrix by which the motion of that moves the node.
    projections: Vec<Vec<Mat6>>,
    /// A projected matrix as 6×6 blocks, each column-major.
    projected: Vec<[f64; 36]>,
}

/// The weights of the terms of a tangent.
#[derive(Debug, Clone, Copy)]
pub struct TangentWeights {
    /// True where K is formed; false for the mass matrix alone.
    pub stiffness: bool,
    /// Factor ∂q̇/∂q of the damping.
    pub rate: f64,
    /// Factor ∂q̈/∂q of the mass.
    pub acceleration: f64,
    /// Moduli of the materials in K.
    pub moduli: Moduli,
}

/// The independent nodes that each node moves with: itself, or those at the end of its chain of masters (and itself for
/// degrees of freedom of its own).
pub fn independent_nodes(system: &System, nodes: usize) -> Vec<Vec<usize>> {
    let mut independent_nodes: Vec<Vec<usize>> = (0..nodes).map(|n| vec![n]).collect();
    for dependent in &system.rigid_links {
        let mut of = independent_nodes[dependent.master].clone();
        if !dependent.rigid {
            of.push(dependent.node);
        }
        independent_nodes[dependent.node] = of;
    }
    independent_nodes
}

/// The projection matrices: for each node and each of its independent nodes, the matrix by which the motion of that
/// moves the node.
pub fn projections(system: &System, nodes: &[Node], independent_nodes: &[Vec<usize>]) -> Vec<Vec<Mat6>> {
    let mut projections: Vec<_> = independent_nodes.iter().map(|r| vec![Mat6::identity(); r.len()]).collect();
    update_projections(system, nodes, independent_nodes, &mut projections);
    projections
}

/// Updates the projection matrices of dependent nodes along the chains of arms.
fn update_projections(
    system: &System,
    nodes: &[Node],
    independent_nodes: &[Vec<usize>],
    projections: &mut [Vec<Mat6>],
) {
    for dependent in &system.rigid_links {
        let D = dependent.D(nodes);
        for k in 0..independent_nodes[dependent.master].len() {
            projections[dependent.node][k] = D * projections[dependent.master][k];
        }
        if !dependent.rigid {
            let own = independent_nodes[dependent.node].len() - 1;
            let free = dependent.dofs.map(|taken| if taken { 0.0 } else { 1.0 });
            projections[dependent.node][own] = Mat6::from_diagonal(&free.into());
        }
    }
}

/// The connectivity of the nodes: one list for each element, joint and nodal matrix, with dependent nodes replaced by
/// their independent nodes. `nodes` counts the joints too: their multipliers are nodes after all others.
pub fn connectivity(system: &System, nodes: usize) -> Vec<Vec<usize>> {
    coupled(system, nodes, &independent_nodes(system, nodes))
}

/// The connectivity with multipliers in place of elimination: every dependent node moves by itself, tied to its master
/// by one more node, which stands after all others.
pub fn connectivity_with_multipliers(system: &System, nodes: usize) -> Vec<Vec<usize>> {
    let alone: Vec<Vec<usize>> = (0..nodes).map(|node| vec![node]).collect();
    let mut connectivity = coupled(system, nodes, &alone);
    connectivity.extend(
        system.rigid_links.iter().enumerate().map(|(k, dependent)| vec![dependent.master, dependent.node, nodes + k]),
    );
    connectivity
}

fn coupled(system: &System, nodes: usize, independent_nodes: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut connectivity: Vec<Vec<usize>> = Vec::new();
    let mut add = |nodes: &[usize]| {
        let mut all: Vec<usize> = nodes.iter().flat_map(|&n| independent_nodes[n].iter().copied()).collect();
        all.sort_unstable();
        all.dedup();
        connectivity.push(all);
    };
    for group in &system.groups {
        (0..group.block.len()).for_each(|e| add(group.block.nodes(e)));
    }
    system.consistent_masses().iter().for_each(|m| add(&m.nodes));
    system.pressures.iter().flat_map(|load| &load.faces).for_each(|face| add(face.nodes()));
    (0..nodes).filter(|&n| independent_nodes[n] != [n]).for_each(|n| add(&[n]));
    // The multipliers of a joint stand for one more of its nodes.
    let joints = system.joints.iter().zip(nodes - system.joints.len()..);
    joints.for_each(|(joint, own)| add(&[joint.nodes[0], joint.nodes[1], own]));
    connectivity
}

impl Assembly {
    /// Finds the destinations of all matrices.
    pub fn new(system: &System, dofs: &DofMap, solver: &Solver, threads: usize) -> Self {
        let nodes = dofs.each().len();
        let independent_nodes = independent_nodes(system, nodes);
        let mut find = Destinations::new(dofs, solver, &independent_nodes);
        let group = |group: &Group| {
            let (block, d) = (&group.block, group.block.dofs());
            (0..block.len()).map(|e| find.local(block.nodes(e), d)).collect()
        };
        let groups: Vec<Vec<Destination>> = system.groups.iter().map(group).collect();
        let faces = system.pressures.iter().flat_map(|load| &load.faces);
        let faces: Vec<Destination> = faces.map(|face| find.local(face.nodes(), 3)).collect();
        let joints = system.joints.iter().zip(nodes - system.joints.len()..);
        let joints: Vec<Destination> =
            joints.map(|(joint, own)| find.local(&[joint.nodes[0], joint.nodes[1], own], 6)).collect();
        let diagonals =
            system.joints.iter().map(|joint| Diagonal::new(joint, &independent_nodes, dofs, solver)).collect();
        let own = find.nodal(system);
        let masses = system.consistent_masses().iter();
        let masses: Vec<Destination> = masses.map(|m| find.projected(&m.nodes, &|_, _| true)).collect();
        let Destinations { scatter, blocks, most, .. } = find;
        let size = |block: &dyn ElementBlock| (block.dofs() * block.nodes(0).len()).pow(2) * block.len().min(CHUNK);
        let local = system.groups.iter().map(|g| size(&*g.block)).max().unwrap_or(0);
        Assembly {
            groups,
            nodes: own,
            masses,
            faces,
            joints,
            diagonals,
            scatter,
            blocks,
            threads: system.uses_threads(threads),
            gyroscopic: system.gyroscopic && !solver.is_symmetric(),
            scratch: Scratch {
                local: vec![0.0; local],
                own: vec![Mat6::zeros(); nodes],
                projections: independent_nodes.iter().map(|r| vec![Mat6::identity(); r.len()]).collect(),
                projected: vec![[0.0; 36]; most * most],
            },
            independent_nodes,
        }
    }

    /// Forms the matrix of the step in `solver`, K + rate·C + acceleration·M at the configuration `now`, where `forces`
    /// is the residual. A symmetric solver receives the symmetric part.
    pub fn tangent(
        &mut self,
        system: &System,
        now: &Configuration,
        loading: &Loading,
        forces: &mut Forces,
        weights: TangentWeights,
        solver: &mut Solver,
    ) {
        let nodes = now.nodes;
        let values = solver.values();
        values.fill(0.0);
        update_projections(system, nodes, &self.independent_nodes, &mut self.scratch.projections);
        if weights.stiffness {
            self.add_elements(system, now, weights, values);
            self.add_pressures(system, nodes, loading, values);
        }
        self.form_nodes(system, nodes, loading, forces, weights);
        self.add_nodes(values);
        self.add_masses(system, weights, values);
        self.add_joints(system, nodes, forces, weights, values);
    }

    fn add_elements(
        &mut self,
        system: &System,
        now: &Configuration,
        TangentWeights { rate, moduli, .. }: TangentWeights,
        values: &mut [f64],
    ) {
        for (group, destinations) in system.groups.iter().zip(&self.groups) {
            let (block, d) = (&group.block, group.block.dofs());
            let now = &group.configuration(now);
            let length = (d * block.nodes(0).len()).pow(2);
            for first in (0..block.len()).step_by(CHUNK) {
                let last = (first + CHUNK).min(block.len());
                let Scratch { local, projections, projected, .. } = &mut self.scratch;
                let local = &mut local[..length * (last - first)];
                let sparse = group.kind.is_unilateral();
                let inactive = |e: usize| sparse && block.is_inactive(e, now);
                let fill = |(k, K): (usize, &mut [f64])| {
                    if !inactive(first + k) {
                        block.tangent(first + k, now, rate, moduli, K);
                    }
                };
                if self.threads {
                    local.par_chunks_mut(length).enumerate().for_each(fill);
                } else {
                    local.chunks_mut(length).enumerate().for_each(fill);
                }
                for (e, K) in (first..last).zip(local.chunks(length)).filter(|(e, _)| !inactive(*e)) {
                    add_local(
                        K,
                        block.nodes(e),
                        &destinations[e],
                        (&self.scatter, &self.blocks, &self.independent_nodes, projections),
                        projected,
                        values,
                    );
                }
            }
        }
    }

    fn add_pressures(&mut self, system: &System, nodes: &[Node], loading: &Loading, values: &mut [f64]) {
        let Scratch { projections, projected, .. } = &mut self.scratch;
        let mut destinations = self.faces.iter();
        for (load, p) in system.pressures.iter().zip(&loading.pressures) {
            for (face, destination) in load.faces.iter().zip(&mut destinations) {
                let mut K = [0.0; 12 * 12];
                let K = &mut K[..(3 * face.nodes().len()).pow(2)];
                face.stiffness(*p, nodes, K);
                add_local(
                    K,
                    face.nodes(),
                    destination,
                    (&self.scatter, &self.blocks, &self.independent_nodes, projections),
                    projected,
                    values,
                );
            }
        }
    }

    /// Adds the joints last, for their penalty factors rest on the matrix of all the others.
    fn add_joints(
        &mut self,
        system: &System,
        nodes: &[Node],
        forces: &mut Forces,
        weights: TangentWeights,
        values: &mut [f64],
    ) {
        let Scratch { projections, projected, .. } = &mut self.scratch;
        let projections = &projections[..];
        let own = nodes.len();
        let add = |j: usize, K: &[f64], values: &mut [f64]| {
            let [a, b] = system.joints[j].nodes;
            let how = (&self.scatter, &self.blocks, &self.independent_nodes[..], projections);
            add_local(K, &[a, b, own + j], &self.joints[j], how, projected, values);
        };
        let multipliers = &mut forces.multipliers;
        joints::tangents(system, nodes, (&self.diagonals, projections), multipliers, weights.stiffness, values, add);
    }

    /// Forms the matrices of nodes: inertia, nodal damping, follower loads, arms.
    fn form_nodes(
        &mut self,
        system: &System,
        nodes: &[Node],
        loading: &Loading,
        forces: &Forces,
        weights: TangentWeights,
    ) {
        let own = &mut self.scratch.own;
        for (node, _) in &self.nodes {
            own[*node] = Mat6::zeros();
        }
        let of_motion = (weights.rate, weights.acceleration);
        let gyroscopic = self.gyroscopic && weights.stiffness;
        for inertia in &system.inertias {
            own[inertia.node] += inertia.tangent(&nodes[inertia.node], of_motion, system.mass_damping, gyroscopic);
        }
        for damping in &system.nodal_damping {
            for i in 0..3 {
                own[damping.node][(i, i)] += weights.rate * damping.translation;
                own[damping.node][(3 + i, 3 + i)] += weights.rate * damping.rotation;
            }
        }
        if !weights.stiffness {
            return;
        }
        let mut add = |node: usize, row: usize, k: Mat3| {
            let mut block = own[node].fixed_view_mut::<3, 3>(row, 3);
            block += k;
        };
        for (load, factor) in system.loads.iter().zip(&loading.factors).filter(|(l, _)| l.follower) {
            let [f, m] = follower_stiffness(load, *factor, &nodes[load.node]);
            add(load.node, 0, f);
            add(load.node, 3, m);
        }
        for (dependent, f) in system.rigid_links.iter().zip(&forces.on_dependents) {
            add(dependent.master, 3, -dependent.arm_stiffness(nodes, f));
        }
    }

    fn add_nodes(&mut self, values: &mut [f64]) {
        let Scratch { own, projections, projected, .. } = &mut self.scratch;
        for (node, destination) in &self.nodes {
            if destination.targets.is_empty() {
                self.scatter.add(own[*node].as_slice(), destination.entries, values);
            } else {
                project(
                    &[*node],
                    &destination.targets,
                    &self.independent_nodes,
                    projections,
                    |_, _| own[*node],
                    projected,
                );
                self.scatter.add(projected.as_flattened(), destination.entries, values);
            }
        }
    }

    fn add_masses(&mut self, system: &System, weights: TangentWeights, values: &mut [f64]) {
        let w = weights.acceleration + system.mass_damping * weights.rate;
        for (mass, destination) in system.consistent_masses().iter().zip(&self.masses) {
            let n = mass.nodes.len();
            let pair = |a: usize, b: usize| {
                let m = w * mass.m[a * n + b];
                Mat6::from_diagonal(&[m, m, m, 0.0, 0.0, 0.0].into())
            };
            let projected = &mut self.scratch.projected;
            project(
                &mass.nodes,
                &destination.targets,
                &self.independent_nodes,
                &self.scratch.projections,
                pair,
                projected,
            );
            self.scatter.add(projected.as_flattened(), destination.entries, values);
        }
    }
}

/// Adds an element's matrix, row-major with 3 or 6 degrees of freedom a node.
fn add_local(
    K: &[f64],
    nodes: &[usize],
    destination: &Destination,
    (scatter, blocks, independent_nodes, projections): (&Scatter, &BlockScatter, &[Vec<usize>], &[Vec<Mat6>]),
    projected: &mut [[f64; 36]],
    values: &mut [f64],
) {
    let [from, to] = destination.blocks;
    if from < to {
        return blocks.add(K, from as usize..to as usize, values);
    }
    if destination.targets.is_empty() {
        return scatter.add(K, destination.entries, values);
    }
    let width = K.len().isqrt();
    let d = width / nodes.len();
    let pair = |a: usize, b: usize| {
        let at = |i: usize, j: usize| K[(d * a + i) * width + d * b + j];
        Mat6::from_fn(|i, j| if i < d && j < d { at(i, j) } else { 0.0 })
    };
    project(nodes, &destination.targets, independent_nodes, projections, pair, projected);
    scatter.add(projected.as_flattened(), destination.entries, values);
}

/// Projects K̂ = 𝒯ᵀ K 𝒯 onto the independent nodes `targets`, with `pair(a, b)` the element's 6×6 block of its nodes a
/// and b.
fn project(
    nodes: &[usize],
    targets: &[usize],
    independent_nodes: &[Vec<usize>],
    projections: &[Vec<Mat6>],
    pair: impl Fn(usize, usize) -> Mat6,
    projected: &mut [[f64; 36]],
) {
    let m = targets.len();
    projected[..m * m].fill([0.0; 36]);
    let destination = |independent: usize| targets.iter().position(|&t| t == independent).unwrap_or(0);
    let stays = |node: usize| independent_nodes[node] == [node];
    for (a, &node_a) in nodes.iter().enumerate() {
        for (b, &node_b) in nodes.iter().enumerate() {
            let k = pair(a, b);
            for (&independent_a, T_a) in independent_nodes[node_a].iter().zip(&projections[node_a]) {
                let left = if stays(node_a) { k } else { T_a.tr_mul(&k) };
                for (&independent_b, T_b) in independent_nodes[node_b].iter().zip(&projections[node_b]) {
                    let block = if stays(node_b) { left } else { left * T_b };
                    let sum = &mut projected[destination(independent_a) * m + destination(independent_b)];
                    sum.iter_mut().zip(block.as_slice()).for_each(|(sum, k)| *sum += k);
                }
            }
        }
    }
}
