//! A matrix that rotates with the model: the matrix of an earlier step serves the current configuration.
//!
//! Beams in a tree, with the bodies on them, are strained by differences of displacements along their lengths, in axes that turn with them.
//! A motion x in the configuration of the matrix becomes the motion x′ = 𝒯 x of the current configuration with the same strains. Rotations
//! turn with their nodes, and at each Gauss point u′ − θ×r′ turns with the section. Displacements are summed from the restrained node, or
//! about the centre of mass, so every iteration keeps resultant forces and momenta. With K the old matrix, 𝒯 K⁻¹ 𝒯ᵀ gives the correction
//! for a residual. The stiffness of stretching and shear is then exact, however far the tree has turned and bent, and the stiffness of
//! bending nearly so. Masses do not follow the change of shape; as always, the contraction of the iteration shows this error.

use crate::context::Context;
use crate::strategy::beam_trees::{BeamTrees, MOST_NODES};
use crate::strategy::strained_line::{LinePoint, LineShape};
use crate::system::NodeRows;
use crate::tolerances::rotated_matrix::{MANY, NEGLIGIBLE};
use base::math::rotation::matrix;
use base::math::{Mat3, Vec3};
use base::snapshot::keep;
use mechanics::state::Node;
use nalgebra::Quaternion;

/// The trees of a model, in the configuration of the matrix and in the current one. It is allocated once.
pub struct RotatedMatrix {
    trees: BeamTrees,
    /// The shapes of beams by number of nodes.
    shapes: Vec<LineShape>,
    /// The Gauss points of each branch from this number on; none for arms.
    first_points: Vec<usize>,
    /// For each dependent node its master, masters first.
    masters: Vec<(usize, usize)>,
    /// The nodes with unknowns, and their rows.
    members: Vec<(usize, NodeRows)>,
    /// For each node its part of the mass of its tree.
    mass: Vec<f64>,
    /// Rotations of all nodes when the matrix was formed, and the turns since then.
    formed: Vec<Quaternion<f64>>,
    turns: Vec<Quaternion<f64>>,
    turned: Vec<Mat3>,
    before: MotionAt,
    now: MotionAt,
    points_turned: Vec<Mat3>,
    /// True if the matrix was formed for the current configuration.
    fresh: bool,
    /// Number of matrices so far.
    matrices: usize,
}

keep!(RotatedMatrix { formed, turns, turned, before, now, points_turned, fresh, matrices } without { trees, shapes, first_points, masters, members, mass });

/// A configuration with displacements and spins of all nodes, or forces and moments.
struct MotionAt {
    points: Vec<LinePoint>,
    u: Vec<Vec3>,
    theta: Vec<Vec3>,
}

keep!(MotionAt { points, u, theta });

impl MotionAt {
    fn new(nodes: usize, points: usize) -> MotionAt {
        let zero = || vec![Vec3::zeros(); nodes];
        MotionAt { points: vec![LinePoint::ZERO; points], u: zero(), theta: zero() }
    }

    fn clear(&mut self, nodes: &[usize]) {
        for &node in nodes {
            (self.u[node], self.theta[node]) = (Vec3::zeros(), Vec3::zeros());
        }
    }
}

impl RotatedMatrix {
    /// The trees of a dynamic model; `None` if there are none, or if the matrix never changes.
    pub fn new(cx: &Context) -> Option<RotatedMatrix> {
        if !cx.is_dynamic() || cx.plan.linear {
            return None;
        }
        let trees = BeamTrees::find(cx)?;
        let count = cx.model.nodes.len();
        let mut in_tree = vec![false; count];
        trees.nodes.iter().for_each(|&node| in_tree[node] = true);
        let links = cx.system.rigid_links.iter().filter(|link| in_tree[link.node]);
        let masters = links.map(|link| (link.node, link.master)).collect();
        let rows = |&node: &usize| (node, *cx.plan.dofs.of(node));
        let members = trees.nodes.iter().map(rows).filter(|(_, rows)| rows.count() > 0).collect();
        let mut points = 0;
        let mut first_points = Vec::new();
        for branch in &trees.branches {
            first_points.push(points);
            points += if branch.master.is_none() { branch.nodes().len() - 1 } else { 0 };
        }
        Some(RotatedMatrix {
            mass: parts_of_mass(cx, &trees),
            shapes: (2..=MOST_NODES).map(LineShape::new).collect(),
            trees,
            first_points,
            masters,
            members,
            turns: vec![Quaternion::identity(); count],
            formed: vec![Quaternion::identity(); count],
            turned: vec![Mat3::identity(); count],
            before: MotionAt::new(count, points),
            now: MotionAt::new(count, points),
            points_turned: vec![Mat3::identity(); points],
            fresh: true,
            matrices: 0,
        })
    }

    /// Records the configuration of a new matrix.
    pub fn note(&mut self, nodes: &[Node]) {
        for &node in &self.trees.nodes {
            self.formed[node] = nodes[node].rotation;
        }
        measure_points(&self.trees, &self.shapes, &self.first_points, nodes, &mut self.before.points);
        self.fresh = true;
        self.matrices += 1;
    }

