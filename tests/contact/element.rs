//! The block by itself: its tangent, its balance, its indifference to where the scene stands.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::contact::restitution::{Loss, number};
use rdsolve::elements::contact::surfaces::{Capsule, Cuboid, Cylinder, Plane, Sphere};
use rdsolve::elements::contact::{ContactLaw, ContactPoint, Contacts, MOST_NODES, Surface, SurfaceShape};
use rdsolve::elements::{ElementBlock, Moduli};
use rdsolve::math::rotation::{exp, matrix};
use rdsolve::math::{Mat3, Vec3};
use rdsolve::state::{Configuration, Node};

const SHAPES: [SurfaceShape; 5] = [
    SurfaceShape::Plane(Plane),
    SurfaceShape::Cuboid(Cuboid { half: [0.3, 0.5, 0.8] }),
    SurfaceShape::Sphere(Sphere { radius: 0.6 }),
    SurfaceShape::Cylinder(Cylinder { radius: 0.5, half: 0.7 }),
    SurfaceShape::Capsule(Capsule { radius: 0.4, half: 0.6 }),
];

fn vector(rng: &mut StdRng, size: f64) -> Vec3 {
    Vec3::from_fn(|_, _| rng.random_range(-size..size))
}

/// A point and a surface in touch, with the past it came by.
struct Touch {
    block: Contacts,
    nodes: Vec<Node>,
    past: Vec<f64>,
}

/// `count` nodes carry the point; `slide` is the way along the surface since the past.
fn touch(rng: &mut StdRng, shape: SurfaceShape, count: usize, radius: f64, friction: f64, slide: f64) -> Touch {
    let law = ContactLaw {
        stiffness: 1e3,
        loss: Loss::Restitution { number: number(0.5), floor: 0.1 },
        friction,
        floor: 0.1,
        resolution: f64::INFINITY,
        duration: 0.0,
        near: 1.0,
        dynamic: true,
    };
    let surface = Surface { center: vector(rng, 0.3), axes: matrix(&exp(&vector(rng, 2.0))), shape };
    let mut weights = [0.0; MOST_NODES];
    let parts: Vec<f64> = (0..count).map(|_| rng.random_range(0.2..1.0)).collect();
    let sum: f64 = parts.iter().sum();
    (0..count).for_each(|k| weights[k] = parts[k] / sum);
    let mut of = [1; MOST_NODES];
    (0..count).for_each(|k| of[k] = 1 + k);
    let point = ContactPoint { nodes: of, weights, count, radius, rolling_radius: radius };

    // The carrier anywhere, the point a little inside the surface.
    let mut nodes = vec![Node::at_rest(vector(rng, 1.0)); count + 1];
    nodes[0].rotation = exp(&vector(rng, 2.0));
    let R = nodes[0].R();
    let p = surface.axes * vector(rng, 1.0) + surface.center;
    let near = surface.closest_point(&p);
    let inside = p - near.n * (near.distance - radius + rng.random_range(0.002..0.006));
    for k in 0..count {
        nodes[1 + k].rotation = exp(&vector(rng, 2.0));
    }
    let place = |nodes: &mut [Node], p: &Vec3, rng: &mut StdRng| {
        let x = nodes[0].x + nodes[0].R() * p;
        let mut rest = x;
        for k in 0..count {
            let own = if k + 1 == count { rest / weights[k] } else { x + vector(rng, 0.2) };
            nodes[1 + k].x = own;
            rest -= weights[k] * own;
        }
    };
    place(&mut nodes, &inside, rng);
    let block = Contacts::new(law, surface, 0, vec![point]);
    let mut past = vec![0.0; block.history()];
    let nothing = past.clone();
    block.update_history(&Configuration { nodes: &nodes, history: &nothing, dt: 0.0 }, 1.0, &mut past);

    // Now it has gone a bit on, with everything turned and moving.
    let turn = exp(&vector(rng, 0.1));
    nodes[0].x += vector(rng, 0.1);
    nodes[0].rotation = turn * nodes[0].rotation;
    place(&mut nodes, &(inside + slide * vector(rng, 1.0).cross(&near.n)), rng);
    let small = if radius > 0.0 { slide / radius } else { 0.1 };
    for node in &mut nodes {
        (node.v, node.omega) = (vector(rng, 0.2), vector(rng, 0.2));
    }
    for k in 0..count {
        nodes[1 + k].rotation = turn * exp(&vector(rng, small)) * nodes[1 + k].rotation;
        // Inwards, so that the force is there whatever the damping.
        let inward = nodes[0].v - R * near.n * 0.1;
        nodes[1 + k].v += inward;
    }
    Touch { block, nodes, past }
}

impl Touch {
    fn force(&self, nodes: &[Node]) -> Vec<f64> {
        let mut F = vec![[0.0; 6]; nodes.len()];
        self.block.subtract_forces(&Configuration { nodes, history: &self.past, dt: 0.0 }, &mut F);
        // In the order of the block: the carrier is its last node.
        F.rotate_left(1);
        F.into_iter().flatten().collect()
    }
}

