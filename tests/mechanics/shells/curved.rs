//! Elements of six and nine nodes: what one of them, and patches of a few, must do.

use crate::support::blocks::{forces, nudge, resultants, stiffness};
use crate::support::random::{turn, vector};
use nalgebra::DVector;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::heat::Heat;
use rdsolve::elements::shell::{
    CurvedQuadrilaterals, CurvedTriangles, DRILLING, LayerModel, NineNodes, Plate, ShellGeometry, SixNodes,
};
use rdsolve::elements::{ElementBlock, Moduli};
use rdsolve::materials::{Hardening, MaterialLaw};
use rdsolve::math::curved_faces::{CurvedFace, corners};
use rdsolve::math::{Mat3, Vec3, rotation};
use rdsolve::state::{Configuration, Node};

const PLATE: Plate = Plate { thickness: 0.1, E: 1e3, nu: 0.3, drilling: DRILLING };
const SIZES: [usize; 2] = [6, 9];

/// A mesh of elements of one shape, with a normal at each node.
struct Mesh {
    x: Vec<Vec3>,
    elements: Vec<Vec<usize>>,
    normals: Vec<Vec3>,
}

impl Mesh {
    fn block(&self, plate: &Plate, damping: f64) -> Box<dyn ElementBlock> {
        let normals: Vec<Vec<Vec3>> =
            self.elements.iter().map(|e| e.iter().map(|&n| self.normals[n]).collect()).collect();
        let all = self.elements.iter().zip(&normals).map(|(nodes, normals)| ShellGeometry::new(nodes, normals));
        match self.elements[0].len() {
            6 => Box::new(CurvedTriangles::new(all, &self.x, plate, damping)),
            _ => Box::new(CurvedQuadrilaterals::new(all, &self.x, plate, damping)),
        }
    }

    fn layered(&self, plate: &Plate, yielding: &LayerModel) -> Box<dyn ElementBlock> {
        let normals: Vec<Vec<Vec3>> =
            self.elements.iter().map(|e| e.iter().map(|&n| self.normals[n]).collect()).collect();
        let all = self.elements.iter().zip(&normals).map(|(nodes, normals)| ShellGeometry::new(nodes, normals));
        match self.elements[0].len() {
            6 => yielding.curved_shells::<SixNodes, 6, 9, 9, 9>(all, &self.x, (plate, &Heat::NONE), 0.0),
            _ => yielding.curved_shells::<NineNodes, 9, 20, 24, 12>(all, &self.x, (plate, &Heat::NONE), 0.0),
        }
    }

    /// A curved element with normals of its own at the nodes.
    fn one(rng: &mut StdRng, n: usize) -> Mesh {
        let at = if n == 6 { SixNodes::NODES.to_vec() } else { NineNodes::NODES.to_vec() };
        let x = at.iter().map(|[r, s]| Vec3::new(*r + 0.2 * s, *s, 0.1 * r * s + 0.1 * r * r) + vector(rng, 0.05));
        let x: Vec<Vec3> = x.collect();
        let normals = (0..n).map(|_| (Vec3::new(0.0, 0.0, 1.0) + vector(rng, 0.1)).normalize()).collect();
        Mesh { x, elements: vec![(0..n).collect()], normals }
    }

