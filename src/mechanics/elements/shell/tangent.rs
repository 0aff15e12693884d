//! The tangent of a shell element: BᵀCB of its strains and σ·∂²ε.

use super::arc::Arc;
use super::interpolation::Interpolation;
use super::kinematics::{Bending, NodalVectors, Shell, Shells, StrainHessian, Strains, first_bending};
use super::section::{CoupledStiffness, SectionTangent, ShellSection};
use crate::elements::block::Moduli;
use crate::state::{Configuration, Node};
use base::math::{Mat3, Vec3, fma, skew};
use std::array::from_fn;

/// A row of B by positions and rotations of the nodes.
pub(super) type Row<const N: usize> = [[f64; 6]; N];

/// The rows of B: one for each strain.
struct Rows<const N: usize, const P: usize, const E: usize> {
    membrane: [Row<N>; E],
    bending: [Row<N>; P],
    shear: [Row<N>; N],
}

/// y ← y + s x.
#[inline(always)]
pub(super) fn add<const N: usize>(y: &mut Row<N>, s: f64, x: &Row<N>) {
    for a in 0..N {
        for k in 0..6 {
            y[a][k] = fma(s, x[a][k], y[a][k]);
        }
    }
}

/// Sets the entries of node `a` in a row.
#[inline(always)]
pub(super) fn set_entry<const N: usize>(row: &mut Row<N>, a: usize, x: &Vec3, theta: &Vec3) {
    row[a] = [x.x, x.y, x.z, theta.x, theta.y, theta.z];
}

impl<const N: usize, const V: usize, const P: usize, const E: usize, S> Shell<N, V, P, E, S> {
    /// ∂ε/∂(x, θ), where `moment(k, a, g)` turns the derivative g by d (k = 0), t₁ or t₂ of node a into that by its rotation.
    #[inline(always)]
    fn rows<K: Interpolation<N, V, P>, const ARC: bool>(
        &self,
        motion: &NodalVectors<N>,
        moment: impl Fn(usize, usize, &Vec3) -> Vec3,
        rows: &mut Rows<N, P, E>,
    ) {
        let NodalVectors { x, turning: [d, t1, t2] } = motion;
        let (v, w) = (NodalVectors::slopes(&self.slopes, x), NodalVectors::slopes(&self.slopes, d));
        let arc = Arc::new(&self.arc, w);
        let bent = if ARC { &arc.long } else { &w };
        for (n, [i, j]) in K::PAIRS.into_iter().enumerate() {
            let mut y = [Vec3::zeros(); V];
            y[i] = v[j];
            y[j] = v[i];
            let g = if ARC { arc.gradient(&y) } else { y };
            for a in 0..N {
                let [s, t] = [self.slopes[i][a], self.slopes[j][a]];
                let along = if i == j { s * v[i] } else { s * v[j] + t * v[i] };
                set_entry(&mut rows.membrane[n], a, &along, &Vec3::zeros());
                let along = if i == j { s * bent[i] } else { s * bent[j] + t * bent[i] };
                let across: Vec3 = (0..V).map(|i| self.slopes[i][a] * g[i]).sum();
                set_entry(&mut rows.bending[n], a, &along, &moment(0, a, &across));
            }
        }
        if ARC && K::CAMBERED {
            for (m, slopes) in self.camber().slopes(&first_bending(&v, bent)).into_iter().enumerate() {
                (0..3).for_each(|n| add(&mut rows.membrane[m], slopes[n], &rows.bending[n]));
            }
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            rows.shear[e] = [[0.0; 6]; N];
            rows.membrane[P + e] = [[0.0; 6]; N];
            let along = x[b] - x[a];
            let (mean, half) = (0.5 * (d[a] + d[b]), 0.5 * along);
            let edge = &self.edges[e];
            let bulge = edge.vector(0, &t1[a], &t2[a]) + edge.vector(1, &t1[b], &t2[b]);
            for (end, node, sign) in [(0, a, -1.0), (1, b, 1.0)] {
                set_entry(&mut rows.shear[e], node, &(sign * mean), &moment(0, node, &half));
                let [c1, c2] = edge.0[end];
                let turn = moment(1, node, &(c1 * along)) + moment(2, node, &(c2 * along));
                set_entry(&mut rows.membrane[P + e], node, &(sign * bulge), &turn);
            }
        }
        let mean = 0.5 / N as f64;
        let (t1, t2): (Vec3, Vec3) = (t1.iter().sum(), t2.iter().sum());
        for a in 0..N {
            let along = mean * (self.slopes[1][a] * t1 - self.slopes[0][a] * t2);
            let turn = mean * (moment(1, a, &v[1]) - moment(2, a, &v[0]));
            set_entry(&mut rows.membrane[E - 1], a, &along, &turn);
        }
    }

