//! What an answer must not depend on: which way round elements are numbered, where the diagonals of triangles lie but for
//! a mirror, how the scene stands in space; and the order in the time step.

use super::benchmarks::{displacements, read};
use crate::support;
use rdsolve::math::{Mat3, Vec3, rotation};

/// The outer layers at the clamp go some ten times as far as where they yield.
const YIELDING: &str = "model = \"elastic-plastic\"\nyield_stress = 4e3\nhardening_modulus = 1e5\n";
const ELASTIC: &str = "model = \"elastic\"\n";

/// A quarter of a cylinder, its first straight side clamped, in a frame of its own.
struct Panel {
    kind: &'static str,
    material: &'static str,
    /// Of the corners 0 to 3: which come first, second, third and fourth.
    order: [usize; 4],
    /// Elements along the arc and along the axis.
    elements: [usize; 2],
    /// Of the loads.
    force: f64,
    /// Turns and mirrors the scene; an origin.
    frame: Mat3,
    origin: Vec3,
}

const PLAIN: Panel = Panel {
    kind: "quadrilateral",
    material: ELASTIC,
    order: [0, 1, 2, 3],
    elements: [6, 4],
    force: 3.0,
    frame: Mat3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
    origin: Vec3::new(0.0, 0.0, 0.0),
};

impl Panel {
    fn vector(&self, x: f64, y: f64, z: f64) -> String {
        let v = self.frame * Vec3::new(x, y, z);
        format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
    }

    /// What `analysis` begins, with two dead forces that bend and twist the panel into large rotations.
    fn deck(&self, analysis: &str) -> String {
        // By radius 1 and length 1.5, in order along the arc, up, back, down.
        let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.5], [1.0, 0.0, 1.5]];
        let mut deck = format!("title = \"panel\"\n{analysis}\n[iteration]\ntolerance = 1e-12\n[points]\n");
        for (name, x) in ["a", "b", "c", "d"].iter().zip(corners) {
            let x = self.frame * Vec3::from(x) + self.origin;
            deck += &format!("{name} = [{:?}, {:?}, {:?}]\n", x.x, x.y, x.z);
        }
        let names = self.order.map(|k| ["a", "b", "c", "d"][k]);
        // Edge k runs from corner k on; that from d to a is clamped.
        let clamped = (0..4).find(|&k| self.order[k].abs_diff(self.order[(k + 1) % 4]) == 3).unwrap() + 1;
        let straight = [self.order[0], self.order[1]].iter().all(|k| [0, 3].contains(k))
            || [self.order[0], self.order[1]].iter().all(|k| [1, 2].contains(k));
        let [n, m] = self.elements;
        let elements = if straight { [m, n] } else { [n, m] };
        deck + &format!(
            "[[shells]]\nname = \"p\"\ncorners = {names:?}\nelements = {elements:?}\nkind = \"{}\"\nthickness = 0.05\n\
             material = \"m\"\nsurface = {{ kind = \"cylinder\", axis = {}, center = [{:?}, {:?}, {:?}] }}\n\
             [materials.m]\n{}youngs_modulus = 1e6\npoisson_ratio = 0.3\ndensity = 1.0\n\
             [[supports]]\nat = \"p.edge{clamped}\"\nfix = \"all\"\n\
             [[loads]]\nat = \"b\"\nforce = {}\namplitude = \"f\"\n[[loads]]\nat = \"c\"\nforce = {}\namplitude = \"f\"\n",
            self.kind,
            self.vector(0.0, 0.0, 1.0),
            self.origin.x,
            self.origin.y,
            self.origin.z,
            self.material,
            self.vector(-9.0 * self.force, 5.0 * self.force, 3.0 * self.force),
            self.vector(-4.0 * self.force, 8.0 * self.force, -6.0 * self.force),
        )
    }

    fn pushed(&self) -> Vec<Vec3> {
        let analysis = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.125\n\
                        [amplitudes.f]\nkind = \"ramp\"\nend = 1.0\n";
        self.answer(&self.deck(analysis))
    }

    /// Thrown as well as pulled, against the clamp at once. With steps of 1e-3, in which waves run through four elements, the time integration adds energy
    /// to some of such throws, to quadrilaterals and to triangles alike, and their answers hang on the last digit.
    fn shaken(&self) -> Vec<Vec3> {
        let analysis = "[analysis]\nkind = \"dynamic\"\nend_time = 0.04\ntime_step = 5e-4\n\
                        [amplitudes.f]\nkind = \"sine-squared\"\nangular_frequency = 60.0\n";
        let thrown = format!("[[initial]]\nat = \"p\"\nvelocity = {}\n", self.vector(-4.0, -6.0, 3.0));
        self.answer(&(self.deck(analysis) + &thrown))
    }

    /// Displacements of b and c at every step, in the frame of the panel.
    fn answer(&self, deck: &str) -> Vec<Vec3> {
        let places = [("b", 0), ("b", 1), ("b", 2), ("c", 0), ("c", 1), ("c", 2)];
        let rows = displacements(&read(deck), &places);
        let pairs = rows.iter().flat_map(|row| [Vec3::new(row[0], row[1], row[2]), Vec3::new(row[3], row[4], row[5])]);
        pairs.map(|u| self.frame.tr_mul(&u)).collect()
    }
}

