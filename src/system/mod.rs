//! The equation of motion of a scene: residual, tangent, energies, for any state of its nodes. Bodies are seen here for
//! the first time: what an element does to a node that rides on a body is handed to the body.

pub mod assembly;
mod build;
mod contacts;
mod dofs;
pub mod energy;
mod inertia;
pub mod joints;
mod lanes;
pub mod masses;
mod motion;
mod plane;
pub mod results;
pub mod ties;
mod tiles;

pub use contacts::ContactState;
pub use dofs::{DofMap, NodeRows};
pub use inertia::Inertia;
pub use joints::{JointState, Multipliers};
pub use motion::{Drive, Prescribed, Side, between};
pub use results::{LinkState, SectionPoint, ShellState};

use crate::constraints::attachment::{self, Attachment};
use crate::constraints::joint::Joint;
use crate::elements::{ElementBlock, Force};
use crate::materials::Dissipation;
use crate::math::{Mat3, Vec3, larger, rotation, skew};
use crate::model::{self, Model, PartKind};
use crate::state::{Configuration, Node};
use inertia::ConsistentMass;
use lanes::Lane;
use std::ops::Range;

/// A group of like elements, of one part: all of them, or some in a row where they are many.
pub struct Group {
    pub block: Box<dyn ElementBlock>,
    pub kind: PartKind,
    /// Place in [`Model::parts`] of the part; of links, which share groups, that of the first.
    pub part: usize,
    /// The part's number of its first element.
    pub first: usize,
    /// Its share of [`crate::state::State::history`].
    pub history: Range<usize>,
}

impl Group {
    /// The motion with this group's past alone.
    #[inline]
    pub fn share<'a>(&self, now: &Configuration<'a>) -> Configuration<'a> {
        Configuration { history: &now.history[self.history.clone()], ..*now }
    }
}

/// Everything that acts on the nodes. Constant over a run.
pub struct System {
    pub groups: Vec<Group>,
    /// Numbers that material points remember.
    pub history: usize,
    /// At most one per node, by node.
    pub inertias: Vec<Inertia>,
    consistent: Vec<ConsistentMass>,
    /// Masters before their riders.
    pub attachments: Vec<Attachment>,
    /// In the order of the model's list, without the rows that a plane motion does not need.
    pub joints: Vec<Joint>,
    watched: Vec<results::Watched>,
    /// Where their groups begin; they are the last.
    contacts: usize,
    loads: Vec<model::Load>,
    pressures: Vec<model::Pressure>,
    nodal_damping: Vec<model::NodalDamping>,
    mass_damping: f64,
    /// The matrix may hold C(r) (37).
    gyroscopic: bool,
    /// The global axis normal to the motion, where the scene is plane.
    pub plane: Option<usize>,
    /// Inertia does not act in a static analysis; weight does.
    dynamic: bool,
}

/// Loads at the instant of equilibrium.
#[derive(Debug, Clone, Default)]
pub struct Loading {
    /// Of the model's loads.
    pub factors: Vec<f64>,
    /// The model's pressures that follow, with their factors.
    pub pressures: Vec<f64>,
    /// The acceleration that every mass feels.
    pub field: Vec3,
}

/// What acts, as the residual leaves it. Written by [`System::residual`].
#[derive(Debug, Clone)]
pub struct Forces {
    /// f_ext − f_int − C v − M a per node; what falls on a constrained direction has been handed to the master.
    pub on_nodes: Vec<Force>,
    /// The forces so handed over, in the order of [`System::attachments`].
    pub on_riders: Vec<Vec3>,
    pub multipliers: Multipliers,
    lanes: Vec<Lane>,
    threads: bool,
}

impl Forces {
    /// For one thread.
    pub fn new(system: &System, nodes: usize) -> Self {
        Forces {
            on_nodes: vec![[0.0; 6]; nodes],
            on_riders: vec![Vec3::zeros(); system.attachments.len()],
            multipliers: Multipliers::new(system.multipliers()),
            lanes: lanes::lanes(system),
            threads: false,
        }
    }

    /// The same, summed on several threads where that pays.
    pub fn on_threads(self, threads: usize) -> Self {
        Forces { threads: threads > 1, ..self }
    }
}

/// Magnitudes against which a residual is judged.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Scale {
    pub force: f64,
    pub moment: f64,
}

impl Scale {
    #[inline]
    fn meet_force(&mut self, f: &Vec3) {
        self.force = f.iter().fold(self.force, |most, f| larger(most, f.abs()));
    }

    #[inline]
    fn meet_moment(&mut self, m: &Vec3) {
        self.moment = m.iter().fold(self.moment, |most, m| larger(most, m.abs()));
    }

