//! Cantilevers of MacNeal & Harder (Finite Elem. Anal. Des. 1, 1985) and Cook's membrane, each published element divided
//! n × n. In their plane quadrilaterals that taper would lock in bending, as all of four nodes without drilling do (MacNeal, Int.
//! J. Numer. Meth. Engrg. 24, 1987), and so would triangles: what is wanted is the answer from one element over the depth.

use super::benchmarks::{deck, displacements, fix, load, point, read, shell};
use crate::support;
use rdsolve::math::Vec3;
use rdsolve::model::{Load, Model, Update};
use std::f64::consts::PI;

const ALL: &str = "ux uy uz rx ry rz";
/// Loads so small that nothing turns.
const P: f64 = 1e-6;

/// What a row is compared with, and how it must come near.
struct Row {
    name: &'static str,
    wanted: f64,
    /// Errors that what is wanted has itself: a beam's theory leaves out its root, where the shell may neither contract across
    /// nor warp.
    floor: f64,
    /// The slope in the element size, least squares through the last three errors above `floor`, is at least this: 2 once the
    /// mesh resolves all there is. None where three errors above it are not to be had.
    slope: Option<f64>,
    /// Errors fall from this mesh of the ladder on.
    from: usize,
}

/// Errors of deflections on finer and finer meshes: they fall, as `row` has it, and the last is below 2 %.
fn ladder(title: &str, row: &Row, meshes: &[usize], of: impl Fn(usize) -> f64) {
    let found: Vec<f64> = meshes.iter().map(|&n| of(n)).collect();
    let errors: Vec<f64> = found.iter().map(|u| u / row.wanted - 1.0).collect();
    // Of stiffnesses, whose errors go with a power of the size also where they are large.
    let all = meshes.iter().zip(&found).map(|(&n, u)| (1.0 / n as f64, (row.wanted / u - 1.0).abs()));
    let above: Vec<(f64, f64)> = all.filter(|(_, excess)| *excess > row.floor).collect();
    let slope = (above.len() >= 3).then(|| support::slope(&above[above.len() - 3..]));
    let list: Vec<String> = meshes.iter().zip(&errors).map(|(n, e)| format!("{n}: {:+.2} %", 100.0 * e)).collect();
    let shown = format!("{title} {}: {}", row.name, list.join(", "));
    println!("{shown}; slope {}", slope.map_or("-".to_owned(), |slope| format!("{slope:.2}")));
    for pair in errors[row.from..].windows(2) {
        assert!(pair[1].abs() < pair[0].abs().max(row.floor), "does not come closer: {shown}");
    }
    assert!(errors.last().unwrap().abs() < 0.02, "{shown}");
    if let Some(bound) = row.slope {
        assert!(slope.is_some_and(|slope| slope > bound), "slope {slope:?}, not {bound}: {shown}");
    }
}

/// Deflections over P; the matrix of the first iteration serves the others.
fn deflections(mut model: Model, at: &[(&str, usize)]) -> Vec<f64> {
    model.solution.iteration.update = Update::Step;
    displacements(&model, at)[1].iter().map(|u| u / P).collect()
}

/// Saint-Venant's torsion constant of a rectangle, b ≥ t.
fn J(b: f64, t: f64) -> f64 {
    let term = |k: i32| (0.5 * f64::from(k) * PI * b / t).tanh() / f64::from(k).powi(5);
    b * t.powi(3) * (1.0 / 3.0 - 64.0 / PI.powi(5) * t / b * (1..100).step_by(2).map(term).sum::<f64>())
}

