//! One element, and patches of a few.

use crate::support::blocks::{forces, nudge, stiffness};
use crate::support::random::{turn, vector};
use nalgebra::DVector;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::elements::heat::Heat;
use rdsolve::elements::shell::{
    DRILLING, LayerModel, Plate, Quadrilateral, Quadrilaterals, ShellGeometry, Triangle, Triangles,
};
use rdsolve::elements::{ElementBlock, Moduli};
use rdsolve::materials::{Dissipation, FailureCriterion, Hardening, MaterialLaw};
use rdsolve::math::{Mat3, Vec3, rotation};
use rdsolve::state::{Configuration, Node};

const PLATE: Plate = Plate { thickness: 0.1, E: 1e3, nu: 0.3, drilling: DRILLING };

/// A mesh of elements of one kind with normals along z, or as given.
struct Mesh {
    x: Vec<Vec3>,
    elements: Vec<Vec<usize>>,
    normals: Vec<Vec3>,
}

impl Mesh {
    fn block(&self, plate: &Plate) -> Box<dyn ElementBlock> {
        self.damped(plate, 0.0)
    }

    fn damped(&self, plate: &Plate, damping: f64) -> Box<dyn ElementBlock> {
        let normals: Vec<Vec<Vec3>> =
            self.elements.iter().map(|e| e.iter().map(|&n| self.normals[n]).collect()).collect();
        let all = self.elements.iter().zip(&normals).map(|(nodes, normals)| ShellGeometry::new(nodes, normals));
        match self.elements[0].len() {
            3 => Box::new(Triangles::new(all, &self.x, plate, damping)),
            _ => Box::new(Quadrilaterals::new(all, &self.x, plate, damping)),
        }
    }

    fn layered(&self, plate: &Plate, yielding: &LayerModel) -> Box<dyn ElementBlock> {
        let normals: Vec<Vec<Vec3>> =
            self.elements.iter().map(|e| e.iter().map(|&n| self.normals[n]).collect()).collect();
        let all = self.elements.iter().zip(&normals).map(|(nodes, normals)| ShellGeometry::new(nodes, normals));
        match self.elements[0].len() {
            3 => yielding.shells::<Triangle, 3, 2, 3, 7>(all, &self.x, (plate, &Heat::NONE), 0.0),
            _ => yielding.shells::<Quadrilateral, 4, 3, 6, 11>(all, &self.x, (plate, &Heat::NONE), 0.0),
        }
    }

    /// Meshes of one element each.
    fn each(&self) -> impl Iterator<Item = Mesh> {
        let one = |e: &Vec<usize>| Mesh { x: self.x.clone(), elements: vec![e.clone()], normals: self.normals.clone() };
        self.elements.iter().map(one)
    }

    /// The patch of MacNeal & Harder: 0.24 × 0.12, four distorted quadrilaterals round one; or their triangles.
    fn patch(triangles: bool) -> Mesh {
        let x = [
            [0.0, 0.0],
            [0.24, 0.0],
            [0.24, 0.12],
            [0.0, 0.12],
            [0.04, 0.02],
            [0.18, 0.03],
            [0.16, 0.08],
            [0.08, 0.08],
        ]
        .map(|[x, y]| Vec3::new(x, y, 0.0));
        let quads = [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]];
        let elements = quads.iter().flat_map(|&[a, b, c, d]| match triangles {
            true => vec![vec![a, b, c], vec![a, c, d]],
            false => vec![vec![a, b, c, d]],
        });
        Mesh { x: x.to_vec(), elements: elements.collect(), normals: vec![Vec3::z(); 8] }
    }

    /// A warped element with normals of its own at the nodes.
    fn one(rng: &mut StdRng, triangle: bool) -> Mesh {
        let corners = [[0.0, 0.0], [1.2, 0.1], [1.3, 0.9], [-0.2, 1.1]];
        let n = if triangle { 3 } else { 4 };
        let x = corners[..n].iter().map(|[x, y]| Vec3::new(*x, *y, 0.0) + vector(rng, 0.1)).collect();
        let normals = (0..n).map(|_| (Vec3::z() + vector(rng, 0.1)).normalize()).collect();
        Mesh { x, elements: vec![(0..n).collect()], normals }
    }
}

