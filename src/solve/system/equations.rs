//! Everything that acts on the nodes of a scene, and the residual of the equation of motion.

use super::centrifugal::CentrifugalLoad;
use super::floating::{FloatingMass, floating_masses};
use super::group::Group;
use super::inertia::{ConsistentMass, Inertia};
use super::joint_loads::{self, JointLoad};
use super::loads::{self, Loading, load_on};
use super::mass_damping::MassDamping;
use super::mass_scaling::MassScaling;
use super::modal_damping::ModalDamping;
use super::multipliers::Multipliers;
use super::node_sums::SumChunk;
use super::parts::beam_ends::BeamEnds;
use super::parts::links::{self, LinkElement};
use super::reduced::{FollowingNodes, resting_groups};
use super::scale::Scale;
use super::thread_partition::{GroupMemory, Partition};
use super::turning_body::TurningBody;
use super::{build, joint_tree, mass_sources, node_sums, plane_motion, thin_axes, thread_partition};
use crate::tolerances::multipliers::{REGULARIZATION, REGULARIZATION_OF_TREES};
use base::math::{Vec3, Vec6, angular, linear, rotation};
use base::snapshot::keep;
use mechanics::constraints::joint::Joint;
use mechanics::constraints::rigid_link::{self, RigidLink};
use mechanics::elements::Force;
use mechanics::materials::Dissipation;
use mechanics::state::{Configuration, Node, State};
use model::{self, Actors, Model};

/// Everything that acts on the nodes: elements, masses, constraints, loads and damping. It is constant over a run.
pub struct System {
    /// Groups of like elements, contacts last.
    pub groups: Vec<Group>,
    /// Number of history variables of all elements.
    pub history: usize,
    /// Lumped inertia, at most one entry for each node, in ascending order of nodes.
    pub inertias: Vec<Inertia>,
    /// The bodies that turn by their angular momentum in implicit schemes.
    turning_bodies: Vec<TurningBody>,
    /// The consistent mass matrices, element by element.
    pub consistent: Vec<ConsistentMass>,
    /// The masses of superelements.
    floating: Vec<FloatingMass>,
    /// The nodes inside of reduced parts.
    following: Vec<FollowingNodes>,
    /// The elements of reduced parts, for their results.
    resting: Vec<Group>,
    /// The dependent nodes, sorted such that a master precedes its dependent nodes.
    pub rigid_links: Vec<RigidLink>,
    /// The joints in the order of the model's list, without the constraint equations that a plane motion does not need.
    pub joints: Vec<Joint>,
    /// ε of the constraint equations.
    regularization: f64,
    /// The links one by one, for the computation of their results.
    pub(super) links: Vec<LinkElement>,
    /// Index of the first group of contacts; these stand last.
    pub(super) contacts: usize,
    /// The loads on nodes.
    pub(super) loads: Vec<model::Load>,
    /// The follower pressures on faces.
    pub(super) pressures: Vec<model::Pressure>,
    /// The centrifugal loads.
    centrifugal: Vec<CentrifugalLoad>,
    /// The joints whose friction grows with their load.
    joint_loads: Vec<JointLoad>,
    /// The ends of the elements of beams, where results are wanted there.
    beam_ends: Option<BeamEnds>,
    /// The mass scaling of elements, if the deck requires it.
    mass_scaling: Option<MassScaling>,
    /// The dampers between nodes and the ground.
    pub(super) nodal_damping: Vec<model::NodalDamping>,
    /// Rayleigh damping of masses.
    pub(super) mass_damping: MassDamping,
    /// Damping of modes.
    modal_damping: ModalDamping,
    /// The tangent may hold the gyroscopic matrix C(r) (37).
    pub(super) gyroscopic: bool,
    /// The global axis normal to the plane of motion, where the scene is plane.
    pub plane: Option<usize>,
    /// True in dynamics. A static analysis has weight but no inertia forces.
    pub(super) dynamic: bool,
}

