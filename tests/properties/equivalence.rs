//! One scene, told or solved in two ways: one answer.

use super::scene::*;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::linear;
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::{AnalysisKind, MassKind, Model, Update};
use rdsolve::plan::Plan;
use rdsolve::state::Node;
use rdsolve::system::System;

/// An arm of two beams with something at its end, to be put there; gravity and a pulse act. The end comes back.
fn arm(time_step: f64) -> (Model, usize) {
    let mut m = empty(AnalysisKind::Dynamic, 1.0, time_step);
    section(&mut m);
    let p = [[0.0, 0.0, 0.0], [1.0, 0.2, 0.1], [1.8, -0.3, 0.5]].map(|x| node(&mut m, Vec3::from(x)));
    beam(&mut m, [p[0], p[1]], 1, 3, Vec3::z(), MassKind::Lumped);
    beam(&mut m, [p[1], p[2]], 2, 1, Vec3::z(), MassKind::Consistent);
    fix(&mut m, p[0], 0..6);
    m.loading.gravity = Vec3::new(1.0, -2.0, -4.0);
    let pulse = sine_squared(&mut m, 5.0);
    push(&mut m, p[1], Vec3::new(0.0, 20.0, -10.0), Vec3::new(5.0, 0.0, 3.0), true, Some(pulse));
    (m, p[2])
}

/// Largest distance over a run between nodes of two models.
fn off(a: (&Model, usize), b: (&Model, usize)) -> f64 {
    let (r, s) = (run(a.0), run(b.0));
    assert_eq!(r.states.len(), s.states.len());
    r.states.iter().zip(&s.states).map(|(r, s)| (r.nodes[a.1].x - s.nodes[b.1].x).norm()).fold(0.0, f64::max)
}

/// The same equations: rounding over 100 steps and 1e-12 left by the iteration.
const SAME: f64 = 1e-10;

#[test]
fn a_mass_is_a_body_on_its_node_or_a_point_mass_with_inertia() {
    let mut rng = StdRng::seed_from_u64(61);
    let (m0, J) = (3.0, inertia(&mut rng, 1.0));
    let (mut point, tip) = arm(0.01);
    mass(&mut point, tip, m0, J);
    let (mut dependent, other) = arm(0.01);
    let x = dependent.nodes[other].x;
    let block = body(&mut dependent, x, m0, J);
    attach(&mut dependent, other, block, ALL);
    let e = off((&point, tip), (&dependent, other));
    assert!(e < SAME, "a body that carries the node: {e:e}");
    // The other way round: the body's node rides on the tip.
    let (mut carried, tip2) = arm(0.01);
    let block = body(&mut carried, x, m0, J);
    attach(&mut carried, block, tip2, ALL);
    let e = off((&point, tip), (&carried, tip2));
    assert!(e < SAME, "a body on the node: {e:e}");
}

/// A body held by one node; by that and two more on a line, which nothing else holds; and by a chain of dependent nodes.
#[test]
fn more_nodes_on_a_body_change_nothing() {
    let mut rng = StdRng::seed_from_u64(62);
    let J = inertia(&mut rng, 1.0);
    let with = |extra: usize, chain: bool| {
        let (mut m, tip) = arm(0.01);
        let x = m.nodes[tip].x;
        let block = body(&mut m, x + Vec3::new(0.4, 0.2, -0.1), 3.0, J);
        for k in 0..extra {
            let p = node(&mut m, x + Vec3::new(0.0, 0.3, 0.1) * (k + 1) as f64);
            attach(&mut m, p, block, ALL);
        }
        let master = if chain {
            let between = node(&mut m, x + Vec3::new(-0.5, 1.0, 2.0));
            attach(&mut m, between, block, ALL);
            between
        } else {
            block
        };
        attach(&mut m, tip, master, ALL);
        (m, tip)
    };
    let (one, tip) = with(0, false);
    for (extra, chain) in [(1, false), (2, false), (0, true), (2, true)] {
        let (other, tip2) = with(extra, chain);
        let e = off((&one, tip), (&other, tip2));
        assert!(e < SAME, "{extra} more nodes, chain {chain}: {e:e}");
    }
}

/// Two masses on a rigid arm are one body at their centre. Equations are written at different points, so the answers agree
/// to the order of the scheme.
#[test]
fn masses_on_arms_are_the_body_they_make() {
    let mut rng = StdRng::seed_from_u64(63);
    let (m1, J1, m2, J2) = (2.0, inertia(&mut rng, 0.6), 1.5, inertia(&mut rng, 0.3));
    let S = Vec3::new(0.5, -0.3, 0.4);
    let errors: Vec<f64> = [0.01, 0.005, 0.0025]
        .iter()
        .map(|&dt| {
            let (mut two, tip) = arm(dt);
            let x = two.nodes[tip].x + Vec3::new(0.1, 0.2, 0.0);
            let first = body(&mut two, x, m1, J1);
            let second = node(&mut two, x + S);
            mass(&mut two, second, m2, J2);
            attach(&mut two, second, first, ALL);
            attach(&mut two, tip, first, ALL);
            let (mut one, tip1) = arm(dt);
            let reduced = m1 * m2 / (m1 + m2);
            let parallel = (Mat3::identity() * S.norm_squared() - S * S.transpose()) * reduced;
            let both = body(&mut one, x + S * (m2 / (m1 + m2)), m1 + m2, J1 + J2 + parallel);
            attach(&mut one, tip1, both, ALL);
            off((&two, tip), (&one, tip1))
        })
        .collect();
    eprintln!("two masses or one body: {errors:?}");
    assert!(order(errors[0], errors[1]) > 1.7 && order(errors[1], errors[2]) > 1.7, "{errors:?}");
    assert!(errors[2] < 1e-4, "{errors:?}");
}