fn at_rest(x: &[Vec3]) -> Vec<Node> {
    x.iter().map(|&x| Node::at_rest(x)).collect()
}

fn law() -> MaterialLaw {
    MaterialLaw::new(1e3, 0.3, Hardening::Linear { yield_stress: 10.0, modulus: 50.0 }, 0.3, None)
}

/// Six zeros and no more: eigenvalues of flat, warped and narrow elements. Zeros are rounding of the largest.
#[test]
fn only_rigid_motions_are_free() {
    let mut rng = StdRng::seed_from_u64(1);
    for triangle in [false, true] {
        for round in 0..10 {
            let mut mesh = Mesh::one(&mut rng, triangle);
            if round == 0 {
                mesh.x.iter_mut().for_each(|x| x.z = 0.0);
                mesh.normals.fill(Vec3::z());
            }
            let block = mesh.block(&PLATE);
            let K = stiffness(&*block, &at_rest(&mesh.x));
            assert!((&K - K.transpose()).amax() < 1e-13 * K.amax());
            let values = dense::eigenvalues(&K);
            let largest = values.last().unwrap();
            assert!(values[..6].iter().all(|v| v.abs() < 1e-14 * largest), "{values:?}");
            // The weakest is drilling about its mean, a thousandth of the shear stiffness.
            assert!(values[6] > 1e-6 * largest, "{values:?}");
        }
    }
}

/// The same element from each of its corners: same forces. Bound: rounding.
#[test]
fn corners_may_come_in_any_order() {
    let mut rng = StdRng::seed_from_u64(2);
    for triangle in [false, true] {
        let mesh = Mesh::one(&mut rng, triangle);
        let n = mesh.x.len();
        let nodes: Vec<Node> = mesh
            .x
            .iter()
            .map(|x| Node {
                rotation: rotation::exp(&vector(&mut rng, 0.5)),
                ..Node::at_rest(x + vector(&mut rng, 0.2))
            })
            .collect();
        let F = forces(&*mesh.block(&PLATE), &Configuration::of(&nodes));
        let size = F.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        for shift in 1..n {
            let elements = vec![(0..n).map(|k| (k + shift) % n).collect()];
            let other = Mesh { x: mesh.x.clone(), elements, normals: mesh.normals.clone() };
            for (a, b) in F.iter().zip(forces(&*other.block(&PLATE), &Configuration::of(&nodes))) {
                for i in 0..6 {
                    assert!((a[i] - b[i]).abs() < 1e-12 * size, "{a:?} {b:?}");
                }
            }
        }
        // Turned over: normals down, corners the other way round.
        let elements = vec![(0..n).rev().collect()];
        let over = Mesh { x: mesh.x.clone(), elements, normals: mesh.normals.iter().map(|n| -n).collect() };
        for (a, b) in F.iter().zip(forces(&*over.block(&PLATE), &Configuration::of(&nodes))) {
            for i in 0..6 {
                assert!((a[i] - b[i]).abs() < 1e-12 * size, "turned over: {a:?} {b:?}");
            }
        }
    }
}

