//! One of three rotations of a node against its support, beside a free rotation. It is a component of the rotation vector, or an angle of a
//! sequence R = R_i R_j R_k of rotations about global axes. With e the axes and ± the sign of i, j, k the angles are
//!   atan2(∓ e_j·R e_k, e_k·R e_k),  asin(± e_i·R e_k),  atan2(∓ e_i·R e_j, e_i·R e_i).

use super::angle::{Angle, body_vector};
use crate::state::Node;
use base::math::turn::RotationAngles;
use base::math::{Mat3, Vec3, Vec6, rotation, stack};
use nalgebra::Quaternion;
use std::f64::consts::TAU;

/// One of the rotations of a node against a support that is at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GivenAngle {
    /// The global axis that the rotation is named after, 0 to 2.
    pub axis: usize,
    measure: Measure,
}

/// How the angle is measured. Vectors on the node are global where it has not turned.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Measure {
    /// The component of the rotation vector, since this rotation.
    Component { from: Quaternion<f64> },
    /// The first angle of a sequence: of a vector of the node against two of the support.
    First(Angle),
    /// The second one: the angle between a vector of the node and the plane across one of the support.
    Second { p: Vec3, s: Vec3 },
    /// The last one: of a vector of the support against two of the node.
    Last(Angle),
}

impl GivenAngle {
    /// The rotation about a global axis, for a node that has not turned.
    pub fn new(axis: usize, angles: RotationAngles) -> GivenAngle {
        let measure = match angles {
            RotationAngles::Vector => Measure::Component { from: Quaternion::identity() },
            RotationAngles::Sequence(axes) => {
                let [i, j, k] = axes.map(|axis| Vec3::ith(axis, 1.0));
                let sign = i.cross(&j).dot(&k);
                match axes.iter().position(|of| *of == axis) {
                    Some(0) => Measure::First(Angle { p: k, s: -sign * j, turned: k }),
                    Some(1) => Measure::Second { p: k, s: sign * i },
                    _ => Measure::Last(Angle { p: i, s: -sign * j, turned: i }),
                }
            }
        };
        GivenAngle { axis, measure }
    }

    /// The angle measured from the current rotation of the node.
    pub fn from_here(&self, a: &Node) -> GivenAngle {
        let R = a.R();
        let back = |v: &Vec3| R.tr_mul(v);
        let measure = match self.measure {
            Measure::Component { .. } => Measure::Component { from: a.rotation },
            Measure::First(angle) => Measure::First(Angle { turned: back(&angle.turned), ..angle }),
            Measure::Second { p, s } => Measure::Second { p: back(&p), s },
            Measure::Last(angle) => Measure::Last(Angle { p: back(&angle.p), s: back(&angle.s), ..angle }),
        };
        GivenAngle { measure, ..*self }
    }

    /// The angle nearest to zero where it is known up to full turns only.
    pub fn nearest(&self, angle: f64) -> f64 {
        match self.measure {
            Measure::First(_) | Measure::Last(_) => angle - TAU * (angle / TAU).round(),
            _ => angle,
        }
    }

    /// True if the angle is ambiguous after a step: the rotation vector near half a turn, the second angle of a sequence near a right
    /// angle, or either past it.
    pub fn is_lost(&self, [before, after]: [&Node; 2], b: &Node) -> bool {
        const HALF_TURN: f64 = 3.0; // radians, of π
        const RIGHT_ANGLE: f64 = 0.05; // the cosine of 1.52 of π/2 radians
        match &self.measure {
            Measure::Component { from } => {
                let [one, other] = [before, after].map(|node| node.rotation * from.conjugate());
                rotation::log(&other).norm() > HALF_TURN || one.coords.dot(&other.coords) * one.w * other.w < 0.0
            }
            Measure::Second { p, s } => (after.R() * p).cross(&(b.R() * s)).norm() < RIGHT_ANGLE,
            Measure::First(angle) | Measure::Last(angle) => {
                let across = |node: &Node| match self.measure {
                    Measure::First(_) => angle.across(b, node),
                    _ => angle.across(node, b),
                };
                let ([x, y, z], [u, v, w]) = (across(before), across(after));
                u.hypot(v) < RIGHT_ANGLE || (x * u + y * v < 0.0 && z * w > 0.5)
            }
        }
    }

    /// The angle with its first two derivatives in time.
    pub fn value(&self, a: &Node, b: &Node) -> [f64; 3] {
        match &self.measure {
            Measure::Component { from } => {
                let phi = vector(a, from);
                let (d, dd) = rotation::vector_rates(&phi, &a.omega, &a.alpha);
                [phi, d, dd].map(|of| of[self.axis])
            }
            Measure::First(angle) => angle.value(b, a),
            Measure::Second { p, s } => {
                let ([p, dp, ddp], s) = (body_vector(a, p), b.R() * s);
                let [x, dx, ddx] = [p, dp, ddp].map(|of| of.dot(&s));
                let [angle, first, second] = arcsine(x);
                [angle, first * dx, first * ddx + second * dx * dx]
            }
            Measure::Last(angle) => angle.value(a, b),
        }
    }

    /// The gradient by positions and rotations of the two nodes.
    pub fn gradient(&self, a: &Node, b: &Node) -> [Vec6; 2] {
        let turn = match &self.measure {
            Measure::Component { from } => {
                let T_inv = rotation::inverse_tangent_matrix(&vector(a, from));
                T_inv.row(self.axis).transpose()
            }
            Measure::First(angle) => {
                let [of_b, of_a] = angle.gradient(b, a);
                return [of_a, of_b];
            }
            Measure::Second { p, s } => {
                let (p, s) = (a.R() * p, b.R() * s);
                arcsine(p.dot(&s))[1] * p.cross(&s)
            }
            Measure::Last(angle) => return angle.gradient(a, b),
        };
        [stack(&Vec3::zeros(), &turn), stack(&Vec3::zeros(), &-turn)]
    }

