//! The tangent of beam elements, one or eight side by side: the Hessian in z = (p, p′, r′) of each Gauss point, by pairs of nodes,
//! projected on rotations.

use super::hessian::{Hessian, ZRows, add, rate_rows};
use super::kinematics::{Pack, strain_matrix};
use super::lane_section::{Linearised, SectionStiffness};
use super::quaternion::{Quat, left, rotation_columns, times_conjugate};
use crate::state::Node;
use base::math::number::{LaneVec3, Number};

/// Second derivatives by two nodes, rows of the first and columns of the second, quaternions q and positions x.
#[derive(Clone, Copy)]
struct Pair<T> {
    q_q: [Quat<T>; 4],
    x_q: [Quat<T>; 3],
    x_x: [[T; 3]; 3],
}

/// Second derivatives by pairs of nodes.
struct Pairs<T, const N: usize> {
    /// The blocks by pairs of nodes; a symmetric matrix has q by q and x by x for a ≤ b alone.
    of: [[Pair<T>; N]; N],
    /// Rows of q by x, transposed, of a matrix that is not symmetric.
    q_x: Option<[[[Quat<T>; 3]; N]; N]>,
}

impl<T: Number, const N: usize> Pairs<T, N> {
    #[inline(always)]
    fn zero(all: bool) -> Self {
        let (four, three) = ([[T::ZERO; 4]; 4], [[T::ZERO; 4]; 3]);
        let of = [[Pair { q_q: four, x_q: three, x_x: [[T::ZERO; 3]; 3] }; N]; N];
        Pairs { of, q_x: if all { Some([[three; N]; N]) } else { None } }
    }

    /// Adds w ∂z/∂(nodes)ᵀ h ∂z/∂(nodes).
    #[inline(always)]
    fn add(&mut self, all: bool, h: &Hessian<T>, w: T, (value, slope): (&[T; N], &[T; N])) {
        for a in 0..N {
            let (v, s) = (w * value[a], w * slope[a]);
            let (mut by_value, mut by_slope) = ([[T::ZERO; 4]; 4], [[T::ZERO; 4]; 4]);
            for k in 0..4 {
                add(&mut by_value[k], v, &h.p_p[k]);
                add(&mut by_value[k], s, &h.dp_p[k]);
                add(&mut by_slope[k], v, &h.p_dp[k]);
                add(&mut by_slope[k], s, &h.dp_dp[k]);
            }
            let mut by_r = [[T::ZERO; 4]; 3];
            for k in 0..3 {
                add(&mut by_r[k], value[a], &h.r_p[k]);
                add(&mut by_r[k], slope[a], &h.r_dp[k]);
            }
            for b in 0..N {
                // By the position of b and the quaternion of a.
                (0..3).for_each(|k| add(&mut self.of[b][a].x_q[k], w * slope[b], &by_r[k]));
                if !all && b < a {
                    continue;
                }
                let to = &mut self.of[a][b];
                for k in 0..4 {
                    add(&mut to.q_q[k], value[b], &by_value[k]);
                    add(&mut to.q_q[k], slope[b], &by_slope[k]);
                }
                (0..3).for_each(|k| add(&mut to.x_x[k], s * slope[b], &h.r_r[k]));
                if let Some(q_x) = &mut self.q_x {
                    for k in 0..3 {
                        add(&mut q_x[a][b][k], v * slope[b], &h.p_r[k]);
                        add(&mut q_x[a][b][k], s * slope[b], &h.dp_r[k]);
                    }
                }
            }
        }
    }

    /// Adds w Bᵀ C B of a viscous section.
    #[inline(never)]
    fn add_viscous(&mut self, B: &ZRows<T>, viscous: &SectionStiffness<T>, w: T, at: (&[T; N], &[T; N])) {
        self.add(true, &Hessian::product(B, &viscous.times(B), [true, true]), w, at);
    }