    /// Straight-sided elements round a node in the middle of a region of random shape, in the plane; side nodes are off the middles of
    /// their sides by up to `moved` of these.
    fn flat(rng: &mut StdRng, n: usize, moved: f64) -> Mesh {
        let sides = rng.random_range(4..7);
        let fan = corners(n);
        let mut mesh = Mesh { x: vec![Vec3::zeros()], elements: Vec::new(), normals: Vec::new() };
        let start: f64 = rng.random_range(0.0..6.3);
        let ring = if fan == 3 { sides } else { 2 * sides };
        for k in 0..ring {
            let angle = start + (k as f64 + rng.random_range(-0.2..0.2)) * std::f64::consts::TAU / ring as f64;
            // Quadrilaterals have every other corner farther out, so that they are convex.
            let far = if fan == 4 && k % 2 == 1 { 1.5 } else { 1.0 };
            let r = far * rng.random_range(0.8..1.0);
            mesh.x.push(Vec3::new(r * angle.cos(), r * angle.sin(), 0.0));
        }
        let mut middles = std::collections::HashMap::new();
        for k in 0..sides {
            let at = |i: usize| 1 + i % ring;
            let of =
                if fan == 3 { vec![0, at(k), at(k + 1)] } else { vec![0, at(2 * k), at(2 * k + 1), at(2 * k + 2)] };
            let mut nodes = of.clone();
            for i in 0..fan {
                let (a, b) = (of[i], of[(i + 1) % fan]);
                let (a, b) = (a.min(b), a.max(b));
                let part = 0.5 + 0.5 * rng.random_range(-moved..=moved);
                let x = &mut mesh.x;
                nodes.push(*middles.entry((a, b)).or_insert_with(|| {
                    x.push(x[a] + part * (x[b] - x[a]));
                    x.len() - 1
                }));
            }
            if fan == 4 {
                let off = if moved > 0.0 { 0.3 * moved } else { 0.0 };
                let middle = of.iter().map(|&n| mesh.x[n]).sum::<Vec3>() / 4.0;
                let off = off * Vec3::new(rng.random_range(-0.2..0.2), rng.random_range(-0.2..0.2), 0.0);
                mesh.x.push(middle + off);
                nodes.push(mesh.x.len() - 1);
            }
            mesh.elements.push(nodes);
        }
        mesh.normals = vec![Vec3::z(); mesh.x.len()];
        mesh
    }
}

fn at_rest(x: &[Vec3]) -> Vec<Node> {
    x.iter().map(|&x| Node::at_rest(x)).collect()
}

/// Nodes moved by a rigid motion, and by random ones of size `strain` besides.
fn moved(rng: &mut StdRng, x: &[Vec3], strain: f64) -> Vec<Node> {
    let (q, shift) = (turn(rng), vector(rng, 3.0));
    let R: Mat3 = rotation::matrix(&q);
    let node = |x: &Vec3| Node {
        rotation: rotation::exp(&vector(rng, 3.0 * strain)) * q,
        v: vector(rng, 1.0),
        omega: vector(rng, 1.0),
        ..Node::at_rest(R * (x + vector(rng, strain)) + shift)
    };
    x.iter().map(node).collect()
}

fn law() -> MaterialLaw {
    MaterialLaw::new(1e3, 0.3, Hardening::Linear { yield_stress: 10.0, modulus: 50.0 }, 0.3, None)
}

/// Six zeros and no more, in elements flat and curved; zeros are rounding of the largest.
#[test]
fn only_rigid_motions_are_free() {
    let mut rng = StdRng::seed_from_u64(1);
    for n in SIZES {
        for round in 0..40 {
            let mesh = match round % 4 {
                0..3 => Mesh::one(&mut rng, n),
                _ => {
                    let fan = Mesh::flat(&mut rng, n, 0.2);
                    let x = fan.elements[0].iter().map(|&a| fan.x[a]).collect();
                    Mesh { x, elements: vec![(0..n).collect()], normals: vec![Vec3::z(); n] }
                }
            };
            let K = stiffness(&*mesh.block(&PLATE, 0.0), &at_rest(&mesh.x));
            assert!((&K - K.transpose()).amax() < 1e-12 * K.amax());
            let values = dense::eigenvalues(&dense::scaled(&K));
            assert!(values[..6].iter().all(|v| v.abs() < 1e-13), "{n}: {values:?}");
            // The weakest is drilling of a node by itself.
            assert!(values[6] > 1e-6, "{n}: {:?}", &values[..10]);
        }
    }
}

/// No force in rigid motions of any size. Bound: rounding of the stiffness times the place.
#[test]
fn rigid_motions_are_free_of_force() {
    let mut rng = StdRng::seed_from_u64(2);
    for n in SIZES {
        for _ in 0..20 {
            let mesh = Mesh::one(&mut rng, n);
            let block = mesh.block(&PLATE, 0.0);
            let K = stiffness(&*block, &at_rest(&mesh.x)).amax();
            let nodes = moved(&mut rng, &mesh.x, 0.0);
            let F = forces(&*block, &Configuration::of(&nodes));
            assert!(F.iter().flatten().all(|f| f.abs() < 1e-12 * K), "{n}: {F:?}");
        }
    }
}

