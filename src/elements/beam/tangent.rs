//! The tangent of a beam element: the Hessian in z = (p, p′, r′) of each Gauss point, by pairs of nodes, projected on
//! rotations.

use super::kinematics::{Beams, GaussPoint, Rate, StrainMatrix, strain_matrix};
use super::quaternion::{Quat, dot, left, multiply, right, right_unit, rotation_columns, times_conjugate};
use super::section::{BeamSection, BeamStiffness};
use crate::elements::block::Moduli;
use crate::math::{Mat3, Vec3, fma, skew};
use crate::state::{Configuration, Node};

/// A row over z: p at 0..4, p′ at 4..8, r′ at 8..11; the last place is unused, so that a row fills whole registers.
type Row = [f64; 12];
/// Second derivatives by a pair of nodes: rows q (4), x (3) of the first, columns q (4), x (3) of the second; the last is unused.
type Pair = [[f64; 8]; 7];

/// y ← y + s x.
#[inline(always)]
fn add<const L: usize>(y: &mut [f64; L], s: f64, x: &[f64; L]) {
    for k in 0..L {
        y[k] = fma(s, x[k], y[k]);
    }
}

/// H += w · ∂z/∂(nodes)ᵀ h ∂z/∂(nodes) for each pair of nodes (a, b); without `ALL` for a ≤ b alone.
#[inline(always)]
fn add_to_pairs<const N: usize, const ALL: bool>(
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
    // A row stays in registers while it is summed.
    std::array::from_fn(|k| {
        let mut row = [0.0; 12];
        for i in 0..6 {
            add(&mut row, B[i][k], &X[i]);
        }
        row
    })
}

