//! The assembled matrix is the derivative of the assembled residual with respect to the increments of the step.

use super::scene::*;
use nalgebra::DMatrix;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::elements::Moduli;
use rdsolve::elements::damper::Damper;
use rdsolve::elements::pressure::Face;
use rdsolve::integrators::{
    AlphaFamily, Bathe, Coefficients, RotationUpdate, Scheme, TwoStages, WilsonTheta, load_steps,
};
use rdsolve::linear;
use rdsolve::math::rotation::{self, exp, inverse_tangent};
use rdsolve::math::{Mat3, Vec3, Vec6, angular, skew, stack};
use rdsolve::model::{
    AnalysisKind, Beam, Centrifugal, Link, MassKind, Model, NodalDamping, PartKind, Pressure, RotationAxis, StepLength,
    TurningMasses,
};
use rdsolve::plan::Plan;
use rdsolve::state::{Configuration, Increment, Node};
use rdsolve::system::TangentWeights;
use rdsolve::system::{Excitation, Forces, Loading, System};

/// A scene at an instant within a step.
struct Instant {
    system: System,
    plan: Plan,
    loading: Loading,
    scheme: Coefficients,
    /// Motion at the start of the step.
    start: Vec<Node>,
    /// (Δu, Θ) since then.
    q: Vec<Vec6>,
    /// Twists of bushings that count turns: none so far.
    history: Vec<f64>,
}

impl Instant {
    /// The scene carried far from where it began, strained, moving, and some way into a step. `rate`: of the motion at
    /// the start; the way into the step is `way`, or what the rates make of it.
    fn random(m: &Model, rng: &mut StdRng, rate: f64, way: Option<f64>) -> Instant {
        let mut m = m.clone();
        m.constraints.restraints.sort_by_key(|h| (h.node, h.dof));
        let system = System::new(&m).unwrap();
        let plan = Plan::new(&m, &system, 1);
        let scheme = match (&m.analysis.kind, &m.solution.scheme) {
            (AnalysisKind::Static, _) => load_steps::coefficients(),
            (_, scheme) => scheme.coefficients(m.analysis.nominal_step()),
        };
        let mut loading = Loading::default();
        Excitation::new(&m).loading(0.8, rdsolve::system::Side::After, &mut loading);
        let whole = turn(rng);
        let R = rdsolve::math::rotation::matrix(&whole);
        let mut start: Vec<Node> = m.nodes.iter().map(|n| Node::at_rest(R * n.x + vector(rng, 0.15))).collect();
        for node in &mut start {
            node.rotation = exp(&vector(rng, 0.25)) * whole;
            (node.v, node.omega) = (vector(rng, rate), vector(rng, rate));
            (node.a, node.alpha) = (vector(rng, rate), vector(rng, rate));
        }
        let mut still = vec![Increment::ZERO; start.len()];
        for (increment, node) in still.iter_mut().zip(&start) {
            (increment.d, increment.dd) = (stack(&node.v, &node.omega), stack(&node.a, &node.alpha));
        }
        for dependent in &system.rigid_links {
            let before = start[dependent.node];
            dependent.move_with_master(&mut start, &mut still, &before);
        }
        let q = start
            .iter()
            .map(|n| match way {
                Some(way) => stack(&vector(rng, way), &vector(rng, way)),
                None => scheme.predict(&stack(&n.v, &n.omega), &stack(&n.a, &n.alpha), &Vec6::zeros()),
            })
            .collect();
        let history = vec![0.0; system.history];
        Instant { system, plan, loading, scheme, start, q, history }
    }

    fn configuration<'a>(&'a self, nodes: &'a [Node]) -> Configuration<'a> {
        Configuration { history: &self.history, ..Configuration::of(nodes) }
    }

