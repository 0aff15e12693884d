//! Pressure that follows: faces by themselves, then scenes with exact solutions.

use super::benchmarks::{displacements, read};
use crate::support;
use crate::support::random::vector;
use nalgebra::DMatrix;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::elements::pressure::Face;
use rdsolve::elements::shell;
use rdsolve::math::Vec3;
use rdsolve::state::Node;

fn at(x: &[Vec3]) -> Vec<Node> {
    x.iter().map(|&x| Node::at_rest(x)).collect()
}

fn forces(faces: &[Face], p: f64, x: &[Vec3]) -> Vec<Vec3> {
    let mut F = vec![[0.0; 6]; x.len()];
    faces.iter().for_each(|face| {
        face.add_forces(p, &at(x), &mut F);
    });
    F.iter().map(|f| Vec3::new(f[0], f[1], f[2])).collect()
}

/// −∂F/∂x of all faces.
fn stiffness(faces: &[Face], p: f64, x: &[Vec3]) -> DMatrix<f64> {
    let mut sum = DMatrix::zeros(3 * x.len(), 3 * x.len());
    for face in faces {
        let n = face.nodes().len();
        let mut K = vec![0.0; 9 * n * n];
        face.stiffness(p, &at(x), &mut K);
        for i in 0..3 * n {
            for j in 0..3 * n {
                sum[(3 * face.nodes()[i / 3] + i % 3, 3 * face.nodes()[j / 3] + j % 3)] += K[3 * n * i + j];
            }
        }
    }
    sum
}

/// A block of which no face is plane: four quadrilaterals round it, triangles below and above. Normals point out.
fn block(rng: &mut StdRng) -> (Vec<Vec3>, Vec<Face>) {
    let corner = |k: usize| Vec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64);
    let x = (0..8).map(|k| corner(k) + vector(rng, 0.2)).collect();
    let round = [[0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]].map(Face::Quadrilateral);
    let ends = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6]].map(Face::Triangle);
    (x, round.into_iter().chain(ends).collect())
}

/// Volume by the flux of x/3, at Gauss points of each face: a road of its own.
fn volume(faces: &[Face], x: &[Vec3]) -> f64 {
    let face = |face: &Face| match face {
        Face::Triangle([a, b, c]) => x[*a].dot(&x[*b].cross(&x[*c])) / 6.0,
        Face::Quadrilateral(n) => {
            let g = 1.0 / 3f64.sqrt();
            let point = |(xi, eta): (f64, f64)| {
                let N = [
                    (1.0 - xi) * (1.0 - eta),
                    (1.0 + xi) * (1.0 - eta),
                    (1.0 + xi) * (1.0 + eta),
                    (1.0 - xi) * (1.0 + eta),
                ];
                let X: Vec3 = (0..4).map(|a| 0.25 * N[a] * x[n[a]]).sum();
                let by_xi = 0.25 * ((1.0 - eta) * (x[n[1]] - x[n[0]]) + (1.0 + eta) * (x[n[2]] - x[n[3]]));
                let by_eta = 0.25 * ((1.0 - xi) * (x[n[3]] - x[n[0]]) + (1.0 + xi) * (x[n[2]] - x[n[1]]));
                X.dot(&by_xi.cross(&by_eta)) / 3.0
            };
            [(-g, -g), (g, -g), (g, g), (-g, g)].into_iter().map(point).sum::<f64>()
        }
        Face::CurvedTriangle(_) | Face::CurvedQuadrilateral(_) => 0.0,
    };
    faces.iter().map(face).sum()
}

