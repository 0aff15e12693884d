//! The matrix of a beam element: the Hessian in z = (p, p′, r′) of each Gauss point, spread over pairs of nodes, projected
//! on rotations.

use super::quaternion::{dot, left, multiply, right, right_unit, rotation_columns, times_conjugate};
use super::{Beams, Elastic, Point, Rate, Section, StrainMatrix, strain_matrix};
use crate::elements::{ElementBlock, Moduli};
use crate::math::{Mat3, Vec3, fma, skew};
use crate::state::Configuration;

/// A row over z: p in 0..4, p′ in 4..8, r′ in 8..11, one place unused.
type Row = [f64; 12];
/// Second derivatives in a pair of nodes: rows q (4), x (3) of the first, columns q (4), x (3) of the second, one unused.
type Pair = [[f64; 8]; 7];

#[inline(always)]
fn add<const L: usize>(y: &mut [f64; L], s: f64, x: &[f64; L]) {
    for k in 0..L {
        y[k] = fma(s, x[k], y[k]);
    }
}

/// H += w · ∂z/∂(nodes)ᵀ h ∂z/∂(nodes) for every pair of nodes; without `ALL`, for those with a ≤ b alone.
#[inline(always)]
fn spread<const N: usize, const ALL: bool>(
    h: &[Row; 11],
    w: f64,
    value: &[f64; N],
    slope: &[f64; N],
    pairs: &mut [[Pair; N]; N],
) {
    for a in 0..N {
        let mut half = [[0.0; 12]; 7];
        for k in 0..4 {
            add(&mut half[k], w * value[a], &h[k]);
            add(&mut half[k], w * slope[a], &h[4 + k]);
        }
        for k in 0..3 {
            add(&mut half[4 + k], w * slope[a], &h[8 + k]);
        }
        for b in if ALL { 0 } else { a }..N {
            for (out, row) in pairs[a][b].iter_mut().zip(&half) {
                for k in 0..4 {
                    out[k] = fma(value[b], row[k], fma(slope[b], row[4 + k], out[k]));
                    out[4 + k] = fma(slope[b], row[8 + k], out[4 + k]);
                }
            }
        }
    }
}

/// BᵀX for strain rows B and X.
#[inline(always)]
fn transpose_product(B: &[Row; 6], X: &[Row; 6]) -> [Row; 11] {
    // Row by row: a row stays in registers while it is summed.
    std::array::from_fn(|k| {
        let mut row = [0.0; 12];
        for i in 0..6 {
            add(&mut row, B[i][k], &X[i]);
        }
        row
    })
}

impl Elastic {
    /// C times six strain rows.
    #[inline(always)]
    fn times(&self, B: &[Row; 6]) -> [Row; 6] {
        let mut CB = [[0.0; 12]; 6];
        for i in 0..3 {
            for j in 0..3 {
                add(&mut CB[i], self.N[(i, j)], &B[j]);
                add(&mut CB[3 + i], self.M[(i, j)], &B[3 + j]);
                if self.coupled {
                    add(&mut CB[i], self.NM[(i, j)], &B[3 + j]);
                    add(&mut CB[3 + i], self.NM[(j, i)], &B[j]);
                }
            }
        }
        CB
    }
}

impl StrainMatrix {
    /// B as six rows over z.
    #[inline(always)]
    fn rows(&self, R: &Mat3) -> [Row; 6] {
        let mut B = [[0.0; 12]; 6];
        for i in 0..3 {
            B[i][..4].copy_from_slice(&self.gamma_p[i]);
            B[3 + i][..4].copy_from_slice(&self.kappa_p[i]);
            B[3 + i][4..8].copy_from_slice(&self.kappa_dp[i]);
            for k in 0..3 {
                B[i][8 + k] = R[(k, i)];
            }
        }
        B
    }
}

