//! Nodes of shells on bodies and on beams, at the end of rigid arms.

use super::{Folder, displacements};
use crate::support::{self, node};
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::Model;

fn model(deck: &str) -> Model {
    Folder::with(&[]).model(deck)
}

/// E, width and thickness of the strip, width and height of the rib under it, length.
const E: f64 = 1e9;
const STRIP: [f64; 2] = [0.1, 0.01];
const RIB: [f64; 2] = [0.01, 0.03];
const LENGTH: f64 = 1.0;

/// A strip with a rib under it, clamped at one end, `n` elements along; pulled down by `force` at the other.
fn ribbed(n: usize, order: usize, nodes: &str, supports: &str, force: f64) -> String {
    let ([b, h], [c, d]) = (STRIP, RIB);
    let e = 0.5 * (h + d);
    format!(
        r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 1.0
[materials.m]
model = "elastic"
youngs_modulus = {E:?}
poisson_ratio = 0.0
[sections.rib]
shape = "general"
area = {:?}
moments = [{:?}, {:?}]
torsion_constant = 1e-8
shear_areas = [{:?}, {:?}]
[points]
a = [0.0, {:?}, 0.0]
b = [{LENGTH:?}, {:?}, 0.0]
m = [0.0, 0.0, 0.0]
n = [{LENGTH:?}, 0.0, 0.0]
c = [{LENGTH:?}, {:?}, 0.0]
d = [0.0, {:?}, 0.0]
root = [0.0, 0.0, {:?}]
tip = [{LENGTH:?}, 0.0, {:?}]
[[shells]]
name = "right"
corners = ["a", "b", "n", "m"]
elements = [{n}, 1]
thickness = {h:?}
material = "m"
[[shells]]
name = "left"
corners = ["m", "n", "c", "d"]
elements = [{n}, 1]
thickness = {h:?}
material = "m"
[[beams]]
name = "rib"
path = ["root", "tip"]
elements = {n}
order = {order}
material = "m"
section = "rib"
orientation = [0.0, 1.0, 0.0]
[[attachments]]
beam = "rib"
nodes = {nodes}
[[supports]]
at = {supports}
fix = "all"
[[loads]]
at = "tip"
force = [0.0, 0.0, {force:?}]
"#,
        c * d,
        c * d * d * d / 12.0,
        d * c * c * c / 12.0,
        c * d * 5.0 / 6.0,
        c * d * 5.0 / 6.0,
        -0.5 * b,
        -0.5 * b,
        0.5 * b,
        0.5 * b,
        -e,
        -e,
    )
}

/// Deflection of the composite beam: F L³/3EI + F L/(5/6 G A), with I of both about their common axis.
fn composite(force: f64) -> f64 {
    let ([b, h], [c, d]) = (STRIP, RIB);
    let (e, A, B) = (0.5 * (h + d), b * h, c * d);
    let I = b * h.powi(3) / 12.0 + c * d.powi(3) / 12.0 + A * B / (A + B) * e * e;
    force * LENGTH.powi(3) / (3.0 * E * I) + force * LENGTH / (5.0 / 6.0 * 0.5 * E * (A + B))
}

/// All nodes of the strip ride on the rib, so cross-sections stay plane and the composite beam is exact. Elements of two nodes
/// couple bending with stretching of the strip, which is straight where the beam is a parabola: second order.
#[test]
fn a_strip_with_a_rib_is_a_composite_beam() {
    let force = -1e-3; // linear: the tip sinks by 1e-5 of the length
    let error = |n: usize| {
        let u = displacements(&model(&ribbed(n, 1, "[\"left\", \"right\"]", "\"root\"", force)));
        let tip = u.iter().find(|(label, _)| label == "tip").unwrap().1[2];
        tip / composite(force) - 1.0
    };
    let points: Vec<(f64, f64)> = [32, 64, 128].map(|n| (1.0 / n as f64, error(n))).to_vec();
    println!("{points:?}");
    let sizes: Vec<(f64, f64)> = points.iter().map(|(h, e)| (*h, e.abs())).collect();
    let slope = support::slope(&sizes);
    assert!((1.9..2.1).contains(&slope), "{slope}: {points:?}");
    assert!(points[2].1.abs() < 2e-5, "{points:?}"); // a quarter of the size, a sixteenth of 2e-4
}

/// Only the line above the rib rides, the ends of the strip are clamped beside it: as stiff but for shear lag of a strip a
/// tenth as wide as long.
#[test]
fn a_line_of_nodes_over_a_rib() {
    let force = -1e-3;
    let deck = ribbed(32, 1, "\"left.edge1\"", "[\"root\", \"a\", \"d\"]", force);
    let model = model(&deck);
    assert_eq!(model.constraints.dependents.len(), 33);
    let u = displacements(&model);
    let tip = u.iter().find(|(label, _)| label == "tip").unwrap().1[2];
    println!("line: {:+.4}", tip / composite(force) - 1.0);
    assert!((tip / composite(force) - 1.0).abs() < 0.02, "{tip}");
}

