//! Balls among themselves: chains of impacts, and a time that grows with their number alone.

use super::go;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::elements::contact::restitution::Loss;
use rdsolve::elements::contact::{
    ContactLaw, ContactPoint, Facet, FacetContacts, FacetTouchers, MOST_NODES, TouchKind,
};
use rdsolve::elements::{Mechanics, Results};
use rdsolve::math::Vec3;
use rdsolve::solve::Frame;
use rdsolve::state::{Configuration, Node};

/// A row of balls of radius 0.1 and 1 kg, a little apart, the first of which is thrown at the others.
fn cradle(scheme: &str, dt: f64, contact: &str) -> String {
    let ball = |k: usize| {
        let (x, v) = (0.201 * k as f64, if k == 0 { 1.0 } else { 0.0 });
        format!(
            r#"{{ name = "b{k}", center = [{x}, 0.0, 0.0], shape = {{ kind = "sphere", radius = 0.1 }}, mass = 1.0, velocity = [{v:?}, 0.0, 0.0] }}"#
        )
    };
    let bodies: Vec<String> = (0..5).map(ball).collect();
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 0.08, time_step = {dt} }}
        integrator = {{ {scheme} }}
        bodies = [{}]
        [[contacts]]
        name = "cradle"
        among = ["b0", "b1", "b2", "b3", "b4"]
        {contact}
        "#,
        bodies.join(", ")
    )
}

fn speeds(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    let nodes = frame.model.bodies.iter().map(|body| frame.state.nodes[body.node].v.x);
    nodes.chain([e.numerical]).collect()
}

/// Newton's cradle with gaps: the last ball goes off with all of the speed, and the others rest.
#[test]
fn newtons_cradle() {
    for scheme in [r#"scheme = "newmark""#, r#"scheme = "central-difference""#] {
        // ω = √(2k/m) = 4472, an impact lasts 0.7 ms, the gaps 1 ms each: impacts come one after the other.
        let done = go(&cradle(scheme, 1e-5, "stiffness = 1e7"), &mut speeds);
        let last = done.rows.last().unwrap();
        println!("{scheme}: {last:?}");
        // Second order with 70 steps an impact, of which four follow.
        for k in 0..4 {
            assert!(last[k].abs() < 2e-3, "{scheme}: {last:?}");
        }
        assert!((last[4] - 1.0).abs() < 2e-3 && last[5].abs() < 1e-3 * 0.5, "{scheme}: {last:?}");
        // Momentum to rounding.
        assert!((last[..5].iter().sum::<f64>() - 1.0).abs() < 1e-12, "{scheme}: {last:?}");
    }
}

/// Balls on a cubic grid, a little closer than they touch, each a bit out of place: `count` cubed.
fn heap(count: usize) -> (FacetContacts, Vec<Node>) {
    let mut rng = StdRng::seed_from_u64(2);
    let law = ContactLaw {
        stiffness: 1e3,
        loss: Loss::None,
        friction: 0.0,
        kinetic: 0.0,
        decay: f64::INFINITY,
        floor: 0.0,
        resolution: f64::INFINITY,
        duration: 0.0,
        near: 0.0,
        touching: 0.0,
        tolerance: None,
        dynamic: true,
    };
    let places = (0..count).flat_map(|i| (0..count).flat_map(move |j| (0..count).map(move |k| [i, j, k])));
    let nodes: Vec<Node> = places
        .map(|[i, j, k]| Node::at_rest(Vec3::new(i as f64, j as f64, k as f64) + super::touch::vector(&mut rng, 0.05)))
        .collect();
    let (points, facets) = (0..nodes.len()).map(|node| ball(node, 0.49 + 0.03 * (node % 3) as f64)).unzip();
    let x: Vec<Vec3> = nodes.iter().map(|node| node.x).collect();
    (FacetContacts::new(law, FacetTouchers::Among, points, facets, &x), nodes)
}

fn ball(node: usize, radius: f64) -> (ContactPoint, Facet) {
    let mut weights = [0.0; MOST_NODES];
    weights[0] = 1.0;
    let point = ContactPoint {
        nodes: [node; MOST_NODES],
        weights,
        count: 1,
        radius,
        rolling_radius: 0.0,
        extent: TouchKind::Point,
    };
    (point, Facet::ball(node, radius, 0.0))
}

/// No pair is missed: the energy is that of all pairs, each once.
#[test]
fn no_pair_of_balls_is_missed() {
    let (block, nodes) = heap(6);
    let radius = |k: usize| 0.49 + 0.03 * (k % 3) as f64;
    let mut all = 0.0;
    for i in 0..nodes.len() {
        for j in 0..i {
            let depth = radius(i) + radius(j) - (nodes[i].x - nodes[j].x).norm();
            all += 0.5 * 1e3 * depth.max(0.0).powi(2);
        }
    }
    let history = vec![0.0; block.history()];
    let energy = block.energy(&Configuration { nodes: &nodes, history: &history, dt: 0.0, previous: None });
    // Rounding of sums of some hundred terms.
    assert!(all > 0.0 && (energy / all - 1.0).abs() < 1e-12, "{energy} {all}");
}

/// An evaluation of 13824 balls takes no more than linear growth from 4096 allows, making the lists anew included. Neither fits the
/// inner cache.
#[test]
fn the_time_of_an_evaluation_is_linear() {
    let time = |count: usize| {
        let (block, mut nodes) = heap(count);
        let history = vec![0.0; block.history()];
        let mut F = vec![[0.0; 6]; nodes.len()];
        let mut evaluate = |nodes: &[Node]| {
            let begin = std::time::Instant::now();
            block.subtract_forces(&Configuration { nodes, history: &history, dt: 0.0, previous: None }, &mut F);
            begin.elapsed().as_secs_f64()
        };
        evaluate(&nodes);
        let of = |k: usize, evaluate: &mut dyn FnMut(&[Node]) -> f64, nodes: &mut Vec<Node>| {
            // One node of many goes far: all lists are made anew.
            nodes[0].x.x -= if k.is_multiple_of(2) { 3.0 } else { -3.0 };
            evaluate(nodes)
        };
        (0..10).map(|k| of(k, &mut evaluate, &mut nodes)).fold(f64::INFINITY, f64::min)
    };
    let (small, large) = (time(16), time(24));
    println!("4096 balls {:.2} ms, 13824 balls {:.2} ms", 1e3 * small, 1e3 * large);
    // 3.4 times as many; twice that where the machine is busy.
    assert!(large < 6.75 * small, "{small} {large}");
}