/// The residual and the constraint forces. [`System::residual`] writes them.
#[derive(Debug, Clone)]
pub struct Forces {
    /// f_ext − f_int − C v − M a at each node, global components; forces on dependent degrees of freedom have been
    /// transferred to the masters.
    pub on_nodes: Vec<Force>,
    /// The forces so transferred, in the order of [`System::rigid_links`]; the tangent needs them.
    pub on_dependents: Vec<Vec3>,
    /// Lagrange multipliers of the joints and violations of their constraint equations.
    pub multipliers: Multipliers,
    partitions: Vec<Partition>,
    chunks: Vec<SumChunk>,
    /// The dissipation of each group of elements; [`System::advance`] writes it.
    spent: Vec<Dissipation>,
    threads: bool,
}

keep!(Forces { on_nodes, on_dependents, multipliers } without { partitions, chunks, spent, threads });

impl Forces {
    /// Zero forces for this number of nodes, to be summed on one thread.
    pub fn new(system: &System, nodes: usize) -> Self {
        let partitions = thread_partition::partition(&system.groups);
        Forces {
            on_nodes: vec![[0.0; 6]; nodes],
            on_dependents: vec![Vec3::zeros(); system.rigid_links.len()],
            multipliers: Multipliers::new(system.multipliers(), system.regularization),
            chunks: node_sums::chunks(&partitions, &system.inertias, nodes),
            partitions,
            spent: vec![Dissipation::default(); system.groups.len()],
            threads: false,
        }
    }

    /// These forces, summed on several threads if the model is large.
    pub fn on_threads(self, threads: usize) -> Self {
        Forces { threads: threads > 1, ..self }
    }
}

impl System {
    /// ε of the constraint equations.
    pub(super) fn regularization(&self) -> f64 {
        self.regularization
    }

    /// Stores the loads of joints with load-dependent friction at the end of a step of length `dt`, which is zero at a start or a jump.
    pub fn remember_joint_loads(&self, state: &mut State, dt: f64) {
        self.joint_loads.iter().for_each(|load| load.remember(&self.joints, state, dt));
    }

    /// The ends of the elements of beams, where results are wanted there.
    pub(super) fn beam_ends(&self) -> Option<&BeamEnds> {
        self.beam_ends.as_ref()
    }

    /// The mass scaling of elements, if the deck requires it.
    pub fn mass_scaling(&self) -> Option<&MassScaling> {
        self.mass_scaling.as_ref()
    }

    /// The global axis normal to a plane that nothing moves the model out of, whether or not the deck restricts it to this plane.
    pub fn plane_that_holds(&self, model: &Model) -> Option<usize> {
        plane_motion::that_holds(model, &self.inertias, &self.rigid_links)
    }

    /// The bodies that turn by their angular momentum in implicit schemes, in ascending order of nodes.
    pub fn turning_bodies(&self) -> &[TurningBody] {
        &self.turning_bodies
    }

    /// Builds the system from the model at its initial positions.
    ///
    /// # Errors
    /// The rigid links form a cycle, which [`model`] excludes.
    pub fn new(model: &Model) -> Result<System, String> {
        Self::with(model, plane_motion::normal)
    }

    /// The system with all directions, whether or not the scene moves in a plane.
    ///
    /// # Errors
    /// As for [`System::new`].
    pub fn in_space(model: &Model) -> Result<System, String> {
        Self::with(model, |_, _, _| None)
    }

