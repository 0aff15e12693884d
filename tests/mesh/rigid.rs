//! Rigid parts: their mass, and the same part deformable and ever stiffer.

use super::{Folder, Plate, positions};
use crate::support::node;
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::Model;
use rdsolve::output::wanted;
use rdsolve::plan::Plan;
use rdsolve::solids::outline::Outline;
use rdsolve::solve::{Frame, Observer, Outcome, Run, Wanted};
use rdsolve::system::System;
use std::sync::atomic::AtomicBool;

fn model(deck: &str) -> Model {
    Folder::with(&[]).model(deck)
}

/// A plate of a material of its own on two flexible legs, a stiffener of tube under one edge.
fn bench(kind: &str, modulus: &str, bodies: &str, loads: &str) -> String {
    format!(
        r#"
[analysis]
kind = "{kind}"
end_time = 0.1
time_step = 0.002
[iteration]
tolerance = 1e-11
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[materials.stiff]
model = "elastic"
youngs_modulus = {modulus}
poisson_ratio = 0.3
density = 7850.0
[sections.leg]
shape = "rectangle"
width = 0.02
height = 0.03
[sections.tube]
shape = "tube"
radius = 0.02
thickness = 0.004
[points]
a = [0.0, 0.0, 0.5]
b = [0.4, 0.0, 0.5]
c = [0.4, 0.3, 0.6]
d = [0.0, 0.3, 0.6]
foot = [-0.1, 0.0, 0.0]
heel = [0.5, 0.1, 0.0]
[[shells]]
name = "plate"
corners = ["a", "b", "c", "d"]
elements = [4, 3]
thickness = 0.02
material = "stiff"
mass = "consistent"
[[beams]]
name = "rim"
path = ["a", "b"]
elements = 2
material = "stiff"
section = "tube"
orientation = [0.0, 1.0, 0.0]
mass = "consistent"
order = 1
[[beams]]
name = "legs"
path = ["foot", "a"]
elements = 2
material = "steel"
section = "leg"
orientation = [0.0, 1.0, 0.0]
[[beams]]
name = "legs2"
path = ["heel", "b"]
elements = 2
material = "steel"
section = "leg"
orientation = [0.0, 1.0, 0.0]
[[supports]]
at = ["foot", "heel"]
fix = "all"
{bodies}
{loads}
"#
    )
}

/// Rising smoothly: a force that is there at once accelerates single nodes of a deformable part however stiff it is.
const LOADS: &str = r#"
[[loads]]
at = "c"
force = [300.0, 500.0, -400.0]
amplitude = "push"
[[loads]]
at = "plate"
pressure = 2000.0
amplitude = "push"
[[loads]]
at = "plate.edge3"
force_per_length = [0.0, 0.0, 700.0]
amplitude = "push"
[amplitudes.push]
kind = "sine-squared"
frequency = 2.5
"#;

const BODY: &str = "[[bodies]]\nname = \"table\"\nparts = [\"plate\", \"rim\"]\n";

/// A thousand times stiffer, a thousandth of the difference: statics to the last step, dynamics over fifty steps.
#[test]
fn a_stiff_part_becomes_the_rigid_one() {
    for kind in ["static", "dynamic"] {
        let rigid = model(&bench(kind, "210e9", BODY, LOADS));
        assert!(
            rigid.parts.iter().filter(|part| ["plate", "rim"].contains(&part.name())).all(|part| part.elements() == 0)
        );
        let exact = positions(&rigid, "c");
        let moved = exact.iter().map(|x| (Vec3::from(*x) - Vec3::from(exact[0])).norm()).fold(0.0, f64::max);
        assert!(moved > 5e-3, "it moves: {moved}");
        let off = ["21e9", "21e12", "21e15"].map(|modulus| {
            let found = positions(&model(&bench(kind, modulus, "", LOADS)), "c");
            let off = found.iter().zip(&exact).map(|(x, exact)| (Vec3::from(*x) - Vec3::from(*exact)).norm());
            off.fold(0.0, f64::max) / moved
        });
        println!("{kind}: {off:?}");
        let [soft, stiff, stiffest] = off;
        assert!(soft < 0.5, "{off:?}");
        assert!((stiff / stiffest / 1000.0).ln().abs() < 0.1, "{kind}: {off:?}");
    }
}

