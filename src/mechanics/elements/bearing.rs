//! A bearing or mount given by full matrices: force and moment depend on all relative displacements, tilts and their rates.
//!
//! Components are along the axes B = R₁ A of the first end; the first axis n is that of the shaft. The displacement is d, and s is the swing of n
//! ([`super::relative_rotation`]). The relative velocity is u̇ and the relative angular velocity w. Force f and moment m are
//!   (f, p) = K (d, s) + C (u̇, 0),  m = Hᵀ p + C_φ (u̇, w),  ṡ = H w.
//! K and C need not be symmetric, and change with the speed |n·w|. The swing of n is that of the shaft's axis, however far the shaft has turned.
//! The power of the skew part of K and of a change of K with the speed counts as damping; it is negative where whirl is fed.

use super::block::{Branches, Elements, Force, Mechanics, Moduli, Results, subtract};
use super::relative_rotation::Swing;
use crate::state::{Configuration, Node};
use base::math::{Mat3, Mat6, Vec3, Vec6, angular, linear, skew, stack};
use nalgebra::{Quaternion, SMatrix};
use std::sync::atomic::{AtomicU64, Ordering};

/// The matrices at a speed, along the axes of the bearing, displacements before rotations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BearingMatrices {
    /// Angular velocity of the second end about the first axis, its magnitude.
    pub speed: f64,
    /// Force per displacement and tilt.
    pub stiffness: Mat6,
    /// Force per velocity and angular velocity.
    pub damping: Mat6,
}

/// One bearing between two nodes.
#[derive(Debug, Clone)]
pub struct Bearing {
    /// The two nodes.
    pub nodes: [usize; 2],
    /// A: the axes as columns, global components at t = 0.
    pub axes: Mat3,
    /// Aᵀ(x₂ − x₁) at t = 0.
    pub offset: Vec3,
    /// The matrices by rising speed, one or more; between two they are interpolated, beyond the ends they stay.
    pub matrices: Vec<BearingMatrices>,
}

/// Motion of the second node relative to the first; components in the frame unless said otherwise.
struct Motion {
    B: Mat3,
    /// x₂ − x₁, global components.
    r: Vec3,
    /// Velocity of the second node relative to the frame of the first, global components.
    u: Vec3,
    /// ω₂ − ω₁, global components.
    w: Vec3,
    swing: Swing,
    /// (d, s).
    strain: Vec6,
    /// (u̇, w).
    rate: Vec6,
}

/// The matrices at a speed, and their derivatives by n·w.
struct AtSpeed {
    K: Mat6,
    C: Mat6,
    dK: Mat6,
    dC: Mat6,
}

impl Bearing {
    fn motion(&self, nodes: &[Node]) -> Motion {
        let [a, b] = self.nodes.map(|n| &nodes[n]);
        let B = a.R() * self.axes;
        let r = b.relative_position(a);
        let (u, w) = (b.v - a.v - a.omega.cross(&r), b.omega - a.omega);
        let Q = a.rotation.conjugate() * b.rotation;
        // The shaft's axis of the second end starts along n.
        let swing = Swing::of(&Quaternion::from_parts(Q.w, self.axes.tr_mul(&Q.imag())), 0);
        let strain = stack(&(B.tr_mul(&r) - self.offset), &swing.s);
        Motion { B, r, u, w, swing, strain, rate: stack(&B.tr_mul(&u), &B.tr_mul(&w)) }
    }

    fn at(&self, spin: f64) -> AtSpeed {
        let (speed, list) = (spin.abs(), &self.matrices);
        let next = list.partition_point(|of| of.speed <= speed);
        if next == 0 || next == list.len() {
            let of = &list[next.min(list.len() - 1)];
            return AtSpeed { K: of.stiffness, C: of.damping, dK: Mat6::zeros(), dC: Mat6::zeros() };
        }
        let [low, high] = [&list[next - 1], &list[next]];
        let slope = spin.signum() / (high.speed - low.speed);
        let (dK, dC) = (slope * (high.stiffness - low.stiffness), slope * (high.damping - low.damping));
        let way = spin.signum() * (speed - low.speed);
        AtSpeed { K: low.stiffness + way * dK, C: low.damping + way * dC, dK, dC }
    }

