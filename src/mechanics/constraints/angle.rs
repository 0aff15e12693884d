//! Relative angle of two nodes about a shared axis, with its derivatives.
//!
//! The axes p and s of the first node are normal to the shared axis e = p × s. With u = R_b p, x = u·R_a p and y = u·R_a s the angle is θ =
//! atan2(y, x). If the nodes share the axis, x² + y² = 1. The formula is smooth elsewhere too, so iterates may leave the axis. The angle is
//! known up to full turns: who needs them counts.

use crate::state::Node;
use base::math::{Mat3, Vec3, Vec6, skew, stack};

/// The angle about an axis, by two unit vectors across it that are fixed to either node at t = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Angle {
    /// Unit vector across the axis, global at t = 0.
    pub p: Vec3,
    /// Unit vector across both, so that p, s and the axis make a right-handed frame.
    pub s: Vec3,
    /// The unit vector of the second node whose angle from p to s it is: p itself, unless the angle counts from another place of the nodes.
    pub turned: Vec3,
}

/// The terms x and y that the angle is formed from, and its derivatives by them.
struct Terms {
    x: f64,
    y: f64,
    /// (R_a p) × u and (R_a s) × u, the gradients of x and y by the spin of the first node.
    turns: [Vec3; 2],
    /// ∂θ/∂x, ∂θ/∂y.
    first: [f64; 2],
}

impl Angle {
    /// The angle about the first of three axes.
    pub fn about_first(axes: &Mat3) -> Angle {
        let p = axes.column(1).into_owned();
        Angle { p, s: axes.column(2).into_owned(), turned: p }
    }

    /// Returns the angle counted from the current rotations of both nodes, about the axis of the first.
    pub fn from_here(&self, a: &Node, b: &Node) -> Angle {
        Angle { turned: b.R().tr_mul(&(a.R() * self.p)), ..*self }
    }

    fn terms(&self, a: &Node, b: &Node) -> Terms {
        let (R, u) = (a.R(), b.R() * self.turned);
        let (p, s) = (R * self.p, R * self.s);
        let (x, y) = (p.dot(&u), s.dot(&u));
        let square = x * x + y * y;
        Terms { x, y, turns: [p.cross(&u), s.cross(&u)], first: [-y / square, x / square] }
    }

    /// The components of the vector of the second node along p, s and across both.
    pub fn across(&self, a: &Node, b: &Node) -> [f64; 3] {
        let u = a.R().tr_mul(&(b.R() * self.turned));
        [self.p.dot(&u), self.s.dot(&u), self.p.cross(&self.s).dot(&u)]
    }

    /// The angle of the second node from the first, from −π to π, with its first two derivatives in time.
    pub fn value(&self, a: &Node, b: &Node) -> [f64; 3] {
        let [u, du, ddu] = body_vector(b, &self.turned);
        let term = |fixed: &Vec3| {
            let [p, dp, ddp] = body_vector(a, fixed);
            [p.dot(&u), dp.dot(&u) + p.dot(&du), ddp.dot(&u) + 2.0 * dp.dot(&du) + p.dot(&ddu)]
        };
        let ([x, dx, ddx], [y, dy, ddy]) = (term(&self.p), term(&self.s));
        let square = x * x + y * y;
        let rate = (x * dy - y * dx) / square;
        [y.atan2(x), rate, (x * ddy - y * ddx - 2.0 * rate * (x * dx + y * dy)) / square]
    }

    /// The gradient by positions and rotations of the two nodes.
    pub fn gradient(&self, a: &Node, b: &Node) -> [Vec6; 2] {
        let Terms { turns, first, .. } = self.terms(a, b);
        let turn = first[0] * turns[0] + first[1] * turns[1];
        [stack(&Vec3::zeros(), &turn), stack(&Vec3::zeros(), &-turn)]
    }

    /// Adds the second derivative times `lambda`, in the blocks of [`super::joint::ConstraintEquation::stiffness`].
    pub fn stiffness(&self, a: &Node, b: &Node, lambda: f64, add: &mut impl FnMut(usize, usize, Mat3)) {
        let Terms { x, y, turns: [tx, ty], first } = self.terms(a, b);
        let (R, u) = (a.R(), skew(&(b.R() * self.turned)));
        let (mut own, mut other) = (Mat3::zeros(), Mat3::zeros());
        for (fixed, derivative) in [self.p, self.s].iter().zip(first) {
            let p = skew(&(R * fixed)) * (lambda * derivative);
            own += u * p;
            other += p * u;
        }
        let fourth = (x * x + y * y).powi(2);
        let (xx, xy) = (2.0 * x * y / fourth, (y * y - x * x) / fourth);
        let mixed = tx * ty.transpose();
        let curved = lambda * (xx * (tx * tx.transpose() - ty * ty.transpose()) + xy * (mixed + mixed.transpose()));
        add(1, 1, own + curved);
        add(1, 3, -other - curved);
        add(3, 1, -own - curved);
        add(3, 3, other + curved);
    }
}

/// An axis fixed to a node with its first two derivatives in time, global components.
pub(super) fn body_vector(node: &Node, e: &Vec3) -> [Vec3; 3] {
    let e = node.R() * e;
    let de = node.omega.cross(&e);
    [e, de, node.alpha.cross(&e) + node.omega.cross(&de)]
}
