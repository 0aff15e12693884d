//! Momentum of what flies free, and reactions of what is held.

use super::scene::*;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::amplitude::Amplitude;
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::{AnalysisKind, Link, LinkKind, MassKind, Model, OwnDamping, PartType, Update};
use rdsolve::system::energy::Energy;
use rdsolve::system::{Forces, Loading, System, results};

/// Two bodies on the ends of a bent beam, a spring between arms of theirs: nothing acts from outside. With `riding` the
/// masses of beam and arms ride on the bodies; without, arms and beam have none.
fn flyer(riding: bool, time_step: f64) -> Model {
    let mut rng = StdRng::seed_from_u64(31);
    let mut m = empty(AnalysisKind::Dynamic, 2.0, time_step);
    section(&mut m);
    let a = body(&mut m, Vec3::new(0.0, 0.0, 0.0), 2.0, inertia(&mut rng, 1.0));
    let b = body(&mut m, Vec3::new(3.0, 1.0, 0.5), 1.0, inertia(&mut rng, 0.5));
    let p = [[0.5, 0.3, 0.1], [1.5, 1.2, 0.3], [2.6, 0.7, 0.6]].map(|x| node(&mut m, Vec3::from(x)));
    let kind = if riding { MassKind::Consistent } else { MassKind::None };
    beam(&mut m, [p[0], p[1]], 1, 3, Vec3::z(), kind);
    beam(&mut m, [p[1], p[2]], 1, 2, Vec3::z(), kind);
    attach(&mut m, p[0], a, ALL);
    attach(&mut m, p[2], b, ALL);
    let (c, d) = (node(&mut m, Vec3::new(0.2, -0.5, 0.8)), node(&mut m, Vec3::new(3.3, 0.2, 1.0)));
    attach(&mut m, c, a, ALL);
    attach(&mut m, d, b, ALL);
    spring(&mut m, [c, d], 20.0, 0.5);
    mass(&mut m, p[1], 0.5, inertia(&mut rng, 0.1));
    if riding {
        mass(&mut m, c, 0.3, Mat3::zeros());
        mass(&mut m, d, 0.3, inertia(&mut rng, 0.1));
    }
    (m.nodes[a].v, m.nodes[a].omega) = (Vec3::new(0.3, -0.2, 0.5), Vec3::new(1.0, -0.5, 0.7));
    (m.nodes[b].v, m.nodes[b].omega) = (Vec3::new(-0.4, 0.6, 0.2), Vec3::new(0.2, 0.8, -0.6));
    m.solution.iteration.update = Update::Step;
    m
}

/// Largest departures of linear and angular momentum from those at t = 0, relative.
fn drift(m: &Model) -> (f64, f64) {
    let record = run(m);
    let first = record.energies[0];
    let of = |f: &dyn Fn(&Energy) -> f64| record.energies.iter().map(f).fold(0.0, f64::max);
    (of(&|e| (e.p - first.p).norm()) / first.p.norm(), of(&|e| (e.l - first.l).norm()) / first.l.norm())
}

/// Where no mass rides the forces of a step cancel in pairs: linear momentum is exact but for the residual left, 1e-12 of
/// the largest force over 100 steps. Angular momentum follows the scheme, of second order.
#[test]
fn free_flight_keeps_momentum() {
    let e: Vec<(f64, f64)> = [0.02, 0.01, 0.005, 0.0025, 0.00125].iter().map(|&dt| drift(&flyer(false, dt))).collect();
    eprintln!("linear, angular: {e:?}");
    assert!(e.iter().all(|e| e.0 < 1e-11), "{e:?}");
    // Errors of other signs, of bodies and of the beam, meet on the longer steps.
    assert!(order(e[0].1, e[2].1) > 3.6 && order(e[3].1, e[4].1) > 1.9, "{e:?}");
    assert!(e[2].1 < 2e-4, "{e:?}");
}

/// The same while the beam yields. Its stiffness jumps as fibres begin and end to yield, which costs the scheme some of its order in
/// angular momentum and nothing in linear.
#[test]
fn free_flight_keeps_momentum_while_it_yields() {
    let e: Vec<(f64, f64)> = [0.02, 0.01, 0.005]
        .iter()
        .map(|&dt| {
            let mut m = flyer(false, dt);
            soften(&mut m, 5.0);
            let energies = run(&m).energies;
            let (first, last) = (energies[0], energies.last().expect("shown"));
            assert!(last.plastic > 0.1 * first.kinetic, "{} of {}", last.plastic, first.kinetic);
            drift(&m)
        })
        .collect();
    eprintln!("linear, angular, while it yields: {e:?}");
    assert!(e.iter().all(|e| e.0 < 1e-11), "{e:?}");
    assert!(order(e[0].1, e[1].1) > 1.5 && order(e[1].1, e[2].1) > 1.5, "{e:?}");
    assert!(e[2].1 < 1e-3, "{e:?}");
}

/// A mass that rides has the acceleration of its body at the end of the step, where the scheme writes no equilibrium:
/// linear momentum is then kept to second order as well (from steps where terms of third order are still a fifth).
#[test]
fn free_flight_with_riding_masses_keeps_momentum_to_second_order() {
    let e: Vec<(f64, f64)> = [0.005, 0.0025, 0.00125].iter().map(|&dt| drift(&flyer(true, dt))).collect();
    eprintln!("linear, angular: {e:?}");
    for of in [|e: &(f64, f64)| e.0, |e: &(f64, f64)| e.1] {
        assert!(order(of(&e[0]), of(&e[1])) > 1.7 && order(of(&e[1]), of(&e[2])) > 1.7, "{e:?}");
        assert!(of(&e[2]) < 1e-3, "{e:?}");
    }
}

