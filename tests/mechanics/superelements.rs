//! Superelements: forces, tangents, momenta and energies of random matrices in random motions.

use crate::support::random::{turn, vector};
use nalgebra::DMatrix;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::superelement::{
    FloatingElement, FloatingWeights, InertiaIntegrals, InnerNodes, ModalMass, NodalMass, Product, SecondOrder,
    SuperelementBlock, SuperelementData,
};
use rdsolve::elements::{Force, Mechanics, Moduli, Results};
use rdsolve::math::rotation::{exp, rates};
use rdsolve::math::{Mat3, Vec3, Vec6, skew};
use rdsolve::state::{Configuration, Node};
use std::sync::Arc;

/// A part of random point masses and springs, whose points move with `interface` nodes and some amplitudes.
struct Random {
    data: SuperelementData,
    x: Vec<Vec3>,
    rng: StdRng,
}

/// The points of the body, more than its degrees of freedom, so that no motion is without mass.
const POINTS: usize = 24;

/// Coordinates with terms of second order.
const COORDINATES: usize = 3;

impl Random {
    fn new(seed: u64, interface: usize, modes: usize, turns: bool) -> Random {
        let mut rng = StdRng::seed_from_u64(seed);
        let size = 6 * interface + modes;
        let mut x: Vec<Vec3> = (0..interface).map(|_| vector(&mut rng, 1.0) + Vec3::new(5.0, -2.0, 1.0)).collect();
        let mean = x.iter().sum::<Vec3>() / interface as f64;
        let acts = |k: usize| k >= 6 * interface || turns || k % 6 < 3;
        let mut motions = DMatrix::zeros(size, 6);
        for (i, x) in x.iter().enumerate() {
            let arms = -skew(&(x - mean));
            for axis in 0..3 {
                motions[(6 * i + axis, axis)] = 1.0;
                (0..3).for_each(|k| motions[(6 * i + k, 3 + axis)] = arms[(k, axis)]);
                motions[(6 * i + 3 + axis, 3 + axis)] = f64::from(u8::from(turns));
            }
        }
        // The rigid part of a motion, and the rest.
        let rigid = (motions.tr_mul(&motions)).try_inverse().unwrap() * motions.transpose();
        let rest = DMatrix::identity(size, size) - &motions * &rigid;
        let mut random =
            |rows: usize| DMatrix::from_fn(rows, size, |_, k| if acts(k) { rng.random_range(-1.0..1.0) } else { 0.0 });
        let springs = random(size + 4) * &rest;
        let dampers = random(3) * &rest;
        let mut mass = DMatrix::zeros(size, size);
        for _ in 0..POINTS {
            let shape = random(3) * &rest;
            let place = Vec3::new(shape[(0, 0)], shape[(1, 0)], shape[(2, 0)]);
            let mut field = DMatrix::zeros(3, 6);
            field.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
            field.fixed_view_mut::<3, 3>(0, 3).copy_from(&-skew(&place));
            let of_point = field * &rigid + 0.2 * shape;
            mass += of_point.tr_mul(&of_point);
        }
        let coordinates = random(COORDINATES) * &rest;
        let entries = |matrix: DMatrix<f64>| Arc::from(matrix.as_slice());
        let products =
            (0..COORDINATES).flat_map(|sum| (0..=sum).flat_map(move |k| (0..=k).map(move |j| (sum, [j, k]))));
        let second_order = SecondOrder {
            coordinates: coordinates.transpose().as_slice().to_vec(),
            stiffness: (1..=COORDINATES).map(|k| k as f64).collect(),
            terms: products.map(|(sum, of)| Product { sum, of, factor: rng.random_range(-1.0..1.0) }).collect(),
        };
        let data = SuperelementData {
            nodes: (0..interface + modes).collect(),
            interface,
            turns,
            stiffness: entries(springs.tr_mul(&springs)),
            mass: entries(mass),
            damping: entries(0.1 * dampers.tr_mul(&dampers)),
            second_order: turns.then(|| Arc::new(second_order)),
        };
        x.resize(interface + modes, x[0]);
        Random { data, x, rng }
    }

    fn element(&self) -> FloatingElement {
        FloatingElement::new(self.data.clone(), &self.x, 0.0)
    }