    /// Adds the second derivative times `lambda` by the rotation of the node, in the blocks of
    /// [`super::joint::ConstraintEquation::stiffness`]: the support does not turn.
    pub fn stiffness(&self, a: &Node, b: &Node, lambda: f64, add: &mut impl FnMut(usize, usize, Mat3)) {
        let k = match &self.measure {
            Measure::Component { from } => {
                let phi = vector(a, from);
                let m = Vec3::ith(self.axis, lambda);
                rotation::inverse_tangent_transpose_derivative(&phi, &m) * rotation::inverse_tangent_matrix(&phi)
            }
            Measure::First(angle) => {
                let other = |of: usize| if of == 1 { 3 } else { 1 };
                return angle.stiffness(b, a, lambda, &mut |row, column, k| add(other(row), other(column), k));
            }
            Measure::Second { p, s } => {
                let (p, s) = (a.R() * p, b.R() * s);
                let ([_, first, second], turn) = (arcsine(p.dot(&s)), p.cross(&s));
                // The change of p × s with a spin of p.
                let own = p * s.transpose() - Mat3::identity() * p.dot(&s);
                lambda * (first * own + second * turn * turn.transpose())
            }
            Measure::Last(angle) => return angle.stiffness(a, b, lambda, add),
        };
        add(1, 1, k);
        add(3, 1, -k);
    }
}

/// The rotation vector of a node since a rotation.
fn vector(a: &Node, from: &Quaternion<f64>) -> Vec3 {
    rotation::log(&(a.rotation * from.conjugate()))
}

/// The angle of a sine and its first two derivatives, which stay finite at a right angle.
fn arcsine(x: f64) -> [f64; 3] {
    const LEAST: f64 = 1e-12;
    let square = (1.0 - x * x).max(LEAST);
    let first = square.sqrt().recip();
    [x.clamp(-1.0, 1.0).asin(), first, x * first / square]
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::{angular, linear};

    /// A node that turns by a spin from a rotation.
    fn turned(spin: &Vec3) -> Node {
        let start = rotation::exp(&Vec3::new(0.4, -0.7, 0.9));
        Node { rotation: rotation::exp(spin) * start, ..Node::at_rest(Vec3::zeros()) }
    }

    #[test]
    fn gradient_stiffness_and_rates_are_derivatives() {
        let h = 1e-4;
        let sequences =
            [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]].map(RotationAngles::Sequence);
        let support = Node::at_rest(Vec3::zeros());
        for angles in sequences.into_iter().chain([RotationAngles::Vector]) {
            for axis in 0..3 {
                let row = GivenAngle::new(axis, angles);
                let at = |spin: &Vec3| row.value(&turned(spin), &support)[0];
                let gradient = |spin: &Vec3| angular(&row.gradient(&turned(spin), &support)[0]);
                let here = gradient(&Vec3::zeros());
                let mut k = Mat3::zeros();
                row.stiffness(&turned(&Vec3::zeros()), &support, 1.0, &mut |i, j, block| {
                    if (i, j) == (1, 1) {
                        k += block;
                    }
                });
                for i in 0..3 {
                    let [back, ahead] = [-h, h].map(|h| Vec3::ith(i, h));
                    // Central differences: h² is 1e-8.
                    assert!((here[i] - (at(&ahead) - at(&back)) / (2.0 * h)).abs() < 1e-7, "{angles:?} {axis}");
                    let change = (gradient(&ahead) - gradient(&back)) / (2.0 * h);
                    assert!((k.column(i) - change).amax() < 1e-6, "{angles:?} {axis}: {k} {change}");
                }
                assert_eq!(linear(&row.gradient(&turned(&Vec3::zeros()), &support)[0]), Vec3::zeros());
                let omega = Vec3::new(0.3, 0.8, -0.5);
                let spinning = Node { omega, ..turned(&Vec3::zeros()) };
                let [_, rate, second] = row.value(&spinning, &support);
                let along = |t: f64| row.value(&Node { omega, ..turned(&(t * omega)) }, &support)[1];
                assert!((rate - here.dot(&omega)).abs() < 1e-12, "{angles:?} {axis}"); // rounding
                assert!((second - (along(h) - along(-h)) / (2.0 * h)).abs() < 1e-7, "{angles:?} {axis}");
                let again = row.from_here(&turned(&Vec3::zeros()));
                assert!(again.value(&turned(&Vec3::zeros()), &support)[0].abs() < 1e-15);
            }
        }
    }

    #[test]
    fn angles_are_those_of_the_turn() {
        let u = Vec3::new(0.3, -0.6, 0.8);
        for angles in [RotationAngles::Vector, RotationAngles::Sequence([2, 0, 1]), RotationAngles::Sequence([0, 1, 2])]
        {
            let node = Node { rotation: angles.rotation(&u), ..Node::at_rest(Vec3::zeros()) };
            for axis in 0..3 {
                let [value, ..] = GivenAngle::new(axis, angles).value(&node, &Node::at_rest(Vec3::zeros()));
                assert!((value - u[axis]).abs() < 1e-14, "{angles:?}"); // rounding
            }
        }
    }
}
