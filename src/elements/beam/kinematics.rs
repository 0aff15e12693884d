//! Kinematics of a beam: from the motion of its nodes to strains, strain rates and their derivatives at a Gauss point.

use super::quaternion::{Quat, dot, left, right_unit, rotation};
use super::section::{BeamSection, BeamStiffness};
use super::shape::ShapeFunctions;
use crate::math::{Mat3, Vec3};
use crate::state::Node;

/// A group of beams of N nodes, whose sections are of type `S`.
pub struct Beams<const N: usize, S = BeamStiffness> {
    /// The shape functions at the integration points, the same for all elements.
    pub(super) shape: ShapeFunctions<N>,
    /// The elements.
    pub(super) elements: Vec<Beam<N, S>>,
    /// Rayleigh factor on the stiffness (time): stress += factor · C · strain rate.
    pub(super) damping: f64,
}

/// One element.
#[derive(Debug, Clone)]
pub(super) struct Beam<const N: usize, S> {
    /// Nodes from one end to the other.
    pub nodes: [usize; N],
    /// dx/dξ: half the length.
    pub jacobian: f64,
    /// Positions of the nodes at t = 0.
    pub start: [Vec3; N],
    /// Unit tangent of the undeformed axis.
    pub tangent: Vec3,
    /// The sections at its integration points.
    pub section: S,
}

/// Motion and strains of a Gauss point.
pub(super) struct GaussPoint {
    /// The interpolated quaternion p, whose length is not one.
    pub p: Quat,
    /// Its derivative p′ along the axis.
    pub dp: Quat,
    /// r′.
    pub dr: Vec3,
    /// Rotation of the section from the undeformed state.
    pub R: Mat3,
    /// 1/|p|².
    pub inv: f64,
    /// Force strains Γ, in the undeformed section axes.
    pub gamma: Vec3,
    /// Curvatures κ, in the undeformed section axes.
    pub kappa: Vec3,
}

impl<const N: usize, S: BeamSection> Beams<N, S> {
    /// The number of integration points of an element.
    #[inline(always)]
    pub(super) fn integration_points(&self) -> usize {
        S::points(N, self.shape.xi.len())
    }

    /// Quaternions of the nodes, all in the half-space of the first (q and −q are the same rotation), and their displacements
    /// less that of the first. Strains come from displacements because positions have fewer digits where the origin is far, or
    /// displacements are small.
    #[inline(always)]
    pub(super) fn gather(&self, element: &Beam<N, S>, nodes: &[Node]) -> ([Quat; N], [Vec3; N]) {
        let mut q = [[0.0; 4]; N];
        let mut u = [Vec3::zeros(); N];
        let [first, first_low] = nodes[element.nodes[0]].parts(&element.start[0]);
        for a in 0..N {
            let node = &nodes[element.nodes[a]];
            q[a] = [node.rotation.w, node.rotation.i, node.rotation.j, node.rotation.k];
            let [high, low] = node.parts(&element.start[a]);
            u[a] = (high - first) + (low - first_low);
            if a > 0 && dot(&q[a], &q[0]) < 0.0 {
                q[a] = q[a].map(|c| -c);
            }
        }
        (q, u)
    }

    /// Position, rotation and strains at Gauss point `g`, from the result of [`Beams::gather`].
    #[inline(always)]
    pub(super) fn interpolate(&self, element: &Beam<N, S>, g: usize, (q, u): &([Quat; N], [Vec3; N])) -> GaussPoint {
        let per_length = 1.0 / element.jacobian;
        let mut p = [0.0; 4];
        let mut dp = [0.0; 4];
        let mut dr = Vec3::zeros();
        for a in 0..N {
            let (value, slope) = (self.shape.value[g][a], self.shape.slope[g][a] * per_length);
            for i in 0..4 {
                p[i] += value * q[a][i];
                dp[i] += slope * q[a][i];
            }
            dr += slope * u[a];
        }
        let inv = 1.0 / dot(&p, &p);
        let R = rotation(&p, inv);
        let pv = Vec3::new(p[1], p[2], p[3]);
        // Γ = Rᵀu′ + (Rᵀ − 1) r₀′ keeps the digits that Rᵀr′ − r₀′ would lose.
        let across = pv.cross(&element.tangent);
        let gamma = R.tr_mul(&dr) + 2.0 * inv * (pv.cross(&across) - p[0] * across);
        dr += element.tangent;
        // κ = 2 vec(p̄ p′)/|p|²
        let dv = Vec3::new(dp[1], dp[2], dp[3]);
        let kappa = 2.0 * inv * (p[0] * dv - dp[0] * pv - pv.cross(&dv));
        GaussPoint { p, dp, dr, R, inv, gamma, kappa }
    }

