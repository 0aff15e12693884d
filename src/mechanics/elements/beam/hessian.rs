//! The Hessian of a Gauss point's energy in z = (p, p′, r′): BᵀCB, σ·∂²ε, and what damping adds.

use super::kinematics::{GaussPoint, Rate, StrainMatrix};
use super::lane_section::SectionStiffness;
use super::quaternion::{Quat, dot, left, right_unit, times_conjugate};
use base::math::number::{LaneVec3, Number};

/// y ← y + s x.
#[inline(always)]
pub(super) fn add<T: Number, const L: usize>(y: &mut [T; L], s: T, x: &[T; L]) {
    for k in 0..L {
        y[k] = T::fma(s, x[k], y[k]);
    }
}

/// Rows over z: of strains, or of the stresses that follow from them.
#[derive(Clone, Copy)]
pub(super) struct ZRows<T> {
    pub gamma: [ZRow<T>; 3],
    pub kappa: [ZRow<T>; 3],
}

/// A row over z.
#[derive(Clone, Copy)]
pub(super) struct ZRow<T> {
    pub p: Quat<T>,
    pub dp: Quat<T>,
    pub r: [T; 3],
}

impl<T: Number> ZRow<T> {
    const ZERO: Self = ZRow { p: [T::ZERO; 4], dp: [T::ZERO; 4], r: [T::ZERO; 3] };

    #[inline(always)]
    fn add(&mut self, s: T, row: &Self) {
        add(&mut self.p, s, &row.p);
        add(&mut self.dp, s, &row.dp);
        add(&mut self.r, s, &row.r);
    }
}

impl<T: Number> ZRows<T> {
    /// The rows of a strain matrix; `by_r`: those of Γ by r′.
    #[inline(always)]
    pub fn new(B: &StrainMatrix<T>, by_r: &[LaneVec3<T>; 3]) -> Self {
        let mut rows = ZRows { gamma: [ZRow::ZERO; 3], kappa: [ZRow::ZERO; 3] };
        for i in 0..3 {
            rows.gamma[i].p = B.gamma_p[i];
            rows.gamma[i].r = by_r[i].0;
            rows.kappa[i].p = B.kappa_p[i];
            rows.kappa[i].dp = B.kappa_dp[i];
        }
        rows
    }

    /// Adds s times other rows.
    #[inline(always)]
    pub fn add(&mut self, s: T, rows: &Self) {
        for i in 0..3 {
            self.gamma[i].add(s, &rows.gamma[i]);
            self.kappa[i].add(s, &rows.kappa[i]);
        }
    }

    /// Bᵀσ.
    #[inline(always)]
    pub fn gradient(&self, [n, m]: &[LaneVec3<T>; 2]) -> ZRow<T> {
        let mut g = ZRow::ZERO;
        for i in 0..3 {
            add(&mut g.p, n.0[i], &self.gamma[i].p);
            add(&mut g.r, n.0[i], &self.gamma[i].r);
            add(&mut g.p, m.0[i], &self.kappa[i].p);
            add(&mut g.dp, m.0[i], &self.kappa[i].dp);
        }
        g
    }
}

impl<T: Number> SectionStiffness<T> {
    /// C times rows of strains.
    #[inline(always)]
    pub(super) fn times(&self, B: &ZRows<T>) -> ZRows<T> {
        let mut CB = ZRows { gamma: [ZRow::ZERO; 3], kappa: [ZRow::ZERO; 3] };
        for i in 0..3 {
            for j in 0..3 {
                // Γ does not depend on p′, nor κ on r′.
                add(&mut CB.gamma[i].p, self.N[i][j], &B.gamma[j].p);
                add(&mut CB.gamma[i].r, self.N[i][j], &B.gamma[j].r);
                add(&mut CB.kappa[i].p, self.M[i][j], &B.kappa[j].p);
                add(&mut CB.kappa[i].dp, self.M[i][j], &B.kappa[j].dp);
                if self.coupled {
                    CB.gamma[i].add(self.NM[i][j], &B.kappa[j]);
                    CB.kappa[i].add(self.NM[j][i], &B.gamma[j]);
                }
            }
        }
        CB
    }
}

/// Second derivatives in z, by rows: `r_p` has rows of r′ and columns of p.
#[derive(Clone, Copy)]
pub(super) struct Hessian<T> {
    pub p_p: [Quat<T>; 4],
    pub p_dp: [Quat<T>; 4],
    pub dp_p: [Quat<T>; 4],
    pub dp_dp: [Quat<T>; 4],
    pub r_p: [Quat<T>; 3],
    pub r_dp: [Quat<T>; 3],
    pub r_r: [[T; 3]; 3],
    /// Rows of p and p′ by r′, transposed.
    pub p_r: [Quat<T>; 3],
    pub dp_r: [Quat<T>; 3],
}