    fn nodes(&self, q: &[Vec6]) -> Vec<Node> {
        let mut nodes = self.start.clone();
        let mut increments = vec![Increment::ZERO; nodes.len()];
        for (i, start) in self.start.iter().enumerate() {
            increments[i].q = q[i];
            let (v, a) = (stack(&start.v, &start.omega), stack(&start.a, &start.alpha));
            self.scheme.differentiate(&mut increments[i], &v, &a, &a);
        }
        if self.scheme.turning.is_some() {
            for body in self.system.turning_bodies() {
                let start = &self.start[body.node];
                let from = body.start(start, &start.alpha, &self.scheme);
                body.differentiate(&from, &mut increments[body.node], &self.scheme);
            }
        }
        for (i, start) in self.start.iter().enumerate() {
            nodes[i].advance(start, &increments[i], RotationUpdate::Exponential);
        }
        for dependent in &self.system.rigid_links {
            dependent.move_with_master(&mut nodes, &mut increments, &self.start[dependent.node]);
        }
        nodes
    }

    fn residual(&self, q: &[Vec6]) -> Vec<f64> {
        let nodes = self.nodes(q);
        let mut forces = Forces::new(&self.system, nodes.len());
        self.system.residual(&self.configuration(&nodes), &self.loading, &mut forces);
        self.plan.dofs.nodal_dofs().iter().map(|&(node, dof)| forces.on_nodes[node][dof]).collect()
    }

    /// −∂r/∂q, a rotation being changed by a small spatial one as the solution of the system does it.
    fn differences(&self) -> DMatrix<f64> {
        let n = self.plan.dofs.unknowns();
        let mut K = DMatrix::zeros(n, n);
        let h = 1e-5;
        for (column, &(node, dof)) in self.plan.dofs.nodal_dofs().iter().enumerate() {
            let at = |h: f64| {
                let mut q = self.q.clone();
                let mut turn = Vec3::zeros();
                if dof < 3 {
                    q[node][dof] += h;
                } else {
                    turn[dof - 3] = h;
                }
                let change = inverse_tangent(&angular(&q[node]), &turn);
                for i in 0..3 {
                    q[node][3 + i] += change[i];
                }
                self.residual(&q)
            };
            for (row, (plus, minus)) in at(h).iter().zip(at(-h)).enumerate() {
                K[(row, column)] = -(plus - minus) / (2.0 * h);
            }
        }
        K
    }

    fn tangent(&mut self, kind: linear::Factorization) -> DMatrix<f64> {
        self.plan.kind = kind;
        let nodes = self.nodes(&self.q);
        let mut forces = Forces::new(&self.system, nodes.len());
        self.system.residual(&self.configuration(&nodes), &self.loading, &mut forces);
        let (mut solver, mut assembly) = self.plan.build(&self.system).unwrap();
        let (rate, acceleration) = self.scheme.weights();
        let weights = TangentWeights {
            stiffness: true,
            rate,
            acceleration,
            turning: self.scheme.turning,
            moduli: Moduli::Algorithmic,
        };
        assembly.tangent(&self.system, &self.configuration(&nodes), &self.loading, &mut forces, weights, &mut solver);
        let n = self.plan.dofs.unknowns();
        DMatrix::from_fn(n, n, |i, j| solver.slot(i, j).map_or(0.0, |slot| solver.values()[slot]))
    }

    /// One term of the bodies' gyroscopic matrices.
    fn gyroscopic(&self, term: GyroscopicTerm) -> DMatrix<f64> {
        let (nodes, (rate, acceleration)) = (self.nodes(&self.q), self.scheme.weights());
        let kappa = self.scheme.turning.unwrap_or(0.0);
        let n = self.plan.dofs.unknowns();
        let mut K = DMatrix::zeros(n, n);
        for inertia in &self.system.inertias {
            let (node, R) = (&nodes[inertia.node], nodes[inertia.node].R());
            let J = R * inertia.J0 * R.transpose();
            let k = term(&J, &skew(&node.omega), &skew(&(J * node.omega)), rate, kappa) * (acceleration / rate);
            let turns = |&(_, &(of, dof)): &(usize, &(usize, usize))| of == inertia.node && dof > 2;
            let rows: Vec<usize> =
                self.plan.dofs.nodal_dofs().iter().enumerate().filter(turns).map(|(row, _)| row).collect();
            assert_eq!(rows.len(), 3);
            for (i, &row) in rows.iter().enumerate() {
                rows.iter().enumerate().for_each(|(j, &column)| K[(row, column)] = k[(i, j)]);
            }
        }
        K
    }
}

