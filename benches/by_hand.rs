//! What generality costs: two bodies on three spring-dampers (decks/two_bodies_on_springs) by rdsolve, and by the program below,
//! which can do that scene and nothing else: Wilson-θ, a dense 12×12 matrix on the stack, an old matrix kept while it serves.
//! Least of repeats taken in turn, time loops alone, one thread, no output on either side.

use nalgebra::{LU, SMatrix, SVector, U12};
use rdsolve::diagnostic::Source;
use rdsolve::integrators::RotationUpdate;
use rdsolve::math::rotation::inverse_tangent;
use rdsolve::math::{Mat3, Vec3, Vec6, angular, skew, stack};
use rdsolve::model;
use rdsolve::plan::Plan;
use rdsolve::solve::{Outcome, Run, Wanted};
use rdsolve::state::{Increment, Node};
use rdsolve::system::System;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

const THETA: f64 = 1.4;
const STIFFNESS: f64 = 2e4;
const DAMPING: f64 = 50.0;
const MASS: [f64; 2] = [100.0, 10.0];
const INERTIA: [[f64; 3]; 2] = [[8.0, 12.0, 15.0], [0.2, 0.3, 0.4]];
/// Ends at t = 0 from the centres of mass.
const ENDS: [[[f64; 3]; 2]; 3] = [
    [[0.4, 0.2, 0.1], [-0.2, 0.1, 0.05]],
    [[0.4, -0.2, 0.1], [-0.2, -0.1, 0.05]],
    [[0.4, 0.0, -0.2], [-0.2, 0.0, -0.1]],
];

type Mat12 = SMatrix<f64, 12, 12>;
type Vec12 = SVector<f64, 12>;

struct ByHand {
    bodies: [Node; 2],
    jerk: [Vec6; 2],
    free: [f64; 3],
    factor: Option<LU<f64, U12, U12>>,
}

impl ByHand {
    fn new() -> Self {
        let mut bodies = [Node::at_rest(Vec3::zeros()), Node::at_rest(Vec3::x())];
        bodies[0].omega = Vec3::new(0.5, 0.0, 2.0);
        bodies[1].v = Vec3::new(1.0, 0.5, 0.0);
        bodies[1].omega = Vec3::new(0.0, 3.0, -1.0);
        let free = ENDS.map(|[a, b]| (Vec3::x() + Vec3::from(b) - Vec3::from(a)).norm());
        let mut scene = ByHand { bodies, jerk: [Vec6::zeros(); 2], free, factor: None };
        // M a = f
        let r = scene.residual(&scene.bodies);
        for (i, body) in scene.bodies.iter_mut().enumerate() {
            body.a = r.fixed_rows::<3>(6 * i) / MASS[i];
            body.alpha = r.fixed_rows::<3>(6 * i + 3).component_div(&Vec3::from(INERTIA[i]));
        }
        scene
    }

    fn residual(&self, bodies: &[Node; 2]) -> Vec12 {
        let mut r = Vec12::zeros();
        let R = [bodies[0].R(), bodies[1].R()];
        for (i, body) in bodies.iter().enumerate() {
            let J0 = Vec3::from(INERTIA[i]);
            let (omega, alpha) = (R[i].tr_mul(&body.omega), R[i].tr_mul(&body.alpha));
            let m = R[i] * (J0.component_mul(&alpha) + omega.cross(&J0.component_mul(&omega)));
            r.fixed_rows_mut::<3>(6 * i).copy_from(&(-MASS[i] * body.a));
            r.fixed_rows_mut::<3>(6 * i + 3).copy_from(&-m);
        }
        for (ends, free) in ENDS.iter().zip(self.free) {
            let S = [R[0] * Vec3::from(ends[0]), R[1] * Vec3::from(ends[1])];
            let d = bodies[1].x + S[1] - bodies[0].x - S[0];
            let rate = bodies[1].v + bodies[1].omega.cross(&S[1]) - bodies[0].v - bodies[0].omega.cross(&S[0]);
            let length = d.norm();
            let e = d / length;
            let f = (STIFFNESS * (length - free) + DAMPING * e.dot(&rate)) * e;
            for (i, f) in [f, -f].iter().enumerate() {
                let moment = S[i].cross(f);
                for k in 0..3 {
                    r[6 * i + k] += f[k];
                    r[6 * i + 3 + k] += moment[k];
                }
            }
        }
        r
    }

    fn tangent(&self, bodies: &[Node; 2], rate: f64, acceleration: f64) -> Mat12 {
        let mut K = Mat12::zeros();
        let R = [bodies[0].R(), bodies[1].R()];
        for i in 0..2 {
            let J = R[i] * Mat3::from_diagonal(&Vec3::from(INERTIA[i])) * R[i].transpose();
            for k in 0..3 {
                K[(6 * i + k, 6 * i + k)] = acceleration * MASS[i];
            }
            let gyroscopic = skew(&bodies[i].omega) * J - skew(&(J * bodies[i].omega));
            K.fixed_view_mut::<3, 3>(6 * i + 3, 6 * i + 3).copy_from(&(acceleration * J + rate * gyroscopic));
        }
        for (ends, free) in ENDS.iter().zip(self.free) {
            let S = [R[0] * Vec3::from(ends[0]), R[1] * Vec3::from(ends[1])];
            let d = bodies[1].x + S[1] - bodies[0].x - S[0];
            let length = d.norm();
            let e = d / length;
            let along = e * e.transpose();
            let k = (STIFFNESS + rate * DAMPING) * along
                + STIFFNESS * (length - free) / length * (Mat3::identity() - along);
            let mut P = SMatrix::<f64, 3, 12>::zeros();
            P.fixed_view_mut::<3, 3>(0, 0).copy_from(&-Mat3::identity());
            P.fixed_view_mut::<3, 3>(0, 3).copy_from(&skew(&S[0]));
            P.fixed_view_mut::<3, 3>(0, 6).copy_from(&Mat3::identity());
            P.fixed_view_mut::<3, 3>(0, 9).copy_from(&-skew(&S[1]));
            K += P.transpose() * k * P;
        }
        K
    }

