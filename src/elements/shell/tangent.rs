//! The tangent of a shell element: BᵀCB of its strains and σ·∂²ε.

use super::arc::Arc;
use super::interpolation::Interpolation;
use super::kinematics::{Bending, NodalVectors, Shell, Shells, StrainHessian, Strains, sum};
use super::section::{ShellSection, ShellStiffness};
use crate::elements::block::Moduli;
use crate::math::{Mat3, Vec3, fma, skew};
use crate::state::{Configuration, Node};
use std::array::from_fn;

/// A row of B by positions and rotations of the nodes.
type Row<const N: usize> = [[f64; 6]; N];

/// The rows of B: one for each strain.
struct Rows<const N: usize, const M: usize> {
    plane: [[Row<N>; M]; 2],
    shear: [Row<N>; N],
    drill: [Row<N>; N],
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

impl<const N: usize, const V: usize, const M: usize, S> Shell<N, V, M, S> {
    /// ∂ε/∂(x, θ), where `moment(k, a, g)` turns the derivative g by d (k = 0), t₁ or t₂ of node a into that by its rotation.
    #[inline(always)]
    fn rows<K: Interpolation<N, V>, const ARC: bool>(
        &self,
        motion: &NodalVectors<N>,
        moment: impl Fn(usize, usize, &Vec3) -> Vec3,
        rows: &mut Rows<N, M>,
    ) {
        let NodalVectors { x, turning: [d, t1, t2] } = motion;
        let (v, w) = (NodalVectors::slopes::<K, V>(x), NodalVectors::slopes::<K, V>(d));
        let arc = Arc::new::<K, N>(w);
        let at = |y: &[Vec3; V], a: usize| (0..V).map(|i| K::SLOPES[i][a] * y[i]).sum::<Vec3>();
        for m in 0..M {
            let y: [Vec3; V] = from_fn(|i| sum(&self.Q[m][i], &v));
            let z: [Vec3; V] = from_fn(|i| sum(&self.Q[m][i], if ARC { &arc.long } else { &w }));
            let g = if ARC { arc.gradient(&y) } else { y };
            for a in 0..N {
                set_entry(&mut rows.plane[0][m], a, &at(&y, a), &Vec3::zeros());
                set_entry(&mut rows.plane[1][m], a, &at(&z, a), &moment(0, a, &at(&g, a)));
            }
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            rows.shear[e] = [[0.0; 6]; N];
            let (mean, half) = (0.5 * (d[a] + d[b]), 0.5 * (x[b] - x[a]));
            set_entry(&mut rows.shear[e], a, &-mean, &moment(0, a, &half));
            set_entry(&mut rows.shear[e], b, &mean, &moment(0, b, &half));
        }
        for g in 0..N {
            let values = &K::VALUES[g];
            let [x1, x2] = self.slopes[g].map(|s| 0.5 * sum(&s, &v));
            let (t1, t2) = (0.5 * sum(values, t1), 0.5 * sum(values, t2));
            let y: [Vec3; V] = from_fn(|i| self.slopes[g][0][i] * t2 - self.slopes[g][1][i] * t1);
            for a in 0..N {
                let theta = values[a] * (moment(2, a, &x1) - moment(1, a, &x2));
                set_entry(&mut rows.drill[g], a, &at(&y, a), &theta);
            }
        }
    }

    /// C B, with the in-plane stiffness `plane`.
    #[inline(always)]
    fn times(&self, plane: &ShellStiffness<M>, B: &Rows<N, M>) -> Rows<N, M> {
        let zero = [[0.0; 6]; N];
        let mut CB = Rows { plane: [[zero; M]; 2], shear: [zero; N], drill: [zero; N] };
        for i in 0..M {
            for j in 0..M {
                add(&mut CB.plane[0][i], plane.N[i][j], &B.plane[0][j]);
                add(&mut CB.plane[1][i], plane.M[i][j], &B.plane[1][j]);
                if plane.coupled {
                    add(&mut CB.plane[0][i], plane.NM[i][j], &B.plane[1][j]);
                    add(&mut CB.plane[1][i], plane.NM[j][i], &B.plane[0][j]);
                }
            }
        }
        for i in 0..N {
            for j in 0..N {
                add(&mut CB.shear[i], self.shear[i][j], &B.shear[j]);
                add(&mut CB.drill[i], self.drilling[i][j], &B.drill[j]);
            }
        }
        CB
    }
}

impl<const N: usize, const M: usize> Rows<N, M> {
    const ZERO: Self = {
        let zero = [[0.0; 6]; N];
        Rows { plane: [[zero; M]; 2], shear: [zero; N], drill: [zero; N] }
    };

    /// Each row.
    #[inline(always)]
    fn all(&self) -> impl Iterator<Item = &Row<N>> {
        self.plane.as_flattened().iter().chain(&self.shear).chain(&self.drill)
    }

    /// Each row, to be changed.
    #[inline(always)]
    fn all_mut(&mut self) -> impl Iterator<Item = &mut Row<N>> {
        self.plane.as_flattened_mut().iter_mut().chain(&mut self.shear).chain(&mut self.drill)
    }

