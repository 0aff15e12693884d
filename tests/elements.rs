//! Every element: tangent against differences at random large rotations under load, no force in a rigid motion,
//! forces in balance, energy as the potential of the force.

use nalgebra::{Quaternion, Unit, Vector3};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::beam::{Beams, Description};
use rdsolve::elements::bushing::{Bushing, Bushings};
use rdsolve::elements::link::{Law, Link, Links};
use rdsolve::elements::shell::{self, Plate, Quadrilaterals, Triangles};
use rdsolve::elements::{Block, Force, Moduli};
use rdsolve::math::{Mat3, Vec3, rotation};
use rdsolve::sections::Stiffness;
use rdsolve::state::{Node, Now};

fn vector(rng: &mut StdRng, size: f64) -> Vec3 {
    Vec3::from_fn(|_, _| size * rng.random_range(-1.0..1.0))
}

fn turn(rng: &mut StdRng) -> Quaternion<f64> {
    let q = Quaternion::new(0.0, 0.0, 0.0, 0.0).map(|_: f64| rng.random_range(-1.0..1.0));
    Unit::new_normalize(q).into_inner()
}

trait Map {
    fn map(self, f: impl FnMut(f64) -> f64) -> Self;
}
impl Map for Quaternion<f64> {
    fn map(self, f: impl FnMut(f64) -> f64) -> Self {
        Quaternion::from(self.coords.map(f))
    }
}

fn section() -> Stiffness {
    Stiffness {
        N: Mat3::new(30.0, 0.0, 0.0, 0.0, 9.0, 1.0, 0.0, 1.0, 7.0),
        M: Mat3::new(2.0, 0.0, 0.0, 0.0, 3.0, 0.5, 0.0, 0.5, 5.0),
        NM: Mat3::new(0.0, 0.0, 0.0, 0.6, 0.0, 0.0, -0.4, 0.0, 0.0),
        mass_per_length: 1.0,
        inertia_per_length: Mat3::identity(),
    }
}

