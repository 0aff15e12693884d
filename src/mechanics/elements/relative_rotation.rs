//! The elastic moment of a bushing over the rotation of its second end relative to its first.
//!
//! Rotation vectors add only while they are small. If a body spins about one axis and is slightly tilted, log(R) has transverse components
//! turned by half the spin and longer than the tilt. If the stiffness about one axis n differs from the others, the rotation is split. It
//! becomes a twist ψ about n and a swing s of that axis, from n to b = Q n:
//!   s = g(c) n × b,  c = n·b = cos θ,  g = θ/sin θ,   ψ̇ = ω·h,  h = (n + b)/(1 + c),
//!   energy ½ s·k s + ½ k_n ψ²,  moment Hᵀ k s + k_n ψ h  with ṡ = H ω.
//! The swing is that of the axis alone, however far the second end has turned about it. P. Dobrowolski, arXiv:1506.05481 (2015);
//! flexion and torsion in the manuals of general programs are the same split. With equal stiffness about all axes no axis is
//! distinguished and the moment is that of ½ k φ², φ = log Q.

use base::math::{Mat3, Vec3, rotation, skew};
use nalgebra::Quaternion;
use std::f64::consts::TAU;

/// Moments about three axes over a relative rotation. Components are along the axes of the bushing, fixed to its first end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RotationalSpring {
    /// Equal stiffness about all axes.
    Isotropic {
        /// The moment per radian.
        stiffness: f64,
    },
    /// One axis stands out: the rotation is a twist about it, and a swing of it.
    AboutAxis {
        /// The axis, 0 to 2.
        axis: usize,
        /// The moment per radian about each axis.
        stiffness: Vec3,
    },
}

/// Moment of a relative rotation with its derivatives.
#[derive(Debug, Clone, Copy)]
pub struct ElasticMoment {
    /// The moment on the second end.
    pub moment: Vec3,
    /// The energy that is stored.
    pub energy: f64,
    /// How near the rotation is to where the moment is no longer defined: the angle φ of a rotation vector, or θ of the swing.
    pub angle: f64,
    /// ψ, counted on over full turns from the angle that was handed in.
    pub twist: f64,
}

impl RotationalSpring {
    /// `stiffness`: moment per radian about each axis of the bushing.
    pub fn new(stiffness: Vec3) -> Self {
        let [a, b, c] = [stiffness.x, stiffness.y, stiffness.z];
        let axis = match [a == b, b == c, a == c] {
            [true, true, _] => return RotationalSpring::Isotropic { stiffness: a },
            [true, ..] => 2,
            [_, true, _] => 0,
            [.., true] => 1,
            // With three different stiffnesses the softest axis turns farthest.
            _ => stiffness.imin(),
        };
        RotationalSpring::AboutAxis { axis, stiffness }
    }

    /// True if a rotation from `before` to `after` ends near half a turn, of the rotation vector or of the swing, or has passed it. The
    /// moment is undefined there and changes sign beyond. Without stiffness there is none.
    pub fn is_turned_over(&self, before: &Quaternion<f64>, after: &Quaternion<f64>) -> bool {
        const LIMIT: f64 = 3.0; // radians, of π
        let passed = match *self {
            RotationalSpring::Isotropic { stiffness: 0.0 } => return false,
            // The sign of the quaternion shows that the nearest rotation vector points the other way round.
            RotationalSpring::Isotropic { .. } => before.coords.dot(&after.coords) * before.w * after.w < 0.0,
            RotationalSpring::AboutAxis { axis, .. } => {
                let [from, to] = [before, after].map(|Q| Swing::of(Q, axis));
                from.c < 0.0 && to.c < 0.0 && from.s.dot(&to.s) < 0.0
            }
        };
        passed || self.moment(after, 0.0).angle > LIMIT
    }

    /// True where any rotation is resisted.
    pub fn resists(&self) -> bool {
        match self {
            RotationalSpring::Isotropic { stiffness } => *stiffness != 0.0,
            RotationalSpring::AboutAxis { .. } => true,
        }
    }

