//! Kinematics of a beam, for one element or for eight side by side: strains, strain rates and their derivatives at a Gauss point.

use super::quaternion::{Quat, dot, left, right_unit, rotation, vector};
use super::section::{BeamSection, BeamStiffness};
use super::shape::ShapeFunctions;
use crate::elements::heat::HeatNodes;
use crate::state::Node;
use base::math::Vec3;
use base::math::lanes::LANES;
use base::math::number::{LaneVec3, Number};

/// A group of beams of N nodes, whose sections are of type `S`.
pub(super) struct Beams<const N: usize, S = BeamStiffness> {
    /// The shape functions at the integration points, the same for all elements.
    pub(super) shape: ShapeFunctions<N>,
    /// The elements.
    pub(super) elements: Vec<Beam<N, S>>,
    /// Rayleigh factor on the stiffness (time): stress += factor · C · strain rate.
    pub(super) damping: f64,
    /// Temperatures; `None` where nothing heats the beams.
    pub(super) heat: Option<BeamHeat>,
}

/// The temperatures of beams.
pub(super) struct BeamHeat {
    /// The numbers.
    pub nodes: HeatNodes,
    /// The axes y and z of the section of each element, at t = 0.
    pub axes: Vec<[Vec3; 2]>,
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

/// A pack of at most as many elements as a [`Number`] has lanes; lanes beyond the last element repeat it.
pub(super) struct Pack<'a, T, const N: usize> {
    /// The number of elements.
    pub count: usize,
    /// The shape functions at the integration points.
    pub shape: &'a ShapeFunctions<N>,
    /// Nodes by lane, and their positions at t = 0.
    nodes: [&'a [usize; N]; LANES],
    start: [&'a [Vec3; N]; LANES],
    /// Half their lengths, and the inverse.
    pub jacobian: T,
    per_length: T,
    /// Unit tangents of their undeformed axes.
    pub tangent: LaneVec3<T>,
}

/// Motion of the nodes of elements: quaternions, all in the half-space of the first (q and −q are the same rotation), and displacements
/// less that of the first. Strains come from displacements because positions have fewer digits where the origin is far, or
/// displacements are small.
pub(super) struct BeamMotion<T, const N: usize> {
    pub q: [Quat<T>; N],
    pub u: [LaneVec3<T>; N],
}

/// Motion and strains of a Gauss point.
pub(super) struct GaussPoint<T> {
    /// The interpolated quaternion p, whose length is not one.
    pub p: Quat<T>,
    /// Its derivative p′ along the axis.
    pub dp: Quat<T>,
    /// r′.
    pub dr: LaneVec3<T>,
    /// Rotation of the section from the undeformed state, columns.
    pub R: [LaneVec3<T>; 3],
    /// 1/|p|².
    pub inv: T,
    /// Force strains Γ and curvatures κ, in the undeformed section axes.
    pub strain: [LaneVec3<T>; 2],
}

impl GaussPoint<f64> {
    /// Γ and κ.
    #[inline(always)]
    pub fn strains(&self) -> (Vec3, Vec3) {
        (self.strain[0].lane(0), self.strain[1].lane(0))
    }
}

/// The displacement from `start` to `x` + `low` as a sum of two vectors, see [`Node::parts`].
#[inline(always)]
fn parts<T: Number>([x, low, start]: [LaneVec3<T>; 3]) -> [LaneVec3<T>; 2] {
    let sum = x - start;
    let c = sum - x;
    [sum, (x - (sum - c)) - (start + c) + low]
}

impl<'a, T: Number, const N: usize> Pack<'a, T, N> {
    /// The pack of some elements.
    #[inline(always)]
    pub fn new<S>(elements: &'a [Beam<N, S>], shape: &'a ShapeFunctions<N>) -> Self {
        let at = |lane: usize| &elements[lane.min(elements.len() - 1)];
        let jacobian = T::gather(|lane| at(lane).jacobian);
        let (mut nodes, mut start) = ([&at(0).nodes; LANES], [&at(0).start; LANES]);
        for lane in 1..LANES {
            (nodes[lane], start[lane]) = (&at(lane).nodes, &at(lane).start);
        }
        Pack {
            count: elements.len(),
            shape,
            nodes,
            start,
            jacobian,
            per_length: T::splat(1.0) / jacobian,
            tangent: LaneVec3::gather(|lane| at(lane).tangent),
        }
    }

    /// A vector of node `a` of each element.
    #[inline(always)]
    pub fn of_node(&self, a: usize, nodes: &[Node], of: impl Fn(&Node) -> Vec3) -> LaneVec3<T> {
        LaneVec3::gather(|lane| of(&nodes[self.nodes[lane][a]]))
    }

    /// The motion of the nodes of the elements.
    #[inline(always)]
    pub fn gather(&self, nodes: &[Node]) -> BeamMotion<T, N> {
        let mut motion = BeamMotion { q: [[T::ZERO; 4]; N], u: [LaneVec3::ZERO; N] };
        let mut first = [LaneVec3::ZERO; 2];
        for a in 0..N {
            let node = |lane: usize| &nodes[self.nodes[lane][a]];
            let q = [
                T::gather(|lane| node(lane).rotation.w),
                T::gather(|lane| node(lane).rotation.i),
                T::gather(|lane| node(lane).rotation.j),
                T::gather(|lane| node(lane).rotation.k),
            ];
            let [high, low] = parts([
                self.of_node(a, nodes, |node| node.x),
                self.of_node(a, nodes, |node| node.low),
                LaneVec3::gather(|lane| self.start[lane][a]),
            ]);
            if a == 0 {
                first = [high, low];
                motion.q[0] = q;
                continue;
            }
            motion.u[a] = (high - first[0]) + (low - first[1]);
            let along = dot(&q, &motion.q[0]);
            (0..4).for_each(|i| motion.q[a][i] = q[i].with_sign_of(along));
        }
        motion
    }

    /// Position, rotation and strains at Gauss point `g`.
    #[inline(always)]
    pub fn interpolate(&self, g: usize, BeamMotion { q, u }: &BeamMotion<T, N>) -> GaussPoint<T> {
        let mut p = [T::ZERO; 4];
        let mut dp = [T::ZERO; 4];
        let mut dr = LaneVec3::ZERO;
        for a in 0..N {
            let (value, slope) = self.at_node(g, a);
            for i in 0..4 {
                p[i] += value * q[a][i];
                dp[i] += slope * q[a][i];
            }
            dr += slope * u[a];
        }
        let inv = T::splat(1.0) / dot(&p, &p);
        let R = rotation(&p, inv);
        let (pv, dv) = (vector(&p), vector(&dp));
        let inv2 = T::splat(2.0) * inv;
        // Γ = Rᵀu′ + (Rᵀ − 1) r₀′ keeps the digits that Rᵀr′ − r₀′ would lose.
        let across = pv.cross(&self.tangent);
        let turned = LaneVec3([R[0].dot(&dr), R[1].dot(&dr), R[2].dot(&dr)]);
        let gamma = turned + inv2 * (pv.cross(&across) - p[0] * across);
        // κ = 2 vec(p̄ p′)/|p|²
        let kappa = inv2 * (p[0] * dv - dp[0] * pv - pv.cross(&dv));
        GaussPoint { p, dp, dr: dr + self.tangent, R, inv, strain: [gamma, kappa] }
    }

    /// Value and slope at Gauss point `g` of the shape function of node `a`.
    #[inline(always)]
    pub fn at_node(&self, g: usize, a: usize) -> (T, T) {
        (T::splat(self.shape.value[g][a]), T::splat(self.shape.slope[g][a]) * self.per_length)
    }

    /// The weight of Gauss point `g` in an integral along the axis.
    #[inline(always)]
    pub fn weight(&self, g: usize) -> T {
        T::splat(self.shape.weight[g]) * self.jacobian
    }

    /// The strains Γ and κ for the stress of a tangent: extrapolated from the previous iterate, see
    /// [`Configuration::previous`](crate::state::Configuration), or those of the point.
    #[inline(always)]
    pub fn leading_strains(
        &self,
        g: usize,
        point: &GaussPoint<T>,
        previous: Option<(&[Node], &BeamMotion<T, N>)>,
    ) -> [LaneVec3<T>; 2] {
        let Some((nodes, motion)) = previous else { return point.strain };
        let before = self.interpolate(g, motion);
        let ([gamma, kappa], _) = self.rates(g, &before, &motion.q, nodes);
        [before.strain[0] + gamma, before.strain[1] + kappa]
    }

    /// Strain rates Γ̇ and κ̇ for the velocities of the nodes, and the underlying ż.
    #[inline(always)]
    pub fn rates(
        &self,
        g: usize,
        point: &GaussPoint<T>,
        q: &[Quat<T>; N],
        nodes: &[Node],
    ) -> ([LaneVec3<T>; 2], Rate<T>) {
        let mut rate = Rate { p: [T::ZERO; 4], dp: [T::ZERO; 4], dr: LaneVec3::ZERO };
        for a in 0..N {
            let (value, slope) = self.at_node(g, a);
            let qdot = left(&(T::splat(0.5) * self.of_node(a, nodes, |node| node.omega)), &q[a]);
            for i in 0..4 {
                rate.p[i] += value * qdot[i];
                rate.dp[i] += slope * qdot[i];
            }
            rate.dr += slope * self.of_node(a, nodes, |node| node.v);
        }
        let B = strain_matrix(&self.tangent, point);
        let gamma = |i: usize| dot(&B.gamma_p[i], &rate.p) + point.R[i].dot(&rate.dr);
        let kappa = |i: usize| dot(&B.kappa_p[i], &rate.p) + dot(&B.kappa_dp[i], &rate.dp);
        ([LaneVec3([gamma(0), gamma(1), gamma(2)]), LaneVec3([kappa(0), kappa(1), kappa(2)])], rate)
    }
}

/// One instance for all sections and all that is asked of an element once a step.
impl<const N: usize> Pack<'_, f64, N> {
    /// [`Pack::gather`] of one element.
    #[inline(never)]
    pub fn motion(&self, nodes: &[Node]) -> BeamMotion<f64, N> {
        self.gather(nodes)
    }

    /// [`Pack::interpolate`] of one element.
    #[inline(never)]
    pub fn point(&self, g: usize, motion: &BeamMotion<f64, N>) -> GaussPoint<f64> {
        self.interpolate(g, motion)
    }

    /// Γ̇ and κ̇ of one element, see [`Pack::rates`].
    #[inline(never)]
    pub fn strain_rates(&self, g: usize, motion: &BeamMotion<f64, N>, nodes: &[Node]) -> (Vec3, Vec3) {
        let point = self.interpolate(g, motion);
        let ([gamma, kappa], _) = self.rates(g, &point, &motion.q, nodes);
        (gamma.lane(0), kappa.lane(0))
    }
}

impl<const N: usize, S: BeamSection> Beams<N, S> {
    /// The number of integration points of an element.
    #[inline(always)]
    pub(super) fn integration_points(&self) -> usize {
        S::points(N, self.shape.xi.len())
    }

