//! The matrix of a shell: BᵀCB of its few strains and σ·∂²ε, which is constant in positions and directors.

use super::section::{Plane, Section};
use super::{Kind, Motion, Shell, Shells, Strains, sum};
use crate::elements::Moduli;
use crate::math::{Mat3, Vec3, fma, skew};
use crate::state::Now;
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
    fn rows<K: Kind<N, V>>(
        &self,
        motion: &Motion<N>,
        moment: impl Fn(usize, usize, &Vec3) -> Vec3,
        rows: &mut Rows<N, M>,
    ) {
        let Motion { x, turning: [d, t1, t2] } = motion;
        let (v, w) = (Motion::slopes::<K, V>(x), Motion::slopes::<K, V>(d));
        let at = |y: &[Vec3; V], a: usize| (0..V).map(|i| K::SLOPES[i][a] * y[i]).sum::<Vec3>();
        for m in 0..M {
            let y: [Vec3; V] = from_fn(|i| sum(&self.Q[m][i], &v));
            let z: [Vec3; V] = from_fn(|i| sum(&self.Q[m][i], &w));
            for a in 0..N {
                let g = at(&y, a);
                entry(&mut rows.plane[0][m], a, &g, &Vec3::zeros());
                entry(&mut rows.plane[1][m], a, &at(&z, a), &moment(0, a, &g));
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
            }
            add(&mut CB.drill[i], self.drilling[i], &B.drill[i]);
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
        now: &Now,
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
        let mut stress = Strains { plane, shear, drill };
        let turning = &motion.turning;
        let mut B = Rows::<N, M>::ZERO;
        element.rows::<K>(&motion, |k, a, g| turning[k][a].cross(g), &mut B);
        let mut CB = element.times(C, &B);
        if DAMPED {
            self.add_damping(element, &motion, now.nodes, &mut stress);
            let rates = element.rates(&motion, now.nodes);
            // ∂ε̇/∂(x, θ): ε̇ is linear in positions and in their rates; ḋ = ω × d turns with d.
            let (mut D, mut turned) = (Rows::<N, M>::ZERO, Rows::<N, M>::ZERO);
            element.rows::<K>(&rates, |k, a, g| turning[k][a].cross(g), &mut D);
            let omega: [Vec3; N] = from_fn(|a| now.nodes[element.nodes[a]].omega);
            element.rows::<K>(&motion, |k, a, g| turning[k][a].cross(&g.cross(&omega[a])), &mut turned);
            for (D, turned) in D.all_mut().zip(turned.all()) {
                for a in 0..N {
                    for k in 3..6 {
                        D[a][k] += turned[a][k];
                    }
                }
            }
            for (D, B) in D.all_mut().zip(B.all()) {
                add(D, rate_weight, B);
            }
            let viscous = element.times(element.section.elastic(), &D);
            CB.all_mut().zip(viscous.all()).for_each(|(sum, more)| add(sum, self.damping, more));
        }
        for a in 0..N {
            for k in 0..6 {
                let mut row = [[0.0; 6]; N];
                B.transpose_times(a, k, &CB, &mut row);
                let at = (6 * a + k) * 6 * N;
                K[at..at + 6 * N].copy_from_slice(row.as_flattened());
            }
        }
        let curvature = element.curvature::<K>(&stress);
        let gradient = curvature.gradient(&motion);
        let width = 6 * N;
        for a in 0..N {
            for b in 0..N {
                for i in 0..3 {
                    K[(6 * a + i) * width + 6 * b + i] += curvature.xx[a][b];
                }
                // δd = δθ × d: the mixed part is −[Σ c d]~ and its transpose.
                let c: Vec3 = (0..3).map(|k| curvature.xd[k][a][b] * turning[k][b]).sum();
                let mixed = skew(&c);
                for i in 0..3 {
                    for j in 0..3 {
                        K[(6 * a + i) * width + 6 * b + 3 + j] -= mixed[(i, j)];
                        K[(6 * b + 3 + j) * width + 6 * a + i] -= mixed[(i, j)];
                    }
                }
            }
            // δ(d × g) at fixed g: (δθ × d) × g = (d gᵀ − (d·g) 1) δθ.
            let mut turn = Mat3::zeros();
            for k in 0..3 {
                let (d, g) = (&turning[k][a], &gradient.turning[k][a]);
                turn += d * g.transpose() - d.dot(g) * Mat3::identity();
            }
            for i in 0..3 {
                for j in 0..3 {
                    K[(6 * a + 3 + i) * width + 6 * a + 3 + j] += turn[(i, j)];
                }
            }
        }
    }
}