    fn elastic(&self) -> SuperelementBlock {
        SuperelementBlock(FloatingElement::new(
            SuperelementData { damping: Arc::from([]), ..self.data.clone() },
            &self.x,
            0.0,
        ))
    }

    /// The nodes carried far, deformed by `strain` and moving with `rate`.
    fn state(&mut self, strain: f64, rate: f64) -> Vec<Node> {
        let whole = turn(&mut self.rng);
        let R = rdsolve::math::rotation::matrix(&whole);
        let interface = self.data.interface;
        let far = vector(&mut self.rng, 10.0);
        let rng = &mut self.rng;
        (0..self.x.len())
            .map(|i| {
                let is_number = i >= interface;
                let mut node = Node::at_rest(self.x[i]);
                node.x =
                    if is_number { self.x[i] + vector(rng, strain) } else { R * self.x[i] + far + vector(rng, strain) };
                if !is_number && self.data.turns {
                    node.rotation = exp(&vector(rng, strain)) * whole;
                    (node.omega, node.alpha) = (vector(rng, rate), vector(rng, rate));
                }
                (node.v, node.a) = (vector(rng, rate), vector(rng, rate));
                node
            })
            .collect()
    }

    /// Node and direction of each degree of freedom.
    fn dofs(&self) -> Vec<(usize, usize)> {
        let each = if self.data.turns { 6 } else { 3 };
        let placed = (0..self.data.interface).flat_map(|node| (0..each).map(move |dof| (node, dof)));
        placed.chain((self.data.interface..self.x.len()).map(|node| (node, 0))).collect()
    }
}

fn all() -> Vec<Random> {
    vec![
        Random::new(1, 1, 2, true),
        Random::new(2, 2, 3, true),
        Random::new(3, 4, 0, false),
        Random::new(4, 3, 4, true),
    ]
}

fn moved(nodes: &[Node], (node, dof): (usize, usize), h: f64) -> Vec<Node> {
    let mut nodes = nodes.to_vec();
    match dof {
        0..3 => nodes[node].x[dof] += h,
        _ => nodes[node].rotation = exp(&(h * Vec3::ith(dof - 3, 1.0))) * nodes[node].rotation,
    }
    nodes
}

fn forces(block: &dyn Mechanics, nodes: &[Node]) -> Vec<Force> {
    let mut F = vec![[0.0; 6]; nodes.len()];
    block.subtract_forces(&Configuration::of(nodes), &mut F);
    F
}

fn inertia(of: &FloatingElement, nodes: &[Node]) -> Vec<Force> {
    let mut F = vec![[0.0; 6]; nodes.len()];
    of.add_inertia(nodes, &Vec3::zeros(), true, None, &mut F);
    F
}

fn largest<'f>(forces: impl IntoIterator<Item = &'f Force>) -> f64 {
    forces.into_iter().flatten().fold(0.0, |largest: f64, f| largest.max(f.abs()))
}

/// The largest departure of a matrix from −∂F/∂q by central differences, relative to its largest entry.
fn departure(
    random: &Random,
    nodes: &[Node],
    K: &[f64],
    of: impl Fn(&[Node]) -> Vec<Force>,
    change: impl Fn(&mut [Node], (usize, usize), f64),
) -> f64 {
    let (width, h) = (6 * nodes.len(), 1e-5);
    let scale = K.iter().fold(0.0, |largest: f64, k| largest.max(k.abs()));
    let mut off: f64 = 0.0;
    for &(node, dof) in &random.dofs() {
        let at = |h: f64| {
            let mut nodes = moved(nodes, (node, dof), h);
            change(&mut nodes, (node, dof), h);
            of(&nodes)
        };
        let (plus, minus) = (at(h), at(-h));
        for &(row, direction) in &random.dofs() {
            let difference = -(plus[row][direction] - minus[row][direction]) / (2.0 * h);
            off = off.max((K[(6 * row + direction) * width + 6 * node + dof] - difference).abs());
        }
    }
    off / scale
}

