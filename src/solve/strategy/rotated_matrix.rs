//! A matrix that turns with the scene: the one of some steps ago answers for the configuration at hand.
//!
//! Beams in a tree, with the bodies on them, are strained by differences of displacements along their lengths, in axes that turn
//! with them. A motion x of the configuration of the matrix becomes one x′ = 𝒯 x of the configuration at hand that strains them
//! alike: rotations turn with their nodes; at each Gauss point u′ − θ×r′ turns with the section; displacements are summed from
//! where the tree is held, or about its centre of mass, so that sums of forces and momenta stay what they are in every iteration.
//! With K the old matrix, 𝒯 K⁻¹ 𝒯ᵀ answers a residual. What stretching and shear resist is then up to
//! date, however far the tree has turned and bent, and bending nearly so. Masses that the shape moves stay behind, which the
//! contraction of the iteration shows as ever.

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

/// The trees of a scene, in the configuration of the matrix and in the one at hand. It is allocated once.
pub struct Turning {
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
    /// Rotations of all nodes when the matrix was formed, and what they have turned since.
    formed: Vec<Quaternion<f64>>,
    turns: Vec<Quaternion<f64>>,
    turned: Vec<Mat3>,
    before: MotionAt,
    now: MotionAt,
    points_turned: Vec<Mat3>,
    /// True where the matrix is that of the configuration at hand.
    fresh: bool,
    /// Number of matrices so far.
    matrices: usize,
}

keep!(Turning { formed, turns, turned, before, now, points_turned, fresh, matrices } without { trees, shapes, first_points, masters, members, mass });

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

