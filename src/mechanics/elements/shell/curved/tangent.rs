//! The tangent of a curved element: BᵀCB of its strains and σ·∂²ε.

use super::kinematics::{CurvedShell, CurvedShells, CurvedStrain, StrainHessian};
use crate::elements::block::Moduli;
use crate::elements::shell::in_plane::LinearisedPlane;
use crate::elements::shell::nodal_vectors::{NodalVectors, sum};
use crate::elements::shell::section::ShellSections;
use crate::state::{Configuration, Node};
use base::math::{Mat3, Vec3, fma, skew};
use std::array::from_fn;

/// A row of B by positions and rotations of the nodes.
type Row<const N: usize> = [[f64; 6]; N];

/// The rows of B: one for each strain.
struct CurvedRows<const N: usize, const P: usize, const Q: usize> {
    membrane: [Row<N>; P],
    bending: [Row<N>; P],
    shear: [Row<N>; Q],
    drilling: [Row<N>; N],
}

/// y ← y + s x.
#[inline(always)]
fn add<const N: usize>(y: &mut Row<N>, s: f64, x: &Row<N>) {
    for a in 0..N {
        for k in 0..6 {
            y[a][k] = fma(s, x[a][k], y[a][k]);
        }
    }
}

/// Sets the entries of node `a` in a row.
#[inline(always)]
fn set_entry<const N: usize>(row: &mut Row<N>, a: usize, x: &Vec3, theta: &Vec3) {
    row[a] = [x.x, x.y, x.z, theta.x, theta.y, theta.z];
}

impl<const N: usize, const P: usize, const Q: usize> CurvedRows<N, P, Q> {
    const ZERO: Self = {
        let zero = [[0.0; 6]; N];
        CurvedRows { membrane: [zero; P], bending: [zero; P], shear: [zero; Q], drilling: [zero; N] }
    };

    /// Each row.
    #[inline(always)]
    fn all(&self) -> impl Iterator<Item = &Row<N>> {
        self.membrane.iter().chain(&self.bending).chain(&self.shear).chain(&self.drilling)
    }

    /// Each row, to be changed.
    #[inline(always)]
    fn all_mut(&mut self) -> impl Iterator<Item = &mut Row<N>> {
        self.membrane.iter_mut().chain(&mut self.bending).chain(&mut self.shear).chain(&mut self.drilling)
    }

    /// Row i of BᵀX, i = component k of node a.
    #[inline(always)]
    fn transpose_times(&self, a: usize, k: usize, X: &Self, row: &mut Row<N>) {
        if k < 3 {
            // Products of slopes do not depend on rotations.
            for (B, X) in self.membrane.iter().zip(&X.membrane) {
                add(row, B[a][k], X);
            }
            for (B, X) in self.drilling.iter().zip(&X.drilling) {
                add(row, B[a][k], X);
            }
        } else {
            // A node's drilling is the only one that its rotation changes.
            add(row, self.drilling[a][a][k], &X.drilling[a]);
        }
        for (B, X) in self.bending.iter().zip(&X.bending) {
            add(row, B[a][k], X);
        }
        for (B, X) in self.shear.iter().zip(&X.shear) {
            add(row, B[a][k], X);
        }
    }
}