/// With layers that yield and remember: tangent against differences, within a step, loading and unloading.
#[test]
fn layers_have_the_tangent_of_their_stress() {
    let mut rng = StdRng::seed_from_u64(3);
    let mut worst = 0.0f64;
    for triangle in [false, true] {
        for round in 0..10 {
            let mesh = Mesh::one(&mut rng, triangle);
            let block = mesh.layered(&PLATE, &LayerModel { law: law(), layers: 4, logarithmic: round % 2 == 1 });
            let (q, shift) = (turn(&mut rng), vector(&mut rng, 3.0));
            let R: Mat3 = rotation::matrix(&q);
            let mut moved = |strain: f64| -> Vec<Node> {
                let node = |x: &Vec3| Node {
                    rotation: rotation::exp(&vector(&mut rng, 3.0 * strain)) * q,
                    ..Node::at_rest(R * (x + vector(&mut rng, strain)) + shift)
                };
                mesh.x.iter().map(node).collect()
            };
            let (first, second) = (moved(0.02), moved(0.02));
            let mut history = vec![0.0; block.history()];
            let past = history.clone();
            block.update_history(
                &Configuration { nodes: &first, history: &past, dt: 1.0, previous: None },
                1.0,
                &mut history,
            );
            assert!(block.plastic_strain(0, &history) > 0.0, "round {round} yields nowhere");
            let n = 6 * mesh.x.len();
            let mut K = vec![0.0; n * n];
            let base = Configuration { nodes: &second, history: &history, dt: 1.0, previous: None };
            block.tangent(0, &base, 0.0, Moduli::Algorithmic, &mut K);
            let scale = K.iter().fold(0.0f64, |m, k| m.max(k.abs()));
            let h = 1e-6; // truncation h² and 1e-16/h, and a layer at its yield limit is met with small chance
            for column in 0..n {
                let at = |h: f64| {
                    let mut nodes = second.clone();
                    nudge(&mut nodes[column / 6], column % 6, h);
                    forces(&*block, &Configuration { nodes: &nodes, ..base })
                };
                let (plus, minus) = (at(h), at(-h));
                for row in 0..n {
                    let k = (plus[row / 6][row % 6] - minus[row / 6][row % 6]) / (2.0 * h);
                    worst = worst.max((K[row * n + column] - k).abs() / scale);
                }
            }
            // The elastic matrix is that of the elastic section with the stress of the layers.
            block.tangent(0, &base, 0.0, Moduli::Elastic, &mut K);
            assert!(K.iter().all(|k| k.is_finite()));
        }
    }
    println!("{worst:e}");
    assert!(worst < 1e-7, "{worst:e}");
}

/// With damping, while nodes move and rotate: the derivatives of the forces by positions and by rates against differences, and the power of
/// the forces against the rate of energy and what damping dissipates.
#[test]
fn damped_elements_have_the_tangent_and_the_power_of_their_forces() {
    let mut rng = StdRng::seed_from_u64(13);
    let (mut worst, h) = (0.0f64, 1e-6); // truncation h² and 1e-16/h
    for triangle in [false, true] {
        for round in 0..6 {
            let mut mesh = Mesh::one(&mut rng, triangle);
            mesh.x.iter_mut().for_each(|x| x.z *= f64::from(round % 2));
            let block = mesh.damped(&PLATE, 0.3);
            let q = turn(&mut rng);
            let R: Mat3 = rotation::matrix(&q);
            let mut node = |x: &Vec3| Node {
                rotation: rotation::exp(&vector(&mut rng, 0.1)) * q,
                v: vector(&mut rng, 1.0),
                omega: vector(&mut rng, 1.0),
                ..Node::at_rest(R * (x + vector(&mut rng, 0.05)))
            };
            let nodes: Vec<Node> = mesh.x.iter().map(&mut node).collect();
            let n = 6 * nodes.len();
            let mut K = [vec![0.0; n * n], vec![0.0; n * n]];
            let now = Configuration::of(&nodes);
            [0.0, 1.0].into_iter().zip(&mut K).for_each(|(w, K)| block.tangent(0, &now, w, Moduli::Algorithmic, K));
            let scale = K.iter().flatten().fold(0.0f64, |m, k| m.max(k.abs()));
            for column in 0..n {
                let at = |h: f64, rates: bool| {
                    let (mut nodes, i) = (nodes.clone(), column % 6);
                    let node = &mut nodes[column / 6];
                    match (rates, i) {
                        (true, 0..3) => node.v[i] += h,
                        (true, _) => node.omega[i - 3] += h,
                        _ => nudge(node, i, h),
                    }
                    forces(&*block, &Configuration::of(&nodes))
                };
                for rates in [false, true] {
                    let (plus, minus) = (at(h, rates), at(-h, rates));
                    for row in 0..n {
                        let k = (plus[row / 6][row % 6] - minus[row / 6][row % 6]) / (2.0 * h);
                        let place = row * n + column;
                        let found = if rates { K[1][place] - K[0][place] } else { K[0][place] };
                        worst = worst.max((found - k).abs() / scale);
                    }
                }
            }
            let after = |dt: f64| {
                let go = |node: &Node| Node {
                    x: node.x + dt * node.v,
                    rotation: rotation::exp(&(dt * node.omega)) * node.rotation,
                    ..*node
                };
                block.energy(&Configuration::of(&nodes.iter().map(go).collect::<Vec<_>>()))
            };
            let rate = (after(1e-5) - after(-1e-5)) / 2e-5;
            let of = |(f, node): (&[f64; 6], &Node)| {
                (0..3).map(|i| f[i] * node.v[i] + f[3 + i] * node.omega[i]).sum::<f64>()
            };
            let power: f64 = forces(&*block, &now).iter().zip(&nodes).map(of).sum();
            let spent = block.damping_power(&now);
            assert!(spent > 0.0 && (power - rate - spent).abs() < 1e-7 * power.abs(), "{power} {rate} {spent}");
        }
    }
    println!("{worst:e}");
    assert!(worst < 1e-7, "{worst:e}");
}

