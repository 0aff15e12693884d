//! The matrix that follows trees of beams as they turn.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::diagnostic::Source;
use rdsolve::math::rotation::{exp, matrix};
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::{self, Model};
use rdsolve::plan::Plan;
use rdsolve::solve::inner::{Context, MANY, RotatedMatrix, at_rest};
use rdsolve::state::{Configuration, Node};
use rdsolve::system::System;
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
    let now = Configuration { nodes, history: &[], dt: 0.0, previous: None };
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
    let mut rotated = RotatedMatrix::new(&cx).expect("two slender arms on a hub");
    let mut rng = StdRng::seed_from_u64(3);
    let mut number = |size: f64| rng.random_range(-size..size);
    let start = at_rest(&model);
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
    (0..MANY).for_each(|_| rotated.note(&before));
    let mut back = r.clone();
    assert!(!rotated.take_back(&before, &mut back) && back == r);
    assert!(rotated.take_back(&after, &mut back));
    let mut along = x.clone();
    rotated.carry_along(&after, &mut along);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // Work is the same in both configurations, to rounding of some hundred terms.
    assert!((dot(&r, &along) - dot(&back, &x)).abs() < 1e-12 * dot(&r, &r).sqrt() * dot(&along, &along).sqrt());
    let change = |nodes: &[Node], x: &[f64]| -> Vec<f64> {
        let [plus, minus] = [1e-5, -1e-5].map(|h| {
            let by = |k: usize| {
                let q = plan.dofs.of(k).gather(x) * h;
                [rdsolve::math::linear(&q), rdsolve::math::angular(&q)]
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
