//! Two nodes joined by Lagrange multipliers (57). It replaces elimination for nodes that already depend on another node, are restrained, or
//! close a loop.
//!
//! A joint is a list of constraint equations c(x, R) = 0 between the positions and rotations of its nodes. A multiplier λ exerts the forces
//! Gᵀλ, G = ∂c/∂(x, θ), which do no work while the gap is closed. Its stiffness is K = λ ∂²c, for spatial spins as everywhere.

use super::angle::{Angle, body_vector};
use super::given_angle::GivenAngle;
use super::relative_turn;
use crate::state::Node;
use base::math::{Mat3, Vec3, Vec6, skew, stack};
use std::f64::consts::TAU;

/// Largest number of constraint equations of a joint: a node of multipliers has six rows.
pub const MOST_EQUATIONS: usize = 6;

/// Largest number of ends of a joint: a node tied to a face of nine nodes.
pub const MOST_ENDS: usize = 10;

/// A joint of two nodes; its equations describe the first as seen from the second. A tie has several second nodes: each equation is then the
/// mean of those with every one of them, by their weights.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The two nodes.
    pub nodes: [usize; 2],
    /// The weight of the second node: 1 unless there are more.
    pub weight: f64,
    /// More second nodes. All weights together are 1.
    pub more: Vec<SecondNode>,
    /// The constraint equations, at most six.
    pub equations: Vec<ConstraintEquation>,
    /// True if the second node is restrained and represents a support.
    pub supports: bool,
    /// Drive of the coordinate; the last equation holds the coordinate at the drive.
    pub drive: Option<Drive>,
}

/// A second node of a joint with its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecondNode {
    /// The node.
    pub node: usize,
    /// Its part of the mean.
    pub weight: f64,
}

/// Drive of a joint coordinate: a separate node, whose displacement along x times a ratio is the prescribed coordinate. A prescribed drive
/// has a restrained node like a support, whose reaction is the effort. Gears share one unknown node, so turns are counted and efforts are
/// in equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// The node.
    pub node: usize,
    /// Its position at t = 0.
    pub start: Vec3,
    /// Coordinate per displacement of the node.
    pub ratio: f64,
    /// True where the node is an unknown.
    pub is_free: bool,
}

impl Drive {
    /// Prescribed value of the coordinate.
    #[inline]
    pub fn coordinate(&self, nodes: &[Node]) -> f64 {
        self.ratio * nodes[self.node].moved(&self.start).x
    }
}

impl Joint {
    /// Violation of an equation with its first two time derivatives; for a drive the lag behind it.
    #[inline]
    pub fn gap(&self, number: usize, nodes: &[Node]) -> [f64; 3] {
        let row = &self.equations[number];
        let gap = self.mean_gap(row, nodes);
        match &self.drive {
            Some(drive) if self.is_driven(number) => {
                let node = &nodes[drive.node];
                let behind = gap[0] - drive.coordinate(nodes);
                [row.nearest(behind), gap[1] - drive.ratio * node.v.x, gap[2] - drive.ratio * node.a.x]
            }
            _ => gap,
        }
    }

    fn mean_gap(&self, row: &ConstraintEquation, nodes: &[Node]) -> [f64; 3] {
        let [a, b] = self.nodes.map(|n| &nodes[n]);
        let mut gap = row.gap(a, b);
        if !self.more.is_empty() {
            gap = gap.map(|gap| self.weight * gap);
            for share in &self.more {
                let other = row.gap(a, &nodes[share.node]);
                (0..3).for_each(|k| gap[k] += share.weight * other[k]);
            }
        }
        gap
    }

    /// The nodes of the joint: the first, then the second ones. The node of a drive is none of them.
    pub fn ends(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        self.nodes.into_iter().chain(self.more.iter().map(|share| share.node))
    }