#[test]
fn the_tangent_is_the_derivative_of_the_forces() {
    for mut random in all() {
        let nodes = random.state(0.2, 0.0);
        let block = random.elastic();
        let mut K = vec![0.0; (6 * nodes.len()).pow(2)];
        block.tangent(0, &Configuration::of(&nodes), 0.0, Moduli::Elastic, &mut K);
        let off = departure(&random, &nodes, &K, |nodes| forces(&block, nodes), |_, _, _| {});
        // The square of the step, and rounding over the step.
        assert!(off < 1e-8, "{off:e}");
        // Damping of a state at rest, by rates.
        let block = SuperelementBlock(FloatingElement::new(random.data.clone(), &random.x, 0.05));
        let rate = 7.0;
        block.tangent(0, &Configuration::of(&nodes), rate, Moduli::Elastic, &mut K);
        let add_rate = |nodes: &mut [Node], (node, dof): (usize, usize), h: f64| match dof {
            0..3 => nodes[node].v[dof] += rate * h,
            _ => nodes[node].omega[dof - 3] += rate * h,
        };
        let off = departure(&random, &nodes, &K, |nodes| forces(&block, nodes), add_rate);
        assert!(off < 1e-8, "damping {off:e}");
    }
}

#[test]
fn forces_are_the_derivative_of_the_energy_and_turn_with_it() {
    for mut random in all() {
        let nodes = random.state(0.2, 0.0);
        let block = random.elastic();
        let F = forces(&block, &nodes);
        let h = 1e-5;
        for (node, dof) in random.dofs() {
            let energy = |h: f64| block.energy(&Configuration::of(&moved(&nodes, (node, dof), h)));
            let slope = (energy(h) - energy(-h)) / (2.0 * h);
            assert!((slope + F[node][dof]).abs() < 1e-8 * largest(&F), "{slope} {:?}", F[node]);
        }
        let (whole, far) = (turn(&mut random.rng), vector(&mut random.rng, 3.0));
        let R = rdsolve::math::rotation::matrix(&whole);
        let mut turned = nodes.clone();
        for node in &mut turned[..random.data.interface] {
            (node.x, node.rotation) =
                (R * node.x + far, if random.data.turns { whole * node.rotation } else { node.rotation });
        }
        for (f, before) in forces(&block, &turned).iter().zip(&F).take(random.data.interface) {
            let expected = R * Vec3::new(before[0], before[1], before[2]);
            // Rounding of positions 10 times the size of the part.
            assert!((Vec3::new(f[0], f[1], f[2]) - expected).norm() < 1e-12 * largest(&F));
        }
    }
}

#[test]
fn rigid_motion_exerts_no_force_and_has_the_momenta_of_a_rigid_body() {
    for mut random in all() {
        let nodes = random.state(0.0, 0.0);
        let block = SuperelementBlock(random.element());
        let (mean, R) = (nodes[0].x, nodes[0].R());
        // A spin about the axis of a rotation of all nodes.
        let (v, omega) = (vector(&mut random.rng, 3.0), vector(&mut random.rng, 20.0));
        let spinning: Vec<Node> = nodes
            .iter()
            .enumerate()
            .map(|(i, node)| match i < random.data.interface {
                true => Node { v: v + omega.cross(&(node.x - mean)), omega, ..*node },
                false => *node,
            })
            .collect();
        let stiffness = random.data.stiffness.iter().fold(0.0, |most: f64, k| most.max(k.abs()));
        // Rounding of displacements of the size of coordinates.
        assert!(largest(&forces(&block, &spinning)) < 1e-12 * stiffness);
        let of = random.element();
        let (energy, p, l) = of.motion(&spinning);
        let m = of.total_mass();
        let arm = of.center_now(&spinning) - mean;
        assert!((p - m * (v + omega.cross(&arm))).norm() < 1e-12 * p.norm());
        // The kinetic energy of a rigid motion is ½ v·p + ½ ω·(l about the node of v).
        let twice = v.dot(&p) + omega.dot(&(l - mean.cross(&p)));
        assert!((2.0 * energy - twice).abs() < 1e-12 * twice, "{energy} {twice}");
        assert!(random.data.turns == (R != Mat3::identity()));
    }
}

