//! Assembly of the matrices of elements, nodes and joints into the matrix of the system, through slots computed once.
//! Matrices at dependent nodes are projected onto independent nodes here, DᵀKD (58): the one place where elements meet
//! rigid bodies.

use super::block_scatter::BlockScatter;
use super::dependents::{Arms, Followers, Projection, independent_nodes, update_projections};
use super::dofs::DofMap;
use super::equations::{Forces, System};
use super::group::Group;
use super::joints::{self, Diagonal};
use super::loads::{Loading, follower_stiffness};
use super::tangent_weights::TangentWeights;
use crate::elements::pressure::MOST_NODES;
use crate::elements::{ElementBlock, Partners};
use crate::linear::Solver;
use crate::math::lanes::LANES;
use crate::math::{Mat3, Mat6};
use crate::state::{Configuration, Node};
use rayon::prelude::*;

/// Number of elements whose matrices are formed before they are added, one after the other, in deck order: a multiple of [`LANES`].
const CHUNK: usize = 256;

/// The destination of every matrix. All but `scratch` is constant over a run.
pub struct Assembly {
    /// Destinations of the elements, by group.
    groups: Vec<Vec<Destination>>,
    /// Pairs of the groups whose elements wander, in the order of those.
    wanderers: Vec<WanderingPairs>,
    /// Destinations of the matrices of nodes: inertia, nodal damping, follower loads, arms of dependent nodes.
    nodes: Vec<(usize, Destination)>,
    masses: Vec<Destination>,
    /// Destinations of the faces under follower pressure, in their order.
    faces: Vec<Destination>,
    joints: Vec<Destination>,
    diagonals: Vec<Diagonal>,
    scatter: Scatter,
    blocks: BlockScatter,
    arms: Arms,
    threads: bool,
    /// True where the gyroscopic matrix C(r) (37) is part of the tangent; it is in the residual always.
    gyroscopic: bool,
    /// True where [`Configuration::lead`] holds the nodes whose stresses act: see [`Assembly::stressed`].
    of_stresses: bool,
    scratch: Scratch,
}

/// The pairs of a group for which the matrix has room.
struct WanderingPairs {
    group: usize,
    partners: Partners,
    destinations: Vec<Destination>,
}

/// The destination of a local matrix.
struct Destination {
    /// The projection that comes first; none where no node is dependent.
    projection: Option<Projection>,
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
    followers: &'a Followers,
    scatter: Scatter,
    blocks: BlockScatter,
    arms: Arms,
    /// Largest number of entries of a matrix that is projected.
    most: usize,
}

impl<'a> Destinations<'a> {
    fn new(dofs: &'a DofMap, solver: &'a Solver, followers: &'a Followers) -> Self {
        let (scatter, blocks, arms) = (Scatter(Vec::new()), BlockScatter::new(), Arms::new());
        Destinations { dofs, solver, followers, scatter, blocks, arms, most: 0 }
    }

    /// The destination of a matrix with `d` degrees of freedom a node, row-major.
    fn local(&mut self, of: &[usize], d: usize) -> Destination {
        self.square(of, d, |k, size| (k / size, k % size))
    }

    /// The destinations of pairs of a group of elements that wander.
    fn pairs(&mut self, group: usize, partners: &Partners) -> WanderingPairs {
        let destinations = (0..partners.pairs.len()).map(|pair| self.local(partners.nodes(pair), 6)).collect();
        WanderingPairs { group, partners: partners.clone(), destinations }
    }

