//! Geometrically exact, shear-flexible beam (Simo-Reissner) with N nodes on a straight, stress-free axis.
//!
//! Strains in the undeformed section axes: Γ = Rᵀ r′ − r₀′ and κ = axial(Rᵀ R′) (Simo & Vu-Quoc 1986), R measured from
//! the undeformed state. Positions and rotation quaternions are interpolated by the Lagrange polynomials of the N Lobatto
//! points, p = Σ N_a q_a, and R = R(p/|p|): frame-invariant, free of path and of singularities (an element may bend by
//! up to half a turn), and polynomial but for |p|². Integration by N − 1 Gauss points keeps it from locking and makes
//! it a mixed method: end nodes converge as h^(2N−2), and for N ≥ 3 small loads at nodes give exact nodal displacements.
//! For N = 2 the shear flexibility is raised by h²/12EI (MacNeal 1978), which makes its small-strain stiffness that of
//! the exact beam in the corotating mean frame of its ends.
//!
//! Everything is differentiated in the eleven numbers z = (p, p′, r′) of a Gauss point, where energy is
//! U(z) = ½ ε·C·ε: gradient g = Bᵀσ and Hessian H = BᵀCB + σ·∂²ε. Nodes enter linearly through the shape functions; a
//! spatial rotation δθ of node a changes its quaternion by ½ δθ q_a.
//! Left out: warping of the section, initial curvature.

mod quaternion;
mod tangent;

use super::{Block, Force, subtract};
use crate::math::{Mat3, Vec3, quadrature};
use crate::sections::Stiffness;
use crate::state::Node;
use quaternion::{Quat, dot, left, right, right_unit, rotation, times_conjugate};

/// Degree of the elements where the deck does not say. `scripts/speed.py --orders` measures it: orders 3 and 4 reach a given
/// error in about the same time, within a factor of two either way, and leave 1 and 2 far behind below an error of 1e-2.
pub const DEFAULT_ORDER: usize = 3;

/// Lagrange polynomials of the Lobatto points at the Gauss points: `value[g][a]`, `slope[g][a]` (per unit of ξ).
#[derive(Debug, Clone)]
struct Shape<const N: usize> {
    value: [[f64; N]; 4],
    slope: [[f64; N]; 4],
    weight: [f64; 4],
}

impl<const N: usize> Shape<N> {
    fn new() -> Self {
        let (nodes, _) = quadrature::lobatto(N);
        let (points, weights) = quadrature::gauss(N - 1);
        let mut shape = Shape { value: [[0.0; N]; 4], slope: [[0.0; N]; 4], weight: [0.0; 4] };
        for (g, (&xi, &w)) in points.iter().zip(weights).enumerate() {
            shape.weight[g] = w;
            for a in 0..N {
                let others = || (0..N).filter(move |&b| b != a);
                let factor = |b: usize| (xi - nodes[b]) / (nodes[a] - nodes[b]);
                shape.value[g][a] = others().map(factor).product();
                shape.slope[g][a] = others()
                    .map(|c| others().filter(|&b| b != c).map(factor).product::<f64>() / (nodes[a] - nodes[c]))
                    .sum();
            }
        }
        shape
    }
}

/// One element.
#[derive(Debug, Clone)]
struct Beam<const N: usize> {
    nodes: [usize; N],
    /// dx/dξ: half the length.
    jacobian: f64,
    /// Unit tangent of the undeformed axis.
    tangent: Vec3,
    /// Stiffness of the section in global axes at t = 0.
    C: Section,
}

/// σ = C ε with ε = (Γ, κ).
#[derive(Debug, Clone)]
struct Section {
    N: Mat3,
    M: Mat3,
    NM: Mat3,
    /// NM is not zero.
    coupled: bool,
}

impl Section {
    #[inline]
    fn stress(&self, gamma: &Vec3, kappa: &Vec3) -> (Vec3, Vec3) {
        let (mut n, mut m) = (self.N * gamma, self.M * kappa);
        if self.coupled {
            n += self.NM * kappa;
            m += self.NM.tr_mul(gamma);
        }
        (n, m)
    }
}

/// What a Gauss point needs of the nodes.
struct Point {
    p: Quat,
    dp: Quat,
    dr: Vec3,
    R: Mat3,
    /// 1/|p|².
    inv: f64,
    gamma: Vec3,
    kappa: Vec3,
}

/// Beams of N nodes.
pub struct Beams<const N: usize> {
    shape: Shape<N>,
    elements: Vec<Beam<N>>,
    /// Rayleigh factor on the stiffness: stress += factor · C · strain rate.
    damping: f64,
}

