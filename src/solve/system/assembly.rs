//! Assembly of the matrices of elements, nodes and joints into the matrix of the system, through slots computed once.
//! Matrices at dependent nodes are projected onto independent nodes here, DᵀKD (58): the one place where elements meet
//! rigid bodies.

use super::block_scatter::BlockScatter;
use super::dependents::{Arms, Followers, update_projections};
use super::destinations::{Destination, Destinations, Places, Scatter};
use super::dofs::DofMap;
use super::equations::{Forces, System};
use super::group::Group;
use super::joints;
use super::loads::{Loading, follower_stiffness};
use super::penalties::Diagonals;
use super::tangent_weights::TangentWeights;
use base::math::lanes::LANES;
use base::math::{Mat3, Mat6, Vec3};
use linear::Solver;
use mechanics::elements::pressure::MOST_NODES;
use mechanics::elements::{ElementBlock, Partners};
use mechanics::state::{Configuration, Node};
use model::LoadedCoordinate;
use rayon::prelude::*;

/// Number of elements whose matrices are formed before they are added, one after the other, in deck order: a multiple of [`LANES`].
const CHUNK: usize = 256;

/// The destination of every matrix. All but `scratch` is constant over a run.
pub struct Assembly {
    /// Destinations of the elements, by group.
    groups: Vec<Vec<Destination>>,
    /// Pairs of the groups with changing partners, in the order of the groups.
    wanderers: Vec<WanderingPairs>,
    /// Destinations of the matrices of nodes: inertia, nodal damping, follower loads, arms of dependent nodes.
    nodes: Vec<(usize, Destination)>,
    masses: Vec<Destination>,
    floating: Vec<Destination>,
    /// Destinations of the faces under follower pressure, in their order.
    faces: Vec<Destination>,
    /// Destinations of the consistent masses under centrifugal loads, in their order.
    centrifugal: Vec<Destination>,
    /// Destinations of the efforts of joints, in the order of the loads.
    efforts: Vec<Destination>,
    joints: Vec<Destination>,
    diagonals: Diagonals,
    scatter: Scatter,
    blocks: BlockScatter,
    arms: Arms,
    threads: bool,
    /// True where the gyroscopic matrix C(r) (37) is part of the tangent; it is in the residual always.
    gyroscopic: bool,
    /// True if [`Configuration::previous`] holds the nodes whose stresses act, see [`Assembly::stressed`].
    of_stresses: bool,
    scratch: Scratch,
}

/// The pairs of a group that have room in the matrix.
struct WanderingPairs {
    group: usize,
    partners: Partners,
    destinations: Vec<Destination>,
}

impl WanderingPairs {
    fn new(group: usize, partners: &Partners, find: &mut Destinations) -> WanderingPairs {
        let destinations = (0..partners.pairs.len()).map(|pair| find.local(partners.nodes(pair), 6)).collect();
        WanderingPairs { group, partners: partners.clone(), destinations }
    }
}
/// Buffers that every tangent writes.
struct Scratch {
    /// Matrices of the elements of a chunk.
    local: Vec<f64>,
    own: Vec<Mat6>,
    /// For each node and each of its independent nodes, the matrix that maps the motion of the independent node to the motion of the node.
    projections: Vec<Vec<Mat6>>,
    /// A projected matrix, or one that is made of few numbers.
    projected: Vec<f64>,
}
impl Assembly {
    /// Finds the destinations of all matrices.
    pub fn new(system: &System, dofs: &DofMap, solver: &Solver, threads: usize) -> Self {
        Self::with_room(system, dofs, solver, threads, &[])
    }