/// The matrix against differences of forces that are polynomials of second degree: central ones are exact but for
/// rounding, 1e-16/h.
#[test]
fn stiffness_is_the_derivative_of_the_forces() {
    let mut rng = StdRng::seed_from_u64(11);
    for _ in 0..10 {
        for n in [3, 4, 6, 9] {
            let x: Vec<Vec3> = (0..n).map(|_| vector(&mut rng, 1.0)).collect();
            let nodes: Vec<usize> = (0..n).collect();
            let face = [Face::of(&nodes).unwrap()];
            let (p, h) = (1.7, 1e-2);
            let K = stiffness(&face, p, &x);
            for j in 0..3 * n {
                let moved = |h: f64| {
                    let mut x = x.clone();
                    x[j / 3][j % 3] += h;
                    forces(&face, p, &x)
                };
                let (plus, minus) = (moved(h), moved(-h));
                for i in 0..3 * n {
                    let k = -(plus[i / 3][i % 3] - minus[i / 3][i % 3]) / (2.0 * h);
                    let size = if n > 4 { 10.0 } else { 1.0 };
                    assert!((K[(i, j)] - k).abs() < 1e-12 * size, "{n} {i} {j}: {} {k}", K[(i, j)]);
                }
            }
        }
    }
    assert!(Face::of(&[0, 1]).is_none());
}

/// Where nothing has moved, a pressure that follows is the one that does not: the same integral by quadrature. Turning and
/// moving the face turns the forces.
#[test]
fn forces_are_those_of_dead_pressure_and_turn_with_the_face() {
    let mut rng = StdRng::seed_from_u64(12);
    for n in [3, 4, 6, 9] {
        let x: Vec<Vec3> = (0..n).map(|_| vector(&mut rng, 1.0)).collect();
        let nodes: Vec<usize> = (0..n).collect();
        let face = Face::of(&nodes).unwrap();
        let areas = face.areas(|n| x[n]);
        for (a, b) in areas.iter().zip(shell::faces(&x)) {
            assert!((a - b).norm() < 1e-15, "{a} {b}"); // rounding of areas below 1
        }
        let R = nalgebra::Rotation3::new(vector(&mut rng, 2.0));
        let shift = vector(&mut rng, 3.0);
        for (a, b) in areas.iter().zip(face.areas(|n| R * x[n] + shift)) {
            assert!((R * a - b).norm() < 1e-14); // and of the shift
        }
    }
}

/// Closed surfaces: no resultant, no moment, a symmetric matrix, and work p ΔV over steps of any size. Bounds: rounding.
#[test]
fn closed_surfaces_have_a_potential() {
    let mut rng = StdRng::seed_from_u64(13);
    for _ in 0..5 {
        let (x, faces) = block(&mut rng);
        let (y, _) = block(&mut rng);
        let F = forces(&faces, 2.0, &x);
        let moment: Vec3 = F.iter().zip(&x).map(|(f, x)| x.cross(f)).sum();
        assert!(F.iter().sum::<Vec3>().norm() < 1e-14 && moment.norm() < 1e-14);
        let K = stiffness(&faces, 2.0, &x);
        assert!((&K - K.transpose()).amax() < 1e-14 * K.amax());
        assert!((stiffness(&faces[..1], 2.0, &x) - stiffness(&faces[..1], 2.0, &x).transpose()).amax() > 1e-2);
        let change = volume(&faces, &y) - volume(&faces, &x);
        let work = |p| faces.iter().map(|face| face.work(p, &at(&x), &at(&y))).sum::<f64>();
        // Forces act against normals that point out.
        assert!((work([2.0, 2.0]) + 2.0 * change).abs() < 1e-14, "{} {change}", work([2.0, 2.0]));
        // A pressure that grows: against the sum over many small parts of the way by the middle of each, of second order.
        let parts = 1000;
        let part = |k: usize| {
            let at_s = |s: f64| -> Vec<Vec3> { x.iter().zip(&y).map(|(x, y)| x + s * (y - x)).collect() };
            let s = |k: usize| k as f64 / parts as f64;
            -(1.0 + 2.0 * 0.5 * (s(k) + s(k + 1))) * (volume(&faces, &at_s(s(k + 1))) - volume(&faces, &at_s(s(k))))
        };
        let sum: f64 = (0..parts).map(part).sum();
        assert!((work([1.0, 3.0]) - sum).abs() < 1e-6, "{} {sum}", work([1.0, 3.0]));
    }
}