/// What the deck's part says of one element.
pub struct Description<'a> {
    pub nodes: &'a [usize],
    pub frame: &'a Mat3,
    pub stiffness: &'a Stiffness,
}

impl<const N: usize> Beams<N> {
    /// `x`: initial positions of all nodes; `damping`: factor of stiffness-proportional damping (time).
    pub fn new<'a>(elements: impl Iterator<Item = Description<'a>>, x: &[Vec3], damping: f64) -> Self {
        let elements = elements
            .map(|e| {
                let mut nodes = [0; N];
                nodes.copy_from_slice(&e.nodes[..N]);
                let axis = x[nodes[N - 1]] - x[nodes[0]];
                let length = axis.norm();
                let section = if N == 2 { with_bending_flexibility(e.stiffness, length) } else { e.stiffness.clone() };
                let turn = |C: &Mat3| e.frame * C * e.frame.transpose();
                Beam {
                    nodes,
                    jacobian: 0.5 * length,
                    tangent: axis / length,
                    C: Section {
                        N: turn(&section.N),
                        M: turn(&section.M),
                        NM: turn(&section.NM),
                        coupled: section.NM != Mat3::zeros(),
                    },
                }
            })
            .collect();
        Beams { shape: Shape::new(), elements, damping }
    }

    /// Quaternions of the nodes, all in the half-space of the first (q and −q are the same rotation).
    #[inline(always)]
    fn gather(&self, element: &Beam<N>, nodes: &[Node]) -> ([Quat; N], [Vec3; N]) {
        let mut q = [[0.0; 4]; N];
        let mut x = [Vec3::zeros(); N];
        for a in 0..N {
            let node = &nodes[element.nodes[a]];
            q[a] = [node.q.w, node.q.i, node.q.j, node.q.k];
            x[a] = node.x;
            if a > 0 && dot(&q[a], &q[0]) < 0.0 {
                q[a] = q[a].map(|c| -c);
            }
        }
        (q, x)
    }

    #[inline(always)]
    fn point(&self, element: &Beam<N>, g: usize, (q, x): &([Quat; N], [Vec3; N])) -> Point {
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
            dr += slope * x[a];
        }
        let inv = 1.0 / dot(&p, &p);
        let R = rotation(&p, inv);
        let gamma = R.tr_mul(&dr) - element.tangent;
        // κ = 2 vec(p̄ p′)/|p|²
        let pv = Vec3::new(p[1], p[2], p[3]);
        let dv = Vec3::new(dp[1], dp[2], dp[3]);
        let kappa = 2.0 * inv * (p[0] * dv - dp[0] * pv - pv.cross(&dv));
        Point { p, dp, dr, R, inv, gamma, kappa }
    }

    /// Strain rates, the direction ż they come from, for nodal velocities.
    #[inline(always)]
    fn rates(&self, element: &Beam<N>, g: usize, point: &Point, q: &[Quat; N], nodes: &[Node]) -> (Vec3, Vec3, Rate) {
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
struct Rate {
    p: Quat,
    dp: Quat,
    dr: Vec3,
}

/// Rows of B = ∂ε/∂z; ∂Γ/∂r′ = Rᵀ and ∂Γ/∂p′ = ∂κ/∂r′ = 0 are not stored.
struct StrainMatrix {
    gamma_p: [Quat; 3],
    kappa_p: [Quat; 3],
    kappa_dp: [Quat; 3],
}

/// |p|² Γ_i + … = vec(p̄ r′ p)·e_i and |p|² κ_i = 2 vec(p̄ p′)·e_i, differentiated with their common divisor |p|².
#[inline(always)]
fn strain_matrix<const N: usize>(element: &Beam<N>, point: &Point) -> StrainMatrix {
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

impl<const N: usize> Block for Beams<N> {
    fn len(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.elements[e].nodes
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_damped(&self) -> bool {
        self.damping > 0.0
    }

    fn subtract_forces(&self, nodes: &[Node], F: &mut [Force]) {
        for element in &self.elements {
            let motion = self.gather(element, nodes);
            let q = &motion.0;
            let mut gradient = [[0.0; 4]; N]; // ∂U/∂q_a
            let mut force = [Vec3::zeros(); N];
            for g in 0..N - 1 {
                let point = self.point(element, g, &motion);
                let (mut n, mut m) = element.C.stress(&point.gamma, &point.kappa);
                if self.damping > 0.0 {
                    let (gamma_rate, kappa_rate, _) = self.rates(element, g, &point, q, nodes);
                    let (nd, md) = element.C.stress(&gamma_rate, &kappa_rate);
                    n += self.damping * nd;
                    m += self.damping * md;
                }
                // σ·∂ε/∂p = −2 (r′ p n + p′ m + (σ·e) p)/|p|², σ·∂ε/∂p′ = 2 p m/|p|².
                let sigma_e = n.dot(&(point.gamma + element.tangent)) + m.dot(&point.kappa);
                let rpn = right(&left(&point.dr, &point.p), &n);
                let dpm = right(&point.dp, &m);
                let pm = right(&point.p, &m);
                let w = self.shape.weight[g] * element.jacobian;
                let w2 = 2.0 * point.inv * w;
                let n_global = point.R * n;
                for a in 0..N {
                    let value = -w2 * self.shape.value[g][a];
                    let slope = w2 * self.shape.slope[g][a] / element.jacobian;
                    for k in 0..4 {
                        gradient[a][k] += value * (rpn[k] + dpm[k] + sigma_e * point.p[k]) + slope * pm[k];
                    }
                    force[a] += (self.shape.weight[g] * self.shape.slope[g][a]) * n_global;
                }
            }
            for a in 0..N {
                let f = &mut F[element.nodes[a]];
                subtract(f, 0, &force[a]);
                subtract(f, 3, &(0.5 * times_conjugate(&gradient[a], &q[a]).1));
            }
        }
    }

    fn tangent(&self, e: usize, nodes: &[Node], rate_weight: f64, K: &mut [f64]) {
        if self.damping > 0.0 {
            self.tangent_of::<true>(e, nodes, rate_weight, K);
        } else {
            self.tangent_of::<false>(e, nodes, rate_weight, K);
        }
    }

    fn energy(&self, nodes: &[Node]) -> f64 {
        let mut sum = 0.0;
        for element in &self.elements {
            let motion = self.gather(element, nodes);
            for g in 0..N - 1 {
                let point = self.point(element, g, &motion);
                let (n, m) = element.C.stress(&point.gamma, &point.kappa);
                sum += 0.5 * self.shape.weight[g] * element.jacobian * (n.dot(&point.gamma) + m.dot(&point.kappa));
            }
        }
        sum
    }

    fn resultants(&self, e: usize, g: usize, frame: &Mat3, nodes: &[Node]) -> Option<(f64, [f64; 6])> {
        let element = &self.elements[e];
        let point = self.point(element, g, &self.gather(element, nodes));
        let (n, m) = element.C.stress(&point.gamma, &point.kappa);
        let (n, m) = (frame.tr_mul(&n), frame.tr_mul(&m));
        let xi = quadrature::gauss(N - 1).0[g];
        Some((element.jacobian * (1.0 + xi), [n.x, n.y, n.z, m.x, m.y, m.z]))
    }

    fn damping_power(&self, nodes: &[Node]) -> f64 {
        if self.damping == 0.0 {
            return 0.0;
        }
        let mut sum = 0.0;
        for element in &self.elements {
            let motion = self.gather(element, nodes);
            for g in 0..N - 1 {
                let point = self.point(element, g, &motion);
                let (gamma, kappa, _) = self.rates(element, g, &point, &motion.0, nodes);
                let (n, m) = element.C.stress(&gamma, &kappa);
                sum += self.damping * self.shape.weight[g] * element.jacobian * (n.dot(&gamma) + m.dot(&kappa));
            }
        }
        sum
    }
}

/// The exact beam's flexibility of bending within the element, put into the shear stiffness: 1/GA + h²/12EI
/// (MacNeal, J. Struct. Mech. 6, 1978). The shear centre stays where it is.
fn with_bending_flexibility(section: &Stiffness, length: f64) -> Stiffness {
    let mut out = section.clone();
    let shear = section.N.fixed_view::<2, 2>(1, 1).into_owned();
    let bending = section.M.fixed_view::<2, 2>(1, 1).into_owned();
    let (Some(shear_flexibility), Some(f)) = (shear.try_inverse(), bending.try_inverse()) else { return out };
    // Q_y bends about z, Q_z about −y.
    let swapped = nalgebra::Matrix2::new(f[(1, 1)], -f[(0, 1)], -f[(1, 0)], f[(0, 0)]);
    let Some(reduced) = (shear_flexibility + swapped * (length * length / 12.0)).try_inverse() else { return out };
    let arm = shear_flexibility * section.NM.fixed_view::<2, 1>(1, 0);
    let coupling = reduced * arm;
    out.N.fixed_view_mut::<2, 2>(1, 1).copy_from(&reduced);
    out.M[(0, 0)] += (arm.tr_mul(&(reduced - shear)) * arm)[(0, 0)];
    out.NM.fixed_view_mut::<2, 1>(1, 0).copy_from(&coupling);
    out
}