impl<const N: usize, const V: usize, const P: usize, const Q: usize, S> CurvedShell<N, V, P, Q, S> {
    /// ∂ε/∂(x, θ); `moment(k, a, g)` converts the derivative g by d (k = 0), p or q of node a to the derivative by its rotation.
    #[inline(always)]
    fn rows(
        &self,
        motion: &NodalVectors<N>,
        moment: impl Fn(usize, usize, &Vec3) -> Vec3,
        rows: &mut CurvedRows<N, P, Q>,
    ) {
        let NodalVectors { x, triads: [d, p, q] } = motion;
        let slopes = &self.sampling.slopes;
        let (v, w) = (NodalVectors::slopes(slopes, x), NodalVectors::slopes(slopes, d));
        for (n, &[i, j]) in self.sampling.pairs.iter().enumerate() {
            for a in 0..N {
                let [s, t] = [slopes[i][a], slopes[j][a]];
                let by = |v: &[Vec3; V]| if i == j { s * v[i] } else { s * v[j] + t * v[i] };
                let along = by(&v);
                set_entry(&mut rows.membrane[n], a, &along, &Vec3::zeros());
                set_entry(&mut rows.bending[n], a, &by(&w), &moment(0, a, &along));
            }
        }
        for (row, [slope, value]) in rows.shear.iter_mut().zip(&self.sampling.shears) {
            let (along, across) = (sum(value, d), sum(slope, x));
            for a in 0..N {
                set_entry(row, a, &(slope[a] * along), &moment(0, a, &(value[a] * across)));
            }
        }
        for (a, row) in rows.drilling.iter_mut().enumerate() {
            let [by_r, by_s] = &self.at_nodes[a];
            for b in 0..N {
                set_entry(row, b, &(0.5 * (by_r[b] * p[a] + by_s[b] * q[a])), &Vec3::zeros());
            }
            let turn = 0.5 * (moment(1, a, &sum(by_r, x)) + moment(2, a, &sum(by_s, x)));
            row[a][3..].copy_from_slice(turn.as_slice());
        }
    }

    /// C B.
    #[inline(always)]
    fn times(
        &self,
        LinearisedPlane { N: membrane, M: bending, NM, coupled, .. }: &LinearisedPlane<P, P, f64>,
        B: &CurvedRows<N, P, Q>,
    ) -> CurvedRows<N, P, Q> {
        let mut CB = CurvedRows::ZERO;
        for i in 0..P {
            for j in 0..P {
                add(&mut CB.membrane[i], membrane[i][j], &B.membrane[j]);
                add(&mut CB.bending[i], bending[i][j], &B.bending[j]);
            }
        }
        if *coupled {
            for i in 0..P {
                for j in 0..P {
                    add(&mut CB.membrane[i], NM[i][j], &B.bending[j]);
                    add(&mut CB.bending[j], NM[i][j], &B.membrane[i]);
                }
            }
        }
        for i in 0..Q {
            for j in 0..Q {
                add(&mut CB.shear[i], self.shear[i][j], &B.shear[j]);
            }
        }
        let [own, mean] = self.drilling;
        for i in 0..N {
            for j in 0..N {
                add(&mut CB.drilling[i], if i == j { own + mean } else { mean }, &B.drilling[j]);
            }
        }
        CB
    }
}

/// Tangent of element `e`, see [`crate::elements::ElementBlock::tangent`], with the stresses at `stressed` if given.
pub(super) fn tangent<
    T,
    const N: usize,
    const V: usize,
    const P: usize,
    const Q: usize,
    S: ShellSections<P, P, f64>,
>(
    shells: &CurvedShells<T, N, V, P, Q, S>,
    e: usize,
    (now, stressed): (&Configuration, Option<&[Node]>),
    rate_weight: Option<f64>,
    moduli: Moduli,
    K: &mut [f64],
) {
    let element = &shells.elements[e];
    let motion = element.gather(now.nodes);
    let strains = match stressed {
        Some(nodes) => element.strains(&element.gather(nodes), nodes),
        None => element.strains(&motion, now.nodes),
    };
    let C = element.section.linearise(&strains.plane, now, moduli);
    let stress = CurvedStrain {
        plane: C.stress,
        shear: element.shear_stress(&strains.shear),
        drilling: element.drilling_stress(&strains.drilling),
    };
    let triads = &motion.triads;
    let mut B = CurvedRows::<N, P, Q>::ZERO;
    element.rows(&motion, |k, a, g| triads[k][a].cross(g), &mut B);
    K.fill(0.0);
    add_product(&B, &element.times(&C, &B), K);
    add_strain_hessian(&element.strain_hessian(&stress), &element.gradient(&stress, &motion), &motion, K);
    if let Some(rate_weight) = rate_weight {
        add_damping(shells.damping, element, &motion, now, rate_weight, &mut B, K);
    }
}