    /// Counts matrices from zero: after a failed step, old matrices must not be used for long.
    pub fn rest(&mut self) {
        self.matrices = 0;
    }

    /// Transforms the residual `r` from the configuration `nodes` to the configuration of the matrix, 𝒯ᵀ r. Returns false where they are
    /// the same.
    pub fn take_back(&mut self, nodes: &[Node], r: &mut [f64]) -> bool {
        if std::mem::take(&mut self.fresh) || self.matrices < MANY {
            return false;
        }
        if !self.measure(nodes) {
            return false;
        }
        self.before.clear(&self.trees.nodes);
        self.now.clear(&self.trees.nodes);
        for (node, rows) in &self.members {
            let f = rows.gather(r);
            self.now.u[*node] = f.fixed_rows::<3>(0).into_owned();
            self.now.theta[*node] = f.fixed_rows::<3>(3).into_owned();
        }
        for free in &self.trees.free {
            let nodes = &self.trees.nodes[free.clone()];
            let force = nodes.iter().map(|&node| self.now.u[node]).sum::<Vec3>();
            for &node in nodes {
                self.now.u[node] -= self.mass[node] * force;
                self.before.u[node] += self.mass[node] * force;
            }
        }
        for k in (0..self.trees.branches.len()).rev() {
            self.take_branch_back(k);
        }
        for &(node, master) in self.masters.iter().rev() {
            // Spins of a rigid body equal the spin of its master; arms contribute as branches only to displacements.
            let arm = self.arm_before(node, master, nodes);
            let (f, m, of_now) = (self.before.u[node], self.before.theta[node], self.now.theta[node]);
            self.before.u[master] += f;
            self.before.theta[master] += m + arm.cross(&f);
            self.now.theta[master] += of_now;
        }
        for (node, rows) in &self.members {
            let back = turn_of(rows, &self.turned[*node]).tr_mul(&self.now.theta[*node]);
            scatter(rows, &self.before.u[*node], &(self.before.theta[*node] + back), r);
        }
        true
    }

    /// Transforms a correction from the configuration of the matrix to the current one, 𝒯 x, after [`RotatedMatrix::take_back`].
    pub fn carry_along(&mut self, nodes: &[Node], x: &mut [f64]) {
        self.before.clear(&self.trees.nodes);
        self.now.clear(&self.trees.nodes);
        for (node, rows) in &self.members {
            let q = rows.gather(x);
            self.before.u[*node] = q.fixed_rows::<3>(0).into_owned();
            self.before.theta[*node] = q.fixed_rows::<3>(3).into_owned();
            self.now.theta[*node] = turn_of(rows, &self.turned[*node]) * self.before.theta[*node];
        }
        for k in 0..self.masters.len() {
            let (node, master) = self.masters[k];
            let arm = self.arm_before(node, master, nodes);
            self.before.u[node] = self.before.u[master] + self.before.theta[master].cross(&arm);
            self.before.theta[node] = self.before.theta[master];
            self.now.theta[node] = self.now.theta[master];
        }
        for k in 0..self.trees.branches.len() {
            self.carry_branch_along(k);
        }
        for free in &self.trees.free {
            let nodes = &self.trees.nodes[free.clone()];
            let apart = |&node: &usize| (self.before.u[node] - self.now.u[node]) * self.mass[node];
            let shift = nodes.iter().map(apart).sum::<Vec3>();
            nodes.iter().for_each(|&node| self.now.u[node] += shift);
        }
        for (node, rows) in &self.members {
            scatter(rows, &self.now.u[*node], &self.now.theta[*node], x);
        }
    }

    /// Displacements of the outer nodes of a branch from the inner node.
    fn carry_branch_along(&mut self, k: usize) {
        let branch = self.trees.branches[k];
        let (of, parent, master) = (branch.nodes(), branch.parent, branch.master);
        let (before, now) = (&self.before, &mut self.now);
        let root = of[parent];
        if let Some(master) = master {
            let outer = of[1 - parent];
            now.u[outer] = now.u[root] + self.turned[master] * (before.u[outer] - before.u[root]);
            return;
        }
        let shape = &self.shapes[of.len() - 2];
        let mut outer = [now.u[root]; MOST_NODES];
        for g in 0..shape.points {
            let at = self.first_points[k] + g;
            let (old, new) = (&before.points[at], &now.points[at]);
            let mut strain = -old.spin(of.iter().map(|&n| before.theta[n])).cross(&old.tangent);
            for (slope, &node) in shape.slope[g].iter().zip(of) {
                strain += *slope * before.u[node];
            }
            let along =
                self.points_turned[at] * strain + new.spin(of.iter().map(|&n| now.theta[n])).cross(&new.tangent);
            for (a, outer) in outer[..of.len()].iter_mut().enumerate() {
                *outer += (shape.integral[a][g] - shape.integral[parent][g]) * along;
            }
        }
        of.iter().zip(outer).for_each(|(&node, u)| now.u[node] = u);
    }