/// Even strains of flat elements of any shape, nodes off the middles of their sides: what is inside follows, and the energy is
/// exact. Even bending is exact where side nodes are in the middle, since a surface of second degree in place is one in (r, s) there.
/// Bound: rounding times the condition of the patch.
#[test]
fn even_strains_in_any_shape() {
    let mut rng = StdRng::seed_from_u64(3);
    let plate = Plate { thickness: 0.05, E: 1.0, nu: 0.3, drilling: DRILLING };
    let (h, plane, G) = (0.05, 1.0 / 0.91, 0.5 / 1.3);
    let mut worst = [[0.0f64; 2]; 2];
    for round in 0..1000 {
        for (shape, n) in SIZES.into_iter().enumerate() {
            let bends = round % 2 == 1;
            let mesh = Mesh::flat(&mut rng, n, if bends { 0.0 } else { 0.25 });
            let K = stiffness(&*mesh.block(&plate, 0.0), &at_rest(&mesh.x));
            let e: [f64; 4] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
            let given = |a: usize| -> [f64; 6] {
                let (x, y) = (mesh.x[a].x, mesh.x[a].y);
                if bends {
                    // w = ½ (e₀ x² + 2 e₁ x y + e₃ y²), θ = (w,y, −w,x).
                    let w = 0.5 * (e[0] * x * x + 2.0 * e[1] * x * y + e[3] * y * y);
                    [0.0, 0.0, w, e[1] * x + e[3] * y, -e[0] * x - e[1] * y, 0.0]
                } else {
                    [e[0] * x + e[1] * y, e[2] * x + e[3] * y, 0.0, 0.0, 0.0, 0.5 * (e[2] - e[1])]
                }
            };
            // Nodes in two elements or more are free: those on the spokes.
            let shared = |a: usize| mesh.elements.iter().filter(|of| of.contains(&a)).count() > 1;
            let inner = |a: usize| {
                shared(a) && (a == 0 || mesh.x[a].norm() < 0.79) || mesh.elements.iter().any(|of| of.get(8) == Some(&a))
            };
            let all = mesh.x.len();
            let free: Vec<usize> = (0..6 * all).filter(|i| inner(i / 6)).collect();
            assert!(free.len() > 6 * 4);
            let exact = DVector::from_fn(6 * all, |i, _| given(i / 6)[i % 6]);
            let mut u = exact.clone();
            dense::balance(&K, &free, &mut u);
            // Drilling is held a millionth as much as the rest, and rounding is so much larger.
            let weight = |i: usize| if i % 6 == 5 { 1e-3 } else { 1.0 };
            let error = (0..6 * all).map(|i| weight(i) * (u[i] - exact[i]).abs()).fold(0.0, f64::max);
            let (a, b, g) = if bends { (e[0], e[3], 2.0 * e[1]) } else { (e[0], e[3], e[1] + e[2]) };
            let thick = if bends { h * h * h / 12.0 } else { h };
            let per_area = thick * 0.5 * (plane * (a * a + b * b + 0.6 * a * b) + G * g * g);
            let ring: Vec<Vec3> =
                mesh.elements.iter().flat_map(|of| of[1..corners(n)].to_vec()).map(|a| mesh.x[a]).collect();
            let area: f64 = (0..ring.len()).map(|k| 0.5 * ring[k].cross(&ring[(k + 1) % ring.len()]).z).sum();
            let energy = 0.5 * u.dot(&(&K * &u));
            let error = error.max((energy / (per_area * area) - 1.0).abs());
            worst[shape][usize::from(bends)] = worst[shape][usize::from(bends)].max(error);
        }
    }
    println!("{worst:?}");
    assert!(worst.iter().flatten().all(|&error| error < 1e-10), "{worst:?}");
}

