//! The matrix of a shell: BᵀCB of its few strains and σ·∂²ε.

use super::arc::Arc;
use super::section::{Plane, Section};
use super::{Bending, Curvature, Kind, Motion, Shell, Shells, Strains, sum};
use crate::elements::Moduli;
use crate::math::{Mat3, Vec3, fma, skew};
use crate::state::Configuration;
use std::array::from_fn;

/// A row of B over the nodes' positions and rotations.
type Row<const N: usize> = [[f64; 6]; N];

/// Rows of B by strain.
struct Rows<const N: usize, const M: usize> {
    plane: [[Row<N>; M]; 2],
    shear: [Row<N>; N],
    drill: [Row<N>; N],
}

#[inline(always)]
fn add<const N: usize>(y: &mut Row<N>, s: f64, x: &Row<N>) {
    for a in 0..N {
        for k in 0..6 {
            y[a][k] = fma(s, x[a][k], y[a][k]);
        }
    }
}

#[inline(always)]
fn entry<const N: usize>(row: &mut Row<N>, a: usize, x: &Vec3, theta: &Vec3) {
    row[a] = [x.x, x.y, x.z, theta.x, theta.y, theta.z];
}

impl<const N: usize, const V: usize, const M: usize, S> Shell<N, V, M, S> {
    /// ∂ε/∂(x, θ), where `moment(k, a, g)` makes of ∂ε/∂d (k = 0), ∂ε/∂t₁, ∂ε/∂t₂ at node a the part of rotation.
    #[inline(always)]
    fn rows<K: Kind<N, V>, const ARC: bool>(
        &self,
        motion: &Motion<N>,
        moment: impl Fn(usize, usize, &Vec3) -> Vec3,
        rows: &mut Rows<N, M>,
    ) {
        let Motion { x, turning: [d, t1, t2] } = motion;
        let (v, w) = (Motion::slopes::<K, V>(x), Motion::slopes::<K, V>(d));
        let arc = Arc::new::<K, N>(w);
        let at = |y: &[Vec3; V], a: usize| (0..V).map(|i| K::SLOPES[i][a] * y[i]).sum::<Vec3>();
        for m in 0..M {
            let y: [Vec3; V] = from_fn(|i| sum(&self.Q[m][i], &v));
            let z: [Vec3; V] = from_fn(|i| sum(&self.Q[m][i], if ARC { &arc.long } else { &w }));
            let g = if ARC { arc.gradient(&y) } else { y };
            for a in 0..N {
                entry(&mut rows.plane[0][m], a, &at(&y, a), &Vec3::zeros());
                entry(&mut rows.plane[1][m], a, &at(&z, a), &moment(0, a, &at(&g, a)));
            }
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            rows.shear[e] = [[0.0; 6]; N];
            let (mean, half) = (0.5 * (d[a] + d[b]), 0.5 * (x[b] - x[a]));
            entry(&mut rows.shear[e], a, &-mean, &moment(0, a, &half));
            entry(&mut rows.shear[e], b, &mean, &moment(0, b, &half));
        }
        for g in 0..N {
            let values = &K::VALUES[g];
            let [x1, x2] = self.slopes[g].map(|s| 0.5 * sum(&s, &v));
            let (t1, t2) = (0.5 * sum(values, t1), 0.5 * sum(values, t2));
            let y: [Vec3; V] = from_fn(|i| self.slopes[g][0][i] * t2 - self.slopes[g][1][i] * t1);
            for a in 0..N {
                let theta = values[a] * (moment(2, a, &x1) - moment(1, a, &x2));
                entry(&mut rows.drill[g], a, &at(&y, a), &theta);
            }
        }
    }