    /// Force and moment on the second node, in the frame.
    fn forces(motion: &Motion, at: &AtSpeed) -> Vec6 {
        let (elastic, viscous) = (at.K * motion.strain, at.C * motion.rate);
        elastic_moment(&elastic, &motion.swing) + viscous
    }

    /// True if the shaft's axis has swung nearly half a turn, where moments are undefined.
    pub fn is_turned_over(&self, end: &[Node]) -> bool {
        const LIMIT: f64 = 3.0; // radians, of π
        self.motion(end).swing.theta > LIMIT
    }

    /// d, its rate along the first axis, force and moment on the second node; components in the frame.
    pub fn state(&self, nodes: &[Node]) -> (Vec3, f64, Vec3, Vec3) {
        let motion = self.motion(nodes);
        let F = Self::forces(&motion, &self.at(motion.rate[3]));
        (linear(&motion.strain), motion.rate[0], linear(&F), angular(&F))
    }
}

/// Force and moment of an elastic force f and a force p on the swing.
fn elastic_moment(elastic: &Vec6, swing: &Swing) -> Vec6 {
    stack(&linear(elastic), &swing.moment(&angular(elastic)))
}

/// A group of bearings.
pub struct Bearings {
    list: Vec<Bearing>,
    /// The speeds at which a linearization holds the matrices, as bits. Not a number: the nodes have the speed.
    held: Vec<AtomicU64>,
}

impl Bearings {
    /// A group of these bearings.
    pub fn new(list: Vec<Bearing>) -> Bearings {
        let held = list.iter().map(|_| AtomicU64::new(f64::NAN.to_bits())).collect();
        Bearings { list, held }
    }

    /// The matrices of a bearing in a motion.
    fn at(&self, e: usize, motion: &Motion) -> AtSpeed {
        let held = f64::from_bits(self.held[e].load(Ordering::Relaxed));
        if held.is_nan() {
            return self.list[e].at(motion.rate[3]);
        }
        AtSpeed { dK: Mat6::zeros(), dC: Mat6::zeros(), ..self.list[e].at(held) }
    }

    /// Each bearing with its motion and its matrices.
    fn each<'a>(&'a self, nodes: &'a [Node]) -> impl Iterator<Item = (&'a Bearing, Motion, AtSpeed)> {
        self.list.iter().enumerate().map(|(e, bearing)| {
            let motion = bearing.motion(nodes);
            let at = self.at(e, &motion);
            (bearing, motion, at)
        })
    }
}

impl Elements for Bearings {
    fn len(&self) -> usize {
        self.list.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.list[e].nodes
    }

    fn dofs(&self) -> usize {
        6
    }
}

impl Mechanics for Bearings {
    fn is_damped(&self) -> bool {
        let has_damping = |of: &BearingMatrices| of.damping != Mat6::zeros();
        self.list.iter().any(|bearing| bearing.matrices.len() > 1 || bearing.matrices.iter().any(has_damping))
    }

    fn hold_speeds(&self, nodes: &[Node]) {
        for (bearing, held) in self.list.iter().zip(&self.held) {
            held.store(bearing.motion(nodes).rate[3].to_bits(), Ordering::Relaxed);
        }
    }