/// Largest difference of an entry, relative to the largest entry of its row.
fn difference(A: &DMatrix<f64>, B: &DMatrix<f64>) -> f64 {
    (0..A.nrows()).map(|i| (A.row(i) - B.row(i)).amax() / B.row(i).amax()).fold(0.0, f64::max)
}

/// In statics nothing is left out. Differences of step h err by h² ≈ 1e-10 and by rounding, 1e-16/h ≈ 1e-11 of forces
/// that are up to 30 times the smallest row; the increments turn nodes by up to half a radian.
#[test]
fn of_a_static_scene_is_exact() {
    let mut rng = StdRng::seed_from_u64(1);
    for round in 0..6 {
        let mut scene = zoo(&mut rng, AnalysisKind::Static, 1.0);
        press(&mut scene);
        let mut at = Instant::random(&scene, &mut rng, 0.0, Some(0.3));
        let exact = at.differences();
        let K = at.tangent(linear::Factorization::BlockLu);
        let error = difference(&K, &exact);
        assert!(error < 1e-7, "round {round}: {error:e}");
        assert!(difference(&K.transpose(), &K) > 1e-3, "arms and followers make it unsymmetric");
        let half = (&exact + exact.transpose()) * 0.5;
        let error = difference(&at.tangent(linear::Factorization::Cholesky), &half);
        assert!(error < 1e-7, "round {round}, symmetric part: {error:e}");
    }
}

/// Pressure on faces between free nodes, dependent nodes and what holds them.
fn press(m: &mut Model) {
    let n = m.nodes.len();
    let faces = vec![Face::Quadrilateral([1, 4, 5, 3]), Face::Triangle([2, n - 3, 5]), Face::Triangle([4, 3, n - 1])];
    m.loading.pressures.push(Pressure { faces, pressure: 3.0, amplitude: None });
    spin(m);
}

/// A centrifugal load on all masses, about an axis beside them.
fn spin(m: &mut Model) {
    let of = TurningMasses {
        parts: (0..m.parts.len()).filter(|&part| m.parts[part].mass_kind().is_some()).collect(),
        bodies: (0..m.bodies.len()).collect(),
        masses: (0..m.masses.len()).collect(),
    };
    let axis = RotationAxis { direction: Vec3::new(0.6, -0.48, 0.64), through: Vec3::new(0.3, 0.2, -0.5) };
    m.loading.centrifugal.push(Centrifugal { of, axis, speed: 1.5, amplitude: None });
}

/// A dynamic scene caught at rest: mass and the weights of the scheme, still without anything left out.
#[test]
fn at_rest_holds_mass_and_damping_exactly() {
    let mut rng = StdRng::seed_from_u64(2);
    for round in 0..3 {
        let mut scene = zoo(&mut rng, AnalysisKind::Dynamic, 0.1);
        damp(&mut scene);
        let mut at = Instant::random(&scene, &mut rng, 0.0, Some(0.0));
        let exact = at.differences();
        let error = difference(&at.tangent(linear::Factorization::BlockLu), &exact);
        assert!(error < 1e-7, "round {round}: {error:e}"); // as above
    }
}

fn damp(m: &mut Model) {
    m.damping.mass_factor = 0.3;
    m.damping.stiffness_factor = 0.02;
    let nodal = [(2, 0.4, 0.2), (3, 0.0, 0.3)];
    m.damping.nodal = nodal.map(|(node, translation, rotation)| NodalDamping { node, translation, rotation }).into();
    for link in m.each_mut::<Link>() {
        match &mut link.kind {
            rdsolve::model::LinkKind::Bearing { .. } | rdsolve::model::LinkKind::Isolator { .. } => {}
            rdsolve::model::LinkKind::Line { damper, .. } | rdsolve::model::LinkKind::Hysteretic { damper, .. } => {
                *damper = Damper { coefficient: 0.7, exponent: 0.6, slow: 0.2 }
            }
            rdsolve::model::LinkKind::Bushing { damping, .. } => *damping = [0.5, 0.3, 0.4, 0.2, 0.3, 0.1],
            rdsolve::model::LinkKind::Joint { law, .. } => law.damping = 0.6,
        }
    }
}