/// Tangents of elements side by side are those of one after the other, whole packs and parts of one, from any element on: elastic, with
/// layers that yield after having yielded, of flat and of curved surfaces. Bound: rounding of the
/// largest entry, now or before anything yields: yielding leaves little of that.
#[test]
fn tangents_side_by_side_are_those_of_one_element() {
    let mut rng = StdRng::seed_from_u64(12);
    for (round, triangle) in (0..8).flat_map(|round| [(round, false), (round, true)]) {
        let mut mesh = Mesh::patch(triangle);
        if round % 2 == 1 {
            mesh.x.iter_mut().for_each(|x| x.z = 2.0 * x.x * x.x + x.y * x.x);
            mesh.normals = mesh.x.iter().map(|x| Vec3::new(-4.0 * x.x - x.y, -x.x, 1.0).normalize()).collect();
        }
        mesh.elements = (0..5).flat_map(|_| mesh.elements.clone()).collect();
        let plate = Plate { thickness: [0.1, 0.003][round / 2 % 2], ..PLATE };
        let model = LayerModel { law: law(), layers: 5, logarithmic: round % 4 == 3 };
        let block = if round < 4 { mesh.block(&plate) } else { mesh.layered(&plate, &model) };
        let (q, shift) = (turn(&mut rng), vector(&mut rng, 3.0));
        let R: Mat3 = rotation::matrix(&q);
        let mut moved = |strain: f64| -> Vec<Node> {
            let node = |x: &Vec3| Node {
                rotation: rotation::exp(&vector(&mut rng, 3.0 * strain)) * q,
                ..Node::at_rest(R * (x + vector(&mut rng, 0.1 * strain)) + shift)
            };
            mesh.x.iter().map(node).collect()
        };
        let (first, second) = (moved(0.05), moved(0.05));
        let (past, mut history) = (vec![0.0; block.history()], vec![0.0; block.history()]);
        let before = Configuration { nodes: &first, history: &past, dt: 1.0, previous: None };
        block.update_history(&before, 1.0, &mut history);
        let now = Configuration { nodes: &second, history: &history, dt: 1.0, previous: None };
        let (count, length) = (block.len(), (6 * block.nodes(0).len()).pow(2));
        let mut elastic = vec![0.0; length];
        for moduli in [Moduli::Algorithmic, Moduli::Elastic] {
            for from in [0, 8, count - 3] {
                let mut all = vec![f64::NAN; (count - from) * length];
                block.tangents(from, &now, 0.0, moduli, &mut all);
                for (e, together) in (from..).zip(all.chunks(length)) {
                    let mut alone = vec![f64::NAN; length];
                    block.tangent(e, &now, 0.0, moduli, &mut alone);
                    block.tangent(e, &now, 0.0, Moduli::Elastic, &mut elastic);
                    let scale = elastic.iter().chain(&alone).fold(0.0f64, |m, k| m.max(k.abs()));
                    for (k, (a, b)) in alone.iter().zip(together).enumerate() {
                        assert!((a - b).abs() < 1e-14 * scale, "{round} {triangle} {e} {k}: {a} {b}");
                    }
                }
            }
        }
    }
}