    /// The strains Γ and κ from which the stress of a tangent follows: those extrapolated from the iterate before, see
    /// [`Configuration::lead`](crate::state::Configuration), or those of the point.
    #[inline(always)]
    pub(super) fn leading_strains(
        &self,
        element: &Beam<N, S>,
        g: usize,
        point: &GaussPoint,
        lead: Option<&[Node]>,
    ) -> (Vec3, Vec3) {
        let Some(nodes) = lead else { return (point.gamma, point.kappa) };
        let motion = self.gather(element, nodes);
        let before = self.interpolate(element, g, &motion);
        let (gamma, kappa, _) = self.rates(element, g, &before, &motion.0, nodes);
        (before.gamma + gamma, before.kappa + kappa)
    }

    /// Strain rates Γ̇ and κ̇ for the velocities of the nodes, and ż, from which they follow.
    #[inline(always)]
    pub(super) fn rates(
        &self,
        element: &Beam<N, S>,
        g: usize,
        point: &GaussPoint,
        q: &[Quat; N],
        nodes: &[Node],
    ) -> (Vec3, Vec3, Rate) {
        let per_length = 1.0 / element.jacobian;
        let mut rate = Rate { p: [0.0; 4], dp: [0.0; 4], dr: Vec3::zeros() };
        for a in 0..N {
            let node = &nodes[element.nodes[a]];
            let (value, slope) = (self.shape.value[g][a], self.shape.slope[g][a] * per_length);
            let qdot = left(&(0.5 * node.omega), &q[a]);
            for i in 0..4 {
                rate.p[i] += value * qdot[i];
                rate.dp[i] += slope * qdot[i];
            }
            rate.dr += slope * node.v;
        }
        let B = strain_matrix(element, point);
        let mut strain_rate = [0.0; 6];
        for i in 0..3 {
            strain_rate[i] = dot(&B.gamma_p[i], &rate.p) + point.R.column(i).dot(&rate.dr);
            strain_rate[3 + i] = dot(&B.kappa_p[i], &rate.p) + dot(&B.kappa_dp[i], &rate.dp);
        }
        let [a, b, c, d, e, f] = strain_rate;
        (Vec3::new(a, b, c), Vec3::new(d, e, f), rate)
    }
}

/// ż of a Gauss point.
pub(super) struct Rate {
    /// Rate of p.
    pub p: Quat,
    /// Rate of p′.
    pub dp: Quat,
    /// Rate of r′.
    pub dr: Vec3,
}

/// Rows of the strain matrix B = ∂ε/∂z; ∂Γ/∂r′ = Rᵀ and ∂Γ/∂p′ = ∂κ/∂r′ = 0 are not stored.
pub(super) struct StrainMatrix {
    /// ∂Γ/∂p, by rows.
    pub gamma_p: [Quat; 3],
    /// ∂κ/∂p, by rows.
    pub kappa_p: [Quat; 3],
    /// ∂κ/∂p′, by rows.
    pub kappa_dp: [Quat; 3],
}

/// The strain matrix at a point: |p|² Γ_i + … = vec(p̄ r′ p)·e_i and |p|² κ_i = 2 vec(p̄ p′)·e_i, differentiated with their
/// common divisor |p|².
#[inline(always)]
pub(super) fn strain_matrix<const N: usize, S>(element: &Beam<N, S>, point: &GaussPoint) -> StrainMatrix {
    let e = point.gamma + element.tangent;
    let rp = left(&point.dr, &point.p);
    let inv2 = 2.0 * point.inv;
    let mut B = StrainMatrix { gamma_p: [[0.0; 4]; 3], kappa_p: [[0.0; 4]; 3], kappa_dp: [[0.0; 4]; 3] };
    for i in 0..3 {
        let (rpe, dpe, pe) = (right_unit(&rp, i), right_unit(&point.dp, i), right_unit(&point.p, i));
        for k in 0..4 {
            B.gamma_p[i][k] = -inv2 * (rpe[k] + e[i] * point.p[k]);
            B.kappa_p[i][k] = -inv2 * (dpe[k] + point.kappa[i] * point.p[k]);
            B.kappa_dp[i][k] = inv2 * pe[k];
        }
    }
    B
}