/// The kinetic energy at coordinates q and rates q̇: displacements, and rotation vectors from the rotations of `nodes`.
fn kinetic(of: &FloatingElement, nodes: &[Node], dofs: &[(usize, usize)], q: &[f64], rate: &[f64]) -> f64 {
    let mut nodes = nodes.to_vec();
    let mut turns = vec![[Vec3::zeros(); 2]; nodes.len()];
    for (k, &(node, dof)) in dofs.iter().enumerate() {
        match dof {
            0..3 => {
                nodes[node].x[dof] += q[k];
                nodes[node].v[dof] = rate[k];
            }
            _ => (turns[node][0][dof - 3], turns[node][1][dof - 3]) = (q[k], rate[k]),
        }
    }
    for (node, [theta, d]) in nodes.iter_mut().zip(turns) {
        node.rotation = exp(&theta) * node.rotation;
        node.omega = rates(&theta, &d, &Vec3::zeros()).0;
    }
    of.motion(&nodes).0
}

/// Inertia forces are those of Lagrange's equations, d/dt ∂T/∂q̇ − ∂T/∂q, with derivatives of T by differences: an independent path.
#[test]
fn inertia_forces_follow_from_the_kinetic_energy() {
    for mut random in all() {
        let nodes = random.state(0.2, 1.0);
        let of = random.element();
        let dofs = random.dofs();
        let part = |k: usize, [linear, angular]: [fn(&Node) -> Vec3; 2]| match dofs[k] {
            (node, dof @ 0..3) => linear(&nodes[node])[dof],
            (node, dof) => angular(&nodes[node])[dof - 3],
        };
        let v: Vec<f64> = (0..dofs.len()).map(|k| part(k, [|node| node.v, |node| node.omega])).collect();
        let a: Vec<f64> = (0..dofs.len()).map(|k| part(k, [|node| node.a, |node| node.alpha])).collect();
        let h = 1e-3;
        // A motion with these rates, q = v t + ½ a t², to the second order.
        let at = |t: f64| -> [Vec<f64>; 2] {
            [
                v.iter().zip(&a).map(|(v, a)| v * t + 0.5 * a * t * t).collect(),
                v.iter().zip(&a).map(|(v, a)| v + a * t).collect(),
            ]
        };
        let energy = |q: &[f64], rate: &[f64]| kinetic(&of, &nodes, &dofs, q, rate);
        // T is a square of the rates, so that this is no approximation.
        let momentum = |k: usize, t: f64| {
            let [q, rate] = at(t);
            let of_rate = |step: f64| {
                let mut rate = rate.clone();
                rate[k] += step;
                energy(&q, &rate)
            };
            0.5 * (of_rate(1.0) - of_rate(-1.0))
        };
        // Differences of the fourth order.
        let slope = |of: &dyn Fn(f64) -> f64| (8.0 * (of(h) - of(-h)) - (of(2.0 * h) - of(-2.0 * h))) / (12.0 * h);
        let F = inertia(&of, &nodes);
        for (k, &(node, dof)) in dofs.iter().enumerate() {
            let rest = at(0.0);
            let by_place = slope(&|step| {
                let mut q = rest[0].clone();
                q[k] += step;
                energy(&q, &rest[1])
            });
            let expected = slope(&|t| momentum(k, t)) - by_place;
            // h⁴ times the fifth derivative, and rounding over h.
            assert!((expected + F[node][dof]).abs() < 1e-8 * largest(&F), "{expected} {}", -F[node][dof]);
        }
    }
}