    /// C B, with the in-plane stiffness `plane`.
    #[inline(always)]
    fn times<K: Interpolation<N, V, P>>(
        &self,
        SectionTangent { plane, NM }: SectionTangent<P, E>,
        B: &Rows<N, P, E>,
    ) -> Rows<N, P, E> {
        let mut CB = Rows::ZERO;
        let mut bending = B.bending;
        if K::EDGES_BEND {
            for (row, by) in bending.iter_mut().zip(&self.bent.0) {
                (0..N).for_each(|e| add(row, by[e], &B.shear[e]));
            }
        }
        for i in 0..E {
            for j in 0..E {
                add(&mut CB.membrane[i], plane.N[i][j], &B.membrane[j]);
            }
        }
        for i in 0..P {
            for j in 0..P {
                add(&mut CB.bending[i], plane.M[i][j], &bending[j]);
            }
        }
        if let Some(NM) = NM {
            for i in 0..E {
                for j in 0..P {
                    add(&mut CB.membrane[i], NM[i][j], &bending[j]);
                    add(&mut CB.bending[j], NM[i][j], &B.membrane[i]);
                }
            }
        }
        for i in 0..N {
            for j in 0..N {
                add(&mut CB.shear[i], self.shear[i][j], &B.shear[j]);
            }
        }
        if K::EDGES_BEND {
            for (row, by) in CB.bending.iter().zip(&self.bent.0) {
                (0..N).for_each(|e| add(&mut CB.shear[e], by[e], row));
            }
        }
        CB
    }
}

impl<const N: usize, const P: usize, const E: usize> Rows<N, P, E> {
    const ZERO: Self = {
        let zero = [[0.0; 6]; N];
        Rows { membrane: [zero; E], bending: [zero; P], shear: [zero; N] }
    };

    /// Each row.
    #[inline(always)]
    fn all(&self) -> impl Iterator<Item = &Row<N>> {
        self.membrane.iter().chain(&self.bending).chain(&self.shear)
    }

    /// Each row, to be changed.
    #[inline(always)]
    fn all_mut(&mut self) -> impl Iterator<Item = &mut Row<N>> {
        self.membrane.iter_mut().chain(&mut self.bending).chain(&mut self.shear)
    }

    /// Row i of BᵀX, i = component k of node a.
    #[inline(always)]
    fn transpose_times<K: Interpolation<N, V, P>, const V: usize>(
        &self,
        a: usize,
        k: usize,
        X: &Self,
        row: &mut Row<N>,
    ) {
        for m in 0..P {
            // Of products of slopes only the first depend on rotations, by the curvature.
            if k < 3 || (K::CAMBERED && m < 3) {
                add(row, self.membrane[m][a][k], &X.membrane[m]);
            }
            add(row, self.bending[m][a][k], &X.bending[m]);
        }
        for (e, ends) in K::EDGES.into_iter().enumerate() {
            if ends.contains(&a) {
                add(row, self.membrane[P + e][a][k], &X.membrane[P + e]);
                add(row, self.shear[e][a][k], &X.shear[e]);
            }
        }
        add(row, self.membrane[E - 1][a][k], &X.membrane[E - 1]);
    }
}