/// The tangent against differences at large rotations, with damping and with layers that yield and remember.
#[test]
fn tangents_are_those_of_forces() {
    let mut rng = StdRng::seed_from_u64(4);
    let mut worst = 0.0f64;
    for n in SIZES {
        for round in 0..9 {
            let mesh = Mesh::one(&mut rng, n);
            let layered = round % 3 == 2;
            let block = match round % 3 {
                0 => mesh.block(&PLATE, 0.0),
                1 => mesh.block(&PLATE, 0.3),
                _ => mesh.layered(&PLATE, &LayerModel { law: law(), layers: 3, logarithmic: round == 5 }),
            };
            let (first, second) = (moved(&mut rng, &mesh.x, 0.02), moved(&mut rng, &mesh.x, 0.02));
            let mut history = vec![0.0; block.history()];
            let past = history.clone();
            let before = Configuration { nodes: &first, history: &past, dt: 1.0, previous: None };
            block.update_history(&before, 1.0, &mut history);
            assert!(!layered || block.plastic_strain(0, &history) > 0.0, "round {round} yields nowhere");
            let mut K = vec![0.0; 36 * n * n];
            let base = Configuration { nodes: &second, history: &history, dt: 1.0, previous: None };
            // Positions alone, then rates alone: K at rate weight 1 less that at 0.
            block.tangent(0, &base, 0.0, Moduli::Algorithmic, &mut K);
            let scale = K.iter().fold(0.0f64, |m, k| m.max(k.abs()));
            let h = 1e-6;
            for column in 0..6 * n {
                let at = |h: f64| {
                    let mut nodes = second.clone();
                    nudge(&mut nodes[column / 6], column % 6, h);
                    forces(&*block, &Configuration { nodes: &nodes, ..base })
                };
                let (plus, minus) = (at(h), at(-h));
                for row in 0..6 * n {
                    let k = (plus[row / 6][row % 6] - minus[row / 6][row % 6]) / (2.0 * h);
                    worst = worst.max((K[row * 6 * n + column] - k).abs() / scale);
                }
            }
        }
    }
    println!("{worst:e}");
    // Truncation h² and 1e-16/h.
    assert!(worst < 1e-7, "{worst:e}");
}

/// As long as nothing yields, layers are the elastic shell.
#[test]
fn layers_that_do_not_yield_are_elastic() {
    let mut rng = StdRng::seed_from_u64(5);
    for n in SIZES {
        let mesh = Mesh::one(&mut rng, n);
        let layered = mesh.layered(&PLATE, &LayerModel { law: law(), layers: 2, logarithmic: false });
        let elastic = mesh.block(&PLATE, 0.0);
        let nodes = moved(&mut rng, &mesh.x, 3e-4);
        let history = vec![0.0; layered.history()];
        let now = Configuration { nodes: &nodes, history: &history, dt: 1.0, previous: None };
        let (a, b) = (forces(&*layered, &now), forces(&*elastic, &now));
        let size = a.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        assert!(a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-11 * size), "{n}");
        let (a, b) = (layered.energy(&now), elastic.energy(&now));
        assert!((a - b).abs() < 1e-11 * a, "{n}: {a} {b}");
    }
}

/// Power of forces is the rate of energy and of what is dissipated. Bound: truncation of differences.
#[test]
fn energy_is_conserved() {
    let mut rng = StdRng::seed_from_u64(6);
    for n in SIZES {
        let mesh = Mesh::one(&mut rng, n);
        let block = mesh.block(&PLATE, 0.3);
        let nodes = moved(&mut rng, &mesh.x, 0.05);
        let after = |dt: f64| -> f64 {
            let go = |node: &Node| Node {
                x: node.x + dt * node.v,
                rotation: rotation::exp(&(dt * node.omega)) * node.rotation,
                ..*node
            };
            block.energy(&Configuration::of(&nodes.iter().map(go).collect::<Vec<_>>()))
        };
        let rate = (after(1e-5) - after(-1e-5)) / 2e-5;
        let now = Configuration::of(&nodes);
        let power: f64 = forces(&*block, &now)
            .iter()
            .zip(&nodes)
            .map(|(f, node)| Vec3::new(f[0], f[1], f[2]).dot(&node.v) + Vec3::new(f[3], f[4], f[5]).dot(&node.omega))
            .sum();
        let dissipated = block.damping_power(&now);
        assert!(
            dissipated > 0.0 && (power - rate - dissipated).abs() < 1e-7 * power.abs(),
            "{power} {rate} {dissipated}"
        );
    }
}

/// A kinked sheet of triangles or quadrilaterals that is stretched does not lose its stability.
#[test]
fn tension_is_stable() {
    let mut rng = StdRng::seed_from_u64(7);
    for n in SIZES {
        for strain in [1e-4, 1e-3, 1e-2] {
            for thickness in [0.1, 0.01, 1e-3] {
                let plate = Plate { thickness, E: 1.0, nu: 0.3, drilling: DRILLING };
                let mesh = Mesh::flat(&mut rng, n, 0.2);
                let block = mesh.block(&plate, 0.0);
                let stretch = |x: &Vec3| Node::at_rest(Vec3::new(x.x * (1.0 + strain), x.y * (1.0 + strain), 0.0));
                let nodes: Vec<Node> = mesh.x.iter().map(stretch).collect();
                let K = stiffness(&*block, &nodes);
                // The rim is held in place and free to turn.
                let inner =
                    |a: usize| mesh.elements.iter().filter(|of| of.contains(&a)).count() > 1 && mesh.x[a].norm() < 0.79;
                let free: Vec<usize> = (0..K.nrows()).filter(|i| inner(i / 6) || i % 6 > 2).collect();
                let least = dense::eigenvalues(&dense::scaled(&dense::part(&K, &free)))[0];
                assert!(least > -1e-13, "{n} nodes, strain {strain}, thickness {thickness}: {least:e}");
            }
        }
    }
}