/// Adds σ·∂²ε: with |p|² e = Y, ∂²e = (∂²Y − ∂|p|²⊗∂e − ∂e⊗∂|p|² − e ∂²|p|²)/|p|².
#[inline(always)]
fn add_geometric(h: &mut [Row; 11], point: &Point, tangent: &Vec3, B: &[Row; 6], n: &Vec3, m: &Vec3) {
    let mut gradient = [0.0; 12];
    for i in 0..3 {
        add(&mut gradient, n[i], &B[i]);
        add(&mut gradient, m[i], &B[3 + i]);
    }
    let inv2 = 2.0 * point.inv;
    let sigma_e = n.dot(&(point.gamma + tangent)) + m.dot(&point.kappa);
    // n·Y_Γ = −p·(r′ p n): columns r′ e_k n, and ∂/∂r′ of it 2 vec(e_k n p̄).
    let np = {
        let (w, v) = times_conjugate(&[0.0, n.x, n.y, n.z], &point.p);
        [w, v.x, v.y, v.z]
    };
    for k in 0..4 {
        let mut unit = [0.0; 4];
        unit[k] = 1.0;
        let rn = right(&left(&point.dr, &unit), n);
        let um = right(&unit, m);
        let un = multiply(&unit, &np);
        for i in 0..4 {
            h[i][k] -= inv2
                * (rn[i] + if i == k { sigma_e } else { 0.0 } + point.p[i] * gradient[k] + point.p[k] * gradient[i]);
            // m·Y_κ = 2 p′·(p m)
            h[4 + i][k] += inv2 * (um[i] - gradient[4 + i] * point.p[k]);
            h[k][4 + i] += inv2 * (um[i] - gradient[4 + i] * point.p[k]);
        }
        for i in 0..3 {
            let c = inv2 * (un[1 + i] - gradient[8 + i] * point.p[k]);
            h[8 + i][k] += c;
            h[k][8 + i] += c;
        }
    }
}

/// ∂ε̇/∂z at fixed ż: the second derivative of the strains along ż.
#[inline(always)]
fn rate_rows(point: &Point, tangent: &Vec3, B: &[Row; 6], rate: &Rate, strain_rates: &[f64; 6]) -> [Row; 6] {
    let mut D = [[0.0; 12]; 6];
    let inv2 = 2.0 * point.inv;
    let e = point.gamma + tangent;
    let along = dot(&point.p, &rate.p);
    let rp = left(&point.dr, &rate.p);
    let dr_p = left(&rate.dr, &point.p);
    for i in 0..3 {
        add(&mut D[i], -inv2 * along, &B[i]);
        add(&mut D[3 + i], -inv2 * along, &B[3 + i]);
        let (a, b, c, d) = (right_unit(&rp, i), right_unit(&dr_p, i), right_unit(&rate.dp, i), right_unit(&rate.p, i));
        for k in 0..4 {
            D[i][k] -= inv2 * (a[k] + b[k] + point.p[k] * strain_rates[i] + e[i] * rate.p[k]);
            D[3 + i][k] -= inv2 * (c[k] + point.p[k] * strain_rates[3 + i] + point.kappa[i] * rate.p[k]);
            D[3 + i][4 + k] += inv2 * d[k];
        }
        let v = times_conjugate(&d, &point.p).1;
        for k in 0..3 {
            D[i][8 + k] += inv2 * v[k];
        }
    }
    D
}