const INFLATED: &str = r#"
title = "inflated strip"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.1
[materials.m]
model = "elastic"
youngs_modulus = 1e5
poisson_ratio = 0.0
[points]
a = [-0.5, 0.0, 0.0]
b = [0.5, 0.0, 0.0]
c = [0.5, 0.2, 0.0]
d = [-0.5, 0.2, 0.0]
[[shells]]
name = "strip"
corners = ["a", "b", "c", "d"]
elements = [COUNT, 1]
thickness = 1e-3
material = "m"
kind = "KIND"
surface = { kind = "cylinder", center = [0.0, 0.0, -0.8660254037844386], axis = [0.0, 1.0, 0.0] }
[[supports]]
at = ["strip.edge2", "strip.edge4"]
fix = ["ux", "uy", "uz"]
[[loads]]
at = "strip"
pressure = -30.0
follower = true
"#;

/// A strip between two hinges, an arc of 60° at first, is blown up: T = p R, with T = λ E h ½ (λ² − 1) since stress and strain
/// are those of Kirchhoff and Green, and the chord kept. Second order in the length of elements; bending, which the
/// formula leaves out, is h²/(12 R ε) ≈ 1e-6 of the span.
#[test]
fn a_strip_is_blown_up_to_an_arc() {
    let (span, angle, p, stiffness): (f64, f64, f64, f64) = (1.0, 30f64.to_radians(), 30.0, 100.0);
    let length = span * angle / angle.sin();
    // Half angle by bisection; T grows with it faster than p R.
    let (mut low, mut high) = (angle, 0.5 * std::f64::consts::PI);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        let (radius, stretch) = (0.5 * span / middle.sin(), span * middle / middle.sin() / length);
        let over = stiffness * 0.5 * (stretch * stretch - 1.0) * stretch > p * radius;
        if over { high = middle } else { low = middle }
    }
    let radius = 0.5 * span / low.sin();
    let rise = radius * (1.0 - low.cos());
    println!("radius {radius}, half angle {}°, rise {rise}", low.to_degrees());
    for kind in ["quadrilateral", "triangle"] {
        let errors: Vec<f64> = [8, 16, 32]
            .into_iter()
            .map(|n| {
                let model = read(&INFLATED.replace("COUNT", &n.to_string()).replace("KIND", kind));
                let top =
                    (0..model.nodes.len()).max_by(|a, b| model.nodes[*a].x.z.total_cmp(&model.nodes[*b].x.z)).unwrap();
                let done = support::run_to_the_end(&model, &mut |frame| vec![frame.state.nodes[top].x.z]);
                let found = done.rows.last().unwrap()[0];
                println!("{kind} {n}: rise {found} ({:+.2e}), {:?}", found / rise - 1.0, done.counts);
                (found / rise - 1.0).abs()
            })
            .collect();
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!(order > 1.8 && order < 2.2, "{kind}: order {order}");
        }
        assert!(errors[2] < 1e-3, "{kind}: {errors:?}");
    }
}

const CANTILEVER: &str = r#"
title = "cantilever under pressure that follows"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.1
[materials.m]
model = "elastic"
youngs_modulus = 1.5e8
poisson_ratio = 0.0
[points]
a = [0.0, 0.0, 0.0]
b = [10.0, 0.0, 0.0]
c = [10.0, WIDTH, 0.0]
d = [0.0, WIDTH, 0.0]
[[shells]]
name = "strip"
corners = ["a", "b", "c", "d"]
elements = [ALONG, ACROSS]
thickness = 0.02
material = "m"
[[supports]]
at = "strip.edge4"
fix = "all"
[[loads]]
at = "strip"
pressure = -0.6
follower = true
"#;