#[test]
fn a_steady_velocity_changes_no_force_and_momenta_have_the_rates_of_forces() {
    for mut random in all() {
        let nodes = random.state(0.2, 1.0);
        let of = random.element();
        let F = inertia(&of, &nodes);
        let more = vector(&mut random.rng, 50.0);
        let mut faster = nodes.clone();
        faster[..random.data.interface].iter_mut().for_each(|node| node.v += more);
        let difference = inertia(&of, &faster).into_iter().zip(&F).map(|(a, b)| std::array::from_fn(|i| a[i] - b[i]));
        let difference: Vec<Force> = difference.collect();
        // Rounding of terms 50² times as large.
        assert!(largest(&difference) < 1e-11 * largest(&F), "{:e}", largest(&difference) / largest(&F));
        // Weight acts at the centre of mass.
        let mut weight = vec![[0.0; 6]; nodes.len()];
        of.add_inertia(&nodes, &Vec3::new(0.0, 0.0, -9.81), false, None, &mut weight);
        let placed = || weight.iter().zip(&nodes).take(random.data.interface);
        let sum = placed().fold(Vec3::zeros(), |sum, (f, _)| sum + Vec3::new(f[0], f[1], f[2]));
        let moment = placed().fold(Vec3::zeros(), |sum, (f, node)| {
            sum + node.x.cross(&Vec3::new(f[0], f[1], f[2])) + Vec3::new(f[3], f[4], f[5])
        });
        let expected = of.total_mass() * Vec3::new(0.0, 0.0, -9.81);
        assert!((sum - expected).norm() < 1e-12 * expected.norm());
        if random.data.turns {
            let arm = of.center_now(&nodes);
            assert!((moment - arm.cross(&expected)).norm() < 1e-12 * expected.norm() * arm.norm());
        }
    }
}

#[test]
fn the_mass_matrix_is_the_derivative_by_accelerations() {
    for mut random in all() {
        let nodes = random.state(0.2, 1.0);
        let of = random.element();
        let F = inertia(&of, &nodes);
        let width = 6 * nodes.len();
        let mut M = vec![0.0; width * width];
        let weights = FloatingWeights { rate: 0.0, acceleration: 1.0, alpha: 0.0, gyroscopic: false };
        of.inertia_tangent(&nodes, &Vec3::zeros(), &weights, &mut M);
        let scale = M.iter().fold(0.0, |most: f64, m| most.max(m.abs()));
        for (node, dof) in random.dofs() {
            let mut faster = nodes.clone();
            match dof {
                0..3 => faster[node].a[dof] += 1.0,
                _ => faster[node].alpha[dof - 3] += 1.0,
            }
            let found = inertia(&of, &faster);
            for (row, direction) in random.dofs() {
                let entry = M[(6 * row + direction) * width + 6 * node + dof];
                // Forces are linear in accelerations; rounding of forces some times as large.
                assert!((F[row][direction] - found[row][direction] - entry).abs() < 1e-12 * scale.max(largest(&F)));
            }
        }
    }
}

#[test]
fn the_gyroscopic_tangent_is_the_derivative_of_inertia_and_weight() {
    for mut random in all() {
        let nodes = random.state(0.2, 1.0);
        let of = random.element();
        let (rate, acceleration, field) = (20.0, 400.0, Vec3::new(3.0, -9.0, 2.0));
        let forces = |nodes: &[Node]| {
            let mut F = vec![[0.0; 6]; nodes.len()];
            of.add_inertia(nodes, &field, true, None, &mut F);
            F
        };
        let mut K = vec![0.0; (6 * nodes.len()).pow(2)];
        let weights = FloatingWeights { rate, acceleration, alpha: 0.0, gyroscopic: true };
        of.inertia_tangent(&nodes, &field, &weights, &mut K);
        let add_rates = |changed: &mut [Node], (node, dof): (usize, usize), h: f64| match dof {
            0..3 => {
                changed[node].v[dof] += rate * h;
                changed[node].a[dof] += acceleration * h;
            }
            _ => {
                let e = Vec3::ith(dof - 3, h);
                let Node { omega, alpha, .. } = nodes[node];
                changed[node].omega += rate * e - 0.5 * omega.cross(&e);
                changed[node].alpha += acceleration * e - 0.5 * alpha.cross(&e);
            }
        };
        let off = departure(&random, &nodes, &K, forces, add_rates);
        // The square of the step, and rounding over the step.
        assert!(off < 1e-8, "{off:e}");
    }
}

/// Two inner nodes of a random superelement, which come last.
struct WithInner {
    random: Random,
    of: FloatingElement,
    inner: InnerNodes,
    own: [usize; 2],
}