/// Calls with every combination, and with what it is called.
fn each(mut check: impl FnMut(&mut StdRng, Touch, &str)) {
    let mut rng = StdRng::seed_from_u64(7);
    for shape in SHAPES {
        for (count, radius) in [(1, 0.0), (1, 0.15), (3, 0.0), (2, 0.1)] {
            for (friction, slide) in [(0.0, 1e-3), (0.8, 3e-4), (0.3, 5e-2)] {
                for _ in 0..8 {
                    let touch = touch(&mut rng, shape, count, radius, friction, slide);
                    check(&mut rng, touch, &format!("{shape:?}, {count} nodes, radius {radius}, friction {friction}"));
                }
            }
        }
    }
}

#[test]
fn the_tangent_is_the_derivative() {
    let mut checked = 0;
    each(|_, touch, what| {
        let size = touch.force(&touch.nodes).iter().fold(0.0f64, |m, f| m.max(f.abs()));
        if size == 0.0 {
            return;
        }
        let (width, rate, h) = (6 * touch.nodes.len(), 3.0, 1e-7);
        let mut K = vec![f64::NAN; width * width];
        let now = Configuration { nodes: &touch.nodes, history: &touch.past, dt: 0.0 };
        touch.block.tangent(0, &now, rate, Moduli::Algorithmic, &mut K);
        let largest = K.iter().fold(0.0f64, |m, k| m.max(k.abs()));
        let moved = |column: usize, h: f64| {
            let mut nodes = touch.nodes.clone();
            let node = &mut nodes[(column / 6 + 1) % touch.nodes.len()];
            let e = Vec3::ith(column % 3, h);
            if column % 6 < 3 {
                node.x += e;
                node.v += rate * e;
            } else {
                node.rotation = exp(&e) * node.rotation;
                node.omega += rate * e;
            }
            touch.force(&nodes)
        };
        let columns: Vec<(Vec<f64>, Vec<f64>)> = (0..width).map(|c| (moved(c, h), moved(c, -h))).collect();
        // Not across the edge between two faces or between sticking and slipping: there second differences do not vanish.
        let base = touch.force(&touch.nodes);
        let kink =
            columns.iter().flat_map(|(a, b)| a.iter().zip(b).zip(&base).map(|((a, b), c)| (a + b - 2.0 * c).abs()));
        if kink.fold(0.0, f64::max) > 1e-4 * largest * h {
            return;
        }
        checked += 1;
        for (column, (ahead, behind)) in columns.iter().enumerate() {
            for row in 0..width {
                let slope = -(ahead[row] - behind[row]) / (2.0 * h);
                let k = K[row * width + column];
                // Rounding of forces of size 10 over 1e-7 gives 1e-8; the largest entries are 1e3 to 1e4.
                assert!((slope - k).abs() < 2e-6 * largest, "{what}: ({row}, {column}): {k} against {slope}");
            }
        }
    });
    assert!(checked > 400, "only {checked} states were in touch and smooth");
}

#[test]
fn forces_and_moments_balance() {
    each(|_, touch, what| {
        let F = touch.force(&touch.nodes);
        let mut nodes = touch.nodes.clone();
        nodes.rotate_left(1);
        let (mut f, mut m, mut size) = (Vec3::zeros(), Vec3::zeros(), 0.0f64);
        for (node, F) in nodes.iter().zip(F.chunks(6)) {
            let (force, moment) = (Vec3::new(F[0], F[1], F[2]), Vec3::new(F[3], F[4], F[5]));
            f += force;
            m += node.x.cross(&force) + moment;
            size = size.max(force.norm());
        }
        // Round-off of sums over some nodes, arms of length one or two.
        assert!(f.norm() < 1e-14 * size.max(1.0) && m.norm() < 1e-13 * size.max(1.0), "{what}: {f} {m}");
    });
}

#[test]
fn forces_turn_with_the_scene() {
    each(|rng, touch, what| {
        let F = touch.force(&touch.nodes);
        let (turn, shift) = (exp(&vector(rng, 3.0)), vector(rng, 5.0));
        let R: Mat3 = matrix(&turn);
        let turned: Vec<Node> = touch
            .nodes
            .iter()
            .map(|n| Node { x: shift + R * n.x, rotation: turn * n.rotation, v: R * n.v, omega: R * n.omega, ..*n })
            .collect();
        let after = touch.force(&turned);
        let size = F.iter().fold(1.0f64, |m, f| m.max(f.abs()));
        for (a, b) in F.chunks(3).zip(after.chunks(3)) {
            let expected = R * Vec3::new(a[0], a[1], a[2]);
            // Depths of 5e-3 are differences of positions of size 5, rounded to 1e-15: 1e-12 of the force.
            assert!((expected - Vec3::new(b[0], b[1], b[2])).norm() < 1e-11 * size, "{what}");
        }
    });
}