/// Tip of a cantilever of length 10, EI = 100, under q = 0.6 a length along its normal. From the free end, where all
/// resultants vanish: N' = Q κ, Q' = −N κ − q, M' = −Q, θ' = κ = M/EI (Runge & Kutta, 4th order, 1000 steps: 1e-12).
fn elastica() -> [f64; 2] {
    let rate = |y: [f64; 6]| {
        let [n, q, m, angle, ..] = y;
        let k = m / 100.0;
        [q * k, -n * k - 0.6, -q, k, angle.cos(), angle.sin()]
    };
    let (steps, mut y) = (1000, [0.0; 6]);
    let h = -10.0 / steps as f64;
    for _ in 0..steps {
        let plus = |s: f64, k: [f64; 6]| std::array::from_fn(|i| y[i] + s * k[i]);
        let a = rate(y);
        let b = rate(plus(0.5 * h, a));
        let c = rate(plus(0.5 * h, b));
        let d = rate(plus(h, c));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    // The root seen from the tip, in axes of the tip: turned to those of the root.
    let (s, c) = y[3].sin_cos();
    [-(c * y[4] + s * y[5]), -(c * y[5] - s * y[4])]
}

/// No potential: the matrix is not symmetric. By LU it is whole and steps converge as Newton's do; the wide strip takes
/// Cholesky and the symmetric part, to the same end.
#[test]
fn a_cantilever_curls_under_pressure() {
    let exact = elastica();
    println!("exact tip {exact:?}");
    let mut errors = Vec::new();
    for (along, across, width) in [(8, 1, "1.0"), (16, 1, "1.0"), (32, 1, "1.0"), (32, 10, "4.0")] {
        let deck = CANTILEVER.replace("ALONG", &along.to_string()).replace("ACROSS", &across.to_string());
        let model = read(&deck.replace("WIDTH", width));
        let rows = displacements(&model, &[("b", 0), ("b", 2)]);
        let end = rows.last().unwrap();
        let error = (end[0] + 10.0 - exact[0]).hypot(end[1] - exact[1]) / 10.0;
        println!("{along} x {across}: {:?} error {error:.2e}", [end[0] + 10.0, end[1]]);
        errors.push(error);
    }
    let order = |k: usize| (errors[k] / errors[k + 1]).log2();
    assert!(order(0) > 1.8 && order(1) > 1.8, "{errors:?}");
    assert!(errors[2] < 2e-3 && (errors[3] - errors[2]).abs() < 1e-4, "{errors:?}");
}

/// A strip blown up in a moment and set swinging: what the scheme takes, `numerical`, falls as the square of the step.
#[test]
fn the_balance_of_energy_holds_the_work_of_pressure() {
    let numerical: Vec<f64> = [2e-4, 1e-4, 5e-5]
        .into_iter()
        .map(|step| {
            let deck = INFLATED
                .replace("\"static\"", "\"dynamic\"")
                .replace("end_time = 1.0", "end_time = 0.02")
                .replace("time_step = 0.1", &format!("time_step = {step:?}"))
                .replace("poisson_ratio = 0.0", "poisson_ratio = 0.3\ndensity = 1000.0")
                .replace("thickness = 1e-3", "thickness = 1e-2")
                .replace("pressure = -30.0", "pressure = -300.0\namplitude = \"push\"")
                .replace("COUNT", "6")
                .replace("KIND", "quadrilateral")
                + "[amplitudes.push]\nkind = \"sine-squared\"\nfrequency = 20.0\n";
            let model = read(&deck);
            let done = support::run_to_the_end(&model, &mut |frame| {
                let energy = frame.derived.energy.unwrap();
                vec![energy.numerical, energy.external, energy.kinetic]
            });
            let largest = |k: usize| done.rows.iter().map(|row| row[k].abs()).fold(0.0, f64::max);
            println!("{step}: numerical {:.3e}, external {:.3e}, kinetic {:.3e}", largest(0), largest(1), largest(2));
            assert!(largest(2) > 0.05 * largest(1), "it moves");
            largest(0) / largest(1)
        })
        .collect();
    let order = |k: usize| (numerical[k] / numerical[k + 1]).log2();
    assert!(order(0) > 1.7 && order(1) > 1.8, "{numerical:?}");
    assert!(numerical[2] < 1e-2, "{numerical:?}");
}
