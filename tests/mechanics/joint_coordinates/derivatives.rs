//! Angles, screws and what acts along coordinates against differences, at random states.

use crate::support::blocks::{forces, nudge};
use rdsolve::constraints::angle::Angle;
use rdsolve::constraints::joint::ConstraintEquation;
use rdsolve::elements::contact::restitution::{Loss, number};
use rdsolve::elements::coordinate_law::{CoordinateLaw, JointFriction, MEMORY, Stops};
use rdsolve::elements::hysteresis::Hysteresis;
use rdsolve::elements::path_law::PathLaw;
use rdsolve::elements::{Mechanics, Moduli};
use rdsolve::math::{Mat3, Vec3, Vec6, rotation};
use rdsolve::state::{Configuration, Node};
use rdsolve::system::parts::coordinate_springs::{CoordinateSpring, CoordinateSprings};

/// Numbers from −1 to 1 that are the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::from_fn(|_, _| self.next())
    }

    /// Two nodes anywhere, whose axes differ by up to half a radian beside any turn about the axis.
    fn pair(&mut self, axis: &Vec3) -> [Node; 2] {
        let first = rotation::exp(&(3.0 * self.vector()));
        let turn = rotation::exp(&(2.5 * self.next() * axis));
        let tilt = rotation::exp(&(0.3 * self.vector()));
        [first, first * tilt * turn].map(|rotation| Node {
            rotation,
            v: self.vector(),
            omega: self.vector(),
            a: self.vector(),
            alpha: self.vector(),
            ..Node::at_rest(self.vector())
        })
    }
}

fn axes() -> Mat3 {
    Mat3::from_columns(&[Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.8, 0.6, 0.0), Vec3::z()])
}

fn equations() -> Vec<ConstraintEquation> {
    let (angle, e) = (Angle::about_first(&axes()), axes().column(0).into_owned());
    vec![
        ConstraintEquation::Angle(angle),
        // A long lead: no state lies near where the count of turns changes.
        ConstraintEquation::Screw { angle, e, at: 0.1, lead: 50.0 },
        ConstraintEquation::Screw { angle, e, at: 0.1, lead: -60.0 },
        ConstraintEquation::distance_along(&e, &Vec3::new(0.3, 0.1, 0.0)),
    ]
}

fn moved(node: &Node, by: &Vec6) -> Node {
    let (u, theta) = (by.fixed_rows::<3>(0).into_owned(), by.fixed_rows::<3>(3).into_owned());
    Node { x: node.x + u, rotation: rotation::exp(&theta) * node.rotation, ..*node }
}

#[test]
fn equations_against_differences() {
    let mut random = Random(11);
    // Central differences with h = 1e-5 of numbers up to some ten: truncation and rounding stay below 1e-8.
    let (h, tolerance) = (1e-5, 2e-8);
    for row in equations() {
        for _ in 0..20 {
            let nodes = random.pair(&axes().column(0).into_owned());
            let lambda = random.next();
            let G = row.gradient(&nodes[0], &nodes[1]);
            let mut K = [[0.0; 12]; 12];
            row.stiffness(&nodes[0], &nodes[1], lambda, |i, j, block| {
                for r in 0..3 {
                    for c in 0..3 {
                        K[3 * i + r][3 * j + c] += block[(r, c)];
                    }
                }
            });
            for j in 0..12 {
                let at = |sign: f64| {
                    let mut by = Vec6::zeros();
                    by[j % 6] = sign * h;
                    let mut now = nodes;
                    now[j / 6] = moved(&nodes[j / 6], &by);
                    now
                };
                let [[a1, b1], [a0, b0]] = [at(1.0), at(-1.0)];
                let slope = (row.gap(&a1, &b1)[0] - row.gap(&a0, &b0)[0]) / (2.0 * h);
                assert!((slope - G[j / 6][j % 6]).abs() < tolerance, "{row:?}: gradient {j}");
                let [G1, G0] = [row.gradient(&a1, &b1), row.gradient(&a0, &b0)];
                for (i, K) in K.iter().enumerate() {
                    let exact = lambda * (G1[i / 6][i % 6] - G0[i / 6][i % 6]) / (2.0 * h);
                    assert!((K[j] - exact).abs() < tolerance, "{row:?}: stiffness {i}, {j}: {} {exact}", K[j]);
                }
            }
        }
    }
}