    /// The pack of one element, and the motion of its nodes.
    #[inline(always)]
    pub(super) fn one(&self, e: usize, nodes: &[Node]) -> (Pack<'_, f64, N>, BeamMotion<f64, N>) {
        let pack = Pack::new(&self.elements[e..=e], &self.shape);
        let motion = pack.motion(nodes);
        (pack, motion)
    }
}

/// ż of a Gauss point.
pub(super) struct Rate<T> {
    /// Rate of p.
    pub p: Quat<T>,
    /// Rate of p′.
    pub dp: Quat<T>,
    /// Rate of r′.
    pub dr: LaneVec3<T>,
}

/// Rows of the strain matrix B = ∂ε/∂z; ∂Γ/∂r′ = Rᵀ and ∂Γ/∂p′ = ∂κ/∂r′ = 0 are not stored.
pub(super) struct StrainMatrix<T> {
    /// ∂Γ/∂p, by rows.
    pub gamma_p: [Quat<T>; 3],
    /// ∂κ/∂p, by rows.
    pub kappa_p: [Quat<T>; 3],
    /// ∂κ/∂p′, by rows.
    pub kappa_dp: [Quat<T>; 3],
}

/// The strain matrix at a point: |p|² Γ_i + … = vec(p̄ r′ p)·e_i and |p|² κ_i = 2 vec(p̄ p′)·e_i, differentiated with their
/// common divisor |p|².
#[inline(always)]
pub(super) fn strain_matrix<T: Number>(tangent: &LaneVec3<T>, point: &GaussPoint<T>) -> StrainMatrix<T> {
    let (e, kappa) = ((point.strain[0] + *tangent).0, point.strain[1].0);
    let rp = left(&point.dr, &point.p);
    let inv2 = T::splat(2.0) * point.inv;
    let zero = [[T::ZERO; 4]; 3];
    let mut B = StrainMatrix { gamma_p: zero, kappa_p: zero, kappa_dp: zero };
    for i in 0..3 {
        let (rpe, dpe, pe) = (right_unit(&rp, i), right_unit(&point.dp, i), right_unit(&point.p, i));
        for k in 0..4 {
            B.gamma_p[i][k] = -inv2 * (rpe[k] + e[i] * point.p[k]);
            B.kappa_p[i][k] = -inv2 * (dpe[k] + kappa[i] * point.p[k]);
            B.kappa_dp[i][k] = inv2 * pe[k];
        }
    }
    B
}