/// Tangent of element `e`, see [`crate::elements::ElementBlock::tangent`], with the stresses at the nodes `stressed` in place of its own;
/// symmetric unless `DAMPED`.
pub(super) fn tangent<T, const N: usize, const V: usize, const P: usize, const E: usize, S, const DAMPED: bool>(
    shells: &Shells<T, N, V, P, E, S>,
    e: usize,
    (now, stressed): (&Configuration, Option<&[Node]>),
    rate_weight: f64,
    moduli: Moduli,
    K: &mut [f64],
) where
    T: Interpolation<N, V, P>,
    S: ShellSection<P, E>,
{
    let element = &shells.elements[e];
    let motion = element.gather(now.nodes);
    let strains = match stressed {
        Some(nodes) => element.strains::<T>(&element.gather(nodes)),
        None => element.strains::<T>(&motion),
    };
    let mut place = CoupledStiffness::ZERO;
    let (plane, C) = element.section.linearise(&strains.plane, now, moduli, &mut place);
    let stress = Strains { plane, shear: element.edge_stress::<T>(&strains.shear, &plane) };
    let turning = &motion.turning;
    let mut B = Rows::<N, P, E>::ZERO;
    element.rows::<T, true>(&motion, |k, a, g| turning[k][a].cross(g), &mut B);
    let mut CB = element.times::<T>(C, &B);
    if T::CAMBERED {
        for (n, row) in element.camber().stiffness(&stress.plane.membrane).iter().enumerate() {
            (0..3).for_each(|k| add(&mut CB.bending[n], row[k], &B.bending[k]));
        }
    }
    set_product::<T, N, V, P, E>(&B, &CB, K);
    let bending = Bending::new::<T, N, P, E, S>(element, &stress.plane, &motion);
    add_bending(&bending, &element.slopes, &turning[0], K);
    let hessian = element.strain_hessian::<T, true>(&stress);
    let gradient = element.gradient::<T, true>(&stress, &motion);
    add_strain_hessian(&hessian, &gradient, &motion, K);
    if DAMPED {
        add_damping(shells, element, &motion, now, rate_weight, &mut B, K);
    }
}

/// K += the derivatives of the forces of damping by positions and rotations, and `rate_weight` times those by their rates. `B` is
/// scratch.
#[inline(always)]
fn add_damping<T, const N: usize, const V: usize, const P: usize, const E: usize, S>(
    shells: &Shells<T, N, V, P, E, S>,
    element: &Shell<N, V, P, E, S>,
    motion: &NodalVectors<N>,
    now: &Configuration,
    rate_weight: f64,
    B: &mut Rows<N, P, E>,
    K: &mut [f64],
) where
    T: Interpolation<N, V, P>,
    S: ShellSection<P, E>,
{
    let turning = &motion.turning;
    let rates = element.rates(motion, now.nodes);
    let omega: [Vec3; N] = from_fn(|a| now.nodes[element.nodes[a]].omega);
    // ∂ε̇/∂(x, θ): ε̇ is linear in positions and in their rates; ḋ = ω × d rotates with d.
    let (mut D, mut turned) = (Rows::<N, P, E>::ZERO, Rows::<N, P, E>::ZERO);
    element.rows::<T, false>(&rates, |k, a, g| turning[k][a].cross(g), &mut D);
    element.rows::<T, false>(motion, |k, a, g| turning[k][a].cross(&g.cross(&omega[a])), &mut turned);
    element.rows::<T, false>(motion, |k, a, g| turning[k][a].cross(g), B);
    for ((D, turned), B) in D.all_mut().zip(turned.all()).zip(B.all()) {
        for a in 0..N {
            for k in 3..6 {
                D[a][k] += turned[a][k];
            }
        }
        add(D, rate_weight, B);
        D.as_flattened_mut().iter_mut().for_each(|d| *d *= shells.damping);
    }
    let mut viscous = [[[[0.0; 6]; N]; 6]; N];
    set_product::<T, N, V, P, E>(
        B,
        &element.times::<T>(element.section.elastic().tangent(), &D),
        viscous.as_flattened_mut().as_flattened_mut().as_flattened_mut(),
    );
    K.iter_mut().zip(viscous.as_flattened().as_flattened().as_flattened()).for_each(|(k, more)| *k += more);
    let stress = shells.viscous_stress(element, motion, now.nodes);
    let hessian = element.strain_hessian::<T, false>(&stress);
    add_strain_hessian(&hessian, &element.gradient::<T, false>(&stress, motion), motion, K);
}