#[test]
fn rates_against_differences() {
    let mut random = Random(13);
    // Second differences with h = 1e-4: h² of fourth derivatives near 1e3 and rounding 1e-15/h² = 1e-7.
    let h = 1e-4;
    for row in equations() {
        for _ in 0..20 {
            let nodes = random.pair(&axes().column(0).into_owned());
            let at = |t: f64| {
                let [a, b] = nodes.map(|n| {
                    let theta = n.omega * t + n.alpha * (0.5 * t * t);
                    let x = n.x + n.v * t + n.a * (0.5 * t * t);
                    Node { x, rotation: rotation::exp(&theta) * n.rotation, ..n }
                });
                row.gap(&a, &b)[0]
            };
            let [_, rate, second] = row.gap(&nodes[0], &nodes[1]);
            let (before, now, after) = (at(-h), at(0.0), at(h));
            assert!(((after - before) / (2.0 * h) - rate).abs() < 2e-5, "{row:?}");
            assert!(((after - 2.0 * now + before) / (h * h) - second).abs() < 2e-4, "{row:?}");
        }
    }
}

fn laws() -> Vec<CoordinateLaw> {
    let spring = CoordinateLaw { stiffness: 1.3, rest: 0.4, damping: 0.7, ..CoordinateLaw::FREE };
    let loss = Loss::Restitution { number: number(0.6), floor: 0.0 };
    vec![
        spring,
        CoordinateLaw { stops: Some(Stops { limits: [-0.2, 0.3], stiffness: 2.0, loss }), ..spring },
        CoordinateLaw {
            friction: Some(JointFriction { limit: 0.8, per_load: 0.0, stick: 0.8 / 1.1 }),
            ..CoordinateLaw::FREE
        },
        CoordinateLaw {
            hysteresis: Some(PathLaw::Backbone(Hysteresis::new(&[[0.1, 0.2], [0.4, 0.3]], 0.1).expect("a backbone"))),
            ..spring
        },
    ]
}

/// The tangent, for displacements and for velocities, and action and reaction: no net force, no net moment about the origin.
#[test]
fn what_acts_along_a_coordinate_against_differences() {
    let mut random = Random(17);
    let (h, tolerance) = (1e-5, 5e-8);
    for law in laws() {
        for lock in equations().into_iter().filter(|row| !matches!(row, ConstraintEquation::Screw { .. })) {
            let block = CoordinateSprings::new(vec![CoordinateSpring { nodes: [0, 1], lock, law, drive: None }]);
            for _ in 0..20 {
                let nodes = random.pair(&axes().column(0).into_owned());
                let q = lock.gap(&nodes[0], &nodes[1])[0];
                // The state before: near the present one, with a landing on its way.
                let history: [f64; MEMORY] = [q + 0.1 * random.next(), random.next(), 1.5, 0.0, q + random.next()];
                let mut anchors = || q + 0.3 * random.next();
                let history = [&history[..], &[anchors(), anchors()]].concat()[..law.memory()].to_vec();
                let now = |nodes: &[Node]| {
                    forces(&block, &Configuration { nodes, history: &history, dt: 0.0, previous: None })
                };
                let f = now(&nodes);
                let (mut sum, mut moment) = (Vec3::zeros(), Vec3::zeros());
                for (node, f) in nodes.iter().zip(&f) {
                    let force = Vec3::new(f[0], f[1], f[2]);
                    sum += force;
                    moment += Vec3::new(f[3], f[4], f[5]) + node.x.cross(&force);
                }
                assert!(sum.amax() < 1e-14 && moment.amax() < 1e-14, "{law:?}: {sum} {moment}");
                let configuration = Configuration { nodes: &nodes, history: &history, dt: 0.0, previous: None };
                let [mut K, mut with_rates] = [[0.0; 144]; 2];
                block.tangent(0, &configuration, 0.0, Moduli::Algorithmic, &mut K);
                block.tangent(0, &configuration, 1.0, Moduli::Algorithmic, &mut with_rates);
                for j in 0..12 {
                    let at = |sign: f64, rates: bool| {
                        let mut there = nodes;
                        let node = &mut there[j / 6];
                        match (rates, j % 6) {
                            (false, dof) => nudge(node, dof, sign * h),
                            (true, dof @ 0..3) => node.v[dof] += sign * h,
                            (true, dof) => node.omega[dof - 3] += sign * h,
                        }
                        now(&there)
                    };
                    for rates in [false, true] {
                        let (after, before) = (at(1.0, rates), at(-1.0, rates));
                        for i in 0..12 {
                            let slope = (after[i / 6][i % 6] - before[i / 6][i % 6]) / (2.0 * h);
                            let exact = if rates { with_rates[12 * i + j] - K[12 * i + j] } else { K[12 * i + j] };
                            assert!(
                                (slope - exact).abs() < tolerance,
                                "{law:?} {lock:?} {rates} {i} {j}: {slope} {exact}"
                            );
                        }
                    }
                }
            }
        }
    }
}