impl<const N: usize, S: Section> Beams<N, S> {
    pub(super) fn tangent_of<const DAMPED: bool>(
        &self,
        e: usize,
        now: &Configuration,
        rate_weight: f64,
        moduli: Moduli,
        K: &mut [f64],
    ) {
        let nodes = now.nodes;
        let element = &self.elements[e];
        let motion = self.gather(element, nodes);
        let q = &motion.0;
        let mut pairs = [[[[0.0; 8]; 7]; N]; N];
        let mut viscous = [[[[0.0; 8]; 7]; N]; N];
        let mut gradient = [[0.0; 4]; N];
        let per_length = 1.0 / element.jacobian;
        for g in 0..self.points() {
            let point = self.locate(element, g, &motion);
            let mut room = Elastic::ZERO;
            let strain = (&point.gamma, &point.kappa);
            let (mut n, mut m, C) = element.section.linearise(g, strain, now, moduli, &mut room);
            let B = strain_matrix(element, &point).rows(&point.R);
            let CB = C.times(&B);
            let mut h = transpose_product(&B, &CB);
            let w = self.shape.weight[g] * element.jacobian;
            let value = &self.shape.value[g];
            let slope = self.shape.slope[g].map(|s| s * per_length);
            if DAMPED {
                let elastic = element.section.elastic();
                let CB = if std::ptr::eq(C, elastic) { CB } else { elastic.times(&B) };
                let c = if std::ptr::eq(C, elastic) { h } else { transpose_product(&B, &CB) };
                spread::<N, DAMPED>(&c, self.damping * w, value, &slope, &mut viscous);
                let (gamma, kappa, rate) = self.rates(element, g, &point, q, nodes);
                let strain_rates = [gamma.x, gamma.y, gamma.z, kappa.x, kappa.y, kappa.z];
                let D = rate_rows(&point, &element.tangent, &B, &rate, &strain_rates);
                let BCD = transpose_product(&CB, &D);
                for k in 0..11 {
                    add(&mut h[k], self.damping, &BCD[k]);
                }
                let (nd, md) = elastic.stress(&gamma, &kappa);
                n += self.damping * nd;
                m += self.damping * md;
            }
            add_geometric(&mut h, &point, &element.tangent, &B, &n, &m);
            spread::<N, DAMPED>(&h, w, value, &slope, &mut pairs);
            // ∂U/∂q_a, for the change of direction of δq_a = ½ δθ q_a itself.
            for i in 0..3 {
                for a in 0..N {
                    for k in 0..4 {
                        gradient[a][k] += w * value[a] * (n[i] * B[i][k] + m[i] * B[3 + i][k])
                            + w * slope[a] * m[i] * B[3 + i][4 + k];
                    }
                }
            }
        }
        if DAMPED {
            for a in 0..N {
                for b in 0..N {
                    // q̇_b = ½ ω_b q_b turns with q_b.
                    let half_omega = 0.5 * nodes[element.nodes[b]].omega;
                    let V = viscous[a][b];
                    for (out, row) in pairs[a][b].iter_mut().zip(&V) {
                        add(out, rate_weight, row);
                        // row · L(½ω) = −L(½ω) rowᵀ, L being antisymmetric for a pure ω.
                        let turned = left(&half_omega, &[row[0], row[1], row[2], row[3]]);
                        for k in 0..4 {
                            out[k] -= turned[k];
                        }
                    }
                }
            }
        }
        let E = q.map(|q| rotation_columns(&q));
        // The same with δθ along the row, one place unused.
        let columns = E.map(|e| std::array::from_fn::<[f64; 4], 4, _>(|k| [e[0][k], e[1][k], e[2][k], 0.0]));
        for a in 0..N {
            // Without damping the Hessian is symmetric: the other half is a copy.
            for b in if DAMPED { 0 } else { a }..N {
                let P = &pairs[a][b];
                // Rows: x, then ½ vec(row q̄_a).
                let mut rows = [[0.0; 8]; 6];
                for i in 0..3 {
                    rows[i] = P[4 + i];
                    for k in 0..4 {
                        add(&mut rows[3 + i], E[a][i][k], &P[k]);
                    }
                }
                for (i, row) in rows.iter().enumerate() {
                    let mut turn = [0.0; 4];
                    for k in 0..4 {
                        add(&mut turn, row[k], &columns[b][k]);
                    }
                    let at = (6 * a + i) * 6 * N + 6 * b;
                    K[at..at + 3].copy_from_slice(&row[4..7]);
                    K[at + 3..at + 6].copy_from_slice(&turn[..3]);
                    if !DAMPED && b != a {
                        for j in 0..6 {
                            K[(6 * b + j) * 6 * N + 6 * a + i] = K[at + j];
                        }
                    }
                }
            }
            // δ(½ vec(G q̄_a)) at fixed G = −¼ (s₀ δθ + s × δθ), s = G q̄_a.
            let (s0, s) = times_conjugate(&gradient[a], &q[a]);
            let turn = -0.25 * (s0 * Mat3::identity() + skew(&s));
            for i in 0..3 {
                for j in 0..3 {
                    K[(6 * a + 3 + i) * 6 * N + 6 * a + 3 + j] += turn[(i, j)];
                }
            }
        }
    }
}