    fn with(
        model: &Model,
        normal: impl Fn(&Model, &[Inertia], &[RigidLink]) -> Option<usize>,
    ) -> Result<System, String> {
        let x: Vec<Vec3> = model.nodes.iter().map(|n| n.x).collect();
        let rigid_links =
            model.constraints.dependents.iter().map(|r| RigidLink::new(r.node, r.master, &x, r.dofs)).collect();
        let rigid_links = rigid_link::sorted(rigid_links, x.len()).ok_or("the attachments form a cycle")?;
        let following = model.reductions.iter().map(|of| FollowingNodes::new(of, &x)).collect::<Option<_>>();
        let following: Vec<FollowingNodes> =
            following.ok_or("the matrices of a reduced part have not been computed")?;
        let (mut inertias, consistent) = mass_sources::masses(model, &x);
        let plane = normal(model, &inertias, &rigid_links);
        thin_axes::raise(model, (&mut inertias, &consistent), &rigid_links, plane);
        let groups = build::groups(model, &x, plane);
        let mass_scaling = MassScaling::new(model, &x, &groups, &mut inertias);
        let joints = build::joints(model, &x, plane);
        let turning_bodies = TurningBody::of(model, (&mut inertias, &consistent), &rigid_links, plane);
        let contacts = groups.iter().position(|group| group.kind.is_unilateral());
        let mut system = System {
            history: groups.last().map_or(0, |group| group.history.end),
            contacts: contacts.unwrap_or(groups.len()),
            groups,
            inertias,
            turning_bodies,
            consistent,
            floating: floating_masses(model, &x),
            following,
            resting: resting_groups(model, &x),
            regularization: match joint_tree::is_tree(model, &joints, &rigid_links) {
                true => REGULARIZATION_OF_TREES,
                false => REGULARIZATION,
            },
            rigid_links,
            joints,
            gyroscopic: model.solution.iteration.gyroscopic != model::Gyroscopic::Right,
            plane,
            links: links::elements(model, &x),
            joint_loads: Vec::new(),
            beam_ends: BeamEnds::wanted(model).then(|| BeamEnds::new(model, &x, mass_scaling.as_ref())),
            mass_scaling,
            loads: model.loading.nodal.clone(),
            pressures: model.loading.pressures.clone(),
            centrifugal: model.loading.centrifugal.iter().map(|load| CentrifugalLoad::new(model, &x, load)).collect(),
            nodal_damping: model.damping.nodal.clone(),
            mass_damping: MassDamping::of(model),
            modal_damping: ModalDamping::new(if model.analysis.is_dynamic() { &model.damping.modal } else { &[] }),
            dynamic: model.analysis.kind == model::AnalysisKind::Dynamic,
        };
        system.joint_loads = joint_loads::find(model, &system.joints, (&system.links, &system.groups));
        Ok(system)
    }

    /// The inertias, rigid links and joints without elements, loads and damping: with them joints are closed and
    /// explicit accelerations found.
    pub fn bare(&self) -> System {
        System {
            groups: Vec::new(),
            contacts: 0,
            history: 0,
            inertias: self.inertias.clone(),
            turning_bodies: Vec::new(),
            consistent: self.consistent.clone(),
            floating: self.floating.clone(),
            following: Vec::new(),
            resting: Vec::new(),
            rigid_links: self.rigid_links.clone(),
            joints: self.joints.clone(),
            regularization: self.regularization,
            links: Vec::new(),
            joint_loads: Vec::new(),
            beam_ends: None,
            mass_scaling: None,
            loads: Vec::new(),
            pressures: Vec::new(),
            centrifugal: Vec::new(),
            nodal_damping: Vec::new(),
            mass_damping: MassDamping::default(),
            modal_damping: ModalDamping::default(),
            gyroscopic: false,
            plane: self.plane,
            dynamic: self.dynamic,
        }
    }

    /// Sums f_ext − f_int − C v − M a at each node and transfers the forces on dependent degrees of freedom to their
    /// masters (58). Returns the magnitudes of the terms.
    pub fn residual(&self, now: &Configuration, loading: &Loading, forces: &mut Forces) -> Scale {
        self.sum_forces(now, loading, forces, None)
    }

    /// Sums forces as [`System::residual`] does and writes the history variables at `now` into `history`, as [`System::update_history`]
    /// does for the whole of the way, with each material computed once. Returns the dissipation.
    pub fn advance(
        &self,
        now: &Configuration,
        loading: &Loading,
        forces: &mut Forces,
        history: &mut [f64],
    ) -> Dissipation {
        self.sum_forces(now, loading, forces, Some(history));
        thread_partition::sum_spent(&forces.spent)
    }

