//! Lines against lines by themselves: tangents, balance, and nothing that is missed.

use super::faces_alone::{STIFFNESS, Scene, law};
use super::touch::vector;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::Results;
use rdsolve::elements::contact::restitution::{Loss, number};
use rdsolve::elements::contact::{ContactPoint, Facet, FacetTouchers, MOST_NODES, TouchKind};
use rdsolve::math::Vec3;
use rdsolve::math::rotation::exp;
use rdsolve::state::Node;

fn line(a: usize, b: usize, radius: f64, rolling_radius: f64) -> ContactPoint {
    let (mut nodes, mut weights) = ([a; MOST_NODES], [0.0; MOST_NODES]);
    nodes[1] = b;
    weights[..2].fill(0.5);
    ContactPoint { nodes, weights, count: 2, radius, rolling_radius, extent: TouchKind::Line }
}

/// Two lines that touch somewhere, everything turned and moving, after they have slid.
fn touching(rng: &mut StdRng, friction: f64, loss: Loss, slide: f64, extent: TouchKind) -> Scene {
    let (half, radius) = (0.05, 0.07);
    let (u, v) = (vector(rng, 1.0), vector(rng, 1.0));
    let n = u.cross(&v).normalize();
    let apart = half + radius - rng.random_range(0.005..0.02);
    // Shares beyond the ends make these touch; of edges, which end there, every other lies within reach of an end.
    let mut share = || match extent {
        TouchKind::Edge if rng.random_range(0..2) == 0 => rng.random_range(0.005..0.04),
        TouchKind::Edge => rng.random_range(0.1..0.9),
        _ => rng.random_range(-0.3..1.3),
    };
    let (s, t) = (share(), share());
    let clamp = |x: f64| x.clamp(0.0, 1.0);
    let b = apart * n - clamp(s) * u + (s - clamp(s)) * 0.1 * u;
    let places = [-clamp(t) * v, (1.0 - clamp(t)) * v, b, b + u];
    let nodes = places.map(|x| Node { rotation: exp(&vector(rng, 2.0)), ..Node::at_rest(x) }).to_vec();
    let facets = vec![Facet::new(&[0, 1], half)];
    let lines = vec![ContactPoint { extent, ..line(2, 3, radius, radius) }];
    let mut scene = Scene::of(law(friction, loss), FacetTouchers::Others, lines, nodes, facets);
    for node in &mut scene.nodes {
        node.x += vector(rng, slide);
        (node.v, node.omega) = (vector(rng, 0.2), vector(rng, 0.2));
        node.rotation = exp(&vector(rng, slide / radius)) * node.rotation;
    }
    // Inwards, so that the force is there whatever the damping.
    scene.nodes[2].v -= 0.3 * n;
    scene.nodes[3].v -= 0.3 * n;
    scene
}

fn each(mut check: impl FnMut(Scene, f64, &str)) {
    let mut rng = StdRng::seed_from_u64(3);
    for (friction, slide) in [(0.0, 1e-3), (0.8, 1e-4), (0.2, 5e-3)] {
        for loss in [Loss::None, Loss::Restitution { number: number(0.5), floor: 0.1 }] {
            for extent in [TouchKind::Line, TouchKind::Edge] {
                for _ in 0..60 {
                    let scene = touching(&mut rng, friction, loss, slide, extent);
                    check(scene, friction, &format!("{extent:?}, friction {friction}, {loss:?}"));
                }
            }
        }
    }
}

#[test]
fn the_tangent_is_the_derivative() {
    let mut checked = 0;
    each(|scene, friction, what| {
        // Rounding of forces of size 20 over 1e-7 gives 2e-8; the largest entries are 1e3. Friction is differentiated by differences over 1e-7
        // of lengths, of forces that bend within the way of its elastic slip, 5 mm.
        checked += usize::from(scene.check_tangent(if friction == 0.0 { 1e-6 } else { 1e-5 }, what));
    });
    assert!(checked > 480, "only {checked} of 720 states were in touch and smooth");
}