    /// The gradient G = ∂c/∂(x, θ) of an equation at each end, in their order, written into `room`.
    pub fn gradient<'r>(&self, number: usize, nodes: &[Node], room: &'r mut [Vec6; MOST_ENDS]) -> &'r [Vec6] {
        let (row, [a, b]) = (&self.equations[number], self.nodes.map(|n| &nodes[n]));
        [room[0], room[1]] = row.gradient(a, b);
        if !self.more.is_empty() {
            (0..2).for_each(|end| room[end] *= self.weight);
            for (end, share) in self.more.iter().enumerate() {
                let [of_first, of_second] = row.gradient(a, &nodes[share.node]);
                room[0] += share.weight * of_first;
                room[2 + end] = share.weight * of_second;
            }
        }
        &room[..2 + self.more.len()]
    }

    /// Adds the stiffness of an equation, as [`ConstraintEquation::stiffness`] does: x and θ of the ends in their order.
    pub fn stiffness(&self, number: usize, nodes: &[Node], lambda: f64, mut add: impl FnMut(usize, usize, Mat3)) {
        let (row, [a, b]) = (&self.equations[number], self.nodes.map(|n| &nodes[n]));
        row.stiffness(a, b, self.weight * lambda, &mut add);
        for (k, share) in self.more.iter().enumerate() {
            let at = |of: usize| if of < 2 { of } else { of + 2 * (k + 1) };
            row.stiffness(a, &nodes[share.node], share.weight * lambda, |i, j, block| add(at(i), at(j), block));
        }
    }

    /// The change of the violation of an equation for small motions (u, θ) of all nodes.
    pub fn opening(&self, number: usize, nodes: &[Node], motions: &[Vec6]) -> f64 {
        let mut room = [Vec6::zeros(); MOST_ENDS];
        let of_ends = self.gradient(number, nodes, &mut room).iter().zip(self.ends());
        let change = of_ends.map(|(G, node)| G.dot(&motions[node])).sum::<f64>();
        match &self.drive {
            Some(drive) if self.is_driven(number) => change - drive.ratio * motions[drive.node][0],
            _ => change,
        }
    }

    /// The node of gears that the joint moves besides its own.
    pub fn shared(&self) -> Option<&Drive> {
        self.drive.as_ref().filter(|drive| drive.is_free)
    }

    /// Nodes with unknowns in the matrix, in the order of the matrix.
    pub fn matrix_nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.ends().chain(self.shared().map(|drive| drive.node))
    }

    /// True for the equation of the drive.
    #[inline]
    pub fn is_driven(&self, number: usize) -> bool {
        self.drive.is_some() && number + 1 == self.equations.len()
    }
}

/// One constraint equation. Vectors are unit vectors at t = 0, fixed to the node that they belong to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ConstraintEquation {
    /// The relative position along a global axis is constant: (x_a − x_b)·e = `at`.
    GlobalAxis {
        /// The global axis, 0 to 2.
        axis: usize,
        /// The component of the relative position along it, in units of length.
        at: f64,
    },
    /// The relative position along an axis of the second node is constant: (x_a − x_b)·R_b e = `at`.
    BodyAxis {
        /// The axis, fixed to the second node.
        e: Vec3,
        /// The component of the relative position along it, in units of length.
        at: f64,
    },
    /// An axis of the first node stays perpendicular to one of the second: R_a p · R_b s = 0.
    Perpendicular {
        /// The axis that is fixed to the first node.
        p: Vec3,
        /// The axis that is fixed to the second node.
        s: Vec3,
    },
    /// The distance of the nodes is constant: |x_a − x_b| = `length` > 0.
    Distance {
        /// The distance.
        length: f64,
    },
    /// The second node has not turned from the first about an axis that both share.
    Angle(Angle),
    /// One of the rotations of the first node against the second, a support, is zero.
    Given(GivenAngle),
    /// A component of the rotation vector from the second to the first node is zero: log(R_a R_bᵀ)·e = 0.
    Turn {
        /// The global axis, 0 to 2.
        axis: usize,
    },
    /// The second node goes along a shared axis by `lead` for each turn about it: −(x_a − x_b)·R_b e − `at` = `lead` θ/2π.
    Screw {
        /// The angle θ of the second node from the first.
        angle: Angle,
        /// The axis, fixed to the second node.
        e: Vec3,
        /// The left-hand side without it at t = 0, in units of length.
        at: f64,
        /// The length of a turn, negative for a left-hand thread.
        lead: f64,
    },
}

impl ConstraintEquation {
    /// Axis of rotation or translation of a coordinate, for an equation that locks it; global components.
    pub fn axis(&self, a: &Node, b: &Node) -> Option<Vec3> {
        match self {
            ConstraintEquation::BodyAxis { e, .. } => Some(b.R() * e),
            ConstraintEquation::Angle(Angle { p, s, .. }) => Some(a.R() * p.cross(s)),
            _ => None,
        }
    }