/// K += the derivatives of the forces of damping by positions and rotations, and `rate_weight` times those by their rates. `B` is
/// scratch.
#[inline(always)]
fn add_damping<const N: usize, const V: usize, const P: usize, const Q: usize, S: ShellSections<P, P, f64>>(
    damping: f64,
    element: &CurvedShell<N, V, P, Q, S>,
    motion: &NodalVectors<N>,
    now: &Configuration,
    rate_weight: f64,
    B: &mut CurvedRows<N, P, Q>,
    K: &mut [f64],
) {
    let triads = &motion.triads;
    let rates = element.rates(motion, now.nodes);
    let omega: [Vec3; N] = from_fn(|a| now.nodes[element.nodes[a]].omega);
    // ∂ε̇/∂(x, θ): ε̇ is linear in positions and in their rates; ḋ = ω × d rotates with d.
    let (mut D, mut turned) = (CurvedRows::<N, P, Q>::ZERO, CurvedRows::<N, P, Q>::ZERO);
    element.rows(&rates, |k, a, g| triads[k][a].cross(g), &mut D);
    element.rows(motion, |k, a, g| triads[k][a].cross(&g.cross(&omega[a])), &mut turned);
    for ((D, turned), B) in D.all_mut().zip(turned.all()).zip(B.all()) {
        for a in 0..N {
            for k in 3..6 {
                D[a][k] += turned[a][k];
            }
        }
        add(D, rate_weight, B);
        D.as_flattened_mut().iter_mut().for_each(|d| *d *= damping);
    }
    add_product(B, &element.times(&element.section.elastic().linearised(), &D), K);
    let stress = element.viscous_stress(damping, motion, now.nodes);
    add_strain_hessian(&element.strain_hessian(&stress), &element.gradient(&stress, motion), motion, K);
}

/// K += BᵀX.
#[inline(always)]
fn add_product<const N: usize, const P: usize, const Q: usize>(
    B: &CurvedRows<N, P, Q>,
    X: &CurvedRows<N, P, Q>,
    K: &mut [f64],
) {
    for a in 0..N {
        for k in 0..6 {
            let mut row = [[0.0; 6]; N];
            B.transpose_times(a, k, X, &mut row);
            let at = (6 * a + k) * 6 * N;
            K[at..at + 6 * N].iter_mut().zip(row.as_flattened()).for_each(|(k, more)| *k += more);
        }
    }
}

/// K += σ·∂²ε of the strains that are bilinear in positions and directors, and δ(d × g) at fixed g.
#[inline(always)]
fn add_strain_hessian<const N: usize>(
    hessian: &StrainHessian<N>,
    gradient: &NodalVectors<N>,
    motion: &NodalVectors<N>,
    K: &mut [f64],
) {
    let (triads, width) = (&motion.triads, 6 * N);
    for a in 0..N {
        for b in 0..N {
            for i in 0..3 {
                K[(6 * a + i) * width + 6 * b + i] += hessian.xx[a][b];
            }
            // δd = δθ × d: the mixed part is −[Σ c d]~ and its transpose.
            let c: Vec3 = (0..3).map(|k| hessian.xd[k][a][b] * triads[k][b]).sum();
            add_mixed(a, b, &-skew(&c), K, width);
        }
        // (δθ × d) × g = (d gᵀ − (d·g) 1) δθ.
        let mut turn = Mat3::zeros();
        for k in 0..3 {
            let (d, g) = (&triads[k][a], &gradient.triads[k][a]);
            turn += d * g.transpose() - d.dot(g) * Mat3::identity();
        }
        add_block(6 * a + 3, 6 * a + 3, &turn, K, width);
    }
}

/// Adds a 3×3 block at a row and a column of K, whose rows have the length `width`.
#[inline(always)]
fn add_block(row: usize, column: usize, block: &Mat3, K: &mut [f64], width: usize) {
    for i in 0..3 {
        for j in 0..3 {
            K[(row + i) * width + column + j] += block[(i, j)];
        }
    }
}

/// Adds the block of the position of `a` and the rotation of `b`, and its transpose.
#[inline(always)]
fn add_mixed(a: usize, b: usize, block: &Mat3, K: &mut [f64], width: usize) {
    for i in 0..3 {
        for j in 0..3 {
            K[(6 * a + i) * width + 6 * b + 3 + j] += block[(i, j)];
            K[(6 * b + 3 + j) * width + 6 * a + i] += block[(i, j)];
        }
    }
}