    /// Largest angle with influence on the moments in a step between two rotations; velocities give the rotation vector `spun` of the
    /// second end, components in the frame. A spin about a free axis is none of them.
    pub fn step_angle(&self, rotations: &[Quaternion<f64>; 2], spun: &Vec3) -> f64 {
        let [before, after] = rotations;
        match *self {
            RotationalSpring::Isotropic { .. } => rotation::log(&(after * before.conjugate())).norm().max(spun.norm()),
            RotationalSpring::AboutAxis { axis, .. } => {
                let [from, to] = [before, after].map(|Q| Swing::of(Q, axis));
                // The axis moves across itself with the part of the spin that is not about it.
                let swung = spun.cross(&from.b).norm().min(spun.cross(&to.b).norm());
                let swing = from.b.cross(&to.b).norm().atan2(from.b.dot(&to.b)).max(swung);
                if !self.counts_turns() {
                    return swing;
                }
                let last = twist(before, axis);
                let turned = counted(twist(after, axis), last) - last;
                swing.max(turned.abs()).max(spun.dot(&from.h()).abs().min(spun.dot(&to.h()).abs()))
            }
        }
    }

    /// The stiffness about the axis of twist: where there is some, full turns count.
    pub fn counts_turns(&self) -> bool {
        matches!(self, RotationalSpring::AboutAxis { axis, stiffness } if stiffness[*axis] != 0.0)
    }

    /// Moment and energy of the rotation `Q`, in the frame; `last`: the twist at the end of the last step.
    pub fn moment(&self, Q: &Quaternion<f64>, last: f64) -> ElasticMoment {
        match *self {
            RotationalSpring::Isotropic { stiffness } => {
                let phi = rotation::log(Q);
                let moment = stiffness * rotation::inverse_tangent_matrix(&phi).tr_mul(&phi);
                ElasticMoment { moment, energy: 0.5 * stiffness * phi.norm_squared(), angle: phi.norm(), twist: 0.0 }
            }
            RotationalSpring::AboutAxis { axis, stiffness } => {
                let swing = Swing::of(Q, axis);
                let p = stiffness.component_mul(&swing.s);
                let twist = counted(twist(Q, axis), last);
                let moment = swing.moment(&p) + stiffness[axis] * twist * swing.h();
                let energy = 0.5 * (p.dot(&swing.s) + stiffness[axis] * twist * twist);
                ElasticMoment { moment, energy, angle: swing.theta, twist }
            }
        }
    }

    /// ∂moment/∂θ for a spin θ of the second end relative to the first, in the frame.
    pub fn tangent(&self, Q: &Quaternion<f64>, last: f64) -> Mat3 {
        match *self {
            RotationalSpring::Isotropic { stiffness } => {
                let phi = rotation::log(Q);
                let T_inv = rotation::inverse_tangent_matrix(&phi);
                let mu = stiffness * phi;
                (stiffness * T_inv.transpose() + rotation::inverse_tangent_transpose_derivative(&phi, &mu)) * T_inv
            }
            RotationalSpring::AboutAxis { axis, stiffness } => {
                let swing = Swing::of(Q, axis);
                let (K, k) = (Mat3::from_diagonal(&stiffness), stiffness[axis]);
                let p = stiffness.component_mul(&swing.s);
                let h = swing.h();
                let twisting = h * h.transpose() + counted(twist(Q, axis), last) * swing.dh();
                swing.H().tr_mul(&K) * swing.H() + swing.geometric(&p) + k * twisting
            }
        }
    }
}

/// The axis n and where it has gone.
pub(super) struct Swing {
    n: Vec3,
    b: Vec3,
    /// n·b
    c: f64,
    /// The angle of the swing.
    pub theta: f64,
    /// g, dg/dc, d²g/dc².
    g: [f64; 3],
    /// The swing as a rotation vector, across n.
    pub s: Vec3,
}