/// Six elements of 1 × 0.2, the sides between them upright, or inclined by 45° to either side in turn, or all to one; each
/// divided into n × `across`.
fn straight(kind: &str, shape: &str, [n, across]: [usize; 2], row: &str) -> f64 {
    let mut body = String::from("[points]\n");
    body += &point("a", [0.0, 0.0, 0.0]);
    body += &point("b", [6.0, 0.0, 0.0]);
    body += &point("c", [6.0, 0.2, 0.0]);
    body += &point("d", [0.0, 0.2, 0.0]);
    body += &shell("beam", "a b c d", [6 * n, across], kind, "");
    body += &fix("beam.edge4", ALL);
    let (force, moment, dof) = match row {
        "extension" => (Vec3::x(), Vec3::zeros(), 0),
        "in-plane" => (Vec3::y(), Vec3::zeros(), 1),
        "out-of-plane" => (Vec3::z(), Vec3::zeros(), 2),
        "twist" => (Vec3::zeros(), Vec3::x(), 2),
        _ => panic!("no row {row}"),
    };
    if dof < 2 {
        body += &fix("beam", "uz rx ry");
    }
    let mut model = read(&deck("straight beam", 1, [1e7, 0.3, 0.1], &body));
    let slant = |k: usize| match (shape, k) {
        ("regular", _) | (_, 0 | 6) => 0.0,
        ("trapezoids", _) if k.is_multiple_of(2) => -0.1,
        _ => 0.1,
    };
    for (index, node) in model.nodes.iter_mut().enumerate() {
        let (x, y) = (node.x.x, node.x.y);
        if x > 6.0 - 1e-9 {
            let corner = y.min(0.2 - y) < 1e-9;
            let share = P / across as f64 * if corner { 0.5 } else { 1.0 };
            let (force, moment) = (share * force, share * moment);
            model.loading.nodal.push(Load {
                node: index,
                force,
                moment,
                follower: false,
                amplitude: None,
                origin: None,
                moment_counts: true,
            });
        }
        // Bilinear in each published element.
        let k = (x.floor() as usize).min(5);
        let s = x - k as f64;
        node.x.x += ((1.0 - s) * slant(k) + s * slant(k + 1)) * (y / 0.1 - 1.0);
    }
    let u = deflections(model, &[("b", dof), ("c", dof)]);
    if row == "twist" { (u[1] - u[0]) / 0.2 } else { 0.5 * (u[0] + u[1]) }
}

/// Beam theory with shear for E = 1e7, ν = 0.3, L = 6, 0.2 × 0.1: 3e-5, 0.1081, 0.4321 as printed. The twist printed,
/// 0.03208, is 6 % less than Saint-Venant's T L/GJ, 0.0341, which the shells go to.
const EXTENSION: Row = Row { name: "extension", wanted: 3e-5, floor: 2e-3, slope: None, from: 0 };
const IN_PLANE: Row = Row { name: "in-plane", wanted: 0.108_094, floor: 3e-3, slope: None, from: 0 };
/// The root may not contract across. In nature that is felt over a width, in coarse meshes over the length of an element, which
/// is more: slope 1, and 1.9 without Poisson's ratio.
const OUT_OF_PLANE: Row = Row { name: "out-of-plane", wanted: 0.432_094, floor: 3e-3, slope: Some(0.8), from: 0 };
/// Next to free edges, over a third of the thickness, twisting turns from moments to shear. Meshes only begin to resolve it: a
/// slope between 1 and 2. One element over the width has nothing of it, and its error says nothing.
const TWIST: Row = Row { name: "twist", wanted: 0.0, floor: 6e-3, slope: Some(1.1), from: 1 };

fn straight_rows(kind: &str, shape: &str, in_plane: &Row, fine: &[usize], layers: &[usize]) {
    let title = format!("straight {shape} {kind}");
    let twist = &Row { wanted: 6.0 / (1e7 / 2.6 * J(0.2, 0.1)), ..TWIST };
    let of = |row: &Row, meshes: &[usize]| ladder(&title, row, meshes, |n| straight(kind, shape, [n, n], row.name));
    of(&EXTENSION, &[1, 2, 4, 8]);
    of(in_plane, fine);
    // 0.9 to 1.4.
    of(&OUT_OF_PLANE, &[1, 2, 4, 8]);
    // 1.2 to 1.4.
    of(twist, layers);
}

#[test]
fn straight_beam_of_quadrilaterals() {
    // Rectangles are within 1 % at once, pieces of any shape within 2 %: there are no three errors above the floor.
    for shape in ["regular", "trapezoids", "parallelograms"] {
        straight_rows("quadrilateral", shape, &IN_PLANE, &[1, 2, 4, 8], &[1, 2, 4, 8, 16]);
        let coarse = straight("quadrilateral", shape, [1, 1], "in-plane");
        assert!((coarse / IN_PLANE.wanted - 1.0).abs() < 0.025, "{shape}: {coarse}");
    }
}

#[test]
fn straight_beam_of_triangles() {
    // The error of the coarsest mesh says nothing: it is of either sign.
    let in_plane = Row { slope: None, from: 1, ..IN_PLANE };
    // Halves of rectangles are within 7 % at once, what is skewed has half of the deflection.
    for (shape, least) in [("regular", 0.93), ("trapezoids", 0.45), ("parallelograms", 0.45)] {
        straight_rows("triangle", shape, &in_plane, &[1, 2, 4, 8, 16, 32, 64], &[1, 2, 4, 8, 16, 32]);
        let coarse = straight("triangle", shape, [1, 1], "in-plane") / in_plane.wanted;
        assert!(coarse > least && coarse < 1.07, "{shape}: {coarse}");
    }
    // Most of it is for their length: as long as they are wide eight do over the depth.
    ladder("straight squares triangle", &in_plane, &[1, 2, 4, 8, 16], |n| {
        straight("triangle", "regular", [5 * n, n], "in-plane")
    });
}