    /// The destination of a matrix whose k-th entry, of so many rows, stands where `place` says.
    fn square(&mut self, of: &[usize], d: usize, place: fn(usize, usize) -> (usize, usize)) -> Destination {
        let dofs = self.dofs;
        let (projection, rows) = if of.iter().all(|&n| self.followers.is_independent(n)) {
            (None, of.iter().flat_map(|&n| (0..d).map(move |i| (n, i))).collect())
        } else {
            let (projection, rows) = self.arms.push(self.followers, dofs, of, d);
            self.most = self.most.max(rows.len().pow(2));
            (Some(projection), rows)
        };
        if let Some(blocks) = self.whole_blocks(&rows) {
            return Destination { projection, entries: Entries { from: 0, halves: 0, to: 0 }, blocks };
        }
        let size = rows.len();
        let row = |i: usize| dofs.row(rows[i].0, rows[i].1);
        let entry = |k: usize| {
            let (i, j) = place(k, size);
            row(i).zip(row(j))
        };
        let entries = self.scatter.push(self.solver, size * size, entry);
        Destination { projection, entries, blocks: [0; 2] }
    }

    /// The blocks of a matrix whose rows are those of different nodes with six unknowns each.
    fn whole_blocks(&mut self, rows: &[(usize, usize)]) -> Option<[u32; 2]> {
        let is_whole = |six: &[(usize, usize)]| (0..6).all(|i| six.get(i) == Some(&(six[0].0, i)));
        if !rows.chunks(6).all(is_whole) {
            return None;
        }
        let firsts: Option<Vec<usize>> = rows.chunks(6).map(|six| self.dofs.of(six[0].0).first_of_six()).collect();
        let firsts = firsts?;
        if (1..firsts.len()).any(|k| firsts[..k].contains(&firsts[k])) {
            return None;
        }
        let from = self.blocks.len() as u32;
        self.blocks.push(self.solver, &firsts).then(|| [from, self.blocks.len() as u32])
    }

    /// The destination of a consistent mass matrix: of its entries themselves, which count for each translation, or of the
    /// matrix of translations that is made of them.
    fn mass(&mut self, of: &[usize]) -> Destination {
        if of.iter().any(|&n| !self.followers.is_independent(n)) {
            return self.local(of, 3);
        }
        let (n, dofs) = (of.len(), self.dofs);
        let entry = |k: usize| {
            let (pair, axis) = (k / 3, k % 3);
            dofs.row(of[pair / n], axis).zip(dofs.row(of[pair % n], axis))
        };
        let entries = self.scatter.push(self.solver, 3 * n * n, entry);
        self.scatter.0[entries.from..entries.to].iter_mut().for_each(|[k, _]| *k /= 3);
        self.most = self.most.max(n * n);
        Destination { projection: None, entries, blocks: [0; 2] }
    }

    /// The destinations of the matrices of nodes, which inertia, nodal damping, follower loads and arms have. Inertia
    /// and damping couple neither translations with one another nor with rotations; arms and followers do.
    fn nodal(&mut self, system: &System) -> Vec<(usize, Destination)> {
        let nodes = self.followers.independent_nodes.len();
        let (mut has_own, mut is_full) = (vec![false; nodes], vec![false; nodes]);
        system.inertias.iter().for_each(|i| has_own[i.node] = true);
        system.nodal_damping.iter().for_each(|d| has_own[d.node] = true);
        system.loads.iter().filter(|l| l.follower).for_each(|l| is_full[l.node] = true);
        system.rigid_links.iter().for_each(|r| is_full[r.master] = true);
        let with_own = (0..nodes).filter(|&n| has_own[n] || is_full[n]);
        with_own.map(|n| (n, self.node(n, is_full[n]))).collect()
    }

    /// The destination of the matrix of a node, column-major.
    fn node(&mut self, node: usize, is_full: bool) -> Destination {
        if is_full || !self.followers.is_independent(node) {
            return self.square(&[node], 6, |k, size| (k % size, k / size));
        }
        let dofs = self.dofs;
        let couples = |i: usize, j: usize| i == j || (i > 2 && j > 2);
        let entry = |k: usize| {
            let (i, j) = (k % 6, k / 6);
            if couples(i, j) { dofs.row(node, i).zip(dofs.row(node, j)) } else { None }
        };
        let entries = self.scatter.push(self.solver, 36, entry);
        Destination { projection: None, entries, blocks: [0; 2] }
    }
}