/// An even strain of any size, turned anywhere: N of Green's strain in axes asked for, no M and Q; layers feel the same. And an even small
/// curvature: M of it. Bounds: rounding of E h = 100, and of strains of 1e-8 against 1.
#[test]
fn resultants_are_those_of_the_state() {
    let mut rng = StdRng::seed_from_u64(8);
    let plane = |e: [f64; 3], factor: f64| {
        let whole = factor * 1e3 / 0.91;
        [whole * (e[0] + 0.3 * e[1]), whole * (e[1] + 0.3 * e[0]), factor * 1e3 / 1.3 * e[2]]
    };
    let near = |found: &[f64], wanted: &[f64], bound: f64| {
        let far = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(far <= bound, "{found:?} for {wanted:?}: {far:e}");
    };
    let far_off = MaterialLaw::new(1e3, 0.3, Hardening::Linear { yield_stress: 1e9, modulus: 0.0 }, 0.0, None);
    for n in SIZES {
        let mesh = Mesh::flat(&mut rng, n, 0.2);
        let U = Mat3::new(1.1, 0.05, 0.0, 0.05, 0.9, 0.0, 0.0, 0.0, 1.0);
        let (q, shift) = (turn(&mut rng), vector(&mut rng, 3.0));
        let R = rotation::matrix(&q);
        let stretched = |x: &Vec3| Node { rotation: q, ..Node::at_rest(R * U * x + shift) };
        let nodes: Vec<Node> = mesh.x.iter().map(stretched).collect();
        let green = 0.5 * (U * U - Mat3::identity());
        let green = [green[(0, 0)], green[(1, 1)], green[(0, 1)]];
        for block in [
            mesh.block(&PLATE, 0.0),
            mesh.layered(&PLATE, &LayerModel { law: far_off.clone(), layers: 3, logarithmic: false }),
        ] {
            let past = vec![0.0; block.history()];
            let now = Configuration { nodes: &nodes, history: &past, dt: 0.0, previous: None };
            let at = resultants(&*block, &Vec3::x(), &mesh.x, &now)[0];
            near(&at.N, &plane(green, 0.1), 1e-11);
            near(&at.M, &[0.0; 3], 1e-11);
            near(&at.Q, &[0.0; 2], 1e-11);
            at.layers().iter().for_each(|layer| near(&layer.stress, &plane(green, 1.0), 1e-10));
            near(at.frame.column(2).as_slice(), (R * Vec3::z()).as_slice(), 1e-13);
        }
        // w = −½ (κ₁₁ x² + κ₂₂ y² + 2 κ₁₂ x y) with nodes in the middles of sides.
        let mesh = Mesh::flat(&mut rng, n, 0.0);
        let k = [2e-8, -1e-8, 1.5e-8];
        let bent = |x: &Vec3| {
            let w = -0.5 * (k[0] * x.x * x.x + k[1] * x.y * x.y + 2.0 * k[2] * x.x * x.y);
            let slope = [-(k[0] * x.x + k[2] * x.y), -(k[1] * x.y + k[2] * x.x)];
            Node { rotation: rotation::exp(&Vec3::new(slope[1], -slope[0], 0.0)), ..Node::at_rest(x + w * Vec3::z()) }
        };
        let nodes: Vec<Node> = mesh.x.iter().map(bent).collect();
        let block = mesh.block(&PLATE, 0.0);
        let at = resultants(&*block, &Vec3::x(), &mesh.x, &Configuration::of(&nodes))[0];
        let wanted = plane(k, 1e-3 / 12.0);
        near(&at.M, &wanted, 1e-6 * wanted[0].abs());
        near(&at.N, &[0.0; 3], 1e-12);
    }
}
