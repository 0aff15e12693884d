//! Six-component bushing: springs and dampers along and about the axes of a frame that rotates with the first node.
//!
//! d = Bᵀ(x₂ − x₁) − d₀ and φ = log(Bᵀ R₂ A), with B = R₁ A the frame. Energy ½ d·k d + ½ φ·k_φ φ, so the force is
//! B k d and the moment B T⁻ᵀ(φ) k_φ φ; dampers act on ḋ and on the relative angular velocity in the frame.

use super::block::{ElementBlock, Force, Moduli, subtract};
use crate::math::{Mat3, Vec3, rotation, skew};
use crate::state::{Configuration, Node};

/// One bushing between two nodes.
#[derive(Debug, Clone)]
pub struct Bushing {
    /// The two nodes.
    pub nodes: [usize; 2],
    /// A: the axes as columns, global components at t = 0.
    pub axes: Mat3,
    /// k, force per length along the axes, then k_φ, moment per radian about them.
    pub stiffness: [f64; 6],
    /// Force per velocity along the axes, then moment per angular velocity about them.
    pub damping: [f64; 6],
    /// Aᵀ(x₂ − x₁) at t = 0.
    pub offset: Vec3,
}

/// Motion of the second node relative to the first.
struct RelativeMotion {
    B: Mat3,
    /// x₂ − x₁
    r: Vec3,
    /// Velocity of the second node relative to the frame of the first, global components.
    u: Vec3,
    /// ω₂ − ω₁
    w: Vec3,
    /// d, in the frame.
    d: Vec3,
    /// φ, in the frame.
    phi: Vec3,
}

impl Bushing {
    fn motion(&self, nodes: &[Node]) -> RelativeMotion {
        let [a, b] = self.nodes.map(|n| &nodes[n]);
        let B = a.R() * self.axes;
        let r = b.relative_position(a);
        let relative = a.rotation.conjugate() * b.rotation;
        RelativeMotion {
            B,
            r,
            u: b.v - a.v - a.omega.cross(&r),
            w: b.omega - a.omega,
            d: B.tr_mul(&r) - self.offset,
            phi: self.axes.tr_mul(&rotation::log(&relative)),
        }
    }

    /// The coefficients of translation and of rotation.
    fn coefficients(values: &[f64; 6]) -> (Vec3, Vec3) {
        let [a, b, c, d, e, f] = *values;
        (Vec3::new(a, b, c), Vec3::new(d, e, f))
    }

    /// Force and moment on the second node, global components.
    fn forces(&self, motion: &RelativeMotion) -> (Vec3, Vec3) {
        let (k, k_phi) = Self::coefficients(&self.stiffness);
        let (c, c_phi) = Self::coefficients(&self.damping);
        let f = k.component_mul(&motion.d) + c.component_mul(&motion.B.tr_mul(&motion.u));
        let T_inv = rotation::inverse_tangent_matrix(&motion.phi);
        let m = T_inv.tr_mul(&k_phi.component_mul(&motion.phi)) + c_phi.component_mul(&motion.B.tr_mul(&motion.w));
        (motion.B * f, motion.B * m)
    }

    /// d, its rate along the first axis, force and moment on the second node; components in the frame.
    pub fn state(&self, nodes: &[Node]) -> (Vec3, f64, Vec3, Vec3) {
        let motion = self.motion(nodes);
        let (F, M) = self.forces(&motion);
        (motion.d, motion.B.column(0).dot(&motion.u), motion.B.tr_mul(&F), motion.B.tr_mul(&M))
    }
}

/// A group of bushings.
pub struct Bushings(pub Vec<Bushing>);

impl ElementBlock for Bushings {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.0[e].nodes
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_damped(&self) -> bool {
        self.0.iter().any(|b| b.damping.iter().any(|&c| c > 0.0))
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for bushing in &self.0 {
            let motion = bushing.motion(now.nodes);
            let (f, m) = bushing.forces(&motion);
            let [a, b] = bushing.nodes;
            subtract(&mut F[a], 0, &-f);
            subtract(&mut F[a], 3, &-(m + motion.r.cross(&f)));
            subtract(&mut F[b], 0, &f);
            subtract(&mut F[b], 3, &m);
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        let bushing = &self.0[e];
        let motion = bushing.motion(now.nodes);
        let (F, M) = bushing.forces(&motion);
        let omega = now.nodes[bushing.nodes[0]].omega;
        let (k, k_phi) = Bushing::coefficients(&bushing.stiffness);
        let (c, c_phi) = Bushing::coefficients(&bushing.damping);
        let B = motion.B;
        let global = |diagonal: &Vec3| B * Mat3::from_diagonal(diagonal) * B.transpose();
        let (k, c, c_phi) = (global(&k), global(&c), global(&c_phi));
        let T_inv = rotation::inverse_tangent_matrix(&motion.phi);
        let mu = k_phi.component_mul(&motion.phi);
        let k_phi = B
            * (T_inv.tr_mul(&Mat3::from_diagonal(&k_phi))
                + rotation::inverse_tangent_transpose_derivative(&motion.phi, &mu))
            * T_inv
            * B.transpose();
        let (r, u, w) = (skew(&motion.r), skew(&motion.u), skew(&motion.w));
        // δF = F_r δr + F_1 δθ₁ with δd = Bᵀ(δr + r~ δθ₁), δḋ = Bᵀ(δu + u~ δθ₁), δu = δv₂ − δv₁ + r~ δω₁ − ω₁~ δr.
        let F_r = k + c * (rate_weight * Mat3::identity() - skew(&omega));
        let F_1 = k * r + c * (u + rate_weight * r) - skew(&F);
        // δM = M_2 (δθ₂ − δθ₁) + M_1 δθ₁
        let M_2 = k_phi + rate_weight * c_phi;
        let M_1 = c_phi * w - skew(&M);
        let Z = Mat3::zeros();
        let dF = [-F_r, F_1, F_r, Z];
        let dM = [Z, M_1 - M_2, Z, M_2];
        for (column, (df, dm)) in dF.iter().zip(&dM).enumerate() {
            let mut moment = -dm - r * df; // of −(M + r × F)
            match column {
                0 => moment -= skew(&F),
                2 => moment += skew(&F),
                _ => {}
            }
            for (row, block) in [-df, moment, *df, *dm].iter().enumerate() {
                for i in 0..3 {
                    for j in 0..3 {
                        K[(3 * row + i) * 12 + 3 * column + j] = block[(i, j)];
                    }
                }
            }
        }
    }

    fn energy(&self, now: &Configuration) -> f64 {
        let energy = |b: &Bushing| {
            let motion = b.motion(now.nodes);
            let (k, k_phi) = Bushing::coefficients(&b.stiffness);
            0.5 * (k.component_mul(&motion.d).dot(&motion.d) + k_phi.component_mul(&motion.phi).dot(&motion.phi))
        };
        self.0.iter().map(energy).sum()
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        let power = |b: &Bushing| {
            let motion = b.motion(now.nodes);
            let (c, c_phi) = Bushing::coefficients(&b.damping);
            let (u, w) = (motion.B.tr_mul(&motion.u), motion.B.tr_mul(&motion.w));
            c.component_mul(&u).dot(&u) + c_phi.component_mul(&w).dot(&w)
        };
        self.0.iter().map(power).sum()
    }
}