    /// Row i of BᵀX, i = component k of node a.
    #[inline(always)]
    fn transpose_times(&self, a: usize, k: usize, X: &Self, row: &mut Row<N>) {
        for m in 0..M {
            // Membrane strains do not depend on rotations.
            if k < 3 {
                add(row, self.plane[0][m][a][k], &X.plane[0][m]);
            }
            add(row, self.plane[1][m][a][k], &X.plane[1][m]);
        }
        for i in 0..N {
            add(row, self.shear[i][a][k], &X.shear[i]);
            add(row, self.drill[i][a][k], &X.drill[i]);
        }
    }
}

/// Tangent of element `e`, see [`crate::elements::ElementBlock::tangent`], with the stresses at the nodes `stressed` in place of its own;
/// symmetric unless `DAMPED`.
pub(super) fn tangent<T, const N: usize, const V: usize, const M: usize, S, const DAMPED: bool>(
    shells: &Shells<T, N, V, M, S>,
    e: usize,
    (now, stressed): (&Configuration, Option<&[Node]>),
    rate_weight: f64,
    moduli: Moduli,
    K: &mut [f64],
) where
    T: Interpolation<N, V>,
    S: ShellSection<M>,
{
    let element = &shells.elements[e];
    let motion = element.gather(now.nodes);
    let strains = match stressed {
        Some(nodes) => element.strains::<T>(&element.gather(nodes)),
        None => element.strains::<T>(&motion),
    };
    let mut place = ShellStiffness::ZERO;
    let (plane, C) = element.section.linearise(&strains.plane, now, moduli, &mut place);
    let (shear, drill) = element.shear_and_drilling(&strains);
    let stress = Strains { plane, shear, drill };
    let turning = &motion.turning;
    let mut B = Rows::<N, M>::ZERO;
    element.rows::<T, true>(&motion, |k, a, g| turning[k][a].cross(g), &mut B);
    set_product(&B, &element.times(C, &B), K);
    let bending = Bending::new::<T, N>(element.by_slopes(&stress.plane[1]), &motion);
    add_bending::<T, N, V>(&bending, &turning[0], K);
    let hessian = element.strain_hessian::<T, true>(&stress);
    let mut gradient = hessian.gradient(&motion);
    bending.add_gradient::<T, N>(&mut gradient);
    add_strain_hessian(&hessian, &gradient, &motion, K);
    if DAMPED {
        add_damping(shells, element, &motion, now, rate_weight, &mut B, K);
    }
}

/// K += the derivatives of the forces of damping by positions and rotations, and `rate_weight` times those by their rates. `B` is
/// scratch.
#[inline(always)]
fn add_damping<T, const N: usize, const V: usize, const M: usize, S>(
    shells: &Shells<T, N, V, M, S>,
    element: &Shell<N, V, M, S>,
    motion: &NodalVectors<N>,
    now: &Configuration,
    rate_weight: f64,
    B: &mut Rows<N, M>,
    K: &mut [f64],
) where
    T: Interpolation<N, V>,
    S: ShellSection<M>,
{
    let turning = &motion.turning;
    let rates = element.rates(motion, now.nodes);
    let omega: [Vec3; N] = from_fn(|a| now.nodes[element.nodes[a]].omega);
    // ∂ε̇/∂(x, θ): ε̇ is linear in positions and in their rates; ḋ = ω × d rotates with d.
    let (mut D, mut turned) = (Rows::<N, M>::ZERO, Rows::<N, M>::ZERO);
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
    set_product(
        B,
        &element.times(element.section.elastic(), &D),
        viscous.as_flattened_mut().as_flattened_mut().as_flattened_mut(),
    );
    K.iter_mut().zip(viscous.as_flattened().as_flattened().as_flattened()).for_each(|(k, more)| *k += more);
    let hessian = element.strain_hessian::<T, false>(&shells.viscous_stress(element, motion, now.nodes));
    add_strain_hessian(&hessian, &hessian.gradient(motion), motion, K);
}

/// K ← BᵀX.
#[inline(always)]
fn set_product<const N: usize, const M: usize>(B: &Rows<N, M>, X: &Rows<N, M>, K: &mut [f64]) {
    for a in 0..N {
        for k in 0..6 {
            let mut row = [[0.0; 6]; N];
            B.transpose_times(a, k, X, &mut row);
            let at = (6 * a + k) * 6 * N;
            K[at..at + 6 * N].copy_from_slice(row.as_flattened());
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
fn add_bending<T: Interpolation<N, V>, const N: usize, const V: usize>(
    bending: &Bending<V>,
    d: &[Vec3; N],
    K: &mut [f64],
) {
    let Bending { arc, Q, p } = bending;
    let width = 6 * N;
    let J: [[Mat3; V]; V] = from_fn(|b| from_fn(|k| arc.slope(b, k)));
    let mixed: [[Mat3; V]; V] = from_fn(|i| from_fn(|k| (0..V).map(|b| Q[i][b] * J[b][k]).sum()));
    let H = arc.hessian::<T, N>(p);
    for b in 0..N {
        let turn = -skew(&d[b]);
        let along =
            |row: &[Mat3]| -> Mat3 { row.iter().enumerate().map(|(k, m)| T::SLOPES[k][b] * m).sum::<Mat3>() * turn };
        let mixed: [Mat3; V] = from_fn(|i| along(&mixed[i]));
        let H = [along(&H[0]), along(&H[1])];
        for a in 0..N {
            let block = (0..V).map(|i| T::SLOPES[i][a] * mixed[i]).sum();
            add_mixed(a, b, &block, K, width);
            let block = skew(&d[a]) * (T::SLOPES[0][a] * H[0] + T::SLOPES[1][a] * H[1]);
            add_block(6 * a + 3, 6 * b + 3, &block, K, width);
        }
    }
}
