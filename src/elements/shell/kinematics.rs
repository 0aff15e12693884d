//! Kinematics of a shell element: from the motion of its nodes to its strains, their rates and their second derivatives.

use super::arc::Arc;
use super::interpolation::{Interpolation, Quadrilateral, Triangle};
use super::section::{ShellSection, ShellStiffness};
use crate::math::Vec3;
use crate::state::Node;
use std::array::from_fn;
use std::marker::PhantomData;

/// One element: N nodes, V vectors of the slopes of the surface, M stress modes.
pub(super) struct Shell<const N: usize, const V: usize, const M: usize, S> {
    /// Nodes, counter-clockwise about the normal.
    pub nodes: [usize; N],
    /// Directors at t = 0.
    pub D: [Vec3; N],
    /// Axes in the plane of the element at t = 0.
    pub T: [Vec3; 2],
    /// Coefficients of the in-plane strains ½ v·Q v and v·Q w, with v the slopes of x and w those of d.
    pub Q: [[[f64; V]; V]; M],
    /// Strains at t = 0.
    pub start: Strains<N, M>,
    /// Stiffness of the shear strains at the edges.
    pub shear: [[f64; N]; N],
    /// Coefficients of v in x,₁ and x,₂, by integration point.
    pub slopes: [[[f64; V]; 2]; N],
    /// Stiffness of the drilling strains at integration points.
    pub drilling: [[f64; N]; N],
    /// The sections at its integration points.
    pub section: S,
}

/// The strains of an element, or the stresses conjugate to them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Strains<const N: usize, const M: usize> {
    /// Membrane and bending, by stress mode.
    pub plane: [[f64; M]; 2],
    /// Transverse shear by edge.
    pub shear: [f64; N],
    /// Drilling by integration point.
    pub drill: [f64; N],
}

/// Positions and directors of the nodes, or their rates, or a gradient by them.
#[derive(Clone, Copy)]
pub(super) struct NodalVectors<const N: usize> {
    /// Positions from that of the first node.
    pub x: [Vec3; N],
    /// d, t₁ and t₂, which rotate with the nodes.
    pub turning: [[Vec3; N]; 3],
}

/// σ·∂²ε.
pub(super) struct StrainHessian<const N: usize> {
    /// Coefficients of x_a·x_b.
    pub xx: [[f64; N]; N],
    /// Coefficients of x_a·d_b, x_a·t₁_b and x_a·t₂_b.
    pub xd: [[[f64; N]; N]; 3],
}

/// A group of shells of one interpolation `K`, whose sections are of type `S`.
pub struct Shells<K, const N: usize, const V: usize, const M: usize, S = ShellStiffness<M>> {
    /// The elements.
    pub(super) elements: Vec<Shell<N, V, M, S>>,
    /// Rayleigh factor on the stiffness (time): stress += factor · C · strain rate.
    pub(super) damping: f64,
    /// The interpolation, which holds no data.
    pub(super) interpolation: PhantomData<K>,
}

/// Quadrilaterals of four nodes.
pub type Quadrilaterals<S = ShellStiffness<5>> = Shells<Quadrilateral, 4, 3, 5, S>;
/// Triangles of three nodes.
pub type Triangles<S = ShellStiffness<3>> = Shells<Triangle, 3, 2, 3, S>;

/// Σ factors_i v_i.
#[inline(always)]
pub(super) fn sum<const V: usize>(factors: &[f64; V], v: &[Vec3; V]) -> Vec3 {
    let mut sum = Vec3::zeros();
    for i in 0..V {
        sum += factors[i] * v[i];
    }
    sum
}

impl<const N: usize> NodalVectors<N> {
    /// The vectors that make up the slopes of a field with the given nodal values.
    #[inline(always)]
    pub fn slopes<K: Interpolation<N, V>, const V: usize>(values: &[Vec3; N]) -> [Vec3; V] {
        from_fn(|i| sum(&K::SLOPES[i], values))
    }

    /// This + s · other.
    #[inline(always)]
    pub fn plus(&self, s: f64, other: &NodalVectors<N>) -> NodalVectors<N> {
        NodalVectors {
            x: from_fn(|a| self.x[a] + s * other.x[a]),
            turning: from_fn(|k| from_fn(|a| self.turning[k][a] + s * other.turning[k][a])),
        }
    }
}

impl<const N: usize, const V: usize, const M: usize, S> Shell<N, V, M, S> {
    /// Positions and directors of the nodes.
    #[inline(always)]
    pub fn gather(&self, nodes: &[Node]) -> NodalVectors<N> {
        let first = &nodes[self.nodes[0]];
        let mut motion = NodalVectors { x: [Vec3::zeros(); N], turning: [[Vec3::zeros(); N]; 3] };
        for a in 0..N {
            let node = &nodes[self.nodes[a]];
            let R = node.R();
            motion.x[a] = node.relative_position(first);
            motion.turning[0][a] = R * self.D[a];
            motion.turning[1][a] = R * self.T[0];
            motion.turning[2][a] = R * self.T[1];
        }
        motion
    }