/// Errors of the tangent of a moving scene for three steps that begin in the same motion, each half the one before.
fn errors(scene: &Model, seed: u64, step: f64) -> Vec<f64> {
    let steps = [step, step / 2.0, step / 4.0];
    let error = |&dt: &f64| {
        let mut scene = scene.clone();
        scene.analysis.step_length = StepLength::Fixed { step: dt };
        let mut at = Instant::random(&scene, &mut StdRng::seed_from_u64(seed), 1.0, None);
        let exact = at.differences();
        difference(&at.tangent(linear::Factorization::BlockLu), &exact)
    };
    steps.iter().map(error).collect()
}

/// In motion the rates of a rotation vector are taken as those at a small rotation, so what is left out against the whole
/// matrix, which grows as 6/τ² M, is of second order in the step where no mass rides.
#[test]
fn in_motion_errs_by_second_order_of_the_step() {
    let mut rng = StdRng::seed_from_u64(3);
    let mut scene = zoo(&mut rng, AnalysisKind::Dynamic, 0.1);
    // Nothing massive on a dependent node: the beams between dependent nodes without mass.
    for beam in scene.each_mut::<Beam>() {
        beam.mass = MassKind::None;
    }
    scene.parts.retain(|part| part.kind() != PartKind::Bar);
    let dependents: Vec<usize> = scene.constraints.dependents.iter().map(|r| r.node).collect();
    for n in 0..scene.nodes.len() {
        if !dependents.contains(&n) {
            mass(&mut scene, n, 1.0, inertia(&mut rng, 0.5));
        }
    }
    let e = errors(&scene, 4, 0.08);
    eprintln!("errors {e:?}");
    assert!(e[2] < 1e-3, "{e:?}");
    assert!(order(e[0], e[1]) > 1.8 && order(e[1], e[2]) > 1.9, "{e:?}");
}

/// A term of the derivative of a body's angular momentum for a small turn, from J, ω~, π~, `rate` and κ, less the factor e.
type GyroscopicTerm = fn(&Mat3, &Mat3, &Mat3, f64, f64) -> Mat3;

/// The terms of first order in the step, with how they enter the matrix.
const GYROSCOPIC_TERMS: [(&str, GyroscopicTerm); 4] = [
    ("half J omega", |J, omega, _, _, _| 0.5 * J * omega),
    ("pi", |_, _, L, _, _| -L),
    ("kappa pi", |_, _, L, rate, kappa| kappa * rate * L),
    ("kappa omega J", |J, omega, _, rate, kappa| -kappa * rate * omega * J),
];

type OfStep = Box<dyn Fn(f64) -> Coefficients>;