/// A quarter of a ring, six elements of 15°, sheared at its end.
pub fn curved(kind: &str, n: usize, row: &str) -> f64 {
    let mut body = String::from("[points]\n");
    body += &point("a", [4.12, 0.0, 0.0]);
    body += &point("b", [4.32, 0.0, 0.0]);
    body += &point("c", [0.0, 4.32, 0.0]);
    body += &point("d", [0.0, 4.12, 0.0]);
    body += &shell("beam", "a b c d", [n, 6 * n], kind, "kind = \"cylinder\", axis = [0.0, 0.0, 1.0]");
    body += &fix("beam.edge1", ALL);
    let (force, dof) = match row {
        "in-plane" => ([0.0, P / 0.2, 0.0], 1),
        _ => ([0.0, 0.0, P / 0.2], 2),
    };
    if dof == 1 {
        body += &fix("beam", "uz rx ry");
    }
    body += &load("beam.edge3", "force_per_length", force);
    let u = deflections(read(&deck("curved beam", 1, [1e7, 0.25, 0.1], &body)), &[("c", dof), ("d", dof)]);
    0.5 * (u[0] + u[1])
}

/// Printed are 0.08734 and 0.5022, 1.4 % less and 0.3 % more than what is wanted here.
#[test]
fn curved_beam() {
    let (e, t, a, b) = (1e7, 0.1, 4.12_f64, 4.32_f64);
    let (r, area, g) = (0.5 * (a + b), t * (b - a), e / 2.5);
    // Timoshenko & Goodier, Theory of Elasticity, article on the curved bar bent by a force at the end.
    let squares = a * a + b * b;
    let within = PI * squares / (e * t * (a * a - b * b + squares * (b / a).ln()));
    // Castigliano, with shear.
    let EI = e * (b - a) * t.powi(3) / 12.0;
    let out = r.powi(3) * (0.25 * PI / EI + (0.75 * PI - 2.0) / (g * J(b - a, t))) + 0.6 * PI * r / (g * area);
    // In the plane within 1 % at once. Out of it 1.19 and 1.14, as of the straight beam: a third of the deflection is by twist.
    let in_plane = Row { name: "in-plane", wanted: within, floor: 1e-3, slope: None, from: 1 };
    for (kind, slope, fine, layers) in [
        ("quadrilateral", 0.9, &[1, 2, 4, 8, 16][..], &[1, 2, 4, 8, 16][..]),
        ("triangle", 1.0, &[1, 2, 4, 8, 16, 32, 64], &[1, 2, 4, 8, 16, 32]),
    ] {
        let out_of_plane = Row { name: "out-of-plane", wanted: out, floor: 6e-3, slope: Some(slope), from: 0 };
        ladder(&format!("curved {kind}"), &in_plane, fine, |n| curved(kind, n, "in-plane"));
        ladder(&format!("curved {kind}"), &out_of_plane, layers, |n| curved(kind, n, "out-of-plane"));
    }
}

/// Cook's tapered panel, n × n elements, sheared at its end. Deflection of the middle of the end.
pub fn cook(kind: &str, n: usize) -> f64 {
    let mut body = String::from("[points]\n");
    body += &point("a", [0.0, 0.0, 0.0]);
    body += &point("b", [48.0, 44.0, 0.0]);
    body += &point("c", [48.0, 60.0, 0.0]);
    body += &point("d", [0.0, 44.0, 0.0]);
    body += &shell("panel", "a b c d", [n, n], kind, "");
    body += &fix("panel.edge4", ALL);
    body += &fix("panel", "uz rx ry");
    body += &load("panel.edge2", "force_per_length", [0.0, P / 16.0, 0.0]);
    let mut model = read(&deck("Cook's membrane", 1, [1.0, 1.0 / 3.0, 1.0], &body));
    let middle = Vec3::new(48.0, 52.0, 0.0);
    let node = model.nodes.iter_mut().find(|node| (node.x - middle).norm() < 1e-9).expect("n is even");
    node.label = "middle".into();
    deflections(model, &[("middle", 1)])[0]
}

#[test]
fn cooks_membrane() {
    // Where fine meshes of any element go; four digits. Slopes 1.6 and above, the clamped corners being singular; the coarsest mesh has
    // half the error it had with straight edges.
    let row = Row { name: "end", wanted: 23.96, floor: 5e-4, slope: Some(1.4), from: 0 };
    for kind in ["quadrilateral", "triangle"] {
        ladder(&format!("Cook {kind}"), &row, &[2, 4, 8, 16, 32], |n| cook(kind, n));
    }
}