/// Buffers that every tangent writes.
struct Scratch {
    /// Matrices of the elements of a chunk.
    local: Vec<f64>,
    own: Vec<Mat6>,
    /// For each node and each of its independent nodes, the matrix by which the motion of that moves the node.
    projections: Vec<Vec<Mat6>>,
    /// A projected matrix, or one that is made of few numbers.
    projected: Vec<f64>,
}

/// The connectivity of the nodes: one list for each element, joint and nodal matrix, with dependent nodes replaced by
/// their independent nodes. `nodes` counts the joints too: their multipliers are nodes after all others;
/// `partners` are pairs of elements that wander.
pub fn connectivity(system: &System, nodes: usize, partners: &[(usize, Partners)]) -> Vec<Vec<usize>> {
    let independent = independent_nodes(&system.rigid_links, nodes);
    let mut connectivity = coupled(system, nodes, &independent);
    for (_, partners) in partners {
        for pair in 0..partners.pairs.len() {
            let mut all: Vec<usize> =
                partners.nodes(pair).iter().flat_map(|&n| independent[n].iter().copied()).collect();
            all.sort_unstable();
            all.dedup();
            connectivity.push(all);
        }
    }
    connectivity
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
    joints.for_each(|(joint, own)| add(&joint.matrix_nodes().chain([own]).collect::<Vec<_>>()));
    connectivity
}

impl Assembly {
    /// Finds the destinations of all matrices.
    pub fn new(system: &System, dofs: &DofMap, solver: &Solver, threads: usize) -> Self {
        Self::with_room(system, dofs, solver, threads, &[])
    }