    #[inline]
    fn meet(&mut self, forces: &[Force]) {
        let mut most = [0.0; 6];
        for f in forces {
            for i in 0..6 {
                most[i] = larger(most[i], f[i].abs());
            }
        }
        self.force = larger(self.force, larger(most[0], larger(most[1], most[2])));
        self.moment = larger(self.moment, larger(most[3], larger(most[4], most[5])));
    }
}

impl System {
    /// # Errors
    /// A cycle among attachments, which [`crate::model`] excludes.
    pub fn new(model: &Model) -> Result<System, String> {
        let x: Vec<Vec3> = model.nodes.iter().map(|n| n.x).collect();
        let attachments =
            model.constraints.dependents.iter().map(|r| Attachment::new(r.node, r.master, &x, r.dofs)).collect();
        let attachments = attachment::sorted(attachments, x.len()).ok_or("the attachments form a cycle")?;
        let (inertias, consistent) = build::masses(model, &x);
        let plane = plane::normal(model, &inertias, &attachments);
        let (groups, watched) = build::groups(model, &x, plane);
        let joints = build::joints(model, &x, plane);
        let contacts = groups.iter().position(|group| group.kind == PartKind::Contact);
        Ok(System {
            history: groups.last().map_or(0, |group| group.history.end),
            contacts: contacts.unwrap_or(groups.len()),
            groups,
            inertias,
            consistent,
            attachments,
            joints,
            gyroscopic: model.solution.iteration.gyroscopic != model::Gyroscopic::Right,
            plane,
            watched,
            loads: model.loading.nodal.clone(),
            pressures: model.loading.pressures.clone(),
            nodal_damping: model.damping.nodal.clone(),
            mass_damping: model.damping.mass_factor,
            dynamic: model.analysis.kind == model::AnalysisKind::Dynamic,
        })
    }

    /// Masses at nodes, what rides on what, and the joints, without all that resists: what joints are closed with.
    pub fn bare(&self) -> System {
        System {
            groups: Vec::new(),
            contacts: 0,
            history: 0,
            inertias: self.inertias.clone(),
            consistent: self.consistent.clone(),
            attachments: self.attachments.clone(),
            joints: self.joints.clone(),
            watched: Vec::new(),
            loads: Vec::new(),
            pressures: Vec::new(),
            nodal_damping: Vec::new(),
            mass_damping: 0.0,
            gyroscopic: false,
            plane: self.plane,
            dynamic: self.dynamic,
        }
    }

    /// Sums f_ext − f_int − C v − M a per node and hands the forces on constrained directions to their masters (58).
    /// Returns the magnitude of what was summed.
    pub fn residual(&self, now: &Configuration, loading: &Loading, forces: &mut Forces) -> Scale {
        let nodes = now.nodes;
        let F = &mut forces.on_nodes[..];
        F.fill([0.0; 6]);
        let mut scale = Scale::default();
        lanes::subtract_forces(&self.groups, now, &mut forces.lanes, forces.threads, F);
        scale.meet(F);
        for inertia in &self.inertias {
            let node = &nodes[inertia.node];
            let mut f = inertia.force(node, &loading.field, self.dynamic, &mut scale);
            if self.mass_damping > 0.0 {
                inertia.add_damping(node, self.mass_damping, &mut f);
            }
            for (sum, f) in F[inertia.node].iter_mut().zip(f) {
                *sum += f;
            }
        }
        for mass in &self.consistent {
            mass.add_forces(nodes, &loading.field, self.dynamic, self.mass_damping, F);
        }
        for damping in &self.nodal_damping {
            let node = &nodes[damping.node];
            crate::elements::subtract(&mut F[damping.node], 0, &(damping.translation * node.v));
            crate::elements::subtract(&mut F[damping.node], 3, &(damping.rotation * node.omega));
        }
        self.add_loads(nodes, loading, F, &mut scale);
        self.join(nodes, forces, &mut scale);
        self.lift(nodes, forces);
        scale
    }