/// A bent arm of two beams with a block at its end, which moves in the plane y = 0, and the tip of the arm. With `plane` the motion
/// out of it may be omitted; `side` is the direction of the sections' y.
fn arm_with_block(plane: bool, side: Vec3) -> (Model, usize) {
    let mut m = empty(AnalysisKind::Dynamic, 1.0, 0.01);
    m.analysis.plane = plane;
    m.stiffnesses.push(rdsolve::sections::Stiffness::general(900.0, [400.0; 2], 30.0, [40.0; 2], 0.7, [0.05; 3]));
    let p = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.2], [1.8, 0.0, 0.6]].map(|x| node(&mut m, Vec3::from(x)));
    beam(&mut m, [p[0], p[1]], 1, 3, side, MassKind::Lumped);
    beam(&mut m, [p[1], p[2]], 2, 1, side, MassKind::Lumped);
    fix(&mut m, p[0], 0..6);
    let block = body(&mut m, Vec3::new(2.0, 0.0, 0.5), 2.0, Mat3::from_diagonal(&Vec3::new(0.3, 0.4, 0.5)));
    attach(&mut m, p[2], block, ALL);
    m.nodes[block].omega = Vec3::y() * 2.0;
    m.nodes[block].v = Vec3::new(0.0, 0.0, 1.0);
    m.loading.gravity = Vec3::new(1.0, 0.0, -4.0);
    (m, p[2])
}

#[test]
fn a_plane_scene_is_the_same_in_space() {
    let in_plane = |plane: bool| arm_with_block(plane, Vec3::y());
    let ((plane, tip), (space, _)) = (in_plane(true), in_plane(false));
    let unknowns = |m: &Model| Plan::new(m, &System::new(m).unwrap(), 1).dofs.unknowns();
    assert_eq!(unknowns(&space), 2 * unknowns(&plane));
    let e = off((&plane, tip), (&space, tip));
    assert!(e < SAME, "{e:e}");
}

/// Fibres that strain alike in a plane motion are one there. Whichever global plane it is, whichever side of the section lies in
/// it, and with all fibres in space: one answer.
#[test]
fn a_plane_scene_that_yields_is_the_same_in_space_and_in_any_plane() {
    let scene = |plane: bool, side: Vec3| {
        let (mut m, _) = arm_with_block(plane, side);
        soften(&mut m, 10.0);
        m
    };
    let history = |m: &Model| System::new(m).unwrap().history;
    // Cyclic changes of the axes, which leave every number as it is.
    let third = Quat::new(0.5, 0.5, 0.5, 0.5);
    for side in [Vec3::y(), Vec3::new(-0.6, 0.0, 1.0)] {
        let (plane, space) = (scene(true, side), scene(false, side));
        assert_eq!(history(&space), 4 * history(&plane), "four rows of four fibres are four");
        let first = run(&plane);
        let spent = first.energies.last().expect("shown").plastic;
        assert!(spent > 1.0, "{spent}");
        let others = [(space, Quat::identity()), (turned(&plane, &third, &Vec3::zeros()), third)];
        let last = third * third;
        for (other, q) in others.into_iter().chain([(turned(&plane, &last, &Vec3::zeros()), last)]) {
            let R = rdsolve::math::rotation::matrix(&q);
            let off = run(&other).states.iter().zip(&first.states).fold(0.0f64, |off, (a, b)| {
                let apart = a.nodes.iter().zip(&b.nodes).map(|(a, b)| (a.x - R * b.x).norm());
                apart.fold(off, f64::max)
            });
            eprintln!("plane and space, yielding: {off:e}");
            assert!(off < SAME, "{side:?}, {q:?}: {off:e}");
        }
    }
}

/// Each way stops within the tolerance of a step; a hundred steps let that grow tenfold.
#[test]
fn updates_and_factorisations_do_not_show() {
    let tolerance = 1e-9;
    let mut rng = StdRng::seed_from_u64(64);
    let mut m = zoo(&mut rng, AnalysisKind::Dynamic, 0.005);
    m.analysis.end_time = 0.5;
    m.solution.iteration.tolerance = tolerance;
    m.solution.iteration.limit = 60;
    m.solution.iteration.update = Update::Iteration;
    let first = run_with(&m, Some(linear::Factorization::BlockLu));
    let travel = m.nodes.iter().zip(&first.last().nodes).map(|(a, b): (_, &Node)| (a.x - b.x).norm());
    assert!(travel.fold(0.0, f64::max) > 0.3, "the scene moves");
    for update in [Update::Iteration, Update::Step, Update::Auto, Update::Never] {
        for kind in [linear::Factorization::BlockLu, linear::Factorization::Cholesky] {
            m.solution.iteration.update = update;
            let other = run_with(&m, Some(kind));
            let e = first.states.iter().zip(&other.states).map(|(a, b)| apart(a, b)).fold(0.0, f64::max);
            eprintln!("{update:?} {kind:?}: {e:e}, {:?}", other.counts);
            assert_eq!(other.counts.cuts, 0, "{update:?} {kind:?}");
            assert!(e < 10.0 * tolerance, "{update:?} {kind:?}: {e:e}");
        }
    }
}