    fn sum_forces(
        &self,
        now: &Configuration,
        loading: &Loading,
        forces: &mut Forces,
        history: Option<&mut [f64]>,
    ) -> Scale {
        let nodes = now.nodes;
        let Forces { on_nodes, partitions, chunks, spent, threads, .. } = forces;
        let F = &mut on_nodes[..];
        let memory = history.map(|history| GroupMemory { history, spent });
        let add = |inertias: &[Inertia], (F, first): (&mut [Force], usize), scale: &mut Scale| {
            self.add_inertia_forces(inertias, (nodes, &loading.field), (F, first), scale)
        };
        let mut scale = Scale::default();
        if partitions.is_empty() {
            F.fill([0.0; 6]);
            thread_partition::run(&self.groups, now, memory, F);
            scale.include(F);
            add(&self.inertias, (F, 0), &mut scale);
        } else {
            thread_partition::run_partitions(partitions, &self.groups, now, memory, *threads);
            scale = node_sums::sum(chunks, partitions, (&self.inertias, &add), *threads, F);
        }
        let relative = |node: usize| self.mass_damping.relative(node, nodes)[0];
        let drag = self.mass_damping.acts().then_some(&relative as &dyn Fn(usize) -> Vec3);
        for mass in &self.consistent {
            mass.add_forces(nodes, &loading.field, self.dynamic, drag, F);
        }
        let drag = self.mass_damping.acts().then_some(&self.mass_damping);
        for mass in &self.floating {
            mass.add_forces(nodes, &loading.field, self.dynamic, drag, F);
            scale.include_force(&(mass.element.total_mass() * loading.field));
        }
        for damping in &self.nodal_damping {
            let node = &nodes[damping.node];
            mechanics::elements::subtract(&mut F[damping.node], 0, &(damping.translation * node.v));
            mechanics::elements::subtract(&mut F[damping.node], 3, &(damping.rotation * node.omega));
        }
        self.modal_damping.add(nodes, Some(F));
        self.add_loads(nodes, loading, F, &mut scale);
        self.subtract_joint_forces(nodes, forces, &mut scale);
        self.transfer_to_masters(nodes, forces);
        scale
    }

    /// Adds weight, inertia and Rayleigh damping forces of some of the inertias to `F`, whose first entry belongs to node `first`.
    fn add_inertia_forces(
        &self,
        inertias: &[Inertia],
        (nodes, field): (&[Node], &Vec3),
        (F, first): (&mut [Force], usize),
        scale: &mut Scale,
    ) {
        for inertia in inertias {
            let node = &nodes[inertia.node];
            let mut f = inertia.force(node, field, self.dynamic, scale);
            if self.mass_damping.acts() {
                self.mass_damping.add(inertia, nodes, &mut f);
            }
            for (sum, f) in F[inertia.node - first].iter_mut().zip(f) {
                *sum += f;
            }
        }
    }

    /// Writes loads and weight alone, without inertia forces. With the rates of the loads as `loading` this is ∂r/∂t at
    /// fixed positions.
    pub fn external(&self, nodes: &[Node], loading: &Loading, forces: &mut Forces) {
        let F = &mut forces.on_nodes[..];
        let mut scale = Scale::default();
        F.fill([0.0; 6]);
        for inertia in &self.inertias {
            let f = inertia.force(&nodes[inertia.node], &loading.field, false, &mut scale);
            for (sum, f) in F[inertia.node].iter_mut().zip(f) {
                *sum += f;
            }
        }
        for mass in &self.consistent {
            mass.add_forces(nodes, &loading.field, false, None, F);
        }
        for mass in &self.floating {
            mass.add_forces(nodes, &loading.field, false, None, F);
        }
        self.add_loads(nodes, loading, F, &mut scale);
        self.transfer_to_masters(nodes, forces);
    }