    /// The degrees of freedom of the two nodes on which the equation can ever act.
    pub fn reach(&self) -> [[bool; 6]; 2] {
        let moves = [true, true, true, false, false, false];
        let turns = [false, false, false, true, true, true];
        match self {
            ConstraintEquation::GlobalAxis { axis, .. } => [std::array::from_fn(|i| i == *axis); 2],
            ConstraintEquation::BodyAxis { .. } => [moves, [true; 6]],
            ConstraintEquation::Perpendicular { .. }
            | ConstraintEquation::Angle(_)
            | ConstraintEquation::Given(_)
            | ConstraintEquation::Turn { .. } => [turns; 2],
            ConstraintEquation::Screw { .. } => [[true; 6]; 2],
            ConstraintEquation::Distance { .. } => [moves; 2],
        }
    }

    /// The equation that locks the distance from the first to the second node along an axis, relative to t = 0, with this distance as its
    /// violation. `d` is x_a − x_b at t = 0.
    pub fn distance_along(e: &Vec3, d: &Vec3) -> ConstraintEquation {
        ConstraintEquation::BodyAxis { e: -e, at: -d.dot(e) }
    }

    /// The equation between the nodes a and b in their current state, with zero gap. Axes are those of the first node or, for a support,
    /// those of t = 0. If the ends need not meet, an arm that turns with the second end joins them.
    pub fn held_here(&self, [a, b]: [&Node; 2], supports: bool, meets: bool) -> ConstraintEquation {
        let d = a.relative_position(b);
        let as_seen = |node: &Node, axis: &Vec3| node.R().tr_mul(axis);
        match self {
            ConstraintEquation::GlobalAxis { axis, .. } if supports || meets => {
                ConstraintEquation::GlobalAxis { axis: *axis, at: d[*axis] }
            }
            ConstraintEquation::GlobalAxis { axis, .. } => {
                ConstraintEquation::BodyAxis { e: as_seen(b, &Vec3::ith(*axis, 1.0)), at: d[*axis] }
            }
            // The axes of a support stay as they are.
            ConstraintEquation::BodyAxis { e, .. } if supports => {
                ConstraintEquation::BodyAxis { e: *e, at: d.dot(&(b.R() * e)) }
            }
            ConstraintEquation::BodyAxis { e, .. } => {
                let now = a.R() * e;
                ConstraintEquation::BodyAxis { e: as_seen(b, &now), at: d.dot(&now) }
            }
            ConstraintEquation::Perpendicular { p, s } if supports => {
                ConstraintEquation::Perpendicular { p: as_seen(a, &(b.R() * p)), s: *s }
            }
            ConstraintEquation::Perpendicular { p, s } => {
                ConstraintEquation::Perpendicular { p: *p, s: as_seen(b, &(a.R() * s)) }
            }
            ConstraintEquation::Distance { .. } => ConstraintEquation::Distance { length: d.norm() },
            ConstraintEquation::Screw { angle, e, at, lead } => {
                let [gap, ..] = self.gap(a, b);
                ConstraintEquation::Screw { angle: *angle, e: *e, at: at + gap, lead: *lead }
            }
            ConstraintEquation::Given(angle) => ConstraintEquation::Given(angle.from_here(a)),
            // A drive is never held where it is: it goes on. Ties hold in all stages alike.
            ConstraintEquation::Angle(_) | ConstraintEquation::Turn { .. } => *self,
        }
    }

    /// Returns the equation of a coordinate that is zero in the current state.
    pub fn counted_from_here(&self, [a, b]: [&Node; 2]) -> ConstraintEquation {
        match self {
            ConstraintEquation::Angle(angle) => ConstraintEquation::Angle(angle.from_here(a, b)),
            _ => self.held_here([a, b], false, false),
        }
    }

    /// The violation nearest to zero where the equation knows it up to full turns only.
    pub fn nearest(&self, gap: f64) -> f64 {
        match self {
            ConstraintEquation::Angle(_) => gap - TAU * (gap / TAU).round(),
            ConstraintEquation::Given(angle) => angle.nearest(gap),
            _ => gap,
        }
    }