impl WithInner {
    fn all() -> impl Iterator<Item = WithInner> {
        all().into_iter().filter(|random| random.data.turns).map(|mut random| {
            let first = random.x.len();
            let own = [first, first + 1];
            let places: [Vec3; 2] = std::array::from_fn(|_| vector(&mut random.rng, 1.0) + Vec3::new(5.0, -2.0, 1.0));
            random.x.extend(places);
            let of = FloatingElement::new(random.data.clone(), &random.x, 0.0);
            let size = random.data.size();
            let shapes: Vec<f64> = (0..12 * size).map(|_| random.rng.random_range(-0.3..0.3)).collect();
            let inner = InnerNodes::new(&of, &own, &random.x, Arc::from(shapes));
            WithInner { random, of, inner, own }
        })
    }

    fn state(&mut self) -> Vec<Node> {
        let mut nodes = self.random.state(0.2, 1.0);
        self.inner.recover(&self.of, &mut nodes);
        nodes
    }

    /// The nodes after the time t, with constant second derivatives of displacements and rotation vectors.
    fn after(&self, nodes: &[Node], t: f64) -> Vec<Node> {
        let mut moved = nodes.to_vec();
        for node in &mut moved[..self.own[0]] {
            let (v, a) = (node.v, node.a);
            node.x += t * v + 0.5 * t * t * a;
            node.rotation = exp(&(t * node.omega + 0.5 * t * t * node.alpha)) * node.rotation;
        }
        self.inner.recover(&self.of, &mut moved);
        moved
    }
}

/// Velocities and accelerations of inner nodes are the derivatives of their places and rotations.
#[test]
fn inner_nodes_have_the_rates_of_their_places() {
    for mut with in WithInner::all() {
        let nodes = with.state();
        let h = 1e-3;
        let at = [-2.0, -1.0, 1.0, 2.0].map(|k| with.after(&nodes, k * h));
        for node in with.own {
            let x = [0, 1, 2, 3].map(|k| at[k][node].x - nodes[node].x);
            let turn = [0, 1, 2, 3]
                .map(|k| rdsolve::math::rotation::log(&(at[k][node].rotation * nodes[node].rotation.conjugate())));
            // Differences of the fourth order, of errors of 1e-12 times the fifth derivative, and rounding over h².
            let first = |of: &[Vec3; 4]| (8.0 * (of[2] - of[1]) - (of[3] - of[0])) / (12.0 * h);
            let second = |of: &[Vec3; 4]| (16.0 * (of[2] + of[1]) - (of[3] + of[0])) / (12.0 * h * h);
            let own = &nodes[node];
            for (found, expected) in
                [(own.v, first(&x)), (own.omega, first(&turn)), (own.a, second(&x)), (own.alpha, second(&turn))]
            {
                assert!((found - expected).norm() < 1e-7 * (1.0 + expected.norm()), "{found} {expected}");
            }
        }
    }
}

/// Small motions of inner nodes are the derivatives of their places; forces on them do the same work after they have been moved.
#[test]
fn forces_on_inner_nodes_do_their_work_on_the_superelement() {
    for mut with in WithInner::all() {
        let nodes = with.state();
        let h = 1e-6;
        let forces: Vec<Vec6> = (0..2)
            .map(|_| {
                let (f, m) = (vector(&mut with.random.rng, 1.0), vector(&mut with.random.rng, 1.0));
                Vec6::new(f.x, f.y, f.z, m.x, m.y, m.z)
            })
            .collect();
        let mut F = vec![[0.0; 6]; nodes.len()];
        with.own.iter().zip(&forces).for_each(|(&node, force)| F[node] = (*force).into());
        with.inner.transfer(&with.of, &nodes, &mut F);
        assert!(with.own.iter().all(|&node| F[node] == [0.0; 6]));
        for (node, dof) in with.random.dofs().into_iter().filter(|(node, _)| *node < with.own[0]) {
            let mut motions = vec![Vec6::zeros(); nodes.len()];
            motions[node][dof] = 1.0;
            with.inner.carry(&with.of, &nodes, &mut motions);
            let at = [-h, h].map(|h| {
                let mut nodes = moved(&nodes, (node, dof), h);
                with.inner.recover(&with.of, &mut nodes);
                nodes
            });
            let mut work = 0.0;
            for (&own, force) in with.own.iter().zip(&forces) {
                let x = (at[1][own].x - at[0][own].x) / (2.0 * h);
                let turn =
                    rdsolve::math::rotation::log(&(at[1][own].rotation * at[0][own].rotation.conjugate())) / (2.0 * h);
                // The square of the step, and rounding of coordinates of 10 over it.
                assert!((motions[own].fixed_rows::<3>(0) - x).norm() < 1e-8, "{} {x}", motions[own]);
                assert!((motions[own].fixed_rows::<3>(3) - turn).norm() < 1e-8, "{} {turn}", motions[own]);
                work += motions[own].dot(force);
            }
            assert!((work - F[node][dof]).abs() < 1e-12 * (1.0 + work.abs()), "{work} {}", F[node][dof]);
        }
    }
}