    fn add_loads(&self, nodes: &[Node], loading: &Loading, F: &mut [Force], scale: &mut Scale) {
        for (load, factor) in self.loads.iter().zip(&loading.factors) {
            let (f, m) = load_on(load, *factor, nodes);
            let f = [f.x, f.y, f.z, m.x, m.y, m.z];
            scale.include(&[f]);
            for (sum, f) in F[load.node].iter_mut().zip(f) {
                *sum += f;
            }
        }
        for (load, p) in self.pressures.iter().zip(&loading.pressures) {
            for face in &load.faces {
                scale.force = scale.force.max(face.add_forces(*p, nodes, F));
            }
        }
        for (load, square) in self.centrifugal.iter().zip(&loading.squares) {
            scale.force = scale.force.max(load.add_forces(*square, nodes, F));
        }
    }

    /// Transfers the forces on dependent nodes to their masters, the last in a chain first, and keeps them separately for the tangent.
    pub(super) fn transfer_to_masters(&self, nodes: &[Node], forces: &mut Forces) {
        let F = &mut forces.on_nodes[..];
        self.following.iter().for_each(|following| following.transfer(nodes, F));
        for (dependent, force) in self.rigid_links.iter().zip(&mut forces.on_dependents).rev() {
            *force = Vec3::new(F[dependent.node][0], F[dependent.node][1], F[dependent.node][2]);
            dependent.transfer_to_masters(nodes, F);
        }
    }

    /// Work of loads and weight between two configurations. Forces at nodes do it by their mean at the ends, follower
    /// pressures by the volume that their faces sweep.
    pub fn external_work(&self, from: (&[Node], &Loading), to: (&[Node], &Loading)) -> f64 {
        let field = 0.5 * (from.1.field + to.1.field);
        let moved = |node: usize| to.0[node].relative_position(&from.0[node]);
        let mut work = 0.0;
        if field != Vec3::zeros() {
            work += self.inertias.iter().map(|i| i.weighing * field.dot(&moved(i.node))).sum::<f64>();
            let weight = |mass: &ConsistentMass| mass.pairs().map(|(a, _, m)| m * field.dot(&moved(a))).sum::<f64>();
            work += self.consistent.iter().map(weight).sum::<f64>();
            work += self.floating.iter().map(|mass| mass.work(&field, from.0, to.0)).sum::<f64>();
        }
        let all = Actors {
            nodal: 0..self.loads.len(),
            pressures: 0..self.pressures.len(),
            centrifugal: 0..self.centrifugal.len(),
            ..Actors::default()
        };
        self.add_load_work(&all, from, to, &mut work);
        work
    }

    /// Adds the work of some of the loads between two configurations, as [`System::external_work`] has it.
    pub fn add_load_work(&self, of: &Actors, from: (&[Node], &Loading), to: (&[Node], &Loading), work: &mut f64) {
        for i in of.nodal.clone() {
            *work += loads::load_work(&self.loads[i], (from.1.factors[i], from.0), (to.1.factors[i], to.0));
        }
        for i in of.pressures.clone() {
            let ends = [from.1.pressures[i], to.1.pressures[i]];
            *work += self.pressures[i].faces.iter().map(|face| face.work(ends, from.0, to.0)).sum::<f64>();
        }
        for i in of.centrifugal.clone() {
            *work += self.centrifugal[i].work((from.0, from.1.squares[i]), (to.0, to.1.squares[i]));
        }
    }

    /// The sum of the forces of some of the loads; `forces` is memory.
    pub fn load_force(&self, of: &Actors, nodes: &[Node], loading: &Loading, forces: &mut Vec<Force>) -> Vec3 {
        let of_load = |i: usize| load_on(&self.loads[i], loading.factors[i], nodes).0;
        let mut sum: Vec3 = of.nodal.clone().map(of_load).sum();
        for i in of.centrifugal.clone() {
            sum += self.centrifugal[i].total(loading.squares[i], nodes);
        }
        forces.clear();
        forces.resize(if of.pressures.is_empty() { 0 } else { nodes.len() }, [0.0; 6]);
        for i in of.pressures.clone() {
            for face in &self.pressures[i].faces {
                face.add_forces(loading.pressures[i], nodes, forces);
            }
        }
        forces.iter().fold(sum, |sum, f| sum + Vec3::new(f[0], f[1], f[2]))
    }