/// The largest difference is rounding, at the end of an iteration that goes on to 1e-12.
fn same(what: &str, a: &[Vec3], b: &[Vec3]) {
    let far = a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let size = a.iter().map(|a| a.norm()).fold(0.0, f64::max);
    println!("{what}: {far:.1e} of {size:.2}");
    assert!(size > 0.15, "{what} hardly moves: {size}");
    assert!(a.len() == b.len() && far < 1e-12 * size, "{what}: {far:e} of {size}");
}

fn all(mut check: impl FnMut(&str, Panel)) {
    for kind in ["quadrilateral", "triangle"] {
        for (word, material, force) in [("elastic", ELASTIC, 3.0), ("yielding", YIELDING, 1.0)] {
            check(&format!("{kind}, {word}"), Panel { kind, material, force, ..PLAIN });
        }
    }
}

#[test]
fn numbering_does_not_matter() {
    all(|what, panel| {
        let found = panel.pushed();
        // Round by one, by two and by three, then the other way round, when normals point the other way. The diagonals of
        // triangles lie across then where the number of elements is even: there the whole mesh is the same one only by two.
        for order in [[1, 2, 3, 0], [2, 3, 0, 1], [3, 0, 1, 2], [0, 3, 2, 1], [1, 0, 3, 2], [2, 1, 0, 3], [3, 2, 1, 0]]
        {
            if panel.kind == "quadrilateral" || order == [2, 3, 0, 1] {
                same(&format!("{what}, from {order:?}"), &found, &Panel { order, ..panel }.pushed());
            }
        }
    });
}

#[test]
fn mirrored_scene_has_mirrored_answer() {
    all(|what, panel| {
        for diagonal in [Vec3::new(1.0, 1.0, -1.0), Vec3::new(-1.0, 1.0, 1.0)] {
            let frame = Mat3::from_diagonal(&diagonal);
            let found = Panel { elements: [5, 3], ..panel };
            same(what, &found.pushed(), &Panel { frame, ..found }.pushed());
        }
    });
}

#[test]
fn turned_scene_has_turned_answer() {
    let frame = rotation::matrix(&rotation::exp(&Vec3::new(1.3, -0.7, 2.1)));
    let origin = Vec3::new(3.0, -2.0, 1.0);
    all(|what, panel| {
        let turned = Panel { frame, origin, ..panel };
        same(&format!("{what}, pushed"), &panel.pushed(), &turned.pushed());
        same(&format!("{what}, shaken"), &panel.shaken(), &turned.shaken());
    });
}

/// Wilson-θ, second order, on a panel shaken so smoothly that steps resolve what moves.
#[test]
fn order_in_the_time_step() {
    for kind in ["quadrilateral", "triangle"] {
        let panel = Panel { kind, elements: [4, 3], ..PLAIN };
        let run = |step: f64| {
            let analysis = format!(
                "[analysis]\nkind = \"dynamic\"\nend_time = 0.4\ntime_step = {step:?}\n[output]\ninterval = 0.04\n\
                 [amplitudes.f]\nkind = \"sine-squared\"\nangular_frequency = {:?}\n",
                std::f64::consts::PI / 0.4
            );
            panel.answer(&panel.deck(&analysis)).iter().map(|u| vec![u.x, u.y, u.z]).collect::<Vec<_>>()
        };
        let finest = run(3.125e-5);
        let steps = [1e-3, 5e-4, 2.5e-4];
        let points = steps.map(|step| (step, support::error(&run(step), &finest, 0)));
        let slope = support::slope(&points);
        println!("{kind}: {points:?}, slope {slope:.2}");
        // The reference is eight times as fine as the last, which takes 1/64 off its error: 0.01 of the slope; the longest step
        // is a twentieth of the shortest period that matters.
        assert!((slope - 2.0).abs() < 0.08, "{kind}: slope {slope}");
    }
}