    /// Rates of positions and directors.
    #[inline(always)]
    pub fn rates(&self, motion: &NodalVectors<N>, nodes: &[Node]) -> NodalVectors<N> {
        let node = |a: usize| &nodes[self.nodes[a]];
        NodalVectors {
            x: from_fn(|a| node(a).v - node(0).v),
            turning: motion.turning.map(|d| from_fn(|a| node(a).omega.cross(&d[a]))),
        }
    }

    /// Strains from zero, those at t = 0 included; bending by angles with `ARC`, by chords without.
    #[inline(always)]
    pub fn measure<K: Interpolation<N, V>, const ARC: bool>(&self, motion: &NodalVectors<N>) -> Strains<N, M> {
        let NodalVectors { x, turning: [d, t1, t2] } = motion;
        let (v, mut w) = (NodalVectors::slopes::<K, V>(x), NodalVectors::slopes::<K, V>(d));
        if ARC {
            w = Arc::new::<K, N>(w).long;
        }
        let mut strains = Strains { plane: [[0.0; M]; 2], shear: [0.0; N], drill: [0.0; N] };
        for i in 0..V {
            for j in 0..V {
                let (membrane, bending) = (0.5 * v[i].dot(&v[j]), v[i].dot(&w[j]));
                for m in 0..M {
                    strains.plane[0][m] += self.Q[m][i][j] * membrane;
                    strains.plane[1][m] += self.Q[m][i][j] * bending;
                }
            }
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            strains.shear[e] = 0.5 * (x[b] - x[a]).dot(&(d[a] + d[b]));
        }
        for g in 0..N {
            let [x1, x2] = self.slopes[g].map(|s| sum(&s, &v));
            strains.drill[g] = 0.5 * (sum(&K::VALUES[g], t2).dot(&x1) - sum(&K::VALUES[g], t1).dot(&x2));
        }
        strains
    }

    /// Strains from t = 0.
    #[inline(always)]
    pub fn strains<K: Interpolation<N, V>>(&self, motion: &NodalVectors<N>) -> Strains<N, M> {
        let mut strains = self.measure::<K, true>(motion);
        for m in 0..M {
            strains.plane[0][m] -= self.start.plane[0][m];
            strains.plane[1][m] -= self.start.plane[1][m];
        }
        for a in 0..N {
            strains.shear[a] -= self.start.shear[a];
            strains.drill[a] -= self.start.drill[a];
        }
        strains
    }

    /// Strain rates, bending by chords: half the difference of the strains ahead and behind by a unit of time, which is exact for
    /// polynomials of second degree.
    #[inline(always)]
    pub fn strain_rates<K: Interpolation<N, V>>(
        &self,
        motion: &NodalVectors<N>,
        rates: &NodalVectors<N>,
    ) -> Strains<N, M> {
        let (mut ahead, behind) =
            (self.measure::<K, false>(&motion.plus(1.0, rates)), self.measure::<K, false>(&motion.plus(-1.0, rates)));
        let half = |a: &mut [f64], b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a = 0.5 * (*a - b));
        half(ahead.plane.as_flattened_mut(), behind.plane.as_flattened());
        half(&mut ahead.shear, &behind.shear);
        half(&mut ahead.drill, &behind.drill);
        ahead
    }

    /// The stresses of transverse shear and drilling.
    #[inline(always)]
    pub fn shear_and_drilling(&self, strains: &Strains<N, M>) -> ([f64; N], [f64; N]) {
        let times = |C: &[[f64; N]; N], e: &[f64; N]| from_fn(|i| (0..N).map(|j| C[i][j] * e[j]).sum());
        (times(&self.shear, &strains.shear), times(&self.drilling, &strains.drill))
    }

    /// Σ stress_m Q_m: the stress of the membrane or of bending as coefficients of pairs of slopes.
    #[inline(always)]
    pub fn by_slopes(&self, plane: &[f64; M]) -> [[f64; V]; V] {
        let mut Q = [[0.0; V]; V];
        for m in 0..M {
            for i in 0..V {
                for j in 0..V {
                    Q[i][j] += plane[m] * self.Q[m][i][j];
                }
            }
        }
        Q
    }

    /// σ·∂²ε; with `ARC` without bending, which [`Bending`] adds.
    #[inline(always)]
    pub fn strain_hessian<K: Interpolation<N, V>, const ARC: bool>(&self, stress: &Strains<N, M>) -> StrainHessian<N> {
        let mut out = StrainHessian { xx: [[0.0; N]; N], xd: [[[0.0; N]; N]; 3] };
        for (part, plane) in stress.plane.iter().enumerate().take(if ARC { 1 } else { 2 }) {
            let Q = self.by_slopes(plane);
            let to = if part == 0 { &mut out.xx } else { &mut out.xd[0] };
            for a in 0..N {
                let half: [f64; V] = from_fn(|j| (0..V).map(|i| K::SLOPES[i][a] * Q[i][j]).sum());
                for b in 0..N {
                    to[a][b] = (0..V).map(|j| half[j] * K::SLOPES[j][b]).sum();
                }
            }
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let half = 0.5 * stress.shear[e];
            for to in [a, b] {
                out.xd[0][b][to] += half;
                out.xd[0][a][to] -= half;
            }
        }
        for g in 0..N {
            for a in 0..N {
                for (k, along, sign) in [(1, 1, -0.5), (2, 0, 0.5)] {
                    let slope: f64 = (0..V).map(|i| self.slopes[g][along][i] * K::SLOPES[i][a]).sum();
                    let s = sign * stress.drill[g] * slope;
                    for b in 0..N {
                        out.xd[k][a][b] += s * K::VALUES[g][b];
                    }
                }
            }
        }
        out
    }
}