    /// The work of loads and weight in a load step by the mean of their values at its ends, and the sum of its terms without signs. The
    /// third value, ½ Σ |Δf| |Δq|, bounds the departure from the work along a path with growing loads and displacements.
    pub fn load_work(&self, from: (&[Node], &Loading), to: (&[Node], &Loading)) -> [f64; 3] {
        let mut sums = [self.external_work(from, to), 0.0, 0.0];
        let mut add = |old: Vec3, new: Vec3, moved: Vec3| {
            sums[1] += 0.5 * (old.norm() + new.norm()) * moved.norm();
            sums[2] += 0.5 * (new - old).norm() * moved.norm();
        };
        let moved = |node: usize| to.0[node].relative_position(&from.0[node]);
        for inertia in &self.inertias {
            add(inertia.weighing * from.1.field, inertia.weighing * to.1.field, moved(inertia.node));
        }
        for (a, _, m) in self.consistent.iter().flat_map(ConsistentMass::pairs) {
            add(m * from.1.field, m * to.1.field, moved(a));
        }
        for mass in &self.floating {
            let m = mass.element.total_mass();
            add(m * from.1.field, m * to.1.field, mass.moved(from.0, to.0));
        }
        for (load, (f0, f1)) in self.loads.iter().zip(from.1.factors.iter().zip(&to.1.factors)) {
            let (a, b) = (&from.0[load.node], &to.0[load.node]);
            let ((f_a, m_a), (f_b, m_b)) = (load_on(load, *f0, from.0), load_on(load, *f1, to.0));
            add(f_a, f_b, moved(load.node));
            add(m_a, m_b, rotation::log(&(b.rotation * a.rotation.conjugate())));
        }
        for (load, (p0, p1)) in self.pressures.iter().zip(from.1.pressures.iter().zip(&to.1.pressures)) {
            for face in &load.faces {
                let areas = [from.0, to.0].map(|nodes| face.areas(|node| nodes[node].x));
                for (k, &node) in face.nodes().iter().enumerate() {
                    add(*p0 * areas[0][k], *p1 * areas[1][k], moved(node));
                }
            }
        }
        for ((load, old), new) in self.centrifugal.iter().zip(&from.1.squares).zip(&to.1.squares) {
            load.along((from.0, *old), (to.0, *new), &mut |[old, new], way| add(old, new, way));
        }
        sums
    }

    /// True if loads and links have a potential (see [`Load::has_potential`](model::Load::has_potential)), so that the tangent is symmetric and
    /// its eigenvalues decide about stability. Pressure counts as if all edges were restrained.
    pub fn has_potential(&self, normal: Option<usize>) -> bool {
        self.links_have_potential() && self.loads.iter().all(|load| load.has_potential(normal))
    }

    /// True if all elements have a potential.
    pub fn links_have_potential(&self) -> bool {
        self.groups.iter().all(|group| group.block.has_potential())
    }

    /// Energy that elements store.
    pub fn stored_energy(&self, now: &Configuration, threads: usize) -> f64 {
        thread_partition::sum(&self.groups, self.uses_threads(threads), &|group| {
            group.block.energy(&group.configuration(now))
        })
    }