    /// The violation c with its derivatives ċ and c̈.
    pub fn gap(&self, a: &Node, b: &Node) -> [f64; 3] {
        let (d, v, w) = (a.relative_position(b), a.v - b.v, a.a - b.a);
        match self {
            ConstraintEquation::GlobalAxis { axis, at } => [d[*axis] - at, v[*axis], w[*axis]],
            ConstraintEquation::BodyAxis { e, at } => {
                let [e, de, dde] = body_vector(b, e);
                [d.dot(&e) - at, v.dot(&e) + d.dot(&de), w.dot(&e) + 2.0 * v.dot(&de) + d.dot(&dde)]
            }
            ConstraintEquation::Perpendicular { p, s } => {
                let ([p, dp, ddp], [s, ds, dds]) = (body_vector(a, p), body_vector(b, s));
                [p.dot(&s), dp.dot(&s) + p.dot(&ds), ddp.dot(&s) + 2.0 * dp.dot(&ds) + p.dot(&dds)]
            }
            ConstraintEquation::Distance { length } => {
                let now = d.norm();
                let u = d / now;
                let rate = u.dot(&v);
                [now - length, rate, u.dot(&w) + (v.norm_squared() - rate * rate) / now]
            }
            ConstraintEquation::Angle(angle) => angle.value(a, b),
            ConstraintEquation::Given(angle) => angle.value(a, b),
            ConstraintEquation::Turn { axis } => relative_turn::value(a, b).map(|of| of[*axis]),
            ConstraintEquation::Screw { angle, e, at, lead } => {
                let along = ConstraintEquation::BodyAxis { e: -e, at: *at }.gap(a, b);
                let turned = angle.value(a, b);
                let [c, rate, second] = std::array::from_fn(|i| along[i] - lead / TAU * turned[i]);
                // The distance tells how many turns the angle lacks.
                [c - lead * (c / lead).round(), rate, second]
            }
        }
    }

    /// The gradient G = ∂c/∂(x, θ) of the two nodes.
    pub fn gradient(&self, a: &Node, b: &Node) -> [Vec6; 2] {
        let zero = Vec3::zeros();
        let d = a.relative_position(b);
        match self {
            ConstraintEquation::GlobalAxis { axis, .. } => {
                let e = Vec3::ith(*axis, 1.0);
                [stack(&e, &zero), stack(&-e, &zero)]
            }
            ConstraintEquation::BodyAxis { e, .. } => {
                let e = b.R() * e;
                [stack(&e, &zero), stack(&-e, &e.cross(&d))]
            }
            ConstraintEquation::Perpendicular { p, s } => {
                let turn = (a.R() * p).cross(&(b.R() * s));
                [stack(&zero, &turn), stack(&zero, &-turn)]
            }
            ConstraintEquation::Distance { .. } => {
                let u = d.normalize();
                [stack(&u, &zero), stack(&-u, &zero)]
            }
            ConstraintEquation::Angle(angle) => angle.gradient(a, b),
            ConstraintEquation::Given(angle) => angle.gradient(a, b),
            ConstraintEquation::Turn { axis } => relative_turn::gradient(a, b, *axis),
            ConstraintEquation::Screw { angle, e, at, lead } => {
                let along = ConstraintEquation::BodyAxis { e: -e, at: *at }.gradient(a, b);
                let turned = angle.gradient(a, b);
                std::array::from_fn(|i| along[i] - lead / TAU * turned[i])
            }
        }
    }

    /// Adds the stiffness: calls `add(row, column, k)` for the 3×3 blocks of ∂(Gᵀλ)/∂(x, θ), whose rows and columns are
    /// numbered in the order x_a, θ_a, x_b, θ_b.
    pub fn stiffness(&self, a: &Node, b: &Node, lambda: f64, mut add: impl FnMut(usize, usize, Mat3)) {
        let d = a.relative_position(b);
        match self {
            ConstraintEquation::GlobalAxis { .. } => {}
            ConstraintEquation::BodyAxis { e, .. } => along_axis(e, b, &d, lambda, &mut add),
            ConstraintEquation::Perpendicular { p, s } => {
                let (p, s) = (skew(&(a.R() * p)), skew(&(b.R() * s)));
                let (sp, ps) = (s * p * lambda, p * s * lambda);
                add(1, 1, sp);
                add(1, 3, -ps);
                add(3, 1, -sp);
                add(3, 3, ps);
            }
            ConstraintEquation::Distance { .. } => {
                let now = d.norm();
                let u = d / now;
                let k = (Mat3::identity() - u * u.transpose()) * (lambda / now);
                for (i, j, sign) in [(0, 0, 1.0), (0, 2, -1.0), (2, 0, -1.0), (2, 2, 1.0)] {
                    add(i, j, k * sign);
                }
            }
            ConstraintEquation::Angle(angle) => angle.stiffness(a, b, lambda, &mut add),
            ConstraintEquation::Given(angle) => angle.stiffness(a, b, lambda, &mut add),
            ConstraintEquation::Turn { axis } => relative_turn::stiffness(a, b, &Vec3::ith(*axis, lambda), &mut add),
            ConstraintEquation::Screw { angle, e, lead, .. } => {
                along_axis(&-e, b, &d, lambda, &mut add);
                angle.stiffness(a, b, -lead / TAU * lambda, &mut add);
            }
        }
    }