    /// Loads and weight alone, in a static analysis: with rates for a loading, how the residual changes with the time.
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
            mass.add_forces(nodes, &loading.field, false, 0.0, F);
        }
        self.add_loads(nodes, loading, F, &mut scale);
        self.lift(nodes, forces);
    }

    fn add_loads(&self, nodes: &[Node], loading: &Loading, F: &mut [Force], scale: &mut Scale) {
        for (load, factor) in self.loads.iter().zip(&loading.factors) {
            let (f, m) = load_on(load, *factor, &nodes[load.node]);
            let f = [f.x, f.y, f.z, m.x, m.y, m.z];
            scale.meet(&[f]);
            for (sum, f) in F[load.node].iter_mut().zip(f) {
                *sum += f;
            }
        }
        for (load, p) in self.pressures.iter().zip(&loading.pressures) {
            for face in &load.faces {
                scale.force = scale.force.max(face.add_forces(*p, nodes, F));
            }
        }
    }

    fn lift(&self, nodes: &[Node], forces: &mut Forces) {
        let F = &mut forces.on_nodes[..];
        for (rider, force) in self.attachments.iter().zip(&mut forces.on_riders).rev() {
            *force = Vec3::new(F[rider.node][0], F[rider.node][1], F[rider.node][2]);
            rider.lift(nodes, F);
        }
    }

    /// Work of loads and weight over a step, by the mean of the forces at its ends; of pressures that follow, by the volume
    /// that faces sweep.
    pub fn external_work(&self, from: (&[Node], &Loading), to: (&[Node], &Loading)) -> f64 {
        let field = 0.5 * (from.1.field + to.1.field);
        let moved = |node: usize| to.0[node].relative_position(&from.0[node]);
        let mut work = 0.0;
        if field != Vec3::zeros() {
            work += self.inertias.iter().map(|i| i.mass * field.dot(&moved(i.node))).sum::<f64>();
            let weight = |mass: &ConsistentMass| mass.pairs().map(|(a, _, m)| m * field.dot(&moved(a))).sum::<f64>();
            work += self.consistent.iter().map(weight).sum::<f64>();
        }
        for (load, (f0, f1)) in self.loads.iter().zip(from.1.factors.iter().zip(&to.1.factors)) {
            let (a, b) = (&from.0[load.node], &to.0[load.node]);
            let ((f_a, m_a), (f_b, m_b)) = (load_on(load, *f0, a), load_on(load, *f1, b));
            work += 0.5 * (f_a + f_b).dot(&b.relative_position(a));
            if load.moment != Vec3::zeros() {
                work += 0.5 * (m_a + m_b).dot(&rotation::log(&(b.q * a.q.conjugate())));
            }
        }
        for (load, (p0, p1)) in self.pressures.iter().zip(from.1.pressures.iter().zip(&to.1.pressures)) {
            work += load.faces.iter().map(|face| face.work([*p0, *p1], from.0, to.0)).sum::<f64>();
        }
        work
    }

    /// Writes what material points will remember of `part` of the way from the last state to `now` into `history`; returns what
    /// became of the work of plastic strains on it.
    pub fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64], threads: usize) -> Dissipation {
        lanes::sum_with(&self.groups, history, self.splits(threads), &|group, history| {
            if group.history.is_empty() {
                return Dissipation::default();
            }
            group.block.update_history(&group.share(now), part, history)
        })
    }

    /// True where work on elements is worth that many threads.
    fn splits(&self, threads: usize) -> bool {
        threads > 1 && lanes::is_large(&self.groups)
    }

    /// Power that dampers take.
    pub fn damping_power(&self, now: &Configuration, threads: usize) -> f64 {
        let nodes = now.nodes;
        let mut power: f64 =
            lanes::sum(&self.groups, self.splits(threads), &|group| group.block.damping_power(&group.share(now)));
        if self.mass_damping > 0.0 {
            let twice = 2.0 * self.mass_damping;
            power += self.inertias.iter().map(|i| twice * i.kinetic_energy(&nodes[i.node])).sum::<f64>();
            power += self.consistent.iter().map(|m| twice * m.kinetic_energy(nodes)).sum::<f64>();
        }
        for d in &self.nodal_damping {
            let node = &nodes[d.node];
            power += d.translation * node.v.norm_squared() + d.rotation * node.omega.norm_squared();
        }
        power
    }

    /// True where fibres that strain alike in a plane motion are one.
    pub fn merges_fibres(&self, part: &model::Beam) -> bool {
        part.yielding.is_some() && build::in_plane(part, self.plane).is_some()
    }

    pub fn nodal_damping(&self) -> &[model::NodalDamping] {
        &self.nodal_damping
    }

    /// True when anything takes energy by rate.
    pub fn is_damped(&self) -> bool {
        self.mass_damping > 0.0 || !self.nodal_damping.is_empty() || self.groups.iter().any(|g| g.block.is_damped())
    }

    /// True when no term of the equation of motion depends on the motion other than linearly, with a constant matrix.
    pub fn is_linear(&self) -> bool {
        self.groups.iter().all(|g| g.block.is_linear())
            && self.attachments.is_empty()
            && self.joints.is_empty()
            && self.loads.iter().all(|l| !l.follower)
            && self.pressures.is_empty()
    }
}

/// Force and moment of a load; a follower turns with its node.
#[inline]
fn load_on(load: &model::Load, factor: f64, node: &Node) -> (Vec3, Vec3) {
    let (f, m) = (factor * load.force, factor * load.moment);
    if load.follower {
        let R = node.R();
        (R * f, R * m)
    } else {
        (f, m)
    }
}

/// ∂(f, m)/∂θ of a follower, as internal force (with the sign of a stiffness).
fn follower_stiffness(load: &model::Load, factor: f64, node: &Node) -> [Mat3; 2] {
    let (f, m) = load_on(load, factor, node);
    [skew(&f), skew(&m)]
}