    /// Writes the history variables at the fraction `part` of the way from the last accepted state to `now` into `history`. Returns the
    /// dissipation of plastic strains on this way.
    pub fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64], threads: usize) -> Dissipation {
        thread_partition::sum_with(&self.groups, history, self.uses_threads(threads), &|group, history| {
            if group.history.is_empty() {
                return Dissipation::default();
            }
            group.block.update_history(&group.configuration(now), part, history)
        })
    }

    /// True where an element or a link may fail.
    pub fn can_fail(&self) -> bool {
        self.groups.iter().any(|group| group.block.can_fail())
    }

    /// True where the elements are many enough for several threads to pay.
    pub fn has_many_elements(&self) -> bool {
        thread_partition::is_large(&self.groups)
    }

    /// True where several threads share the elements.
    pub(super) fn uses_threads(&self, threads: usize) -> bool {
        threads > 1 && self.has_many_elements()
    }

    /// Power that viscous damping dissipates: dampers, nodal and Rayleigh damping.
    pub fn damping_power(&self, now: &Configuration, threads: usize) -> f64 {
        let nodes = now.nodes;
        let mut power: f64 = thread_partition::sum(&self.groups, self.uses_threads(threads), &|group| {
            group.block.damping_power(&group.configuration(now))
        });
        power += self.drag_powers(nodes)[0];
        for d in &self.nodal_damping {
            let node = &nodes[d.node];
            power += d.translation * node.v.norm_squared() + d.rotation * node.omega.norm_squared();
        }
        power + self.modal_damping.add(nodes, None)
    }

    /// The centrifugal loads, in the order of the model's list.
    pub fn centrifugal(&self) -> &[CentrifugalLoad] {
        &self.centrifugal
    }

    /// Rayleigh damping of masses.
    pub fn mass_damping(&self) -> &MassDamping {
        &self.mass_damping
    }

    /// Damping of modes.
    pub fn modal_damping(&self) -> &ModalDamping {
        &self.modal_damping
    }

    /// Power of the supports that move the reference frames of mass damping, besides the power of their reactions.
    pub fn carrying_power(&self, nodes: &[Node]) -> f64 {
        if self.dynamic && self.mass_damping.has_frames() { self.drag_powers(nodes)[1] } else { 0.0 }
    }

    /// The powers of mass damping, as in [`MassDamping::powers`].
    fn drag_powers(&self, nodes: &[Node]) -> [f64; 2] {
        let mut powers = self.mass_damping.powers((&self.inertias, &self.consistent), nodes);
        for mass in &self.floating {
            let own = mass.powers(&self.mass_damping, nodes);
            powers = [powers[0] + own[0], powers[1] + own[1]];
        }
        powers
    }

    /// The nodes inside of reduced parts.
    pub fn following(&self) -> &[FollowingNodes] {
        &self.following
    }

    /// Writes the motion of the nodes inside of reduced parts.
    pub fn recover(&self, nodes: &mut [Node]) {
        self.following.iter().for_each(|following| following.recover(nodes));
    }

    /// The groups that give results, in the order of the parts: the elements of reduced parts in place of their superelements.
    pub fn shown_groups(&self) -> impl Iterator<Item = &Group> + Clone {
        let mut acting = self.groups.iter().filter(|group| !group.reduces).peekable();
        let mut resting = self.resting.iter().peekable();
        std::iter::from_fn(move || match (acting.peek(), resting.peek()) {
            (Some(first), Some(second)) if first.part > second.part => resting.next(),
            (None, _) => resting.next(),
            _ => acting.next(),
        })
    }

    /// The masses of superelements.
    pub fn floating(&self) -> &[FloatingMass] {
        &self.floating
    }

    /// The nodes of superelements with mass.
    pub fn floating_nodes(&self) -> impl Iterator<Item = usize> {
        self.floating.iter().flat_map(|mass| mass.element.nodes()).copied()
    }

    /// Dampers between nodes and the ground.
    pub fn nodal_damping(&self) -> &[model::NodalDamping] {
        &self.nodal_damping
    }

    /// True where a damper has its steepest force at rest.
    pub fn damps_most_at_rest(&self) -> bool {
        self.groups.iter().any(|group| group.block.damps_most_at_rest())
    }

    /// True where any viscous damping acts.
    pub fn is_damped(&self) -> bool {
        self.mass_damping.acts()
            || self.modal_damping.acts()
            || !self.nodal_damping.is_empty()
            || self.groups.iter().any(|g| g.block.is_damped())
    }

    /// True where the scene has links.
    pub fn has_links(&self) -> bool {
        !self.links.is_empty()
    }

    /// True where the equation of motion is linear in the motion, with constant matrices.
    pub fn is_linear(&self) -> bool {
        self.groups.iter().all(|g| g.block.is_linear())
            && self.rigid_links.is_empty()
            && self.joints.is_empty()
            && self.loads.iter().all(|l| !l.follower && l.coordinate().is_none())
            && self.pressures.is_empty()
            && self.centrifugal.is_empty()
            && !self.modal_damping.acts()
    }
}