/// Reactions and loads of a static scene balance as they stand in the deformed structure, forces and moments about the
/// origin. Iteration leaves 1e-12 of the largest force per direction.
#[test]
fn static_reactions_balance_the_loads() {
    let mut rng = StdRng::seed_from_u64(32);
    for _ in 0..3 {
        let mut m = zoo(&mut rng, AnalysisKind::Static, 0.05);
        // Links along a fixed direction pass on moments that nobody takes; only supports may.
        let is_fixed = |link: &Link| matches!(link.kind, LinkKind::Line { direction: Some(_), .. });
        m.parts.retain(|part| !Link::of(part).is_some_and(is_fixed));
        // Far from buckling.
        m.loading.nodal.iter_mut().for_each(|load| (load.force, load.moment) = (load.force * 0.15, load.moment * 0.15));
        m.loading.gravity *= 0.15;
        let record = run(&m);
        let state = record.last();
        let (mut force, mut moment, mut size) = (Vec3::zeros(), Vec3::zeros(), 0.0f64);
        let mut add = |x: &Vec3, f: Vec3, m: Vec3| {
            force += f;
            moment += x.cross(&f) + m;
            size = size.max(f.norm()).max(m.norm()).max(x.cross(&f).norm());
        };
        m.constraints.restraints.sort_by_key(|h| (h.node, h.dof));
        for (h, &value) in m.constraints.restraints.iter().zip(&state.reactions) {
            let mut f = [Vec3::zeros(); 2];
            f[h.dof / 3][h.dof % 3] = value;
            add(&state.nodes[h.node].x, f[0], f[1]);
        }
        for load in &m.loading.nodal {
            let node = &state.nodes[load.node];
            let R = if load.follower { node.R() } else { Mat3::identity() };
            add(&node.x, R * load.force, R * load.moment);
        }
        // Weight as the system spreads it over the nodes: what remains of it without elements, loads and dependent nodes.
        let mut stripped = m.clone();
        stripped.constraints.dependents.clear();
        stripped.loading.nodal.clear();
        let mut bare = System::new(&stripped).unwrap();
        bare.groups.clear();
        let mut weight = Forces::new(&bare, m.nodes.len());
        bare.residual(&state.configuration(), &Loading { field: m.loading.gravity, ..Loading::default() }, &mut weight);
        for (node, f) in state.nodes.iter().zip(weight.on_nodes) {
            add(&node.x, Vec3::new(f[0], f[1], f[2]), Vec3::new(f[3], f[4], f[5]));
        }
        eprintln!("force {:e} moment {:e}", force.norm() / size, moment.norm() / size);
        assert!(force.norm() < 1e-12 * size && moment.norm() < 1e-12 * size, "{force} {moment}");
    }
}

/// A body on a rail is pushed sideways and along from one instant on: from then on the rail carries the whole push.
#[test]
fn reactions_jump_with_the_loads() {
    let mut m = empty(AnalysisKind::Dynamic, 0.5, 0.05);
    let block = body(&mut m, Vec3::zeros(), 2.0, Mat3::identity());
    fix(&mut m, block, [0, 1]);
    m.loading.amplitudes.push(Amplitude::Step { start: 0.2, end: f64::INFINITY });
    push(&mut m, block, Vec3::new(0.0, 10.0, 1.0), Vec3::zeros(), false, Some(0));
    for state in run(&m).states {
        // At the jump itself the step before it ends.
        let push = if state.time > 0.21 { 10.0 } else { 0.0 };
        assert!((state.reactions[1] + push).abs() < 1e-12, "{} at t = {}", state.reactions[1], state.time);
    }
}

/// What links.csv says a bushing does to its first end is what the ground there must bear, also across a distance.
#[test]
fn bushings_tell_the_moment_at_their_first_end() {
    let mut m = empty(AnalysisKind::Static, 1.0, 0.5);
    let ground = node(&mut m, Vec3::zeros());
    let block = body(&mut m, Vec3::new(1.0, 0.5, 0.0), 1.0, Mat3::identity());
    fix(&mut m, ground, 0..6);
    let stiffness = [1e3, 2e3, 3e3, 100.0, 200.0, 300.0];
    let kind = LinkKind::Bushing { stiffness, damping: [0.0; 6], axes: Mat3::identity() };
    m.add(Link {
        name: "mount".into(),
        ends: [ground, block],
        kind,
        own_damping: OwnDamping::default(),
        failure: None,
        take_up: None,
    });
    push(&mut m, block, Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.1, 0.2, 0.3), false, None);
    let state = run(&m).last().clone();
    let mut links = Vec::new();
    results::link_states(&System::new(&m).unwrap(), &state.configuration(), &mut links);
    let link = links[0];
    let felt = [link.f.x, link.f.y, link.f.z, link.m.x, link.m.y, link.m.z];
    for (reaction, felt) in state.reactions.iter().zip(felt) {
        assert!((reaction + felt).abs() < 1e-10, "{reaction} for {felt}");
    }
}