#[test]
fn forces_and_moments_balance() {
    each(|scene, _, what| {
        let F = scene.force(&scene.nodes);
        let (mut f, mut m, mut size) = (Vec3::zeros(), Vec3::zeros(), 0.0f64);
        for (node, F) in scene.nodes.iter().zip(F.chunks(6)) {
            let (force, moment) = (Vec3::new(F[0], F[1], F[2]), Vec3::new(F[3], F[4], F[5]));
            f += force;
            m += node.x.cross(&force) + moment;
            size = size.max(force.norm());
        }
        assert!(f.norm() < 1e-13 * size.max(1.0) && m.norm() < 1e-13 * size.max(1.0), "{what}: {f} {m}");
    });
}

/// Lines that move as one body, fast and far, feel nothing of that: the forces turn along.
#[test]
fn forces_go_along_with_a_motion_of_both() {
    let mut rng = StdRng::seed_from_u64(12);
    let mut rubbing = 0;
    each(|mut scene, friction, what| {
        let still = scene.force(&scene.nodes);
        let (turn, way) = (exp(&vector(&mut rng, 3.0)), vector(&mut rng, 2.0));
        let R = rdsolve::math::rotation::matrix(&turn);
        for node in &mut scene.nodes {
            (node.x, node.rotation) = (R * node.x + way, turn * node.rotation);
            (node.v, node.omega) = (R * node.v, R * node.omega);
        }
        let moved = scene.force(&scene.nodes);
        for (a, b) in still.chunks(3).zip(moved.chunks(3)) {
            let (a, b) = (Vec3::from_column_slice(a), Vec3::from_column_slice(b));
            // Forces of up to 20 by a stiffness of 1e3 at coordinates of size 4.
            assert!((R * a - b).norm() < 1e-10, "{what}: {a} {b}");
            rubbing += usize::from(friction > 0.0 && a.norm() > 0.0);
        }
    });
    assert!(rubbing > 1000, "{rubbing}");
}

/// Sixty lines thrown about among themselves: the energy is that of all pairs whose nearest points, by samples refined about the best, lie
/// within reach. Lists are made anew as they move.
#[test]
fn no_pair_is_missed() {
    let mut rng = StdRng::seed_from_u64(8);
    let (count, radius) = (60, 0.06);
    let mut nodes = Vec::new();
    for _ in 0..count {
        let (x, u) = (vector(&mut rng, 1.0), vector(&mut rng, 0.4));
        nodes.extend([Node::at_rest(x), Node::at_rest(x + u)]);
    }
    let lines: Vec<ContactPoint> = (0..count).map(|k| line(2 * k, 2 * k + 1, radius, 0.0)).collect();
    let facets = (0..count).map(|k| Facet::new(&[2 * k, 2 * k + 1], radius)).collect();
    let mut scene = Scene::of(law(0.0, Loss::None), FacetTouchers::Itself, lines, nodes, facets);
    let mut touched = 0;
    for _ in 0..200 {
        for node in &mut scene.nodes {
            node.x += vector(&mut rng, 0.02);
        }
        let x = |node: usize| scene.nodes[node].x;
        let mut exact = 0.0;
        for i in 0..count {
            for j in 0..i {
                let (a, u) = (x(2 * i), x(2 * i + 1) - x(2 * i));
                let (b, v) = (x(2 * j), x(2 * j + 1) - x(2 * j));
                // Nearest points by turns on either line, from the best of some: the distance is convex.
                let (mut s, mut t) = (0.5, 0.5);
                for _ in 0..4000 {
                    let before = [s, t];
                    t = ((a + s * u - b).dot(&v) / v.norm_squared()).clamp(0.0, 1.0);
                    s = ((b + t * v - a).dot(&u) / u.norm_squared()).clamp(0.0, 1.0);
                    if before == [s, t] {
                        break;
                    }
                }
                let depth: f64 = 2.0 * radius - (a + s * u - b - t * v).norm();
                if depth > 0.0 {
                    touched += 1;
                    exact += 0.5 * STIFFNESS * depth * depth;
                }
            }
        }
        let found = scene.block.energy(&scene.now(&scene.nodes));
        assert!((found - exact).abs() < 1e-9 * exact.max(1.0), "{found} for {exact}");
    }
    assert!(touched > 1000, "{touched}");
}