/// One word: the part is a body of its name, with everything that acted on it; interior nodes are gone.
#[test]
fn one_word_makes_a_part_rigid() {
    let deck = bench("dynamic", "210e9", "", LOADS).replace("mass = \"consistent\"\norder = 1", "");
    let stray = deck.replace("name = \"plate\"", "name = \"plate\"\nrigid = true");
    let rigid = model(&stray.replace("thickness = 0.02", "thickness = 0.03"));
    assert_eq!(rigid.bodies[0].name, "plate");
    let soft = model(&deck);
    // Pressure acts on every node of the plate, so all of them ride.
    assert_eq!(rigid.nodes.len(), soft.nodes.len() + 1);
    // Without it only those that are named, shared or loaded.
    let free = stray
        .replace("[[loads]]\nat = \"plate\"\npressure = 2000.0\namplitude = \"push\"\n", "")
        .replace("at = \"plate.edge3\"", "at = \"plate.edge1\"");
    let left = model(&free);
    let attached =
        left.constraints.dependents.iter().filter(|dependent| dependent.master == left.bodies[0].node).count();
    // Four corners, and three more nodes along edge1, which a load names.
    assert_eq!(attached, 7, "{:?}", left.nodes.iter().map(|node| node.label.as_str()).collect::<Vec<_>>());
    let system = System::new(&rigid).unwrap();
    let text = rdsolve::plan::explain::explain(&Plan::new(&rigid, &system, 1), &rigid, &system).to_string();
    assert!(text.contains("shell `plate` as body `plate`, mass ") && text.contains("its 12 elements"), "{text}");
    let Outline { points, cells } = rigid.bodies[0].shape.outline();
    assert_eq!((points.len(), cells.len()), (20, 12));
    // Its corners are where the points are.
    let center = rigid.nodes[rigid.bodies[0].node].x;
    assert!(points.iter().any(|p| (center + p - Vec3::new(0.4, 0.3, 0.6)).norm() < 1e-15));
}

/// Exact integrals: a rectangle a × b, cut anyhow into faces; a tube along its axis.
#[test]
fn mass_and_inertia_are_integrals() {
    let (a, b, h, density) = (2.0, 2.0, 0.05, 7850.0);
    let (m, thin) = (density * a * b * h, density * a * b * h * h * h / 12.0);
    let exact = Mat3::from_diagonal(&Vec3::new(m * b * b / 12.0, m * a * a / 12.0, m * (a * a + b * b) / 12.0))
        + thin * Mat3::identity();
    let head = |part: &str| {
        format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.1\n[materials.m]\nmodel = \"elastic\"\n\
             youngs_modulus = 1e9\npoisson_ratio = 0.3\ndensity = 7850.0\n{part}"
        )
    };
    let folder = Folder::with(&[("square.msh", include_str!("square.msh"))]);
    let shell = "[mesh]\nfile = \"square.msh\"\n[[shells]]\ngroup = \"everything\"\nthickness = 0.05\nmaterial = \"m\"\nrigid = true\n";
    let body = &folder.model(&head(shell)).bodies[0];
    assert!((body.mass / m - 1.0).abs() < 1e-13, "{}", body.mass);
    assert!((body.inertia - exact).norm() < 1e-12 * exact.norm(), "{}", body.inertia);

    let tube = "[sections.t]\nshape = \"tube\"\nradius = 0.05\nthickness = 0.01\n[points]\np = [1.0, 2.0, 3.0]\nq = [1.0, 2.0, 5.0]\n\
                [[beams]]\nname = \"tube\"\npath = [\"p\", \"q\"]\nelements = 3\nmaterial = \"m\"\nsection = \"t\"\norientation = [1.0, 0.0, 0.0]\nrigid = true\n";
    let model = model(&head(tube));
    let body = &model.bodies[0];
    let (r, s, l) = (0.05f64, 0.04f64, 2.0);
    let m = density * std::f64::consts::PI * (r * r - s * s) * l;
    let (across, along) = (m * (r * r + s * s) / 4.0 + m * l * l / 12.0, m * (r * r + s * s) / 2.0);
    assert!((body.mass / m - 1.0).abs() < 1e-13);
    assert!((model.nodes[body.node].x - Vec3::new(1.0, 2.0, 4.0)).norm() < 1e-14);
    assert!((body.inertia - Mat3::from_diagonal(&Vec3::new(across, across, along))).norm() < 1e-12 * across);
}