impl<T: Number> Hessian<T> {
    /// BᵀX of rows of strains and of stresses; unless `all` those of a symmetric matrix, which has no columns of r′.
    #[inline(always)]
    pub fn product(B: &ZRows<T>, X: &ZRows<T>, [all, coupled]: [bool; 2]) -> Self {
        let (four, three) = ([[T::ZERO; 4]; 4], [[T::ZERO; 4]; 3]);
        let r_r = [[T::ZERO; 3]; 3];
        let mut h = Hessian {
            p_p: four,
            p_dp: four,
            dp_p: four,
            dp_dp: four,
            r_p: three,
            r_dp: three,
            r_r,
            p_r: three,
            dp_r: three,
        };
        for i in 0..3 {
            let (gamma, kappa, n, m) = (&B.gamma[i], &B.kappa[i], &X.gamma[i], &X.kappa[i]);
            for k in 0..4 {
                add(&mut h.p_p[k], gamma.p[k], &n.p);
                add(&mut h.p_p[k], kappa.p[k], &m.p);
                add(&mut h.dp_p[k], kappa.dp[k], &m.p);
                add(&mut h.dp_dp[k], kappa.dp[k], &m.dp);
                if all {
                    add(&mut h.p_dp[k], gamma.p[k], &n.dp);
                    add(&mut h.p_dp[k], kappa.p[k], &m.dp);
                }
            }
            for k in 0..3 {
                add(&mut h.r_p[k], gamma.r[k], &n.p);
                add(&mut h.r_r[k], gamma.r[k], &n.r);
                if coupled {
                    add(&mut h.r_dp[k], gamma.r[k], &n.dp);
                }
                if all {
                    add(&mut h.p_r[k], n.r[k], &gamma.p);
                    add(&mut h.p_r[k], m.r[k], &kappa.p);
                    add(&mut h.dp_r[k], m.r[k], &kappa.dp);
                }
            }
        }
        if !all {
            (0..4).for_each(|i| (0..4).for_each(|k| h.p_dp[i][k] = h.dp_p[k][i]));
        }
        h
    }

    /// Adds σ·∂²ε, `g` = Bᵀσ: with |p|² e = Y, ∂²e = (∂²Y − ∂|p|²⊗∂e − ∂e⊗∂|p|² − e ∂²|p|²)/|p|².
    #[inline(always)]
    pub fn add_second(&mut self, point: &GaussPoint<T>, tangent: &LaneVec3<T>, g: &ZRow<T>, [n, m]: &[LaneVec3<T>; 2]) {
        let (p, inv2) = (&point.p, T::splat(2.0) * point.inv);
        let sigma_e = n.dot(&(point.strain[0] + *tangent)) + m.dot(&point.strain[1]);
        // n·Y_Γ = −p·(r′ p n). Its matrix is −r′·n in the scalar part, r′ × n beside it, and r′·n − n r′ᵀ − r′ nᵀ in the rest.
        let (u, along, across) = (&point.dr, point.dr.dot(n), point.dr.cross(n));
        for i in 0..4 {
            for k in 0..=i {
                let own = match (i, k) {
                    (0, 0) => -along,
                    (_, 0) => across.0[i - 1],
                    _ => -(n.0[i - 1] * u.0[k - 1] + u.0[i - 1] * n.0[k - 1]),
                };
                let own = if i == k { own + (if i > 0 { along + sigma_e } else { sigma_e }) } else { own };
                let h = inv2 * (own + p[i] * g.p[k] + p[k] * g.p[i]);
                self.p_p[i][k] -= h;
                if k < i {
                    self.p_p[k][i] -= h;
                }
            }
        }
        // m·Y_κ = 2 p′·(p m).
        let LaneVec3([x, y, z]) = *m;
        let of_m = [[T::ZERO, -x, -y, -z], [x, T::ZERO, z, -y], [y, -z, T::ZERO, x], [z, y, -x, T::ZERO]];
        // ∂/∂r′ of n·Y_Γ is 2 vec(p n p̄).
        let (w, LaneVec3([x, y, z])) = times_conjugate(&[T::ZERO, n.0[0], n.0[1], n.0[2]], p);
        let of_n = [[x, w, z, -y], [y, -z, w, x], [z, y, -x, w]];
        for k in 0..4 {
            for i in 0..4 {
                let h = inv2 * (of_m[i][k] - g.dp[i] * p[k]);
                self.dp_p[i][k] += h;
                self.p_dp[k][i] += h;
            }
            for i in 0..3 {
                let h = inv2 * (of_n[i][k] - g.r[i] * p[k]);
                self.r_p[i][k] += h;
                self.p_r[i][k] += h;
            }
        }
    }
}

/// ∂ε̇/∂z at fixed ż: the second derivative of the strains in the direction ż; `B` is ∂ε/∂z.
#[inline(always)]
pub(super) fn rate_rows<T: Number>(
    (point, tangent): (&GaussPoint<T>, &LaneVec3<T>),
    B: &ZRows<T>,
    rate: &Rate<T>,
    [gamma, kappa]: &[LaneVec3<T>; 2],
) -> ZRows<T> {
    let mut D = ZRows { gamma: [ZRow::ZERO; 3], kappa: [ZRow::ZERO; 3] };
    let inv2 = T::splat(2.0) * point.inv;
    let e = point.strain[0] + *tangent;
    D.add(-inv2 * dot(&point.p, &rate.p), B);
    let rp = left(&point.dr, &rate.p);
    let dr_p = left(&rate.dr, &point.p);
    for i in 0..3 {
        let (a, b, c, d) = (right_unit(&rp, i), right_unit(&dr_p, i), right_unit(&rate.dp, i), right_unit(&rate.p, i));
        for k in 0..4 {
            let of_gamma = a[k] + b[k] + point.p[k] * gamma.0[i] + e.0[i] * rate.p[k];
            let of_kappa = c[k] + point.p[k] * kappa.0[i] + point.strain[1].0[i] * rate.p[k];
            D.gamma[i].p[k] -= inv2 * of_gamma;
            D.kappa[i].p[k] -= inv2 * of_kappa;
            D.kappa[i].dp[k] += inv2 * d[k];
        }
        let v = times_conjugate(&d, &point.p).1;
        (0..3).for_each(|k| D.gamma[i].r[k] += inv2 * v.0[k]);
    }
    D
}