impl BeamStiffness {
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

/// h += σ·∂²ε: with |p|² e = Y, ∂²e = (∂²Y − ∂|p|²⊗∂e − ∂e⊗∂|p|² − e ∂²|p|²)/|p|².
#[inline(always)]
fn add_geometric(h: &mut [Row; 11], point: &GaussPoint, tangent: &Vec3, B: &[Row; 6], n: &Vec3, m: &Vec3) {
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

/// ∂ε̇/∂z at fixed ż: the second derivative of the strains in the direction ż.
#[inline(always)]
fn rate_rows(point: &GaussPoint, tangent: &Vec3, B: &[Row; 6], rate: &Rate, strain_rates: &[f64; 6]) -> [Row; 6] {
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

/// ∂U/∂q_a += w ∂U/∂z · ∂z/∂q_a: needed because δq_a = ½ δθ q_a changes with q_a.
#[inline(always)]
fn add_gradient<const N: usize>(
    B: &[Row; 6],
    (n, m): (&Vec3, &Vec3),
    w: f64,
    (value, slope): (&[f64; N], &[f64; N]),
    gradient: &mut [Quat; N],
) {
    for i in 0..3 {
        for a in 0..N {
            for k in 0..4 {
                gradient[a][k] +=
                    w * value[a] * (n[i] * B[i][k] + m[i] * B[3 + i][k]) + w * slope[a] * m[i] * B[3 + i][4 + k];
            }
        }
    }
}

/// H += the derivatives of damping by the rates of the nodes, `viscous` by those of z: `rate_weight` times ∂f/∂ż, and ∂f/∂z by
/// q̇_b = ½ ω_b q_b, which turns with q_b.
#[inline(always)]
fn add_rate_terms<const N: usize>(
    pairs: &mut [[Pair; N]; N],
    viscous: &[[Pair; N]; N],
    rate_weight: f64,
    omega: impl Fn(usize) -> Vec3,
) {
    for a in 0..N {
        for b in 0..N {
            let half_omega = 0.5 * omega(b);
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

/// K ← the Hessian by positions and rotations, x and δθ of each node: δq_a = ½ δθ q_a at fixed q_a. Without `ALL` the Hessian
/// is symmetric and given for a ≤ b: the other half is a copy.
#[inline(always)]
fn project<const N: usize, const ALL: bool>(pairs: &[[Pair; N]; N], q: &[Quat; N], K: &mut [f64]) {
    let E = q.map(|q| rotation_columns(&q));
    // The coefficients are stored with δθ along the row; the last place is unused.
    let columns = E.map(|e| std::array::from_fn::<[f64; 4], 4, _>(|k| [e[0][k], e[1][k], e[2][k], 0.0]));
    for a in 0..N {
        for b in if ALL { 0 } else { a }..N {
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
                if !ALL && b != a {
                    for j in 0..6 {
                        K[(6 * b + j) * 6 * N + 6 * a + i] = K[at + j];
                    }
                }
            }
        }
    }
}

/// K += δ(½ vec(G q̄_a)) at fixed G = ∂U/∂q_a: −¼ (s₀ δθ + s × δθ), s = G q̄_a.
#[inline(always)]
fn add_change_of_direction<const N: usize>(gradient: &[Quat; N], q: &[Quat; N], K: &mut [f64]) {
    for a in 0..N {
        let (s0, s) = times_conjugate(&gradient[a], &q[a]);
        let turn = -0.25 * (s0 * Mat3::identity() + skew(&s));
        for i in 0..3 {
            for j in 0..3 {
                K[(6 * a + 3 + i) * 6 * N + 6 * a + 3 + j] += turn[(i, j)];
            }
        }
    }
}

/// The damping of a Gauss point: h += β BᵀC ∂ε̇/∂z, C the elastic stiffness and `CB` = C B; returns the stress β C ε̇.
#[inline(always)]
fn add_damping<const N: usize, S: BeamSection>(
    beams: &Beams<N, S>,
    (e, g): (usize, usize),
    (point, q): (&GaussPoint, &[Quat; N]),
    now: &Configuration,
    (B, CB): (&[Row; 6], &[Row; 6]),
    h: &mut [Row; 11],
) -> (Vec3, Vec3) {
    let element = &beams.elements[e];
    let (gamma, kappa, rate) = beams.rates(element, g, point, q, now.nodes);
    let strain_rates = [gamma.x, gamma.y, gamma.z, kappa.x, kappa.y, kappa.z];
    let D = rate_rows(point, &element.tangent, B, &rate, &strain_rates);
    let BCD = transpose_product(CB, &D);
    for k in 0..11 {
        add(&mut h[k], beams.damping, &BCD[k]);
    }
    let (n, m) = element.section.elastic().stress(&gamma, &kappa);
    (beams.damping * n, beams.damping * m)
}

/// Tangent of element `e`, see [`crate::elements::ElementBlock::tangent`], with the stresses that `lead` tells; symmetric unless
/// `DAMPED`.
pub(super) fn tangent<const N: usize, S: BeamSection, const DAMPED: bool>(
    beams: &Beams<N, S>,
    e: usize,
    (now, lead): (&Configuration, Option<&[Node]>),
    rate_weight: f64,
    moduli: Moduli,
    K: &mut [f64],
) {
    let element = &beams.elements[e];
    let motion = beams.gather(element, now.nodes);
    let q = &motion.0;
    let mut pairs = [[[[0.0; 8]; 7]; N]; N];
    let mut viscous = [[[[0.0; 8]; 7]; N]; N];
    let mut gradient = [[0.0; 4]; N];
    let per_length = 1.0 / element.jacobian;
    for g in 0..beams.integration_points() {
        let point = beams.interpolate(element, g, &motion);
        let mut place = BeamStiffness::ZERO;
        let (gamma, kappa) = beams.leading_strains(element, g, &point, lead);
        let (mut n, mut m, C) = element.section.linearise(g, (&gamma, &kappa), now, moduli, &mut place);
        let B = strain_matrix(element, &point).rows(&point.R);
        let CB = C.times(&B);
        let mut h = transpose_product(&B, &CB);
        let w = beams.shape.weight[g] * element.jacobian;
        let value = &beams.shape.value[g];
        let slope = beams.shape.slope[g].map(|s| s * per_length);
        if DAMPED && !element.section.has_failed(now.history) {
            let elastic = element.section.elastic();
            let CB = if std::ptr::eq(C, elastic) { CB } else { elastic.times(&B) };
            let c = if std::ptr::eq(C, elastic) { h } else { transpose_product(&B, &CB) };
            add_to_pairs::<N, DAMPED>(&c, beams.damping * w, value, &slope, &mut viscous);
            let (nd, md) = add_damping(beams, (e, g), (&point, q), now, (&B, &CB), &mut h);
            n += nd;
            m += md;
        }
        add_geometric(&mut h, &point, &element.tangent, &B, &n, &m);
        add_to_pairs::<N, DAMPED>(&h, w, value, &slope, &mut pairs);
        add_gradient(&B, (&n, &m), w, (value, &slope), &mut gradient);
    }
    if DAMPED {
        add_rate_terms(&mut pairs, &viscous, rate_weight, |b| now.nodes[element.nodes[b]].omega);
    }
    project::<N, DAMPED>(&pairs, q, K);
    add_change_of_direction(&gradient, q, K);
}