    /// Adds the derivatives of damping by the rates of the nodes: `rate_weight` times ∂f/∂ż, and ∂f/∂z by q̇_b = ½ ω_b q_b, which turns
    /// with q_b. `viscous` holds the derivatives by z.
    #[inline(always)]
    fn add_rate_terms(&mut self, viscous: &Self, rate_weight: T, omega: impl Fn(usize) -> LaneVec3<T>) {
        for b in 0..N {
            let half_omega = T::splat(0.5) * omega(b);
            for a in 0..N {
                let (to, of) = (&mut self.of[a][b], &viscous.of[a][b]);
                // row · L(½ω) = −L(½ω) rowᵀ, L being antisymmetric for a pure ω.
                let add_row = |to: &mut Quat<T>, row: &Quat<T>| {
                    let turned = left(&half_omega, row);
                    (0..4).for_each(|k| to[k] += rate_weight * row[k] - turned[k]);
                };
                (0..4).for_each(|k| add_row(&mut to.q_q[k], &of.q_q[k]));
                for k in 0..3 {
                    add_row(&mut to.x_q[k], &of.x_q[k]);
                    add(&mut to.x_x[k], rate_weight, &of.x_x[k]);
                }
                if let (Some(q_x), Some(of)) = (&mut self.q_x, &viscous.q_x) {
                    (0..3).for_each(|k| add(&mut q_x[a][b][k], rate_weight, &of[a][b][k]));
                }
            }
        }
    }

    /// The Hessian by positions and rotations, x and δθ of each node: δq_a = ½ δθ q_a at fixed q_a. Where it is symmetric one half is a
    /// copy.
    #[inline(always)]
    fn project(&self, all: bool, q: &[Quat<T>; N]) -> [[[[T; 6]; N]; 6]; N] {
        let mut E = [[[T::ZERO; 4]; 3]; N];
        (0..N).for_each(|a| E[a] = rotation_columns(&q[a]));
        let mut H = [[[[T::ZERO; 6]; N]; 6]; N];
        for a in 0..N {
            for b in 0..N {
                let of = &self.of[a][b];
                for i in 0..3 {
                    for j in 0..3 {
                        let by_turn = product(&of.x_q[i], &E[b][j]);
                        H[a][i][b][3 + j] = by_turn;
                        match &self.q_x {
                            Some(q_x) => H[a][3 + i][b][j] = product(&q_x[a][b][j], &E[a][i]),
                            None => H[b][3 + j][a][i] = by_turn,
                        }
                    }
                }
                if !all && b < a {
                    continue;
                }
                for j in 0..3 {
                    let mut turned = [T::ZERO; 4];
                    (0..4).for_each(|k| turned[k] = product(&of.q_q[k], &E[b][j]));
                    for i in 0..3 {
                        let by_turns = product(&turned, &E[a][i]);
                        H[a][i][b][j] = of.x_x[i][j];
                        H[a][3 + i][b][3 + j] = by_turns;
                        if !all && b > a {
                            H[b][j][a][i] = of.x_x[i][j];
                            H[b][3 + j][a][3 + i] = by_turns;
                        }
                    }
                }
            }
        }
        H
    }
}

/// a·b of all four numbers, each product rounded with its sum.
#[inline(always)]
fn product<T: Number>(a: &Quat<T>, b: &Quat<T>) -> T {
    T::fma(a[0], b[0], T::fma(a[1], b[1], T::fma(a[2], b[2], a[3] * b[3])))
}

/// H += δ(½ vec(G q̄_a)) at fixed G = ∂U/∂q_a: −¼ (s₀ δθ + s × δθ), s = G q̄_a.
#[inline(always)]
fn add_change_of_direction<T: Number, const N: usize>(
    gradient: &[Quat<T>; N],
    q: &[Quat<T>; N],
    H: &mut [[[[T; 6]; N]; 6]; N],
) {
    let quarter = T::splat(-0.25);
    for a in 0..N {
        let (s0, LaneVec3(s)) = times_conjugate(&gradient[a], &q[a]);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            H[a][3 + i][a][3 + i] += quarter * s0;
            H[a][3 + i][a][3 + j] -= quarter * s[k];
            H[a][3 + i][a][3 + k] += quarter * s[j];
        }
    }
}