impl System {
    /// Writes the small motions (u, θ) of dependent nodes from those of their masters, at the current positions: D of
    /// (48).
    pub fn project(&self, nodes: &[Node], motions: &mut [Vec6]) {
        for dependent in &self.rigid_links {
            let carried = dependent.D(nodes) * motions[dependent.master];
            for i in (0..6).filter(|&i| dependent.dofs[i]) {
                motions[dependent.node][i] = carried[i];
            }
        }
    }

    /// Like [`System::project`], with the small motions of nodes inside of reduced parts too.
    pub fn carry_all(&self, nodes: &[Node], motions: &mut [Vec6]) {
        self.project(nodes, motions);
        self.following.iter().for_each(|following| following.carry(nodes, motions));
    }

    /// Multiplies the small motions of all nodes by M. The products are written into `forces.on_nodes`, transferred to
    /// independent nodes; `motions` receives those of dependent nodes.
    pub fn apply_mass(&self, nodes: &[Node], motions: &mut [Vec6], forces: &mut Forces) {
        self.project(nodes, motions);
        let F = &mut forces.on_nodes[..];
        F.fill([0.0; 6]);
        for inertia in &self.inertias {
            let of = &motions[inertia.node];
            let mut f = [0.0; 6];
            for i in 0..3 {
                f[i] = inertia.mass * of[i];
            }
            if inertia.rotary {
                let m = inertia.J(&nodes[inertia.node]) * angular(of);
                f[3..].copy_from_slice(m.as_slice());
            }
            F[inertia.node] = f;
        }
        for mass in &self.consistent {
            for (a, b, m) in mass.pairs() {
                mechanics::elements::subtract(&mut F[a], 0, &(-m * linear(&motions[b])));
            }
        }
        self.floating.iter().for_each(|mass| mass.subtract_product(nodes, motions, -1.0, F));
        self.transfer_to_masters(nodes, forces);
    }

    /// Writes the forces α M q of Rayleigh damping, transferred to independent nodes, for small motions q of all nodes.
    pub fn drag_of(&self, nodes: &[Node], motions: &[Vec6], forces: &mut Forces) {
        let F = &mut forces.on_nodes[..];
        F.fill([0.0; 6]);
        for inertia in &self.inertias {
            let q = &motions[inertia.node];
            let (mass, J) = inertia.drag(&nodes[inertia.node], self.mass_damping.alpha);
            mechanics::elements::subtract(&mut F[inertia.node], 0, &(-mass * linear(q)));
            if let Some(J) = J {
                mechanics::elements::subtract(&mut F[inertia.node], 3, &-(J * angular(q)));
            }
        }
        for mass in &self.consistent {
            for (a, b, m) in mass.pairs() {
                mechanics::elements::subtract(&mut F[a], 0, &(-mass.alpha * m * linear(&motions[b])));
            }
        }
        self.floating.iter().for_each(|mass| mass.subtract_product(nodes, motions, -mass.alpha, F));
        self.transfer_to_masters(nodes, forces);
    }

    /// The consistent mass matrices, element by element.
    pub fn consistent_masses(&self) -> &[ConsistentMass] {
        &self.consistent
    }
}