impl Swing {
    /// The swing of an axis of the bushing, 0 to 2, in a relative rotation.
    pub fn of(Q: &Quaternion<f64>, axis: usize) -> Swing {
        let n = Vec3::ith(axis, 1.0);
        let b: Vec3 = rotation::matrix(Q).column(axis).into();
        let across = n.cross(&b);
        let (c, sine) = (n.dot(&b), across.norm());
        let theta = sine.atan2(c);
        let g = angle_over_sine(theta, c, sine);
        Swing { n, b, c, theta, g, s: g[0] * across }
    }

    /// ∂s/∂θ.
    pub fn H(&self) -> Mat3 {
        let across = self.n.cross(&self.b);
        -self.g[0] * skew(&self.n) * skew(&self.b) - self.g[1] * across * across.transpose()
    }

    /// Hᵀp.
    pub fn moment(&self, p: &Vec3) -> Vec3 {
        self.H().tr_mul(p)
    }

    /// ∂(Hᵀp)/∂θ with p held.
    pub fn geometric(&self, p: &Vec3) -> Mat3 {
        let Swing { n, b, g: [g, g1, g2], .. } = self;
        let across = n.cross(b);
        let db = -skew(b);
        let dc = db.tr_mul(n).transpose();
        let dacross = skew(n) * db;
        // Hᵀp = g b × (n × p)·(−1) − g′ a (a·p), a = n × b
        let np = n.cross(p);
        let swung = -b.cross(&np);
        let ap = across.dot(p);
        swung * dc * *g1 + skew(&np) * db * *g
            - across * dc * (*g2 * ap)
            - (dacross * ap + across * (p.transpose() * dacross)) * *g1
    }

    fn h(&self) -> Vec3 {
        (self.n + self.b) / (1.0 + self.c)
    }

    /// ∂h/∂θ.
    fn dh(&self) -> Mat3 {
        let db = -skew(&self.b);
        let dc = db.tr_mul(&self.n).transpose();
        db / (1.0 + self.c) - (self.n + self.b) * dc / (1.0 + self.c).powi(2)
    }
}

/// g = θ/sin θ as a function of c = cos θ, with its first two derivatives.
fn angle_over_sine(theta: f64, c: f64, sine: f64) -> [f64; 3] {
    if theta < 0.3 {
        // g = Σ aₙ uⁿ, u = 1 − c = 2 sin²(θ/2), aₙ = 2ⁿ (n!)²/(2n+1)!; the ratio of terms is below u/2 = 0.023.
        let u = 2.0 * (0.5 * theta).sin().powi(2);
        let (mut a, mut g) = (1.0, [1.0, 0.0, 0.0]);
        let mut powers = [1.0, 0.0, 0.0]; // uⁿ and its derivatives
        for n in 1..14 {
            let order = f64::from(n);
            a *= order / (2.0 * order + 1.0);
            powers = [u * powers[0], powers[0] + u * powers[1], 2.0 * powers[1] + u * powers[2]];
            g = std::array::from_fn(|k| g[k] + a * powers[k]);
        }
        return [g[0], -g[1], g[2]];
    }
    let lag = sine - theta * c;
    [theta / sine, -lag / sine.powi(3), (theta * sine * sine - 3.0 * c * lag) / sine.powi(5)]
}

/// The twist about an axis of the bushing, within half a turn.
fn twist(Q: &Quaternion<f64>, axis: usize) -> f64 {
    let (sine, cosine) = (Q.imag()[axis], Q.w);
    // Q and −Q are the same rotation: the half angle is taken within a quarter turn.
    2.0 * if cosine < 0.0 { (-sine).atan2(-cosine) } else { sine.atan2(cosine) }
}