/// Stress at an integration point at the strains there, and its derivative.
type Linearise<'a, T> = dyn Fn(usize, &[LaneVec3<T>; 2]) -> Linearised<T> + 'a;

/// The sections of some elements.
pub(super) struct PackSections<'a, T> {
    /// The number of integration points.
    pub points: usize,
    /// Stress and its derivative at a point.
    pub linearise: &'a Linearise<'a, T>,
    /// Damping times the stiffness at a point before they yield.
    pub viscous: &'a dyn Fn(usize) -> SectionStiffness<T>,
    /// The elements have failed, all of them: nothing is damped.
    pub has_failed: bool,
}

/// Writes the tangents of the elements of a pack into `K`, row-major, one after the other, see [`crate::elements::Mechanics::tangent`],
/// with the stresses extrapolated from `previous`. Without a `rate_weight` they are symmetric; with one they include damping.
pub(super) fn tangent<T: Number, const N: usize>(
    pack: &Pack<T, N>,
    sections: &PackSections<T>,
    (nodes, previous): (&[Node], Option<&[Node]>),
    rate_weight: Option<f64>,
    K: &mut [f64],
) {
    let damped = rate_weight.is_some();
    let motion = pack.gather(nodes);
    let before = previous.map(|nodes| (nodes, pack.gather(nodes)));
    let previous = before.as_ref().map(|(nodes, motion)| (*nodes, motion));
    let mut pairs = Pairs::<T, N>::zero(damped);
    let mut of_rates = damped.then(|| Pairs::<T, N>::zero(true));
    let mut gradient = [[T::ZERO; 4]; N];
    for g in 0..sections.points {
        let point = pack.interpolate(g, &motion);
        let strain = pack.leading_strains(g, &point, previous);
        let Linearised { mut stress, C } = (sections.linearise)(g, &strain);
        let w = pack.weight(g);
        let (mut value, mut slope) = ([T::ZERO; N], [T::ZERO; N]);
        (0..N).for_each(|a| (value[a], slope[a]) = pack.at_node(g, a));
        let B = ZRows::new(&strain_matrix(&pack.tangent, &point), &point.R);
        let mut stresses = C.times(&B);
        if let Some(of_rates) = of_rates.as_mut().filter(|_| !sections.has_failed) {
            let (strain_rates, rate) = pack.rates(g, &point, &motion.q, nodes);
            let D = rate_rows((&point, &pack.tangent), &B, &rate, &strain_rates);
            let viscous = (sections.viscous)(g);
            stresses.add(T::splat(1.0), &viscous.times(&D));
            let [n, m] = viscous.stress(&strain_rates);
            stress = [stress[0] + n, stress[1] + m];
            of_rates.add_viscous(&B, &viscous, w, (&value, &slope));
        }
        let along = B.gradient(&stress);
        let mut h = Hessian::product(&B, &stresses, [damped, damped || C.coupled]);
        h.add_second(&point, &pack.tangent, &along, &stress);
        pairs.add(damped, &h, w, (&value, &slope));
        // δq_a = ½ δθ q_a changes with q_a.
        for a in 0..N {
            add(&mut gradient[a], w * value[a], &along.p);
            add(&mut gradient[a], w * slope[a], &along.dp);
        }
    }
    if let (Some(of_rates), Some(rate_weight)) = (&of_rates, rate_weight) {
        let omega = |b: usize| pack.of_node(b, nodes, |node| node.omega);
        pairs.add_rate_terms(of_rates, T::splat(rate_weight), omega);
    }
    let mut H = pairs.project(damped, &motion.q);
    add_change_of_direction(&gradient, &motion.q, &mut H);
    let numbers = H.as_flattened().as_flattened().as_flattened();
    T::write(numbers, pack.count, K, |lane| lane * numbers.len());
}
