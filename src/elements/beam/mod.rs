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

mod fibres;
mod quaternion;
mod section;
mod tangent;

use super::{ElementBlock, Force, Moduli, subtract};
use crate::materials::{self, Bar, Dissipation, Law, StressState};
use crate::math::{Mat3, Vec3, quadrature};
use crate::sections::{Fibre, Stiffness};
use crate::state::{Configuration, Node};
use fibres::{Fibred, Profile};
use quaternion::{Quat, dot, left, right, right_unit, rotation, times_conjugate};
use schemars::JsonSchema;
pub use section::Elastic;
use section::Section;
use serde::Deserialize;
use std::sync::Arc;

/// Degree of the elements where the deck does not say. `scripts/speed.py --orders` measures it: orders 3 and 4 reach a given
/// error in about the same time, within a factor of two either way, and leave 1 and 2 far behind below an error of 1e-2.
pub const DEFAULT_ORDER: usize = 3;

/// Integration points of an element at most.
pub const MOST_POINTS: usize = 5;

/// The rule by which an element is integrated along its length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IntegrationRule {
    /// The most accurate for its number of points, which lie inside.
    #[default]
    Gauss,
    /// With points at the ends of the element, where clamped beams yield first.
    Lobatto,
}

impl IntegrationRule {
    fn points(self, n: usize) -> (&'static [f64], &'static [f64]) {
        match self {
            IntegrationRule::Gauss => quadrature::gauss(n),
            IntegrationRule::Lobatto => quadrature::lobatto(n),
        }
    }
}

/// Lagrange polynomials of the nodes, which are Lobatto points, at the integration points: `value[g][a]`, `slope[g][a]` (per
/// unit of ξ).
#[derive(Debug, Clone)]
struct Shape<const N: usize> {
    value: [[f64; N]; MOST_POINTS],
    slope: [[f64; N]; MOST_POINTS],
    weight: [f64; MOST_POINTS],
    xi: &'static [f64],
}

impl<const N: usize> Shape<N> {
    fn new((points, weights): (&'static [f64], &[f64])) -> Self {
        let (nodes, _) = quadrature::lobatto(N);
        let zero = [[0.0; N]; MOST_POINTS];
        let mut shape = Shape { value: zero, slope: zero, weight: [0.0; MOST_POINTS], xi: points };
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
struct Beam<const N: usize, S> {
    nodes: [usize; N],
    /// dx/dξ: half the length.
    jacobian: f64,
    /// Where the nodes lay at t = 0.
    start: [Vec3; N],
    /// Unit tangent of the undeformed axis.
    tangent: Vec3,
    section: S,
}

/// Motion of an integration point.
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
pub struct Beams<const N: usize, S = Elastic> {
    shape: Shape<N>,
    elements: Vec<Beam<N, S>>,
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
    /// Elastic beams. `x`: initial positions of all nodes; `damping`: factor of stiffness-proportional damping (time).
    pub fn new<'a>(elements: impl Iterator<Item = Description<'a>>, x: &[Vec3], damping: f64) -> Self {
        let section = |e: &Description, length: f64| match N {
            2 => Elastic::new(&with_bending_flexibility(e.stiffness, length), e.frame),
            _ => Elastic::new(e.stiffness, e.frame),
        };
        Beams::build(elements, x, damping, IntegrationRule::Gauss.points(N - 1), section)
    }
}

/// How the material of a beam yields.
#[derive(Debug, Clone)]
pub struct Yielding {
    pub law: Law,
    pub fibres: Vec<Fibre>,
    /// Shear stress counts in the yield condition; otherwise shear and torsion stay elastic.
    pub shear: bool,
    pub rule: IntegrationRule,
    /// Integration points of an element, as many as its order at least.
    pub points: usize,
}

impl Yielding {
    /// Beams of N nodes, all of one section. The two-node element goes without the correction of its shear stiffness, which
    /// is that of an elastic beam.
    pub fn beams<'a, const N: usize>(
        &self,
        elements: impl Iterator<Item = Description<'a>>,
        x: &[Vec3],
        damping: f64,
    ) -> Box<dyn ElementBlock> {
        match self.shear {
            true => self.fibred::<N, _, 3>(materials::Fibre, elements, x, damping),
            false => self.fibred::<N, _, 1>(Bar, elements, x, damping),
        }
    }

    fn fibred<'a, const N: usize, S: StressState<C> + 'static, const C: usize>(
        &self,
        state: S,
        elements: impl Iterator<Item = Description<'a>>,
        x: &[Vec3],
        damping: f64,
    ) -> Box<dyn ElementBlock> {
        let (mut profile, mut first) = (None, 0);
        let section = |e: &Description, _| {
            let of = || Arc::new(Profile::new(&self.law, state, &self.fibres, e.stiffness));
            let section = Fibred::new(profile.get_or_insert_with(of), e.stiffness, e.frame, first, self.points);
            first += section.history();
            section
        };
        Box::new(Beams::<N, Fibred<S, C>>::build(elements, x, damping, self.rule.points(self.points), section))
    }
}

impl<const N: usize, S: Section> Beams<N, S> {
    /// `section` makes the sections of an element of given length.
    fn build<'a>(
        elements: impl Iterator<Item = Description<'a>>,
        x: &[Vec3],
        damping: f64,
        rule: (&'static [f64], &[f64]),
        mut section: impl FnMut(&Description, f64) -> S,
    ) -> Self {
        let elements = elements
            .map(|e| {
                let mut nodes = [0; N];
                nodes.copy_from_slice(&e.nodes[..N]);
                let axis = x[nodes[N - 1]] - x[nodes[0]];
                let length = axis.norm();
                let start = nodes.map(|node| x[node]);
                Beam { nodes, start, jacobian: 0.5 * length, tangent: axis / length, section: section(&e, length) }
            })
            .collect();
        Beams { shape: Shape::new(rule), elements, damping }
    }

