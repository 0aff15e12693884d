//! The block by itself: its tangent, its balance, its indifference to where the scene stands.

use super::touch::{Touch, vector};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::Mechanics;
use rdsolve::elements::contact::restitution::{Loss, number};
use rdsolve::elements::contact::surfaces::{Capsule, Cuboid, Cylinder, Plane, Sphere};
use rdsolve::elements::contact::{ContactLaw, ContactPoint, Contacts, MOST_NODES, Surface, SurfaceShape, TouchKind};
use rdsolve::math::Vec3;
use rdsolve::math::polyhedron::Polyhedron;
use rdsolve::math::rotation::{exp, matrix};
use rdsolve::state::{Configuration, Node};
use std::sync::Arc;

fn shapes() -> [SurfaceShape; 6] {
    let corners = [[-0.5, -0.4, -0.3], [0.6, -0.3, -0.3], [0.1, 0.5, -0.3], [-0.2, -0.4, 0.5], [0.3, 0.1, 0.6]];
    let hull = Polyhedron::hull(&corners.map(Vec3::from)).expect("a solid").0;
    [
        SurfaceShape::Plane(Plane),
        SurfaceShape::Cuboid(Cuboid { half: [0.3, 0.5, 0.8] }),
        SurfaceShape::Sphere(Sphere { radius: 0.6 }),
        SurfaceShape::Cylinder(Cylinder { radius: 0.5, half: 0.7 }),
        SurfaceShape::Capsule(Capsule { radius: 0.4, half: 0.6 }),
        SurfaceShape::of_polyhedron(Arc::new(hull), 0.0),
    ]
}

/// A point and a surface in touch. `count` nodes carry the point; `slide` is the way along the surface since the past.
fn touch(
    rng: &mut StdRng,
    shape: SurfaceShape,
    count: usize,
    radius: f64,
    (friction, lift): (f64, f64),
    slide: f64,
) -> Touch<Contacts> {
    let law = ContactLaw {
        stiffness: 1e3,
        loss: Loss::Restitution { number: number(0.5), floor: 0.1 },
        friction,
        kinetic: friction,
        decay: f64::INFINITY,
        floor: 0.1,
        resolution: f64::INFINITY,
        duration: 0.0,
        near: 1.0,
        touching: 0.0,
        tolerance: (lift > 0.0).then_some(1e-9),
        dynamic: true,
    };
    let surface = Surface { center: vector(rng, 0.3), axes: matrix(&exp(&vector(rng, 2.0))), shape };
    let mut weights = [0.0; MOST_NODES];
    let parts: Vec<f64> = (0..count).map(|_| rng.random_range(0.2..1.0)).collect();
    let sum: f64 = parts.iter().sum();
    (0..count).for_each(|k| weights[k] = parts[k] / sum);
    let mut of = [1; MOST_NODES];
    (0..count).for_each(|k| of[k] = 1 + k);
    let point = ContactPoint { nodes: of, weights, count, radius, rolling_radius: radius, extent: TouchKind::Point };

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
    block.update_history(&Configuration { nodes: &nodes, history: &nothing, dt: 0.0, previous: None }, 1.0, &mut past);
    if let (true, Some(last)) = (lift > 0.0, past.last_mut()) {
        *last = lift;
    }

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

/// Calls with every combination, and with what it is called.
fn each(mut check: impl FnMut(&mut StdRng, Touch<Contacts>, &str)) {
    let mut rng = StdRng::seed_from_u64(7);
    for shape in shapes() {
        for (count, radius) in [(1, 0.0), (1, 0.15), (3, 0.0), (2, 0.1)] {
            // With multipliers, too, of a force that is there at a gap.
            for (friction, slide, lift) in [(0.0, 1e-3, 0.0), (0.8, 3e-4, 0.0), (0.3, 5e-2, 0.0), (0.5, 3e-4, 0.01)] {
                for _ in 0..8 {
                    let touch = touch(&mut rng, shape.clone(), count, radius, (friction, lift), slide);
                    check(&mut rng, touch, &format!("{shape:?}, {count} nodes, radius {radius}, friction {friction}"));
                }
            }
        }
    }
}

#[test]
fn the_tangent_is_the_derivative() {
    let mut checked = 0;
    // Rounding of forces of size 10 over 1e-7 gives 1e-8; the largest entries are 1e3 to 1e4.
    each(|_, touch, what| checked += usize::from(touch.check_tangent(2e-6, what)));
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
        let size = F.iter().fold(1.0f64, |m, f| m.max(f.abs()));
        for (expected, found) in touch.forces_of_turned_scene(rng) {
            // Depths of 5e-3 are differences of positions of size 5, rounded to 1e-15: 1e-12 of the force.
            assert!((expected - found).norm() < 1e-11 * size, "{what}");
        }
    });
}