/// The schemes in which bodies turn by their angular momentum, for a step.
fn turning_schemes() -> [(&'static str, OfStep); 5] {
    let rotation = RotationUpdate::Exponential;
    let family = move |alpha_m, alpha_f, gamma, beta| AlphaFamily { alpha_m, alpha_f, gamma, beta, rotation };
    [
        ("wilson-theta", Box::new(move |dt| WilsonTheta { theta: 1.4, rotation }.coefficients(dt))),
        ("newmark", Box::new(move |dt| family(0.0, 0.0, 0.5, 0.25).coefficients(dt))),
        ("hht-alpha", Box::new(move |dt| family(0.0, 0.3, 0.8, 0.4225).coefficients(dt))),
        (
            "generalized-alpha",
            Box::new(move |dt| family(1.0 / 3.0, 4.0 / 9.0, 11.0 / 18.0, 25.0 / 81.0).coefficients(dt)),
        ),
        ("bathe", Box::new(move |dt| Bathe { split: 0.6, rotation }.second(dt))),
    ]
}

/// The angular momentum of bodies changes with their rotation, their velocity and what free rotation accelerates: in every scheme the
/// matrix errs by second order of the step, 1e-7 of itself in short ones, and by first order without any of its terms.
#[test]
fn of_turning_bodies_lacks_no_gyroscopic_term() {
    let mut rng = StdRng::seed_from_u64(7);
    let mut scene = empty(AnalysisKind::Dynamic, 1.0, 0.1);
    for _ in 0..4 {
        let node = body(&mut scene, vector(&mut rng, 1.0), 1.0, inertia(&mut rng, 0.5));
        // What nothing excites is no unknown.
        (scene.nodes[node].v, scene.nodes[node].omega) = (vector(&mut rng, 1.0), vector(&mut rng, 1.0));
    }
    assert_eq!(System::new(&scene).unwrap().turning_bodies().len(), 4);
    for (name, scheme) in turning_schemes() {
        let mut whole = Vec::new();
        let mut without = GYROSCOPIC_TERMS.map(|_| Vec::new());
        for dt in [8e-3, 4e-3, 5e-4] {
            scene.analysis.step_length = StepLength::Fixed { step: dt };
            let mut at = Instant::random(&scene, &mut StdRng::seed_from_u64(8), 1.0, None);
            at.scheme = scheme(dt);
            let exact = at.differences();
            let K = at.tangent(linear::Factorization::BlockLu);
            whole.push(difference(&K, &exact));
            for (errors, (_, term)) in without.iter_mut().zip(GYROSCOPIC_TERMS) {
                errors.push(difference(&(&K - at.gyroscopic(term)), &exact));
            }
        }
        println!("{name}: {whole:?}, without a term {without:?}");
        assert!(order(whole[0], whole[1]) > 1.9, "{name}: {whole:?}");
        // (ω Δt)² with a part of 1/12 and the like, at up to 1.7 rad a unit of time.
        assert!(whole[2] < 1e-7, "{name}: {whole:?}");
        let kappa = scheme(1.0).turning.unwrap();
        for (errors, (term, _)) in without.iter().zip(GYROSCOPIC_TERMS) {
            let enters = kappa != 0.0 || !term.starts_with("kappa");
            assert!(!enters || errors[2] > 5e-5, "{name} without {term}: {errors:?}");
        }
    }
}

/// About a thin axis the matrix has the terms of angular velocities in axes of the body, besides those of the momentum as far as it counts.
#[test]
fn of_thin_bodies_errs_by_second_order_of_the_step() {
    let mut rng = StdRng::seed_from_u64(9);
    let mut scene = empty(AnalysisKind::Dynamic, 1.0, 0.1);
    for ratio in [1e-4, 1e-2, 0.03, 0.08] {
        let R = rotation::matrix(&turn(&mut rng));
        let J = R * Mat3::from_diagonal(&Vec3::new(1.0, 1.0 - 0.5 * ratio, ratio)) * R.transpose();
        let node = body(&mut scene, vector(&mut rng, 1.0), 1.0, J);
        (scene.nodes[node].v, scene.nodes[node].omega) = (vector(&mut rng, 1.0), vector(&mut rng, 1.0));
    }
    assert_eq!(System::new(&scene).unwrap().turning_bodies().len(), 4);
    for (name, scheme) in turning_schemes() {
        let errors = [8e-3, 4e-3, 5e-4].map(|dt| {
            scene.analysis.step_length = StepLength::Fixed { step: dt };
            let mut at = Instant::random(&scene, &mut StdRng::seed_from_u64(8), 1.0, None);
            at.scheme = scheme(dt);
            difference(&at.tangent(linear::Factorization::BlockLu), &at.differences())
        });
        println!("{name}: {errors:?}");
        assert!(order(errors[0], errors[1]) > 1.8, "{name}: {errors:?}");
        assert!(errors[2] < 1e-6, "{name}: {errors:?}");
    }
}

/// Masses of dependent nodes leave out the rates of g = ω×(ω×S), and dampers on dependent nodes those of the arm: first order.
#[test]
fn in_motion_with_massive_riders_errs_by_first_order_of_the_step() {
    let mut rng = StdRng::seed_from_u64(5);
    let mut scene = zoo(&mut rng, AnalysisKind::Dynamic, 0.1);
    damp(&mut scene);
    let e = errors(&scene, 6, 0.004);
    eprintln!("errors {e:?}");
    assert!(e[2] < 0.1, "{e:?}");
    assert!(order(e[0], e[1]) > 0.8 && order(e[1], e[2]) > 0.9, "{e:?}");
}