    /// Like [`Assembly::new`], with room for pairs of elements with changing partners, by the groups of these elements.
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
        let wanderers =
            partners.iter().map(|(group, partners)| WanderingPairs::new(*group, partners, &mut find)).collect();
        let faces = system.pressures.iter().flat_map(|load| &load.faces);
        let faces: Vec<Destination> = faces.map(|face| find.local(face.nodes(), 3)).collect();
        let turning = system.centrifugal().iter().flat_map(|load| &load.consistent);
        let centrifugal = turning.map(|mass| find.local(&mass.nodes, 3)).collect();
        let efforts = efforts(system).map(|(_, along)| find.local(&along.ends, 6)).collect();
        let joints = system.joints.iter().zip(nodes - system.joints.len()..);
        let joints: Vec<Destination> =
            joints.map(|(joint, own)| find.local(&joint.matrix_nodes().chain([own]).collect::<Vec<_>>(), 6)).collect();
        let diagonals = Diagonals::new(system, &followers.independent_nodes, dofs, solver);
        let own = find.nodal(system);
        let of_floating = system.floating().iter().map(|mass| find.local(mass.element.nodes(), 6)).collect();
        let of_masses = system.consistent_masses().iter().map(|m| find.mass(&m.nodes)).collect();
        let Destinations { scatter, blocks, arms, most, .. } = find;
        Assembly {
            groups,
            wanderers,
            nodes: own,
            masses: of_masses,
            floating: of_floating,
            faces,
            centrifugal,
            efforts,
            joints,
            diagonals,
            scatter,
            blocks,
            arms,
            threads: system.uses_threads(threads),
            gyroscopic: system.gyroscopic && !solver.is_symmetric(),
            of_stresses: false,
            scratch: Scratch {
                local: vec![0.0; largest_matrix(system, partners)],
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

    /// Like [`Assembly::tangent`] without multipliers and penalties, but with the derivative of the joint forces: the stiffness of the
    /// motions that joints allow.
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

    /// Like [`Assembly::unconstrained`] with K in the configuration `now`, but with the stresses of elements at the nodes
    /// [`Configuration::previous`].
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
            self.add_centrifugal(system, loading, values);
            self.add_efforts(system, nodes, loading, values);
        }
        self.form_nodes(system, nodes, loading, forces, weights);
        self.add_nodes(values);
        self.add_masses(system, weights, values);
        self.add_floating(system, (nodes, &loading.field), weights, values);
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
                let one = |(e, K): (usize, &mut [f64])| match now.previous {
                    _ if inactive(e) => {}
                    Some(stressed) if of_stresses => block.stressed_tangent(e, now, stressed, K),
                    _ => block.tangent(e, now, rate, moduli, K),
                };
                let fill = |(k, K): (usize, &mut [f64])| {
                    let from = first + LANES * k;
                    // The matrix around supports needs few elements.
                    let wanted = &destinations[from..(from + LANES).min(last)];
                    if wanted.iter().all(Destination::is_empty) {
                        return;
                    }
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
                for (e, K) in (first..last).zip(local.chunks_mut(length)) {
                    if !destinations[e].is_empty() && !inactive(e) {
                        how.add((K, width), &destinations[e], projected, values);
                    }
                }
            }
        }
    }

    fn add_wanderers(&mut self, system: &System, now: &Configuration, rate: f64, values: &mut [f64]) {
        let Scratch { local, projections, projected, .. } = &mut self.scratch;
        let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
        for WanderingPairs { group, partners, destinations } in &self.wanderers {
            let group = &system.groups[*group];
            let Some(block) = group.wandering() else { continue };
            block.pair_tangents(partners, &group.configuration(now), rate, local, &mut |pair, K: &mut [f64]| {
                how.add((K, 6 * partners.nodes(pair).len()), &destinations[pair], projected, values);
            });
        }
    }

    /// True if the matrix has room for all active pairs of elements with changing partners.
    pub fn has_room(&self, system: &System, now: &Configuration) -> bool {
        let mut wanderers = self.wanderers.iter();
        system.wandering_groups().all(|(number, group, block)| {
            let own = wanderers.next().filter(|own| own.group == number);
            let none = Partners::default();
            block.has_room(own.map_or(&none, |own| &own.partners), &group.configuration(now))
        })
    }

    /// The pairs that have room in the matrix, by their groups.
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

    fn add_centrifugal(&mut self, system: &System, loading: &Loading, values: &mut [f64]) {
        let Scratch { local, projections, projected, .. } = &mut self.scratch;
        let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
        let mut destinations = self.centrifugal.iter();
        for (load, square) in system.centrifugal().iter().zip(&loading.squares) {
            for (mass, destination) in load.consistent.iter().zip(&mut destinations) {
                let K = &mut local[..9 * mass.m.len()];
                load.stiffness(*square, mass, K);
                how.add((K, 3 * mass.nodes.len()), destination, projected, values);
            }
        }
    }

    fn add_efforts(&mut self, system: &System, nodes: &[Node], loading: &Loading, values: &mut [f64]) {
        let Scratch { projections, projected, .. } = &mut self.scratch;
        let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
        let mut K = [0.0; 12 * 12];
        for ((index, along), destination) in efforts(system).zip(&self.efforts) {
            along.stiffness(loading.factors[index], nodes, &mut K);
            how.add((&mut K, 12), destination, projected, values);
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
        self.diagonals.round(system, nodes, &forces.on_dependents, weights.acceleration == 0.0);
        let multipliers = &mut forces.multipliers;
        joints::tangents(system, nodes, (&mut self.diagonals, projections), multipliers, weights, values, add);
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
            let damping = &system.mass_damping;
            own[inertia.node] += inertia.tangent(&nodes[inertia.node], &weights, damping.alpha, gyroscopic);
            if let Some(k) = damping.by_place(inertia, nodes).filter(|_| gyroscopic) {
                let mut block = own[inertia.node].fixed_view_mut::<3, 3>(0, 0);
                block += k;
            }
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
            let [f, m] = follower_stiffness(load, *factor, nodes);
            add(load.node, 0, f);
            add(load.node, 3, m);
        }
        for (load, square) in system.centrifugal().iter().zip(&loading.squares) {
            load.add_nodal_stiffness(*square, nodes, own);
        }
        let mut add = |node: usize, row: usize, k: Mat3| {
            let mut block = own[node].fixed_view_mut::<3, 3>(row, 3);
            block += k;
        };
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
        let Scratch { projections, projected, local, .. } = &mut self.scratch;
        let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
        for (mass, destination) in system.consistent_masses().iter().zip(&self.masses) {
            let w = weights.acceleration + mass.alpha * weights.rate;
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

impl Assembly {
    fn add_floating(
        &mut self,
        system: &System,
        (nodes, field): (&[Node], &Vec3),
        weights: TangentWeights,
        values: &mut [f64],
    ) {
        if weights.acceleration == 0.0 && weights.rate == 0.0 && *field == Vec3::zeros() {
            return;
        }
        let Scratch { projections, projected, local, .. } = &mut self.scratch;
        let how = Places { scatter: &self.scatter, blocks: &self.blocks, arms: &self.arms, projections };
        for (mass, destination) in system.floating().iter().zip(&self.floating) {
            let width = 6 * mass.element.nodes().len();
            let K = &mut local[..width * width];
            mass.tangent((nodes, field), &weights, self.gyroscopic && weights.stiffness, K);
            how.add((K, width), destination, projected, values);
        }
    }
}

/// Entries of the largest matrices that are formed together: of a chunk of elements, a mass, or a pair of partners.
fn largest_matrix(system: &System, partners: &[(usize, Partners)]) -> usize {
    let size = |block: &dyn ElementBlock| (block.dofs() * block.nodes(0).len()).pow(2) * block.len().min(CHUNK);
    let masses = system.consistent_masses().iter().map(|m| 9 * m.m.len());
    let pairs = partners.iter().map(|(_, partners)| (6 * partners.most_nodes()).pow(2));
    let floating = system.floating().iter().map(|mass| (6 * mass.element.nodes().len()).pow(2));
    let elements = system.groups.iter().map(|g| size(&*g.block));
    elements.chain(masses).chain(pairs).chain(floating).max().unwrap_or(0)
}

/// The efforts of joints with the indices of their loads, each once.
fn efforts(system: &System) -> impl Iterator<Item = (usize, &LoadedCoordinate)> {
    let coordinates = system.loads.iter().enumerate().filter_map(|(index, load)| Some((index, load.coordinate()?)));
    coordinates.filter(|(_, along)| along.end == 1)
}