/// K ← BᵀX.
#[inline(always)]
fn set_product<T: Interpolation<N, V, P>, const N: usize, const V: usize, const P: usize, const E: usize>(
    B: &Rows<N, P, E>,
    X: &Rows<N, P, E>,
    K: &mut [f64],
) {
    for a in 0..N {
        for k in 0..6 {
            let mut row = [[0.0; 6]; N];
            B.transpose_times::<T, V>(a, k, X, &mut row);
            let at = (6 * a + k) * 6 * N;
            K[at..at + 6 * N].copy_from_slice(row.as_flattened());
        }
    }
}

/// K += σ·∂²ε of the strains that are bilinear in positions and directors, and δ(d × g) at fixed g.
#[inline(always)]
pub(super) fn add_strain_hessian<const N: usize>(
    hessian: &StrainHessian<N>,
    gradient: &NodalVectors<N>,
    motion: &NodalVectors<N>,
    K: &mut [f64],
) {
    let (turning, width) = (&motion.turning, 6 * N);
    for a in 0..N {
        for b in 0..N {
            for i in 0..3 {
                K[(6 * a + i) * width + 6 * b + i] += hessian.xx[a][b];
            }
            // δd = δθ × d: the mixed part is −[Σ c d]~ and its transpose.
            let c: Vec3 = (0..3).map(|k| hessian.xd[k][a][b] * turning[k][b]).sum();
            add_mixed(a, b, &-skew(&c), K, width);
        }
        // (δθ × d) × g = (d gᵀ − (d·g) 1) δθ.
        let mut turn = Mat3::zeros();
        for k in 0..3 {
            let (d, g) = (&turning[k][a], &gradient.turning[k][a]);
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

/// K += σ·∂²ε of bending measured by angles.
#[inline(always)]
fn add_bending<const N: usize, const V: usize>(
    bending: &Bending<V>,
    slopes: &[[f64; N]; V],
    d: &[Vec3; N],
    K: &mut [f64],
) {
    let Bending { arc, Q, p } = bending;
    let width = 6 * N;
    let J: [[Mat3; V]; V] = from_fn(|b| from_fn(|k| arc.slope(b, k)));
    let mixed: [[Mat3; V]; V] = from_fn(|i| from_fn(|k| (0..V).map(|b| Q[i][b] * J[b][k]).sum()));
    let H = arc.hessian(p);
    for b in 0..N {
        let turn = -skew(&d[b]);
        let along =
            |row: &[Mat3]| -> Mat3 { row.iter().enumerate().map(|(k, m)| slopes[k][b] * m).sum::<Mat3>() * turn };
        let mixed: [Mat3; V] = from_fn(|i| along(&mixed[i]));
        let H = [along(&H[0]), along(&H[1])];
        for a in 0..N {
            let block = (0..V).map(|i| slopes[i][a] * mixed[i]).sum();
            add_mixed(a, b, &block, K, width);
            let block = skew(&d[a]) * (slopes[0][a] * H[0] + slopes[1][a] * H[1]);
            add_block(6 * a + 3, 6 * b + 3, &block, K, width);
        }
    }
}