/// An element of every kind with the initial positions of its nodes.
fn kinds(rng: &mut StdRng) -> Vec<(&'static str, Box<dyn Block>, Vec<Vec3>)> {
    let mut kinds: Vec<(&'static str, Box<dyn Block>, Vec<Vec3>)> = Vec::new();
    let frame = rotation::matrix(&turn(rng));
    let stiffness = section();
    let start = vector(rng, 2.0);
    let axis: Vec3 = frame.column(0).into_owned() * 1.3;
    macro_rules! beam {
        ($name:literal, $n:literal, $damping:literal) => {{
            let (points, _) = rdsolve::math::quadrature::lobatto($n);
            let x: Vec<Vec3> = points.iter().map(|p| start + axis * (0.5 + 0.5 * p)).collect();
            let nodes: Vec<usize> = (0..$n).collect();
            let one = [Description { nodes: &nodes, frame: &frame, stiffness: &stiffness }];
            kinds.push(($name, Box::new(Beams::<$n>::new(one.into_iter(), &x, $damping)), x));
        }};
    }
    beam!("beam of 2 nodes", 2, 0.0);
    beam!("beam of 3 nodes", 3, 0.0);
    beam!("beam of 4 nodes", 4, 0.0);
    beam!("beam of 5 nodes", 5, 0.0);
    beam!("damped beam of 2 nodes", 2, 0.3);
    beam!("damped beam of 4 nodes", 4, 0.3);
    let ends = vec![start, start + axis];
    let link = |law, direction| Link { nodes: [0, 1], law, damping: 0.7, direction, free_length: 1.2 };
    let linear = Law::Linear { stiffness: 20.0, preload: 1.0 };
    let d = frame.column(1).into_owned();
    kinds.push(("link", Box::new(Links(vec![link(linear.clone(), None)])), ends.clone()));
    kinds.push(("link along a direction", Box::new(Links(vec![link(linear, Some(d))])), ends.clone()));
    let table = Law::Table { points: vec![[-9.0, -7.0], [0.0, 0.0], [9.0, 20.0]] };
    kinds.push(("table link", Box::new(Links(vec![link(table, None)])), ends.clone()));
    let bars = rdsolve::elements::bar::links(&[[0, 1]], 40.0, false, &ends, 0.2);
    kinds.push(("bar", Box::new(bars), ends.clone()));
    let bushing = Bushing {
        nodes: [0, 1],
        axes: frame,
        stiffness: [10.0, 20.0, 30.0, 4.0, 5.0, 6.0],
        damping: [1.0, 0.5, 0.2, 0.1, 0.3, 0.2],
        offset: frame.tr_mul(&axis),
    };
    kinds.push(("bushing", Box::new(Bushings(vec![bushing])), ends));
    shells(rng, &mut kinds);
    kinds
}

/// Warped and curved ones, with and without damping.
fn shells(rng: &mut StdRng, kinds: &mut Vec<(&'static str, Box<dyn Block>, Vec<Vec3>)>) {
    let plate = Plate { thickness: 0.4, E: 60.0, nu: 0.3, drilling: 0.1 };
    let frame = rotation::matrix(&turn(rng));
    let corners = [[0.0, 0.0], [1.2, 0.1], [1.3, 0.9], [-0.2, 1.1]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let x: Vec<Vec3> = corners.iter().map(|c| frame * (c + vector(rng, 0.1))).collect();
    let normals: Vec<Vec3> = x.iter().map(|_| frame * (Vec3::z() + vector(rng, 0.1)).normalize()).collect();
    let four = || [shell::Description { nodes: &[0, 1, 2, 3], normals: &normals }].into_iter();
    let three = || [shell::Description { nodes: &[0, 1, 2], normals: &normals[..3] }].into_iter();
    kinds.push(("quadrilateral", Box::new(Quadrilaterals::new(four(), &x, &plate, 0.0)), x.clone()));
    kinds.push(("damped quadrilateral", Box::new(Quadrilaterals::new(four(), &x, &plate, 0.2)), x.clone()));
    kinds.push(("triangle", Box::new(Triangles::new(three(), &x, &plate, 0.0)), x[..3].to_vec()));
    kinds.push(("damped triangle", Box::new(Triangles::new(three(), &x, &plate, 0.2)), x[..3].to_vec()));
}

/// Nodes moved far as a whole and strained and rotated against each other.
fn moved(rng: &mut StdRng, x: &[Vec3], strain: f64) -> Vec<Node> {
    let (turn, shift) = (turn(rng), vector(rng, 5.0));
    let R = rotation::matrix(&turn);
    x.iter()
        .map(|x| {
            let mut node = Node::at_rest(R * x + shift + vector(rng, strain));
            let local = rotation::exp(&vector(rng, strain));
            // The sign of a quaternion carries no meaning; elements must not care.
            let sign = if rng.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 };
            node.q = local * turn * sign;
            node.v = vector(rng, 1.0);
            node.omega = vector(rng, 1.0);
            node
        })
        .collect()
}

fn forces(block: &dyn Block, nodes: &[Node]) -> Vec<Force> {
    let mut F = vec![[0.0; 6]; nodes.len()];
    block.subtract_forces(&Now::of(nodes), &mut F);
    F.iter().map(|f| f.map(|c| -c)).collect()
}

fn nudge(node: &mut Node, dof: usize, h: f64) {
    let mut d = Vec3::zeros();
    d[dof % 3] = h;
    if dof < 3 { node.x += d } else { node.q = rotation::exp(&d) * node.q }
}

#[test]
fn tangent_is_the_derivative_of_the_force() {
    let mut rng = StdRng::seed_from_u64(7);
    for round in 0..20 {
        for (name, block, x) in kinds(&mut rng) {
            let nodes = moved(&mut rng, &x, 0.3);
            let d = block.dofs();
            let size = d * nodes.len();
            let (mut K0, mut K1) = (vec![0.0; size * size], vec![0.0; size * size]);
            block.tangent(0, &Now::of(&nodes), 0.0, Moduli::Algorithmic, &mut K0);
            block.tangent(0, &Now::of(&nodes), 1.0, Moduli::Algorithmic, &mut K1);
            let scale = K0.iter().fold(0.0f64, |m, k| m.max(k.abs()));
            let h = 1e-5; // truncation h² ~ 1e-10 and cancellation 1e-16/h ~ 1e-11, relative
            for column in 0..size {
                let difference = |change: &dyn Fn(&mut Node, f64)| {
                    let at = |h: f64| {
                        let mut nodes = nodes.clone();
                        change(&mut nodes[column / d], h);
                        forces(&*block, &nodes)
                    };
                    let (plus, minus) = (at(h), at(-h));
                    move |row: usize| (plus[row / d][row % d] - minus[row / d][row % d]) / (2.0 * h)
                };
                let position = difference(&|node, h| nudge(node, column % d, h));
                let velocity = difference(&|node, h| match column % d {
                    i @ 0..3 => node.v[i] += h,
                    i => node.omega[i - 3] += h,
                });
                for row in 0..size {
                    let (k, c) = (K0[row * size + column], K1[row * size + column] - K0[row * size + column]);
                    let message = || format!("{name}, round {round}, row {row}, column {column}");
                    assert!((k - position(row)).abs() < 1e-7 * scale, "{}: {k} {}", message(), position(row));
                    assert!((c - velocity(row)).abs() < 1e-7 * scale, "{} (rate): {c} {}", message(), velocity(row));
                }
            }
        }
    }
}

/// Positions x → R x + s with velocities of a rigid motion: neither stress nor damping. Bound: rounding of positions ~10
/// times stiffness ~60 times 1e-16.
#[test]
fn rigid_motion_gives_no_force() {
    let mut rng = StdRng::seed_from_u64(8);
    for _ in 0..20 {
        for (name, block, x) in kinds(&mut rng) {
            if name.contains("link") {
                continue; // preload and free length: stressed by intention
            }
            let mut nodes = moved(&mut rng, &x, 0.0);
            let (v, omega) = (vector(&mut rng, 1.0), vector(&mut rng, 1.0));
            for node in &mut nodes {
                node.omega = omega;
                node.v = v + omega.cross(&node.x);
            }
            for f in forces(&*block, &nodes) {
                assert!(f.iter().all(|c| c.abs() < 1e-12), "{name}: {f:?}");
            }
        }
    }
}

/// Internal forces have no resultant, turn with the element, and are the gradient of its energy.
#[test]
fn forces_balance_turn_with_the_element_and_have_a_potential() {
    let mut rng = StdRng::seed_from_u64(9);
    for _ in 0..20 {
        for (name, block, x) in kinds(&mut rng) {
            let along = name.contains("direction");
            let mut nodes = moved(&mut rng, &x, 0.3);
            let F = forces(&*block, &nodes);
            let (mut force, mut moment) = (Vec3::zeros(), Vec3::zeros());
            for (node, f) in nodes.iter().zip(&F) {
                let (f, m) = (Vec3::new(f[0], f[1], f[2]), Vec3::new(f[3], f[4], f[5]));
                force += f;
                moment += node.x.cross(&f) + m;
            }
            let size = F.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
            assert!(force.norm() < 1e-13 * size * 10.0, "{name}: {force}");
            assert!(along || moment.norm() < 1e-13 * size * 100.0, "{name}: {moment}");

            if !along {
                let q = turn(&mut rng);
                let R = rotation::matrix(&q);
                let shift = vector(&mut rng, 3.0);
                let turned: Vec<Node> = nodes
                    .iter()
                    .map(|n| Node { x: R * n.x + shift, q: q * n.q, v: R * n.v, omega: R * n.omega, ..*n })
                    .collect();
                for (a, b) in forces(&*block, &turned).iter().zip(&F) {
                    for i in [0, 3] {
                        let (a, b) = (Vec3::new(a[i], a[i + 1], a[i + 2]), Vec3::new(b[i], b[i + 1], b[i + 2]));
                        assert!((a - R * b).norm() < 1e-12 * size, "{name}");
                    }
                }
            }

            // Without velocities there is no damping and the energy is a potential.
            for node in &mut nodes {
                node.v = Vector3::zeros();
                node.omega = Vector3::zeros();
            }
            let F = forces(&*block, &nodes);
            let h = 1e-5; // as above
            for a in 0..nodes.len() {
                for dof in 0..6 {
                    let energy = |h: f64| {
                        let mut nodes = nodes.clone();
                        nudge(&mut nodes[a], dof, h);
                        block.energy(&Now::of(&nodes))
                    };
                    let slope = (energy(h) - energy(-h)) / (2.0 * h);
                    assert!((F[a][dof] - slope).abs() < 1e-7 * size.max(1.0), "{name}: {} {slope}", F[a][dof]);
                }
            }
        }
    }
}

/// The power of the damping is what the rate-dependent part of the forces takes from the motion.
#[test]
fn damping_takes_power() {
    let mut rng = StdRng::seed_from_u64(10);
    for (name, block, x) in kinds(&mut rng) {
        let nodes = moved(&mut rng, &x, 0.2);
        let still: Vec<Node> = nodes.iter().map(|n| Node { v: Vec3::zeros(), omega: Vec3::zeros(), ..*n }).collect();
        let (F, F0) = (forces(&*block, &nodes), forces(&*block, &still));
        let mut power = 0.0;
        for ((node, f), f0) in nodes.iter().zip(&F).zip(&F0) {
            for i in 0..3 {
                power += (f[i] - f0[i]) * node.v[i] + (f[3 + i] - f0[3 + i]) * node.omega[i];
            }
        }
        let taken = block.damping_power(&Now::of(&nodes));
        assert!((power - taken).abs() < 1e-11 * (1.0 + taken), "{name}: {power} {taken}"); // rounding of ~100 terms
        assert!(taken >= 0.0 && (taken > 0.0) == block.is_damped(), "{name}: {taken}");
    }
}

/// Two nodes: the small-strain stiffness of the exact (Timoshenko) beam with coupled bending, by its flexibility.
#[test]
fn two_node_beam_has_the_exact_linear_stiffness() {
    let x = [Vec3::zeros(), Vec3::new(1.7, 0.0, 0.0)];
    let (length, C) = (1.7, section());
    let frame = Mat3::identity();
    let one = [Description { nodes: &[0, 1], frame: &frame, stiffness: &C }];
    let beam = Beams::<2>::new(one.into_iter(), &x, 0.0);
    let nodes = x.map(Node::at_rest);
    let mut K = [0.0; 144];
    beam.tangent(0, &Now::of(&nodes), 0.0, Moduli::Algorithmic, &mut K);
    // Free end under a unit wrench: strains ε(x) = C⁻¹ σ(x), tip motion by integrating them (three Gauss points: exact).
    let mut C6 = nalgebra::Matrix6::zeros();
    C6.fixed_view_mut::<3, 3>(0, 0).copy_from(&C.N);
    C6.fixed_view_mut::<3, 3>(3, 3).copy_from(&C.M);
    C6.fixed_view_mut::<3, 3>(0, 3).copy_from(&C.NM);
    C6.fixed_view_mut::<3, 3>(3, 0).copy_from(&C.NM.transpose());
    let inverse = C6.try_inverse().unwrap();
    let (points, weights) = rdsolve::math::quadrature::gauss(3);
    let mut flexibility = nalgebra::Matrix6::<f64>::zeros();
    for (xi, w) in points.iter().zip(weights) {
        let arm = 0.5 * length * (1.0 - xi);
        let mut to_section = nalgebra::Matrix6::identity();
        to_section.fixed_view_mut::<3, 3>(3, 0).copy_from(&rdsolve::math::skew(&Vec3::new(arm, 0.0, 0.0)));
        flexibility += 0.5 * length * *w * to_section.transpose() * inverse * to_section;
    }
    let tip = nalgebra::Matrix6::from_fn(|i, j| K[(6 + i) * 12 + 6 + j]);
    let product = tip * flexibility;
    assert!((product - nalgebra::Matrix6::identity()).amax() < 1e-12, "{product}"); // condition ~ 100
}