impl Turning {
    /// The trees of a dynamic scene; `None` where there are none, or where the matrix never changes.
    pub fn new(cx: &Context) -> Option<Turning> {
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
        Some(Turning {
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

    /// Notes the configuration for which the matrix has been formed.
    pub fn note(&mut self, nodes: &[Node]) {
        for &node in &self.trees.nodes {
            self.formed[node] = nodes[node].rotation;
        }
        measure_points(&self.trees, &self.shapes, &self.first_points, nodes, &mut self.before.points);
        self.fresh = true;
        self.matrices += 1;
    }

    /// Begins to count matrices anew: after a step that was given up, old matrices must not lead as far as they can.
    pub fn rest(&mut self) {
        self.matrices = 0;
    }

    /// Takes the residual `r` at the configuration `nodes` to that of the matrix, 𝒯ᵀ r. Returns false where they are the same.
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
            // Spins of a rigid body are those of its master; arms are branches that have their say in displacements alone.
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

    /// Takes a correction for the configuration of the matrix to the one at hand, 𝒯 x, after [`Turning::take_back`].
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

    /// Displacements of the outer nodes of a branch from those of the inner one.
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
            let mut strain = -old.spin(of.iter().map(|&n| before.theta[n])).cross(&old.along);
            for (slope, &node) in shape.slope[g].iter().zip(of) {
                strain += *slope * before.u[node];
            }
            let along = self.points_turned[at] * strain + new.spin(of.iter().map(|&n| now.theta[n])).cross(&new.along);
            for (a, outer) in outer[..of.len()].iter_mut().enumerate() {
                *outer += (shape.integral[a][g] - shape.integral[parent][g]) * along;
            }
        }
        of.iter().zip(outer).for_each(|(&node, u)| now.u[node] = u);
    }

    /// The same for forces, from the outer nodes to the inner one.
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
            let (of_old, of_new) = (-old.along.cross(&strain), new.along.cross(&along));
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

    /// Writes what has turned since the matrix was formed. Returns false where that is too little to matter.
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

/// The mass at each node. Displacements of a tree are counted about its centre, to which dependent nodes give their part.
fn mass(cx: &Context) -> Vec<f64> {
    let mut mass = vec![0.0; cx.model.nodes.len()];
    cx.system.inertias.iter().for_each(|inertia| mass[inertia.node] += inertia.mass);
    for (node, _, m) in cx.system.consistent_masses().iter().flat_map(|mass| mass.pairs()) {
        mass[node] += m;
    }
    mass
}

/// The part that each node has of the mass of its free tree, or of its number of nodes where these have none.
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

/// The turn of the spins of a node: one about a single axis leaves them as they are.
fn turn_of(rows: &NodeRows, turned: &Mat3) -> Mat3 {
    if (3..6).all(|dof| rows.has(dof)) { *turned } else { Mat3::identity() }
}

fn scatter(rows: &NodeRows, u: &Vec3, theta: &Vec3, x: &mut [f64]) {
    rows.scatter(&base::math::stack(u, theta), x);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Plan;
    use crate::system::System;
    use base::diagnostic::Source;
    use base::math::rotation::exp;
    use mechanics::state::Configuration;
    use model::{self, Model};
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};
    use std::sync::atomic::AtomicBool;

    static NEVER: AtomicBool = AtomicBool::new(false);

    /// A free hub with an angled arm and a straight one, and a block at the end of the first.
    fn scene() -> Model {
        let text = r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = 1e-3
plane = "off"
[sections.rod]
shape = "general"
axial_stiffness = 1e6
shear_stiffness = [4e5, 3e5]
torsional_stiffness = 8.0
bending_stiffness = [10.0, 20.0]
mass_per_length = 1.0
inertia_per_length = [0.02, 0.01, 0.01]
[points]
a = [0.1, 0.0, 0.0]
b = [1.1, 0.2, 0.0]
c = [1.2, 1.0, 0.3]
d = [0.0, -0.2, 0.1]
e = [-0.8, -0.5, 0.0]
[[beams]]
name = "angled"
path = ["a", "b", "c"]
elements = 1
order = 3
section = "rod"
orientation = [0.0, 0.0, 1.0]
[[beams]]
name = "straight"
path = ["e", "d"]
elements = 2
order = 2
section = "rod"
orientation = [0.0, 0.0, 1.0]
[[bodies]]
name = "hub"
center = [0.0, 0.0, 0.0]
mass = 5.0
inertia = [0.05, 0.06, 0.1]
[[bodies]]
name = "block"
center = [1.3, 1.1, 0.2]
mass = 2.0
inertia = [0.02, 0.03, 0.04]
[[attachments]]
body = "hub"
nodes = ["a", "d"]
[[attachments]]
body = "block"
nodes = "c"
[output]
interval = 1.0
"#;
        let source = Source::new("deck.toml", text, &[]);
        let (model, problems) = model::read(&source);
        let drawn: Vec<String> = problems.iter().map(|problem| problem.draw(&source, false)).collect();
        model.unwrap_or_else(|| panic!("{}", drawn.join("\n")))
    }

    /// The scene moved by displacements and rotation vectors, with dependent nodes after their masters.
    fn moved(system: &System, nodes: &[Node], by: impl Fn(usize) -> [Vec3; 2]) -> Vec<Node> {
        let mut moved = nodes.to_vec();
        for (k, node) in moved.iter_mut().enumerate() {
            let [u, theta] = by(k);
            node.x += u;
            node.rotation = exp(&theta) * node.rotation;
        }
        for link in &system.rigid_links {
            let master = moved[link.master];
            (moved[link.node].x, moved[link.node].rotation) = (master.x + link.arm(&master), master.rotation);
        }
        moved
    }

    /// N, V_y and V_z at all Gauss points.
    fn forces(system: &System, nodes: &[Node]) -> Vec<f64> {
        let now = Configuration { nodes, history: &[], dt: 0.0, lead: None };
        let mut forces = Vec::new();
        for block in system.groups.iter().map(|group| &group.block) {
            for (e, g) in (0..block.len()).flat_map(|e| (0..block.points()).map(move |g| (e, g))) {
                if let Some(point) = block.point(e, g, &Mat3::identity(), &now) {
                    forces.extend_from_slice(&point.forces[..3]);
                }
            }
        }
        forces
    }

    #[test]
    fn a_motion_is_carried_along_with_its_strains() {
        let model = scene();
        let system = System::new(&model).unwrap();
        let plan = Plan::new(&model, &system, 1);
        let cx = Context::new(&model, &plan, &system, [false; 2], &NEVER);
        let mut turning = Turning::new(&cx).expect("two slender arms on a hub");
        let mut rng = StdRng::seed_from_u64(3);
        let mut number = |size: f64| rng.random_range(-size..size);
        let start = crate::context::at_rest(&model);
        let count = start.len();
        let mut random = |size: f64| -> Vec<[Vec3; 2]> {
            (0..count).map(|_| [0, 1].map(|_| Vec3::from_fn(|_, _| number(size)))).collect()
        };
        let (first, second) = (random(0.1), random(0.1));
        let whole = Vec3::new(0.5, -1.5, 2.0);
        let before = moved(&system, &start, |k| first[k]);
        let after = moved(&system, &start, |k| {
            let turned = matrix(&exp(&whole)) * start[k].x - start[k].x;
            [turned + second[k][0], whole]
        });
        let after = moved(&system, &after, |k| [Vec3::zeros(), second[k][1]]);
        let x: Vec<f64> = random(1.0).iter().flatten().flatten().copied().take(plan.dofs.unknowns()).collect();
        let r: Vec<f64> = random(1.0).iter().flatten().flatten().copied().take(plan.dofs.unknowns()).collect();
        (0..MANY).for_each(|_| turning.note(&before));
        let mut back = r.clone();
        assert!(!turning.take_back(&before, &mut back) && back == r);
        assert!(turning.take_back(&after, &mut back));
        let mut along = x.clone();
        turning.carry_along(&after, &mut along);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // Work is the same in both configurations, to rounding of some hundred terms.
        assert!((dot(&r, &along) - dot(&back, &x)).abs() < 1e-12 * dot(&r, &r).sqrt() * dot(&along, &along).sqrt());
        let change = |nodes: &[Node], x: &[f64]| -> Vec<f64> {
            let [plus, minus] = [1e-5, -1e-5].map(|h| {
                let by = |k: usize| {
                    let q = plan.dofs.of(k).gather(x) * h;
                    [base::math::linear(&q), base::math::angular(&q)]
                };
                forces(&system, &moved(&system, nodes, by))
            });
            plus.iter().zip(minus).map(|(plus, minus)| (plus - minus) / 2e-5).collect()
        };
        let (old, new) = (change(&before, &x), change(&after, &along));
        let largest = old.iter().fold(0.0f64, |largest, force| largest.max(force.abs()));
        for (old, new) in old.iter().zip(&new) {
            // Differences of this length err by their square.
            assert!((old - new).abs() < 1e-8 * largest, "{old}, {new} of {largest}");
        }
    }
}