    /// True where the multiplier is a moment and the gap an angle; otherwise they are a force and a length.
    pub fn is_rotational(&self) -> bool {
        use ConstraintEquation::{Angle, Given, Perpendicular, Turn};
        matches!(self, Perpendicular { .. } | Angle(_) | Given(_) | Turn { .. })
    }

    /// Classifies the equation for motion in the plane normal to a global axis: true if it constrains something, `None` if its forces act
    /// out of that plane. `d` is x_a − x_b.
    pub fn in_plane(&self, normal: usize, d: &Vec3) -> Option<bool> {
        const SMALL: f64 = 1e-12; // what rounding leaves of a zero
        let along = |v: &Vec3| v[normal].abs() > 1.0 - SMALL;
        let across = |v: &Vec3| v[normal].abs() <= SMALL * v.amax();
        match self {
            ConstraintEquation::GlobalAxis { axis, .. } => Some(*axis != normal),
            ConstraintEquation::BodyAxis { e, .. } if along(e) => Some(false),
            ConstraintEquation::BodyAxis { e, .. } => (across(e) && across(d)).then_some(true),
            ConstraintEquation::Perpendicular { p, s } if along(p) || along(s) => Some(false),
            ConstraintEquation::Perpendicular { p, s } => (across(p) && across(s)).then_some(true),
            ConstraintEquation::Distance { .. } => across(d).then_some(true),
            ConstraintEquation::Angle(Angle { p, s, .. }) => (across(p) && across(s)).then_some(true),
            ConstraintEquation::Given(GivenAngle { axis, .. }) | ConstraintEquation::Turn { axis } => {
                Some(*axis == normal)
            }
            // Its moment is about the axis along which its force acts.
            ConstraintEquation::Screw { .. } => None,
        }
    }

    /// Word for the constrained motion, for messages and tables.
    pub fn word(&self) -> &'static str {
        match self {
            ConstraintEquation::GlobalAxis { axis, .. } => ["ux", "uy", "uz"][*axis],
            ConstraintEquation::BodyAxis { .. } => "sideways",
            ConstraintEquation::Perpendicular { .. } => "turn",
            ConstraintEquation::Distance { .. } => "distance",
            ConstraintEquation::Angle(_) => "angle",
            ConstraintEquation::Given(GivenAngle { axis, .. }) | ConstraintEquation::Turn { axis } => {
                ["rx", "ry", "rz"][*axis]
            }
            ConstraintEquation::Screw { .. } => "thread",
        }
    }
}

/// The stiffness of [`ConstraintEquation::BodyAxis`]; `d` is x_a − x_b.
fn along_axis(e: &Vec3, b: &Node, d: &Vec3, lambda: f64, add: &mut impl FnMut(usize, usize, Mat3)) {
    let e = skew(&(b.R() * e)) * lambda;
    add(0, 3, -e);
    add(2, 3, e);
    add(3, 0, e);
    add(3, 2, -e);
    add(3, 3, skew(d) * e);
}

/// Equations that keep the nodes together along global axes, as [`super::rigid_link`] does.
pub fn translations(dofs: [bool; 3], d: &Vec3) -> impl Iterator<Item = ConstraintEquation> {
    (0..3).filter(move |&axis| dofs[axis]).map(move |axis| ConstraintEquation::GlobalAxis { axis, at: d[axis] })
}

/// Equations against relative rotation about some axes of the second node. One free axis gives a revolute joint, two give a universal joint
/// with a cross that is perpendicular at t = 0. The free axes turn with the nodes.
pub fn rotations(dofs: [bool; 3], axes: &Mat3) -> Vec<ConstraintEquation> {
    let e = |i: usize| axes.column(i % 3).into_owned();
    let square = |i: usize, j: usize| ConstraintEquation::Perpendicular { p: e(i), s: e(j) };
    let fixed: Vec<usize> = (0..3).filter(|&i| dofs[i]).collect();
    match fixed.as_slice() {
        [k] => vec![square(k + 1, k + 2)],
        // The free axis of the first node stays perpendicular to the other two of the second.
        [i, j] => vec![square(3 - i - j, *i), square(3 - i - j, *j)],
        [] => Vec::new(),
        _ => vec![square(0, 1), square(1, 2), square(2, 0)],
    }
}