    /// The same with room for pairs of elements that wander, by the groups of those.
    pub fn with_room(
        system: &System,
        dofs: &DofMap,
        solver: &Solver,
        threads: usize,
        partners: &[(usize, Partners)],
    ) -> Self {
        let nodes = dofs.each().len();
        let followers = Followers::new(&system.rigid_links, nodes);
        let mut find = Destinations::new(dofs, solver, &followers);
        let group = |group: &Group| {
            let (block, d) = (&group.block, group.block.dofs());
            (0..block.len()).map(|e| find.local(block.nodes(e), d)).collect()
        };
        let groups: Vec<Vec<Destination>> = system.groups.iter().map(group).collect();
        let wanderers = partners.iter().map(|(group, partners)| find.pairs(*group, partners)).collect();
        let faces = system.pressures.iter().flat_map(|load| &load.faces);
        let faces: Vec<Destination> = faces.map(|face| find.local(face.nodes(), 3)).collect();
        let joints = system.joints.iter().zip(nodes - system.joints.len()..);
        let joints: Vec<Destination> =
            joints.map(|(joint, own)| find.local(&joint.matrix_nodes().chain([own]).collect::<Vec<_>>(), 6)).collect();
        let diagonals = system
            .joints
            .iter()
            .map(|joint| Diagonal::new(joint, &followers.independent_nodes, dofs, solver))
            .collect();
        let own = find.nodal(system);
        let of_masses = system.consistent_masses().iter().map(|m| find.mass(&m.nodes)).collect();
        let Destinations { scatter, blocks, arms, most, .. } = find;
        let size = |block: &dyn ElementBlock| (block.dofs() * block.nodes(0).len()).pow(2) * block.len().min(CHUNK);
        let masses = system.consistent_masses().iter().map(|m| 9 * m.m.len());
        let pairs = partners.iter().map(|(_, partners)| (6 * partners.most_nodes()).pow(2));
        let local = system.groups.iter().map(|g| size(&*g.block)).chain(masses).chain(pairs).max().unwrap_or(0);
        Assembly {
            groups,
            wanderers,
            nodes: own,
            masses: of_masses,
            faces,
            joints,
            diagonals,
            scatter,
            blocks,
            arms,
            threads: system.uses_threads(threads),
            gyroscopic: system.gyroscopic && !solver.is_symmetric(),
            of_stresses: false,
            scratch: Scratch {
                local: vec![0.0; local],
                own: vec![Mat6::zeros(); nodes],
                projections: followers.independent_nodes.iter().map(|r| vec![Mat6::identity(); r.len()]).collect(),
                projected: vec![0.0; most],
            },
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
        self.without_joints(system, now, loading, forces, weights, solver);
        self.add_joints(system, now.nodes, forces, weights, solver.values());
    }

    /// The same without the rows of multipliers and what penalties add, but with the derivative of the joints' forces: what acts on
    /// motions that the joints allow.
    pub fn unconstrained(
        &mut self,
        system: &System,
        now: &Configuration,
        loading: &Loading,
        forces: &mut Forces,
        weights: TangentWeights,
        solver: &mut Solver,
    ) {
        self.without_joints(system, now, loading, forces, weights, solver);
        if weights.stiffness {
            let Scratch { projections, projected, .. } = &mut self.scratch;
            let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
            let values = solver.values();
            joints::stiffnesses(system, now.nodes, &forces.multipliers, |j, K| {
                how.add((K, joints::width(&system.joints[j])), &self.joints[j], projected, values);
            });
        }
    }

    /// As [`Assembly::unconstrained`] with K in a configuration `now`, but with the stresses that elements have at the nodes that stand as
    /// [`Configuration::lead`] there.
    pub fn stressed(
        &mut self,
        system: &System,
        now: &Configuration,
        loading: &Loading,
        forces: &mut Forces,
        weights: TangentWeights,
        solver: &mut Solver,
    ) {
        self.of_stresses = true;
        self.unconstrained(system, now, loading, forces, weights, solver);
        self.of_stresses = false;
    }

    fn without_joints(
        &mut self,
        system: &System,
        now: &Configuration,
        loading: &Loading,
        forces: &Forces,
        weights: TangentWeights,
        solver: &mut Solver,
    ) {
        let nodes = now.nodes;
        let values = solver.values();
        values.fill(0.0);
        update_projections(&system.rigid_links, nodes, &mut self.scratch.projections);
        if weights.stiffness {
            self.add_elements(system, now, weights, values);
            self.add_wanderers(system, now, weights.rate, values);
            self.add_pressures(system, nodes, loading, values);
        }
        self.form_nodes(system, nodes, loading, forces, weights);
        self.add_nodes(values);
        self.add_masses(system, weights, values);
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
                let (sparse, of_stresses) = (group.kind.is_unilateral(), self.of_stresses);
                let inactive = |e: usize| sparse && block.is_inactive(e, now);
                let one = |(e, K): (usize, &mut [f64])| match now.lead {
                    _ if inactive(e) => {}
                    Some(stressed) if of_stresses => block.stressed_tangent(e, now, stressed, K),
                    _ => block.tangent(e, now, rate, moduli, K),
                };
                let fill = |(k, K): (usize, &mut [f64])| {
                    let from = first + LANES * k;
                    if sparse || of_stresses {
                        (from..).zip(K.chunks_mut(length)).for_each(one);
                    } else {
                        block.tangents(from, now, rate, moduli, K);
                    }
                };
                if self.threads {
                    local.par_chunks_mut(LANES * length).enumerate().for_each(fill);
                } else {
                    local.chunks_mut(LANES * length).enumerate().for_each(fill);
                }
                let width = d * block.nodes(0).len();
                let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
                for (e, K) in (first..last).zip(local.chunks_mut(length)).filter(|(e, _)| !inactive(*e)) {
                    how.add((K, width), &destinations[e], projected, values);
                }
            }
        }
    }

    fn add_wanderers(&mut self, system: &System, now: &Configuration, rate: f64, values: &mut [f64]) {
        let Scratch { local, projections, projected, .. } = &mut self.scratch;
        let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
        for WanderingPairs { group, partners, destinations } in &self.wanderers {
            let group = &system.groups[*group];
            let Some(block) = group.block.wandering() else { continue };
            block.pair_tangents(partners, &group.configuration(now), rate, local, &mut |pair, K: &mut [f64]| {
                how.add((K, 6 * partners.nodes(pair).len()), &destinations[pair], projected, values);
            });
        }
    }

    /// True where the matrix has room for all pairs of wandering elements that act.
    pub fn has_room(&self, system: &System, now: &Configuration) -> bool {
        let mut wanderers = self.wanderers.iter();
        system.wandering_groups().all(|(number, group, block)| {
            let own = wanderers.next().filter(|own| own.group == number);
            let none = Partners::default();
            block.has_room(own.map_or(&none, |own| &own.partners), &group.configuration(now))
        })
    }

    /// The pairs for which the matrix has room, by their groups.
    pub fn partners(&self) -> Vec<(usize, Partners)> {
        self.wanderers.iter().map(|own| (own.group, own.partners.clone())).collect()
    }

    fn add_pressures(&mut self, system: &System, nodes: &[Node], loading: &Loading, values: &mut [f64]) {
        let Scratch { projections, projected, .. } = &mut self.scratch;
        let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
        let mut destinations = self.faces.iter();
        let mut scratch = [0.0; 9 * MOST_NODES * MOST_NODES];
        for (load, p) in system.pressures.iter().zip(&loading.pressures) {
            for (face, destination) in load.faces.iter().zip(&mut destinations) {
                let width = 3 * face.nodes().len();
                let K = &mut scratch[..width * width];
                face.stiffness(*p, nodes, K);
                how.add((K, width), destination, projected, values);
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
        let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
        let destinations = &self.joints;
        let add = |j: usize, K: &mut [f64], values: &mut [f64]| {
            how.add((K, joints::width(&system.joints[j])), &destinations[j], projected, values);
        };
        let multipliers = &mut forces.multipliers;
        joints::tangents(system, nodes, (&self.diagonals, projections), multipliers, weights, values, add);
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
        let gyroscopic = self.gyroscopic && weights.stiffness;
        for inertia in &system.inertias {
            own[inertia.node] += inertia.tangent(&nodes[inertia.node], &weights, system.mass_damping, gyroscopic);
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
        let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
        for (node, destination) in &self.nodes {
            how.add((own[*node].as_mut_slice(), 6), destination, projected, values);
        }
    }

    fn add_masses(&mut self, system: &System, weights: TangentWeights, values: &mut [f64]) {
        let w = weights.acceleration + system.mass_damping * weights.rate;
        let Scratch { projections, projected, local, .. } = &mut self.scratch;
        let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
        for (mass, destination) in system.consistent_masses().iter().zip(&self.masses) {
            if destination.projection.is_none() {
                let m = &mut projected[..mass.m.len()];
                m.iter_mut().zip(&mass.m).for_each(|(scaled, m)| *scaled = w * m);
                how.scatter.add(m, destination.entries, values);
                continue;
            }
            let n = mass.nodes.len();
            let K = &mut local[..9 * n * n];
            K.fill(0.0);
            for (k, m) in mass.m.iter().enumerate() {
                for axis in 0..3 {
                    K[(3 * (k / n) + axis) * 3 * n + 3 * (k % n) + axis] = w * m;
                }
            }
            how.add((K, 3 * n), destination, projected, values);
        }
    }
}

/// The places of local matrices in the system's.
struct Places<'a> {
    scatter: &'a Scatter,
    blocks: &'a BlockScatter,
    arms: &'a Arms,
    projections: &'a [Vec<Mat6>],
}

impl Places<'_> {
    /// Adds a local matrix of this number of rows, row-major. It is used up where it has dependent nodes.
    #[inline]
    fn add(
        &self,
        (K, width): (&mut [f64], usize),
        destination: &Destination,
        projected: &mut [f64],
        values: &mut [f64],
    ) {
        let (K, width) = match &destination.projection {
            None => (&*K, width),
            Some(projection) => {
                (self.arms.project(projection, self.projections, (K, width), projected), projection.width())
            }
        };
        match destination.blocks {
            [from, to] if from < to => self.blocks.add(K, width, from as usize..to as usize, values),
            _ => self.scatter.add(K, destination.entries, values),
        }
    }
}