    /// Returns the iterations.
    fn step(&mut self, dt: f64) -> usize {
        let tau = THETA * dt;
        let (rate, acceleration) = (3.0 / tau, 6.0 / (tau * tau));
        let start = self.bodies;
        let v = start.map(|body| stack(&body.v, &body.omega));
        let a = start.map(|body| stack(&body.a, &body.alpha));
        let mut q: [Vec6; 2] =
            [0, 1].map(|i| tau * v[i] + 0.5 * tau * tau * a[i] + tau * tau * tau / 6.0 * self.jerk[i]);
        let (mut trial, mut iterations, mut last) = (start, 0, f64::INFINITY);
        let at = |q: &Vec6, i: usize| Increment {
            q: *q,
            d: rate * q - 2.0 * v[i] - 0.5 * tau * a[i],
            dd: acceleration * q - 6.0 / tau * v[i] - 2.0 * a[i],
        };
        loop {
            for i in 0..2 {
                trial[i].advance(&start[i], &at(&q[i], i), RotationUpdate::Exponential);
            }
            let r = self.residual(&trial);
            if self.factor.is_none() {
                self.factor = Some(self.tangent(&trial, rate, acceleration).lu());
            }
            let dq = self.factor.as_ref().and_then(|factor| factor.solve(&r)).expect("masses everywhere");
            let (mut correction, mut motion) = (0.0f64, 1e-6f64);
            for i in 0..2 {
                let turn = inverse_tangent(&angular(&q[i]), &dq.fixed_rows::<3>(6 * i + 3).into());
                let change = stack(&dq.fixed_rows::<3>(6 * i).into(), &turn);
                q[i] += change;
                correction = correction.max(change.amax());
                motion = motion.max(q[i].amax());
            }
            iterations += 1;
            let size = correction / motion;
            // What is left after this correction, by the contraction of the last two.
            let contraction = size / last;
            if iterations > 1 && size * contraction / (1.0 - contraction) < 1e-8 && contraction < 1.0 {
                break;
            }
            if contraction > 0.3 && contraction.is_finite() && iterations > 1 {
                self.factor = None;
            }
            assert!(iterations < 50);
            last = size;
        }
        for i in 0..2 {
            let a1 = a[i] + (at(&q[i], i).dd - a[i]) / THETA;
            let end = Increment {
                q: dt * v[i] + dt * dt / 6.0 * (2.0 * a[i] + a1),
                d: v[i] + 0.5 * dt * (a[i] + a1),
                dd: a1,
            };
            self.bodies[i].advance(&start[i], &end, RotationUpdate::Exponential);
            self.jerk[i] = (stack(&self.bodies[i].a, &self.bodies[i].alpha) - a[i]) / dt;
        }
        iterations
    }
}

fn main() {
    let deck = include_str!("../decks/two_bodies_on_springs/deck.toml");
    println!(
        "{:>10} {:>22} {:>22} {:>7} {:>10}",
        "dt", "rdsolve us/step (it)", "by hand us/step (it)", "ratio", "apart"
    );
    for division in [8, 32, 128] {
        let dt = 0.025 / f64::from(division);
        let sets =
            ["expect=[]".to_owned(), "output={every=1000000000}".to_owned(), format!("analysis.time_step={dt:?}")];
        let model = model::read(&Source::new("deck.toml", deck, &sets)).0.expect("a sound deck");
        let system = System::new(&model).expect("a system");
        let plan = Plan::new(&model, &system, 1);
        let stop = AtomicBool::new(false);
        let steps = 200 * division;
        let (mut program, mut hand, mut its, mut ends) = (f64::INFINITY, f64::INFINITY, [0, 0], [Vec3::zeros(); 2]);
        for _ in 0..30 {
            let mut run = Run::new(&model, &system, &plan, Wanted::default(), &stop).expect("memory");
            let began = Instant::now();
            let (outcome, state) = run.run(&mut ());
            program = program.min(began.elapsed().as_secs_f64());
            assert!(matches!(outcome, Outcome::Done));
            (its[0], ends[0]) = (run.counts().iterations, state.expect("an end").nodes[1].x);

            let mut scene = ByHand::new();
            let began = Instant::now();
            its[1] = (0..steps).map(|_| scene.step(dt)).sum();
            hand = hand.min(began.elapsed().as_secs_f64());
            ends[1] = scene.bodies[1].x;
        }
        let per = |seconds: f64| 1e6 * seconds / f64::from(steps);
        let row = |seconds: f64, its: usize| format!("{:.2} ({:.2})", per(seconds), its as f64 / f64::from(steps));
        let apart = (ends[0] - ends[1]).amax();
        println!(
            "{dt:>10} {:>22} {:>22} {:>7.2} {apart:>10.1e}",
            row(program, its[0]),
            row(hand, its[1]),
            program / hand
        );
    }
}