/// A rigid plate under pressure flies as ½ p A/m t², and as a body of the same numbers given in the deck when it is struck
/// at a corner: there the same motion to rounding.
#[test]
fn a_rigid_plate_flies() {
    let head = "[analysis]\nkind = \"dynamic\"\nend_time = 0.5\ntime_step = 0.01\n[materials.m]\nmodel = \"elastic\"\n\
                youngs_modulus = 1e9\npoisson_ratio = 0.3\ndensity = 1000.0\n[mesh]\nfile = \"a.msh\"\n\
                [[shells]]\ngroup = \"plate\"\nthickness = 0.01\nmaterial = \"m\"\nrigid = true\n";
    let folder = Folder::with(&[("a.msh", &Plate { n: 4, m: 2, size: [1.0, 0.5] }.msh4())]);
    let model = folder.model(&format!("{head}[[loads]]\nat = \"plate\"\npressure = -100.0\n"));
    let z = positions(&model, "plate").last().unwrap()[2];
    // Upwards, along the normal; the scheme is exact under a constant force.
    assert!((z / (0.5 * 100.0 / (1000.0 * 0.01) * 0.25) - 1.0).abs() < 1e-12, "{z}");

    let struck = "[[loads]]\nat = \"corner\"\nforce = [0.0, 1.0, 5.0]\n";
    let model = folder.model(&format!("{head}{struck}"));
    let body = &model.bodies[0];
    let J = body.inertia;
    let given = format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.5\ntime_step = 0.01\n[points]\ncorner = [1.0, 0.5, 0.0]\n\
         [[bodies]]\nname = \"plate\"\ncenter = [0.5, 0.25, 0.0]\nmass = {:?}\ninertia = [{:?}, {:?}, {:?}]\n\
         [[attachments]]\nbody = \"plate\"\nnodes = \"corner\"\n{struck}",
        body.mass,
        J[(0, 0)],
        J[(1, 1)],
        J[(2, 2)]
    );
    let (one, two) = (positions(&model, "plate"), positions(&self::model(&given), "plate"));
    for (a, b) in one.iter().zip(&two) {
        assert!((Vec3::from(*a) - Vec3::from(*b)).norm() < 1e-12, "{a:?} {b:?}");
    }
}

/// A body of parts on its legs, pushed: the scheme takes little and less with shorter steps.
#[test]
fn energy_of_rigid_parts() {
    let lost = |step: &str| {
        let deck = bench("dynamic", "210e9", BODY, LOADS);
        let model = model(&deck.replace("time_step = 0.002", step));
        let at = node(&model, "table");
        let system = System::new(&model).unwrap();
        let plan = Plan::new(&model, &system, 1);
        assert_eq!(plan.dofs.of(at).count(), 6);
        let mut watch = Energies::default();
        let stop = AtomicBool::new(false);
        let wanted = wanted(&model) | Wanted::ENERGY;
        let (outcome, _) = Run::new(&model, &system, &plan, wanted, &stop).unwrap().run(&mut watch);
        assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
        watch.numerical / watch.kinetic
    };
    let off = ["time_step = 1e-3", "time_step = 2.5e-4"].map(lost);
    println!("{off:?}");
    assert!(off[0] < 0.05 && off[1] < off[0] / 10.0, "{off:?}");
}

/// Greatest absolute values over a run.
#[derive(Default)]
struct Energies {
    numerical: f64,
    kinetic: f64,
}

impl Observer for Energies {
    fn on_step(&mut self, frame: &Frame) -> std::io::Result<()> {
        let Some(energy) = frame.derived.energy else { return Ok(()) };
        self.numerical = self.numerical.max(energy.numerical.abs());
        self.kinetic = self.kinetic.max(energy.kinetic.abs());
        Ok(())
    }
}