    /// The transpose of [`RotatedMatrix::carry_branch_along`] for forces, from the outer nodes to the inner one.
    fn take_branch_back(&mut self, k: usize) {
        let branch = self.trees.branches[k];
        let (of, parent) = (branch.nodes(), branch.parent);
        let (before, now) = (&mut self.before, &mut self.now);
        let root = of[parent];
        if let Some(master) = branch.master {
            let outer = of[1 - parent];
            let force = now.u[outer];
            now.u[root] += force;
            let force = self.turned[master].tr_mul(&force);
            before.u[outer] += force;
            before.u[root] -= force;
            return;
        }
        let shape = &self.shapes[of.len() - 2];
        for g in 0..shape.points {
            let at = self.first_points[k] + g;
            let mut along = Vec3::zeros();
            for (a, &node) in of.iter().enumerate().filter(|&(a, _)| a != parent) {
                along += (shape.integral[a][g] - shape.integral[parent][g]) * now.u[node];
            }
            let strain = self.points_turned[at].tr_mul(&along);
            let (old, new) = (before.points[at], now.points[at]);
            let (of_old, of_new) = (-old.tangent.cross(&strain), new.tangent.cross(&along));
            for (a, &node) in of.iter().enumerate() {
                before.theta[node] += old.moment_on(a, &of_old);
                now.theta[node] += new.moment_on(a, &of_new);
                before.u[node] += shape.slope[g][a] * strain;
            }
        }
        for (_, &node) in of.iter().enumerate().filter(|&(a, _)| a != parent) {
            let force = now.u[node];
            now.u[root] += force;
        }
    }

    /// Writes the turns of nodes and points since the matrix was formed. Returns false if the turns are negligible.
    fn measure(&mut self, nodes: &[Node]) -> bool {
        let mut largest = 0.0f64;
        for &node in &self.trees.nodes {
            let turn = nodes[node].rotation * self.formed[node].conjugate();
            largest = largest.max(turn.imag().norm_squared());
            self.turns[node] = turn;
        }
        // Half angles count.
        if 4.0 * largest * self.trees.slenderness < NEGLIGIBLE {
            return false;
        }
        for &node in &self.trees.nodes {
            self.turned[node] = matrix(&self.turns[node]);
        }
        measure_points(&self.trees, &self.shapes, &self.first_points, nodes, &mut self.now.points);
        let points = self.before.points.iter().zip(&self.now.points);
        for (turned, (before, now)) in self.points_turned.iter_mut().zip(points) {
            *turned = matrix(&(now.rotation * before.rotation.conjugate()));
        }
        true
    }

    /// The arm of a dependent node in the configuration of the matrix.
    fn arm_before(&self, node: usize, master: usize, nodes: &[Node]) -> Vec3 {
        self.turned[master].tr_mul(&nodes[node].relative_position(&nodes[master]))
    }
}

/// The mass at each node. Displacements of a tree refer to its centre of mass, and dependent nodes contribute to it.
fn mass(cx: &Context) -> Vec<f64> {
    let mut mass = vec![0.0; cx.model.nodes.len()];
    cx.system.inertias.iter().for_each(|inertia| mass[inertia.node] += inertia.mass);
    for (node, _, m) in cx.system.consistent_masses().iter().flat_map(|mass| mass.pairs()) {
        mass[node] += m;
    }
    mass
}

/// The fraction of each node in the mass of its free tree, or in the number of its nodes if the tree has no mass.
fn parts_of_mass(cx: &Context, trees: &BeamTrees) -> Vec<f64> {
    let mut mass = mass(cx);
    for free in &trees.free {
        let nodes = &trees.nodes[free.clone()];
        let all: f64 = nodes.iter().map(|&node| mass[node]).sum();
        for &node in nodes {
            mass[node] = if all > 0.0 { mass[node] / all } else { 1.0 / nodes.len() as f64 };
        }
    }
    mass
}

fn measure_points(trees: &BeamTrees, shapes: &[LineShape], first: &[usize], nodes: &[Node], points: &mut [LinePoint]) {
    for (branch, first) in trees.branches.iter().zip(first).filter(|(branch, _)| branch.master.is_none()) {
        let of = branch.nodes();
        let shape = &shapes[of.len() - 2];
        for g in 0..shape.points {
            points[first + g] = LinePoint::new(shape, g, of, nodes);
        }
    }
}

/// The rotation of the spins of a node; identity if the node does not have all three rotations.
fn turn_of(rows: &NodeRows, turned: &Mat3) -> Mat3 {
    if (3..6).all(|dof| rows.has(dof)) { *turned } else { Mat3::identity() }
}

fn scatter(rows: &NodeRows, u: &Vec3, theta: &Vec3, x: &mut [f64]) {
    rows.scatter(&base::math::stack(u, theta), x);
}
