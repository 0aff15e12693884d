//! The mass of a reduced part, node by node: the inertia forces of all nodes act on the superelement by their shapes. Nodes move as the shapes
//! say in a frame that turns, so centrifugal, Coriolis and gyroscopic forces of the modes are complete, and momenta are those of the nodes.

use super::build;
use super::inertia::{ConsistentMass, Inertia};
use super::scale::Scale;
use base::math::{Vec3, Vec6, angular, linear, stack};
use mechanics::elements::Force;
use mechanics::elements::superelement::{FloatingElement, InnerNodes, SuperelementData};
use mechanics::state::Node;
use model::{Model, Reduction};
use std::collections::HashMap;
use std::fmt;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The masses at the nodes of a reduced part.
pub struct ReducedMass {
    /// The superelement on the nodes of `nodes`.
    element: FloatingElement,
    inner: InnerNodes,
    /// Nodes of the scene: those of the superelement, then inner nodes. All else here names nodes by their place among these.
    nodes: Vec<usize>,
    /// The number of nodes of the superelement.
    acting: usize,
    inertias: Vec<Inertia>,
    consistent: Vec<ConsistentMass>,
    /// Positions at t = 0.
    start: Vec<Vec3>,
    total: f64,
    memory: Mutex<Memory>,
}

/// Nodes, forces and small motions of the part.
struct Memory {
    nodes: Vec<Node>,
    F: Vec<Force>,
    motions: Vec<Vec6>,
}

impl fmt::Debug for ReducedMass {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("ReducedMass").field("nodes", &self.nodes).finish_non_exhaustive()
    }
}

impl ReducedMass {
    /// The masses of a reduced part; `None` before its matrices have been computed, and without mass.
    pub fn new(model: &Model, of: &Reduction, x: &[Vec3]) -> Option<ReducedMass> {
        let made = of.made.as_ref()?;
        let nodes: Vec<usize> = made.matrices.nodes.iter().chain(&of.inner).copied().collect();
        let acting = made.matrices.nodes.len();
        let start: Vec<Vec3> = nodes.iter().map(|&node| x[node]).collect();
        let data = SuperelementData { nodes: (0..acting).collect(), ..made.matrices.clone() };
        let element = FloatingElement::new(data, &start, 0.0);
        let own: Vec<usize> = (acting..nodes.len()).collect();
        let inner = InnerNodes::new(&element, &own, &start, made.shapes.clone());
        let parts = of.parts.iter().map(|&part| &model.parts[part]);
        let (mut inertias, mut consistent) = build::masses_of(model, x, [].iter(), [].iter(), parts);
        let place: HashMap<usize, usize> = nodes.iter().enumerate().map(|(place, &node)| (node, place)).collect();
        inertias.iter_mut().for_each(|inertia| inertia.node = place[&inertia.node]);
        consistent.iter_mut().flat_map(|mass| &mut mass.nodes).for_each(|node| *node = place[&*node]);
        let total = inertias.iter().map(|inertia| inertia.mass).sum::<f64>()
            + consistent.iter().flat_map(|mass| &mass.m).sum::<f64>();
        let memory = Memory {
            nodes: start.iter().map(|x| Node::at_rest(*x)).collect(),
            F: vec![[0.0; 6]; nodes.len()],
            motions: vec![Vec6::zeros(); nodes.len()],
        };
        let mass = ReducedMass {
            element,
            inner,
            nodes,
            acting,
            inertias,
            consistent,
            start,
            total,
            memory: Mutex::new(memory),
        };
        (total > 0.0).then_some(mass)
    }

    /// The memory with the motion of all nodes, without forces.
    fn at(&self, nodes: &[Node]) -> MutexGuard<'_, Memory> {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        for (own, &node) in memory.nodes.iter_mut().zip(&self.nodes[..self.acting]) {
            *own = nodes[node];
        }
        self.inner.recover(&self.element, &mut memory.nodes);
        memory.F.fill([0.0; 6]);
        memory
    }

    /// Moves forces to the superelement, and adds them to those of the scene.
    fn pass_on(&self, memory: &mut Memory, factor: f64, F: &mut [Force]) {
        let Memory { nodes, F: own, .. } = memory;
        self.inner.transfer(&self.element, nodes, own);
        for (&node, force) in self.nodes[..self.acting].iter().zip(own) {
            F[node].iter_mut().zip(force).for_each(|(sum, f)| *sum += factor * *f);
        }
    }

    /// Subtracts inertia forces from `F` and adds weight; weight alone unless `dynamic`.
    pub fn add_forces(&self, nodes: &[Node], field: &Vec3, dynamic: bool, F: &mut [Force]) {
        if !dynamic && *field == Vec3::zeros() {
            return;
        }
        let memory = &mut *self.at(nodes);
        let mut scale = Scale::default();
        for inertia in &self.inertias {
            memory.F[inertia.node] = inertia.force(&memory.nodes[inertia.node], field, dynamic, &mut scale);
        }
        for mass in &self.consistent {
            mass.add_forces(&memory.nodes, field, dynamic, None, &mut memory.F);
        }
        self.pass_on(memory, 1.0, F);
    }

    /// Subtracts `factor` times the product of the mass matrix and small motions of all nodes of the scene from `F`.
    pub fn subtract_product(&self, nodes: &[Node], motions: &[Vec6], factor: f64, F: &mut [Force]) {
        let memory = &mut *self.at(nodes);
        for (own, &node) in memory.motions.iter_mut().zip(&self.nodes[..self.acting]) {
            *own = motions[node];
        }
        self.inner.carry(&self.element, &memory.nodes, &mut memory.motions);
        for inertia in &self.inertias {
            let motion = &memory.motions[inertia.node];
            let f =
                stack(&(inertia.mass * linear(motion)), &(inertia.J(&memory.nodes[inertia.node]) * angular(motion)));
            memory.F[inertia.node] = f.into();
        }
        for (a, b, m) in self.consistent.iter().flat_map(ConsistentMass::pairs) {
            mechanics::elements::subtract(&mut memory.F[a], 0, &(-m * linear(&memory.motions[b])));
        }
        self.pass_on(memory, -factor, F);
    }

    /// Kinetic energy, linear momentum, and angular momentum about the origin.
    pub fn motion(&self, nodes: &[Node]) -> (f64, Vec3, Vec3) {
        let memory = &*self.at(nodes);
        let (mut kinetic, mut p, mut l) = (0.0, Vec3::zeros(), Vec3::zeros());
        for inertia in &self.inertias {
            let node = &memory.nodes[inertia.node];
            kinetic += inertia.kinetic_energy(node);
            p += inertia.mass * node.v;
            l += node.x.cross(&(inertia.mass * node.v)) + inertia.spin(node);
        }
        for mass in &self.consistent {
            let (own_p, own_l) = mass.momentum(&memory.nodes);
            kinetic += mass.kinetic_energy(&memory.nodes);
            (p, l) = (p + own_p, l + own_l);
        }
        (kinetic, p, l)
    }

    /// The displacement of the centre of mass from t = 0.
    pub fn center_moved(&self, nodes: &[Node]) -> Vec3 {
        let memory = &*self.at(nodes);
        let moved = |node: usize| memory.nodes[node].moved(&self.start[node]);
        let lumped = self.inertias.iter().map(|inertia| inertia.mass * moved(inertia.node)).sum::<Vec3>();
        let pairs = self.consistent.iter().flat_map(ConsistentMass::pairs);
        (lumped + pairs.map(|(a, _, m)| m * moved(a)).sum::<Vec3>()) / self.total
    }
}