/// Eight elements side by side have the bits that each has by itself, forces, history and dissipation, whole packs and parts of one: elastic,
/// with layers that yield and with such that fail.
#[test]
fn packs_have_the_bits_of_their_elements() {
    let mut rng = StdRng::seed_from_u64(11);
    let plain = MaterialLaw::new(1e3, 0.3, Hardening::Linear { yield_stress: 5.0, modulus: 50.0 }, 0.0, None);
    let fails = law().failing_at(FailureCriterion::at(0.01));
    for triangle in [false, true] {
        let mesh = Mesh::patch(triangle);
        for (law, logarithmic) in
            [(None, false), (Some(&plain), false), (Some(&plain), true), (Some(&fails), false), (Some(&fails), true)]
        {
            let block = |mesh: &Mesh| match law {
                Some(law) => mesh.layered(&PLATE, &LayerModel { law: law.clone(), layers: 5, logarithmic }),
                None => mesh.block(&PLATE),
            };
            let (all, each) = (block(&mesh), mesh.each().map(|one| block(&one)).collect::<Vec<_>>());
            let mut past = vec![0.0; all.history()];
            let mut spent = 0.0;
            for strain in [1e-3, 1e-2, 5e-3, 2e-3, 2e-2, 5e-2] {
                let (q, shift) = (turn(&mut rng), vector(&mut rng, 3.0));
                let R: Mat3 = rotation::matrix(&q);
                let mut node = |x: &Vec3| Node {
                    rotation: rotation::exp(&vector(&mut rng, strain)) * q,
                    low: vector(&mut rng, 1e-17),
                    ..Node::at_rest(R * (x + vector(&mut rng, 0.1 * strain)) + shift)
                };
                let nodes: Vec<Node> = mesh.x.iter().map(&mut node).collect();
                let now = Configuration { nodes: &nodes, history: &past, dt: 1.0, previous: None };
                let mut sums = [vec![[0.0; 6]; nodes.len()], vec![[0.0; 6]; nodes.len()]];
                let mut new = [past.clone(), past.clone()];
                let together = all.advance(&now, &mut sums[0], &mut new[0]);
                let (mut alone, mut first) = (Dissipation::default(), 0);
                for one in &each {
                    let own = first..first + one.history();
                    let now = Configuration { history: &past[own.clone()], ..now };
                    alone += one.advance(&now, &mut sums[1], &mut new[1][own.clone()]);
                    first = own.end;
                }
                // Two parts are added for an element that fails, in another order.
                assert!((together.eroded - alone.eroded).abs() <= 1e-15 * together.eroded);
                alone.eroded = together.eroded;
                assert!((&sums[0], &new[0], together) == (&sums[1], &new[1], alone), "{law:?} at {strain}");
                // Forces and history by themselves are those found together.
                let (mut alone, mut F) = (past.clone(), vec![[0.0; 6]; nodes.len()]);
                assert_eq!(all.update_history(&now, 1.0, &mut alone), together);
                all.subtract_forces(&now, &mut F);
                assert_eq!((&alone, &F), (&new[0], &sums[0]));
                past = alone;
                spent += together.plastic;
            }
            assert_eq!(spent > 0.0, law.is_some());
            assert_eq!((0..all.len()).any(|e| all.has_failed(e, &past)), law.is_some_and(MaterialLaw::can_fail));
        }
    }
}