#[test]
fn inner_nodes_turn_with_the_whole() {
    for mut with in WithInner::all() {
        let mut nodes = with.state();
        let (whole, far) = (turn(&mut with.random.rng), vector(&mut with.random.rng, 3.0));
        let R = rdsolve::math::rotation::matrix(&whole);
        let before = nodes.clone();
        for node in &mut nodes[..with.random.data.interface] {
            *node = Node {
                x: R * node.x + far,
                rotation: whole * node.rotation,
                v: R * node.v,
                omega: R * node.omega,
                a: R * node.a,
                alpha: R * node.alpha,
                ..*node
            };
        }
        with.inner.recover(&with.of, &mut nodes);
        for node in with.own {
            let (now, then) = (&nodes[node], &before[node]);
            // Rounding of coordinates of 10.
            assert!((now.x - R * then.x - far).norm() < 1e-13 * 100.0);
            for (now, then) in [(now.v, then.v), (now.a, then.a), (now.omega, then.omega), (now.alpha, then.alpha)] {
                assert!((now - R * then).norm() < 1e-11 * (1.0 + then.norm()), "{now} {then}");
            }
            assert!((now.R() - R * then.R()).norm() < 1e-12);
        }
    }
}

/// The mass matrix of a reduced part in a bent state has the momenta of its integrals as columns.
#[test]
fn the_mass_matrix_of_a_bent_part_gives_its_momenta() {
    for mut random in all().into_iter().filter(|random| random.data.turns) {
        let (size, interface) = (random.data.size(), random.data.interface);
        let mean = random.x[..interface].iter().sum::<Vec3>() / interface as f64;
        let mut Y: Vec<Vec3> = random.x[..interface].iter().map(|x| x - mean).collect();
        let rng = &mut random.rng;
        Y.extend([vector(rng, 1.0), vector(rng, 1.0)]);
        let rotary = (0..Y.len()).map(|node| {
            let root = Mat3::from_fn(|_, _| rng.random_range(-1.0..1.0));
            NodalMass { node, J0: root * root.transpose() }
        });
        let rotary = rotary.collect();
        let masses = (0..Y.len()).flat_map(|i| [(i, i, 2.0), (i, 0, 0.1), (0, i, 0.1)]).collect();
        let shapes = DMatrix::from_fn(6 * Y.len(), size, |row, k| match row < 6 * interface {
            true => f64::from(u8::from(row == k)),
            false => rng.random_range(-0.3..0.3),
        });
        let of_mass = ModalMass { Y, masses, rotary };
        let integrals = InertiaIntegrals::new(&of_mass, &shapes);
        random.data.mass = Arc::from(of_mass.matrix(&shapes).as_slice());
        let (of, nodes) = (random.element(), random.state(0.3, 0.0));
        let width = 6 * nodes.len();
        let mut M = vec![0.0; width * width];
        integrals.mass_tangent(&of, &nodes, 2.0, &mut M);
        let largest = M.iter().fold(0.0, |largest: f64, m| largest.max(m.abs()));
        for &(node, dof) in &random.dofs() {
            let (mut motions, mut F) = (vec![Vec6::zeros(); nodes.len()], vec![[0.0; 6]; nodes.len()]);
            motions[node][dof] = 1.0;
            integrals.subtract_product(&of, &nodes, &motions, 2.0, &mut F);
            for &(row, direction) in &random.dofs() {
                let found = M[(6 * row + direction) * width + 6 * node + dof];
                // Rounding.
                assert!((found + F[row][direction]).abs() < 1e-13 * largest, "{found} {}", F[row][direction]);
            }
        }
    }
}