    /// C B.
    #[inline(always)]
    fn times(&self, plane: &Plane<M>, B: &Rows<N, M>) -> Rows<N, M> {
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

    #[inline(always)]
    fn all(&self) -> impl Iterator<Item = &Row<N>> {
        self.plane.as_flattened().iter().chain(&self.shear).chain(&self.drill)
    }

    #[inline(always)]
    fn all_mut(&mut self) -> impl Iterator<Item = &mut Row<N>> {
        self.plane.as_flattened_mut().iter_mut().chain(&mut self.shear).chain(&mut self.drill)
    }

    /// Row i of BᵀX, i = component k of node a.
    #[inline(always)]
    fn transpose_times(&self, a: usize, k: usize, X: &Self, row: &mut Row<N>) {
        for m in 0..M {
            // Membranes do not feel rotations.
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

impl<K, const N: usize, const V: usize, const M: usize, S> Shells<K, N, V, M, S>
where
    K: Kind<N, V>,
    S: Section<M>,
{
    pub(super) fn tangent_of<const DAMPED: bool>(
        &self,
        e: usize,
        now: &Configuration,
        rate_weight: f64,
        moduli: Moduli,
        K: &mut [f64],
    ) {
        let element = &self.elements[e];
        let motion = element.gather(now.nodes);
        let strains = element.strains::<K>(&motion);
        let mut room = Plane::ZERO;
        let (plane, C) = element.section.linearise(&strains.plane, now, moduli, &mut room);
        let (shear, drill) = element.across(&strains);
        let stress = Strains { plane, shear, drill };
        let turning = &motion.turning;
        let mut B = Rows::<N, M>::ZERO;
        element.rows::<K, true>(&motion, |k, a, g| turning[k][a].cross(g), &mut B);
        set_product(&B, &element.times(C, &B), K);
        let bending = Bending::new::<K, N>(element.by_slopes(&stress.plane[1]), &motion);
        add_bending::<K, N, V>(&bending, &turning[0], K);
        let curvature = element.curvature::<K, true>(&stress);
        let mut gradient = curvature.gradient(&motion);
        bending.add_gradient::<K, N>(&mut gradient);
        add_curvature(&curvature, &gradient, &motion, K);
        if DAMPED {
            let rates = element.rates(&motion, now.nodes);
            let omega: [Vec3; N] = from_fn(|a| now.nodes[element.nodes[a]].omega);
            // ∂ε̇/∂(x, θ): ε̇ is linear in positions and in their rates; ḋ = ω × d turns with d.
            let (mut D, mut turned) = (Rows::<N, M>::ZERO, Rows::<N, M>::ZERO);
            element.rows::<K, false>(&rates, |k, a, g| turning[k][a].cross(g), &mut D);
            element.rows::<K, false>(&motion, |k, a, g| turning[k][a].cross(&g.cross(&omega[a])), &mut turned);
            element.rows::<K, false>(&motion, |k, a, g| turning[k][a].cross(g), &mut B);
            for ((D, turned), B) in D.all_mut().zip(turned.all()).zip(B.all()) {
                for a in 0..N {
                    for k in 3..6 {
                        D[a][k] += turned[a][k];
                    }
                }
                add(D, rate_weight, B);
                D.as_flattened_mut().iter_mut().for_each(|d| *d *= self.damping);
            }
            let mut viscous = [[[[0.0; 6]; N]; 6]; N];
            set_product(
                &B,
                &element.times(element.section.elastic(), &D),
                viscous.as_flattened_mut().as_flattened_mut().as_flattened_mut(),
            );
            K.iter_mut().zip(viscous.as_flattened().as_flattened().as_flattened()).for_each(|(k, more)| *k += more);
            let curvature = element.curvature::<K, false>(&self.viscous(element, &motion, now.nodes));
            add_curvature(&curvature, &curvature.gradient(&motion), &motion, K);
        }
    }
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

/// K += σ·∂²ε of what is bilinear in positions and directors, and δ(d × g) at fixed g.
#[inline(always)]
fn add_curvature<const N: usize>(curvature: &Curvature<N>, gradient: &Motion<N>, motion: &Motion<N>, K: &mut [f64]) {
    let (turning, width) = (&motion.turning, 6 * N);
    for a in 0..N {
        for b in 0..N {
            for i in 0..3 {
                K[(6 * a + i) * width + 6 * b + i] += curvature.xx[a][b];
            }
            // δd = δθ × d: the mixed part is −[Σ c d]~ and its transpose.
            let c: Vec3 = (0..3).map(|k| curvature.xd[k][a][b] * turning[k][b]).sum();
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

#[inline(always)]
fn add_block(row: usize, column: usize, block: &Mat3, K: &mut [f64], width: usize) {
    for i in 0..3 {
        for j in 0..3 {
            K[(row + i) * width + column + j] += block[(i, j)];
        }
    }
}

/// Position of a against rotation of b, and its transpose.
#[inline(always)]
fn add_mixed(a: usize, b: usize, block: &Mat3, K: &mut [f64], width: usize) {
    for i in 0..3 {
        for j in 0..3 {
            K[(6 * a + i) * width + 6 * b + 3 + j] += block[(i, j)];
            K[(6 * b + 3 + j) * width + 6 * a + i] += block[(i, j)];
        }
    }
}

/// K += σ·∂²ε of bending by angles.
#[inline(always)]
fn add_bending<T: Kind<N, V>, const N: usize, const V: usize>(bending: &Bending<V>, d: &[Vec3; N], K: &mut [f64]) {
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