impl<const N: usize> StrainHessian<N> {
    /// The gradient Bᵀσ: forces, and the derivatives of energy by d, t₁ and t₂.
    #[inline(always)]
    pub fn gradient(&self, motion: &NodalVectors<N>) -> NodalVectors<N> {
        let mut gradient = NodalVectors { x: [Vec3::zeros(); N], turning: [[Vec3::zeros(); N]; 3] };
        for a in 0..N {
            gradient.x[a] = sum(&self.xx[a], &motion.x);
            for k in 0..3 {
                gradient.x[a] += sum(&self.xd[k][a], &motion.turning[k]);
                for b in 0..N {
                    gradient.turning[k][b] += self.xd[k][a][b] * motion.x[a];
                }
            }
        }
        gradient
    }
}

/// The stress of bending with bending measured by angles.
pub(super) struct Bending<const V: usize> {
    /// The lengthened slopes of the directors.
    pub arc: Arc<V>,
    /// The stress as coefficients of pairs of slopes.
    pub Q: [[f64; V]; V],
    /// Q v.
    pub p: [Vec3; V],
}

impl<const V: usize> Bending<V> {
    /// `Q`: see [`Shell::by_slopes`].
    #[inline(always)]
    pub fn new<K: Interpolation<N, V>, const N: usize>(Q: [[f64; V]; V], motion: &NodalVectors<N>) -> Self {
        let v = NodalVectors::slopes::<K, V>(&motion.x);
        let arc = Arc::new::<K, N>(NodalVectors::slopes::<K, V>(&motion.turning[0]));
        Bending { arc, p: from_fn(|k| sum(&Q[k], &v)), Q }
    }

    /// Adds its part of Bᵀσ.
    #[inline(always)]
    pub fn add_gradient<K: Interpolation<N, V>, const N: usize>(&self, gradient: &mut NodalVectors<N>) {
        let g = self.arc.gradient(&self.p);
        for i in 0..V {
            let f = sum(&self.Q[i], &self.arc.long);
            for a in 0..N {
                gradient.x[a] += K::SLOPES[i][a] * f;
                gradient.turning[0][a] += K::SLOPES[i][a] * g[i];
            }
        }
    }
}

impl<K, const N: usize, const V: usize, const M: usize, S> Shells<K, N, V, M, S>
where
    K: Interpolation<N, V>,
    S: ShellSection<M>,
{
    /// The stress of damping.
    #[inline(always)]
    pub(super) fn viscous_stress(
        &self,
        element: &Shell<N, V, M, S>,
        motion: &NodalVectors<N>,
        nodes: &[Node],
    ) -> Strains<N, M> {
        let rates = element.strain_rates::<K>(motion, &element.rates(motion, nodes));
        let mut stress = element.elastic_stress(&rates);
        let times = |a: &mut [f64]| a.iter_mut().for_each(|a| *a *= self.damping);
        times(stress.plane.as_flattened_mut());
        times(&mut stress.shear);
        times(&mut stress.drill);
        stress
    }
}

impl<const N: usize, const V: usize, const M: usize, S: ShellSection<M>> Shell<N, V, M, S> {
    /// The elastic stress at the given strains.
    #[inline(always)]
    pub fn elastic_stress(&self, strains: &Strains<N, M>) -> Strains<N, M> {
        let (shear, drill) = self.shear_and_drilling(strains);
        Strains { plane: self.section.elastic().stress(&strains.plane), shear, drill }
    }
}