    /// Quaternions of the nodes, all in the half-space of the first (q and −q are the same rotation), and how much further than
    /// the first they have moved. Strains come from that: positions have fewer digits where the origin is far, or displacements
    /// are small.
    #[inline(always)]
    fn gather(&self, element: &Beam<N, S>, nodes: &[Node]) -> ([Quat; N], [Vec3; N]) {
        let mut q = [[0.0; 4]; N];
        let mut u = [Vec3::zeros(); N];
        let [first, first_low] = nodes[element.nodes[0]].parts(&element.start[0]);
        for a in 0..N {
            let node = &nodes[element.nodes[a]];
            q[a] = [node.q.w, node.q.i, node.q.j, node.q.k];
            let [high, low] = node.parts(&element.start[a]);
            u[a] = (high - first) + (low - first_low);
            if a > 0 && dot(&q[a], &q[0]) < 0.0 {
                q[a] = q[a].map(|c| -c);
            }
        }
        (q, u)
    }

    #[inline(always)]
    fn locate(&self, element: &Beam<N, S>, g: usize, (q, u): &([Quat; N], [Vec3; N])) -> Point {
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
        // Γ = Rᵀu′ + (Rᵀ − 1) r₀′, without the digits that Rᵀr′ − r₀′ would lose.
        let across = pv.cross(&element.tangent);
        let gamma = R.tr_mul(&dr) + 2.0 * inv * (pv.cross(&across) - p[0] * across);
        dr += element.tangent;
        // κ = 2 vec(p̄ p′)/|p|²
        let dv = Vec3::new(dp[1], dp[2], dp[3]);
        let kappa = 2.0 * inv * (p[0] * dv - dp[0] * pv - pv.cross(&dv));
        Point { p, dp, dr, R, inv, gamma, kappa }
    }

    /// Strain rates, the direction ż they come from, for nodal velocities.
    #[inline(always)]
    fn rates(
        &self,
        element: &Beam<N, S>,
        g: usize,
        point: &Point,
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
fn strain_matrix<const N: usize, S>(element: &Beam<N, S>, point: &Point) -> StrainMatrix {
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

impl<const N: usize, S: Section> ElementBlock for Beams<N, S> {
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

    fn history(&self) -> usize {
        self.elements.iter().map(|e| e.section.history()).sum()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        let nodes = now.nodes;
        for element in &self.elements {
            let motion = self.gather(element, nodes);
            let q = &motion.0;
            let mut gradient = [[0.0; 4]; N]; // ∂U/∂q_a
            let mut force = [Vec3::zeros(); N];
            for g in 0..self.points() {
                let point = self.locate(element, g, &motion);
                let (mut n, mut m) = element.section.stress(g, &point.gamma, &point.kappa, now);
                if self.damping > 0.0 {
                    let (gamma_rate, kappa_rate, _) = self.rates(element, g, &point, q, nodes);
                    let (nd, md) = element.section.elastic().stress(&gamma_rate, &kappa_rate);
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

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        if self.damping > 0.0 {
            self.tangent_of::<true>(e, now, rate_weight, moduli, K);
        } else {
            self.tangent_of::<false>(e, now, rate_weight, moduli, K);
        }
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        let mut sum = Dissipation::default();
        for element in &self.elements {
            let motion = self.gather(element, now.nodes);
            for g in 0..self.points() {
                let point = self.locate(element, g, &motion);
                let spent = element.section.update_history(g, (&point.gamma, &point.kappa), now, part, history);
                sum += spent * (self.shape.weight[g] * element.jacobian);
            }
        }
        sum
    }

    fn energy(&self, now: &Configuration) -> f64 {
        let mut sum = 0.0;
        for element in &self.elements {
            let motion = self.gather(element, now.nodes);
            for g in 0..self.points() {
                let point = self.locate(element, g, &motion);
                let energy = element.section.energy(g, &point.gamma, &point.kappa, now);
                sum += self.shape.weight[g] * element.jacobian * energy;
            }
        }
        sum
    }

    #[inline(always)]
    fn points(&self) -> usize {
        S::points(N, self.shape.xi.len())
    }

    fn point(&self, e: usize, g: usize, frame: &Mat3, now: &Configuration) -> Option<super::Point> {
        let element = &self.elements[e];
        let point = self.locate(element, g, &self.gather(element, now.nodes));
        let (n, m) = element.section.stress(g, &point.gamma, &point.kappa, now);
        let (n, m) = (frame.tr_mul(&n), frame.tr_mul(&m));
        Some(super::Point {
            s: element.jacobian * (1.0 + self.shape.xi[g]),
            forces: [n.x, n.y, n.z, m.x, m.y, m.z],
            plastic_strain: element.section.plastic_strain(g, now.history),
        })
    }

    fn plastic_strain(&self, e: usize, past: &[f64]) -> f64 {
        (0..self.points()).map(|g| self.elements[e].section.plastic_strain(g, past)).fold(0.0, f64::max)
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        let nodes = now.nodes;
        if self.damping == 0.0 {
            return 0.0;
        }
        let mut sum = 0.0;
        for element in &self.elements {
            let motion = self.gather(element, nodes);
            for g in 0..self.points() {
                let point = self.locate(element, g, &motion);
                let (gamma, kappa, _) = self.rates(element, g, &point, &motion.0, nodes);
                let (n, m) = element.section.elastic().stress(&gamma, &kappa);
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