/// A strip whose end edge is bolted to a block, which is held: what the block feels, and the same scene turned.
fn bolted(R: &Mat3) -> String {
    let point = |x: [f64; 3]| {
        let x = R * Vec3::from(x);
        format!("[{:?}, {:?}, {:?}]", x.x, x.y, x.z)
    };
    format!(
        r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.25
[materials.m]
model = "elastic"
youngs_modulus = 2e11
poisson_ratio = 0.3
[sections.post]
shape = "general"
axial_stiffness = 1e7
shear_stiffness = [5e6, 5e6]
torsional_stiffness = 2e3
bending_stiffness = [4e3, 4e3]
[points]
foot = {}
head = {}
a = {}
b = {}
c = {}
d = {}
[[bodies]]
name = "block"
center = {}
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[beams]]
name = "post"
path = ["foot", "head"]
elements = 1
section = "post"
orientation = {}
[[shells]]
name = "strip"
corners = ["a", "b", "c", "d"]
elements = [6, 2]
thickness = 0.01
material = "m"
[[attachments]]
body = "block"
nodes = ["strip.edge4", "head"]
[[supports]]
at = "foot"
fix = "all"
[[loads]]
at = "b"
force = {}
[[loads]]
at = "strip.edge2"
force_per_length = {}
[output]
reactions = true
"#,
        point([-0.3, 0.1, -1.0]),
        point([-0.3, 0.1, 0.0]),
        point([0.0, 0.0, 0.2]),
        point([1.0, 0.0, 0.2]),
        point([1.0, 0.2, 0.2]),
        point([0.0, 0.2, 0.2]),
        point([-0.2, 0.1, 0.1]),
        point([1.0, 0.0, 0.0]),
        point([30.0, 200.0, 150.0]),
        point([0.0, 0.0, 800.0]),
    )
}

#[test]
fn an_edge_of_a_shell_on_a_body() {
    let straight = model(&bolted(&Mat3::identity()));
    let foot = node(&straight, "foot");
    let wanted = rdsolve::output::wanted(&straight) | rdsolve::solve::Wanted::REACTIONS;
    let system = rdsolve::system::System::new(&straight).unwrap();
    let plan = rdsolve::plan::Plan::new(&straight, &system, 1);
    let stop = std::sync::atomic::AtomicBool::new(false);
    struct Last(Vec<Vec3>, Vec<f64>);
    impl rdsolve::solve::Observer for Last {
        fn on_step(&mut self, frame: &rdsolve::solve::Frame) -> std::io::Result<()> {
            self.0 = frame.state.nodes.iter().map(|node| node.x).collect();
            self.1 = frame.reactions.to_vec();
            Ok(())
        }
    }
    let mut last = Last(Vec::new(), Vec::new());
    let (outcome, _) = rdsolve::solve::Run::new(&straight, &system, &plan, wanted, &stop).unwrap().run(&mut last);
    assert!(matches!(outcome, rdsolve::solve::Outcome::Done), "{outcome:?}");
    // Equilibrium of the whole in its deformed place: force and moment about the foot.
    let x = &last.0;
    let (mut f, mut m) = (Vec3::zeros(), Vec3::zeros());
    for load in &straight.loading.nodal {
        f += load.force;
        m += (x[load.node] - x[foot]).cross(&load.force);
    }
    let moved = (x[node(&straight, "b")] - straight.nodes[node(&straight, "b")].x).norm();
    assert!(moved > 0.05, "large: {moved}");
    let held: Vec<(usize, usize)> = straight.constraints.restraints.iter().map(|held| (held.node, held.dof)).collect();
    for ((at, dof), reaction) in held.iter().zip(&last.1) {
        assert_eq!(*at, foot);
        let exact = if *dof < 3 { -f[*dof] } else { -m[*dof - 3] };
        // The residual is 1e-8 of the largest force or moment.
        assert!((reaction - exact).abs() < 1e-6 * f.norm().max(m.norm()), "{dof}: {reaction} {exact}");
    }

    let R = Mat3::from(nalgebra::Rotation3::from_scaled_axis(Vec3::new(0.7, -1.1, 2.0)));
    let (one, two) = (displacements(&straight), displacements(&model(&bolted(&R))));
    for ((label, u), (_, v)) in one.iter().zip(&two) {
        let off = (R * Vec3::from(*u) - Vec3::from(*v)).norm();
        assert!(off < 1e-8 * moved, "{label}: {off}");
    }
}