/// The angle nearest to `last` that differs from `angle` by full turns.
fn counted(angle: f64, last: f64) -> f64 {
    angle + TAU * ((last - angle) / TAU).round()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const SPRINGS: [Vec3; 5] = [
        Vec3::new(0.0, 5.0, 5.0),
        Vec3::new(2.0, 2.0, 7.0),
        Vec3::new(3.0, 1.0, 4.0),
        Vec3::new(0.0, 3.0, 0.0),
        Vec3::new(4.0, 4.0, 4.0),
    ];

    fn rotations() -> impl Iterator<Item = Vec3> {
        let angles = [1e-5, 0.1, 0.29, 0.31, 1.2, 2.6];
        let axes = [Vec3::new(1.0, 0.2, -0.4), Vec3::new(-0.3, 1.0, 0.5), Vec3::new(0.1, -0.2, 1.0)];
        angles.into_iter().flat_map(move |angle| axes.map(|axis| angle * axis.normalize()))
    }

    fn turned(Q: &Quaternion<f64>, by: Vec3) -> Quaternion<f64> {
        rotation::exp(&by) * Q
    }

    #[test]
    fn moments_are_the_derivative_of_the_energy_and_tangents_that_of_moments() {
        for spring in SPRINGS.map(RotationalSpring::new) {
            for theta in rotations() {
                let Q = rotation::exp(&theta);
                let last = 4.0 * PI; // two turns ago
                let (at, K) = (spring.moment(&Q, last), spring.tangent(&Q, last));
                // Central differences of a function of size 1 to 50: h² from curvature, ε/h from rounding, 1e-8 together.
                let h = 1e-5;
                for i in 0..3 {
                    let d = Vec3::ith(i, h);
                    let (up, down) = (spring.moment(&turned(&Q, d), last), spring.moment(&turned(&Q, -d), last));
                    let slope = (up.energy - down.energy) / (2.0 * h);
                    assert!((slope - at.moment[i]).abs() < 3e-7 * (1.0 + at.energy), "{spring:?} {theta:?} {i}");
                    let column = (up.moment - down.moment) / (2.0 * h);
                    let miss = (column - K.column(i)).amax();
                    assert!(miss < 3e-7 * (1.0 + K.amax()), "{spring:?} {theta:?} {i}: {miss:e}");
                }
            }
        }
    }

    #[test]
    fn a_tilt_is_felt_the_same_however_far_the_end_has_spun() {
        let spring = RotationalSpring::new(Vec3::new(0.0, 5.0, 3.0));
        let tilt = Vec3::new(0.0, 0.02, -0.01);
        let still = spring.moment(&rotation::exp(&tilt), 0.0);
        for turns in 1..40 {
            let spin = rotation::exp(&Vec3::new(0.7 * f64::from(turns), 0.0, 0.0));
            let spun = spring.moment(&(rotation::exp(&tilt) * spin), 0.0);
            // Rounding of quaternions, a few ε over the tilt of 0.02.
            assert!((spun.moment - still.moment).amax() < 1e-13, "{turns}: {:?}", spun.moment);
            assert!((spun.energy - still.energy).abs() < 1e-15);
        }
    }

    #[test]
    fn twists_count_full_turns() {
        let spring = RotationalSpring::new(Vec3::new(0.0, 0.0, 2.0));
        let mut twist = 0.0;
        for step in 0..=100 {
            let angle = 0.3 * f64::from(step);
            let at = spring.moment(&rotation::exp(&Vec3::new(0.0, 0.0, angle)), twist);
            twist = at.twist;
            // Angles up to 30, which quaternions hold to a few ε.
            assert!((at.moment - Vec3::new(0.0, 0.0, 2.0 * angle)).amax() < 1e-13, "{angle}");
        }
    }

    #[test]
    fn small_rotations_have_the_moments_of_their_components() {
        let k = Vec3::new(3.0, 1.0, 4.0);
        let phi = Vec3::new(1e-5, -2e-5, 0.5e-5);
        let m = RotationalSpring::new(k).moment(&rotation::exp(&phi), 0.0).moment;
        // The measures differ by products of angles: 1e-10 times the stiffness.
        assert!((m - k.component_mul(&phi)).amax() < 2e-9);
    }
}