/// As long as nothing yields, layers are the elastic shell: same forces and energy to rounding.
#[test]
fn layers_that_do_not_yield_are_elastic() {
    let mut rng = StdRng::seed_from_u64(4);
    for triangle in [false, true] {
        let mesh = Mesh::one(&mut rng, triangle);
        let layered = mesh.layered(&PLATE, &LayerModel { law: law(), layers: 2, logarithmic: false });
        let elastic = mesh.block(&PLATE);
        let nodes: Vec<Node> = mesh
            .x
            .iter()
            .map(|x| Node {
                rotation: rotation::exp(&vector(&mut rng, 1e-3)),
                ..Node::at_rest(x + vector(&mut rng, 1e-3))
            })
            .collect();
        let history = vec![0.0; layered.history()];
        let now = Configuration { nodes: &nodes, history: &history, dt: 1.0, previous: None };
        let (a, b) = (forces(&*layered, &now), forces(&*elastic, &now));
        let size = a.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        assert!(a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-12 * size));
        let (a, b) = (layered.energy(&now), elastic.energy(&now));
        assert!((a - b).abs() < 1e-12 * a);
    }
}

/// Constant states on distorted meshes, by small displacements given on the rim: what is inside follows exactly, and so does
/// the energy. Bound: rounding times the condition of the patch, some 1e6 with h/L of 1e-2.
#[test]
fn patches_strain_evenly() {
    let h = 1e-3;
    let plate = Plate { thickness: h, E: 1e6, nu: 0.25, drilling: 1e-3 };
    let G = 1e6 / 2.5;
    let plane = 1e6 / (1.0 - 0.25 * 0.25);
    type Field = fn(f64, f64) -> ([f64; 3], [f64; 3]);
    // (u, v, w) and rotations; with rotations (−w,y … ) chosen for no shear where bending.
    let fields: [(&str, Field, f64); 4] = [
        ("membrane", |x, y| ([x + 0.5 * y, y + 0.5 * x, 0.0], [0.0; 3]), { h * (plane * (1.0 + 0.25) + 0.5 * G) }),
        // w = (x² + xy + y²)/2, θ = (w,y, −w,x).
        ("bending", |x, y| ([0.0, 0.0, 0.5 * (x * x + x * y + y * y)], [0.5 * x + y, -x - 0.5 * y, 0.0]), {
            h * h * h / 12.0 * (plane * (1.0 + 0.25) + 0.5 * G)
        }),
        ("shear", |x, y| ([0.0, 0.0, x + 0.5 * y], [0.0; 3]), h * 5.0 / 6.0 * G * 0.5 * 1.25),
        ("rotation", |x, y| ([-y, x, 0.0], [0.0, 0.0, 1.0]), 0.0),
    ];
    for triangles in [false, true] {
        let mesh = Mesh::patch(triangles);
        let K = stiffness(&*mesh.block(&plate), &at_rest(&mesh.x));
        for (name, field, energy) in fields {
            if name == "shear" && triangles {
                continue; // their edges bend instead
            }
            let given = |n: usize| {
                let (u, r) = field(mesh.x[n].x, mesh.x[n].y);
                [u[0], u[1], u[2], r[0], r[1], r[2]]
            };
            let outer = 4;
            let free: Vec<usize> = (6 * outer..6 * 8).collect();
            let mut u = DVector::zeros(48);
            for n in 0..outer {
                for d in 0..6 {
                    u[6 * n + d] = given(n)[d];
                }
            }
            if name == "shear" {
                // Bending could lower the energy: the state is held as it is instead.
                for n in 4..8 {
                    for d in 0..6 {
                        u[6 * n + d] = given(n)[d];
                    }
                }
            } else {
                dense::balance(&K, &free, &mut u);
                for &dof in &free {
                    let exact = given(dof / 6)[dof % 6];
                    assert!((u[dof] - exact).abs() < 1e-8, "{name} {triangles}: {dof} {} {exact}", u[dof]);
                }
            }
            let found = 0.5 * u.dot(&(&K * &u)) / (0.24 * 0.12);
            let size = if energy == 0.0 { 1e6 * h } else { energy };
            assert!((found - energy).abs() < 1e-8 * size, "{name} {triangles}: {found} {energy}");
        }
    }
}