    fn has_potential(&self) -> bool {
        let is_symmetric = |of: &BearingMatrices| of.stiffness == of.stiffness.transpose();
        self.list.iter().all(|bearing| bearing.matrices.iter().all(is_symmetric))
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for (bearing, motion, at) in self.each(now.nodes) {
            let forces = Bearing::forces(&motion, &at);
            let [f, m] = [motion.B * linear(&forces), motion.B * angular(&forces)];
            let [a, b] = bearing.nodes;
            subtract(&mut F[a], 0, &-f);
            subtract(&mut F[a], 3, &-(m + motion.r.cross(&f)));
            subtract(&mut F[b], 0, &f);
            subtract(&mut F[b], 3, &m);
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        let bearing = &self.list[e];
        let motion = bearing.motion(now.nodes);
        let at = self.at(e, &motion);
        let forces = Bearing::forces(&motion, &at);
        let motions = motions(&motion, &now.nodes[bearing.nodes[0]].omega, rate_weight);
        let by_motion = derivative(&motion, &at) * motions;
        let (f, m) = (motion.B * linear(&forces), motion.B * angular(&forces));
        for column in 0..12 {
            let local: Vec6 = by_motion.column(column).into();
            let unit = Vec3::ith(column % 3, 1.0);
            // The frame turns with the first node.
            let turned = |force: &Vec3| if (3..6).contains(&column) { unit.cross(force) } else { Vec3::zeros() };
            let (df, dm) = (motion.B * linear(&local) + turned(&f), motion.B * angular(&local) + turned(&m));
            let arm = match column {
                0..3 => -unit.cross(&f),
                6..9 => unit.cross(&f),
                _ => Vec3::zeros(),
            };
            let rows = [-df, -(dm + motion.r.cross(&df) + arm), df, dm];
            rows.iter().flatten().enumerate().for_each(|(row, value)| K[12 * row + column] = *value);
        }
    }
}

/// The change of (d, θ, u̇, w) in the frame by (x₁, θ₁, x₂, θ₂), with velocities that change by `rate_weight` as much; θ is the relative rotation.
fn motions(motion: &Motion, omega: &Vec3, rate_weight: f64) -> SMatrix<f64, 12, 12> {
    let (I, Bt) = (Mat3::identity(), motion.B.transpose());
    let (r, u, w) = (skew(&motion.r), skew(&motion.u), skew(&motion.w));
    let slip = rate_weight * I - skew(omega);
    let mut all = SMatrix::<f64, 12, 12>::zeros();
    let mut set = |row: usize, column: usize, block: Mat3| {
        all.fixed_view_mut::<3, 3>(3 * row, 3 * column).copy_from(&(Bt * block));
    };
    set(0, 0, -I);
    set(0, 1, r);
    set(0, 2, I);
    set(1, 1, -I);
    set(1, 3, I);
    set(2, 0, -slip);
    set(2, 1, u + rate_weight * r);
    set(2, 2, slip);
    set(3, 1, w - rate_weight * I);
    set(3, 3, rate_weight * I);
    all
}

/// ∂(f, m) in the frame by (d, θ, u̇, w).
fn derivative(motion: &Motion, at: &AtSpeed) -> SMatrix<f64, 6, 12> {
    let H = motion.swing.H();
    let elastic = at.K * motion.strain;
    let mut by_place = at.K;
    let by_swing = by_place.fixed_view::<6, 3>(0, 3) * H;
    by_place.fixed_view_mut::<6, 3>(0, 3).copy_from(&by_swing);
    let moments = H.tr_mul(&by_place.fixed_view::<3, 6>(3, 0));
    by_place.fixed_view_mut::<3, 6>(3, 0).copy_from(&moments);
    let mut turned = by_place.fixed_view_mut::<3, 3>(3, 3);
    turned += motion.swing.geometric(&angular(&elastic));
    let mut by_rate = at.C;
    let by_speed = elastic_moment(&(at.dK * motion.strain), &motion.swing) + at.dC * motion.rate;
    let mut spin = by_rate.column_mut(3);
    spin += by_speed;
    let mut all = SMatrix::<f64, 6, 12>::zeros();
    all.fixed_view_mut::<6, 6>(0, 0).copy_from(&by_place);
    all.fixed_view_mut::<6, 6>(0, 6).copy_from(&by_rate);
    all
}

impl Results for Bearings {
    fn energy(&self, now: &Configuration) -> f64 {
        self.each(now.nodes).map(|(_, motion, at)| 0.5 * motion.strain.dot(&(at.K * motion.strain))).sum()
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        let power = |(bearing, motion, at): (&Bearing, Motion, AtSpeed)| {
            let strain_rate = stack(&linear(&motion.rate), &(motion.swing.H() * angular(&motion.rate)));
            let skew_part = 0.5 * (at.K - at.K.transpose()) * motion.strain;
            let [a, b] = bearing.nodes.map(|node| &now.nodes[node]);
            let n: Vec3 = motion.B.column(0).into();
            let spun_up = n.dot(&(b.alpha - a.alpha)) + a.omega.cross(&n).dot(&motion.w);
            let stiffened = 0.5 * spun_up * motion.strain.dot(&(at.dK * motion.strain));
            skew_part.dot(&strain_rate) + (at.C * motion.rate).dot(&motion.rate) - stiffened
        };
        self.each(now.nodes).map(power).sum()
    }
}

impl Branches for Bearings {
    fn is_turned_over(&self, e: usize, _: &[Node], now: &[Node]) -> bool {
        self.list[e].is_turned_over(now)
    }
}
