//! Kinematics of a shell element: from the motion of its nodes to its strains, their rates and their derivatives.

use super::arc::Arc;
use super::camber::Camber;
use super::edge::EdgeTangents;
use super::edge_bending::EdgeBending;
use super::interpolation::{Interpolation, Quadrilateral, Triangle};
use super::lanes::ShellPack;
use super::section::{InPlane, ShellSection, ShellStiffness};
use crate::state::{Configuration, Node};
use base::math::Vec3;
use std::array::from_fn;
use std::marker::PhantomData;

/// Which slopes are multiplied: see [`Interpolation::PAIRS`].
type Pairs<const P: usize> = [[usize; 2]; P];

/// One element: N nodes, V slopes of the surface, P products of them, E numbers of the membrane.
pub(super) struct Shell<const N: usize, const V: usize, const P: usize, const E: usize, S> {
    /// Nodes, counter-clockwise about the normal.
    pub nodes: [usize; N],
    /// Directors at t = 0.
    pub D: [Vec3; N],
    /// Tangents of the nodes at t = 0: the axes of the element, turned until they are normal to the directors.
    pub T: [[Vec3; 2]; N],
    /// The slopes v_i = Σ slopes[i][a] x_a.
    pub slopes: [[f64; N]; V],
    /// S of [`super::arc`].
    pub arc: [[f64; 2]; 2],
    /// Stretch by curvature; `None` where it is that of chords, as for most elements.
    pub camber: Option<Box<Camber<f64>>>,
    /// The edges.
    pub edges: [EdgeTangents; N],
    /// Strains at t = 0.
    pub start: Strains<N, P, E>,
    /// Stiffness of the shear strains at the edges.
    pub shear: [[f64; N]; N],
    /// Curvature by those strains.
    pub bent: EdgeBending<f64, N>,
    /// The sections at its integration points.
    pub section: S,
}

/// The strains of an element, or the stresses conjugate to them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Strains<const N: usize, const P: usize, const E: usize> {
    /// Membrane and bending.
    pub plane: InPlane<P, E>,
    /// Transverse shear by edge.
    pub shear: [f64; N],
}

/// Positions and directors of the nodes, or their rates, or a gradient by them.
#[derive(Clone, Copy)]
pub(super) struct NodalVectors<const N: usize> {
    /// Positions from that of the first node.
    pub x: [Vec3; N],
    /// d, t₁ and t₂, which rotate with the nodes.
    pub turning: [[Vec3; N]; 3],
}

/// σ·∂²ε of the strains that are bilinear in positions and directors.
pub(super) struct StrainHessian<const N: usize> {
    /// Coefficients of x_a·x_b.
    pub xx: [[f64; N]; N],
    /// Coefficients of x_a·d_b, x_a·t₁_b and x_a·t₂_b.
    pub xd: [[[f64; N]; N]; 3],
}

/// A group of shells of one interpolation `K`, whose sections are of type `S`.
pub struct Shells<K, const N: usize, const V: usize, const P: usize, const E: usize, S = ShellStiffness<P, E>>
where
    S: ShellSection<P, E>,
{
    /// The elements.
    pub(super) elements: Vec<Shell<N, V, P, E, S>>,
    /// The elements in packs of eight, where forces are computed from these.
    pub(super) packs: Vec<ShellPack<N, V, P, E, S::Packed>>,
    /// Rayleigh factor on the stiffness (time): stress += factor · C · strain rate.
    pub(super) damping: f64,
    /// The interpolation, which holds no data.
    pub(super) interpolation: PhantomData<K>,
}

/// Quadrilaterals of four nodes.
pub type Quadrilaterals<S = ShellStiffness<6, 11>> = Shells<Quadrilateral, 4, 3, 6, 11, S>;
/// Triangles of three nodes.
pub type Triangles<S = ShellStiffness<3, 7>> = Shells<Triangle, 3, 2, 3, 7, S>;

/// Σ factors_i v_i.
#[inline(always)]
pub(super) fn sum<const V: usize>(factors: &[f64; V], v: &[Vec3; V]) -> Vec3 {
    let mut sum = Vec3::zeros();
    for i in 0..V {
        sum += factors[i] * v[i];
    }
    sum
}

/// Σ v.
#[inline(always)]
fn total<const N: usize>(v: &[Vec3; N]) -> Vec3 {
    let mut sum = v[0];
    for v in &v[1..] {
        sum += v;
    }
    sum
}

impl<const N: usize> NodalVectors<N> {
    /// The slopes of a field with the given nodal values.
    #[inline(always)]
    pub fn slopes<const V: usize>(slopes: &[[f64; N]; V], values: &[Vec3; N]) -> [Vec3; V] {
        from_fn(|i| sum(&slopes[i], values))
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

/// A stress as symmetric coefficients of pairs of slopes.
#[inline(always)]
pub(super) fn by_pairs<const V: usize, const P: usize>(pairs: &Pairs<P>, stress: &[f64]) -> [[f64; V]; V] {
    let mut Q = [[0.0; V]; V];
    for (&[i, j], s) in pairs.iter().zip(stress) {
        Q[i][j] = *s;
        Q[j][i] = *s;
    }
    Q
}

impl<const N: usize, const V: usize, const P: usize, const E: usize, S> Shell<N, V, P, E, S> {
    /// Stretch by curvature.
    #[inline(always)]
    pub fn camber(&self) -> &Camber<f64> {
        self.camber.as_deref().unwrap_or(&Camber::NONE)
    }

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
            motion.turning[1][a] = R * self.T[a][0];
            motion.turning[2][a] = R * self.T[a][1];
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

    /// Strains from zero, those at t = 0 included; bending by angles and stretch along arcs with `ARC`, by chords without.
    #[inline(always)]
    pub fn measure<K: Interpolation<N, V, P>, const ARC: bool>(&self, motion: &NodalVectors<N>) -> Strains<N, P, E> {
        let NodalVectors { x, turning: [d, t1, t2] } = motion;
        let (v, mut w) = (NodalVectors::slopes(&self.slopes, x), NodalVectors::slopes(&self.slopes, d));
        if ARC {
            w = Arc::new(&self.arc, w).long;
        }
        let mut strains = Strains { plane: InPlane::ZERO, shear: [0.0; N] };
        let membrane = &mut strains.plane.membrane;
        let bending = &mut strains.plane.bending;
        for (n, [i, j]) in K::PAIRS.into_iter().enumerate() {
            membrane[n] = if i == j { 0.5 * v[i].dot(&v[i]) } else { v[i].dot(&v[j]) };
            bending[n] = if i == j { v[i].dot(&w[i]) } else { v[i].dot(&w[j]) + v[j].dot(&w[i]) };
        }
        if ARC && K::CAMBERED {
            let stretch = self.camber().stretch(0.5, &[bending[0], bending[1], bending[2]]);
            (0..3).for_each(|m| membrane[m] += stretch[m]);
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let along = x[b] - x[a];
            let edge = &self.edges[e];
            strains.plane.membrane[P + e] =
                along.dot(&(edge.vector(0, &t1[a], &t2[a]) + edge.vector(1, &t1[b], &t2[b])));
            strains.shear[e] = 0.5 * along.dot(&(d[a] + d[b]));
        }
        if K::EDGES_BEND {
            let more = self.bent.curvature(&strains.shear);
            (0..3).for_each(|n| strains.plane.bending[n] += more[n]);
        }
        let mean = 0.5 / N as f64;
        strains.plane.membrane[E - 1] = mean * (total(t1).dot(&v[1]) - total(t2).dot(&v[0]));
        strains
    }

    /// Strains from t = 0.
    #[inline(always)]
    pub fn strains<K: Interpolation<N, V, P>>(&self, motion: &NodalVectors<N>) -> Strains<N, P, E> {
        let mut strains = self.measure::<K, true>(motion);
        let less = |a: &mut [f64], b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a -= b);
        less(&mut strains.plane.membrane, &self.start.plane.membrane);
        less(&mut strains.plane.bending, &self.start.plane.bending);
        less(&mut strains.shear, &self.start.shear);
        strains
    }

    /// Strain rates, bending by chords: half the difference of the strains ahead and behind by a unit of time, which is exact for
    /// polynomials of second degree.
    #[inline(always)]
    pub fn strain_rates<K: Interpolation<N, V, P>>(
        &self,
        motion: &NodalVectors<N>,
        rates: &NodalVectors<N>,
    ) -> Strains<N, P, E> {
        let (mut ahead, behind) =
            (self.measure::<K, false>(&motion.plus(1.0, rates)), self.measure::<K, false>(&motion.plus(-1.0, rates)));
        let half = |a: &mut [f64], b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a = 0.5 * (*a - b));
        half(&mut ahead.plane.membrane, &behind.plane.membrane);
        half(&mut ahead.plane.bending, &behind.plane.bending);
        half(&mut ahead.shear, &behind.shear);
        ahead
    }

    /// The stresses of transverse shear.
    #[inline(always)]
    pub fn shear_stress(&self, shear: &[f64; N]) -> [f64; N] {
        from_fn(|i| (0..N).map(|j| self.shear[i][j] * shear[j]).sum())
    }

    /// The derivative of energy by the numbers of shear: the stress of shear and, by [`super::edge_bubbles`], of bending.
    #[inline(always)]
    pub fn edge_stress<K: Interpolation<N, V, P>>(&self, shear: &[f64; N], plane: &InPlane<P, E>) -> [f64; N] {
        let mut stress = self.shear_stress(shear);
        if K::EDGES_BEND {
            let more = self.bent.stress(&plane.bending);
            (0..N).for_each(|e| stress[e] += more[e]);
        }
        stress
    }

    /// The derivative of energy by the numbers of bending: the stress of bending and, by [`super::camber`], of the membrane. `long`:
    /// the lengthened slopes of the directors.
    #[inline(always)]
    pub fn bending_stress<K: Interpolation<N, V, P>>(
        &self,
        plane: &InPlane<P, E>,
        v: &[Vec3; V],
        long: &[Vec3; V],
    ) -> [f64; P] {
        if !K::CAMBERED {
            return plane.bending;
        }
        let more = self.camber().moments(&plane.membrane, &first_bending(v, long));
        let mut stress = plane.bending;
        (0..3).for_each(|n| stress[n] += more[n]);
        stress
    }

    /// The gradient Bᵀσ: forces, and the derivatives of energy by d, t₁ and t₂. Bending by angles and stretch along arcs with `ARC`,
    /// by chords without.
    #[inline(always)]
    pub fn gradient<K: Interpolation<N, V, P>, const ARC: bool>(
        &self,
        stress: &Strains<N, P, E>,
        motion: &NodalVectors<N>,
    ) -> NodalVectors<N> {
        let NodalVectors { x, turning: [d, t1, t2] } = motion;
        let (v, w) = (NodalVectors::slopes(&self.slopes, x), NodalVectors::slopes(&self.slopes, d));
        let N_ = by_pairs::<V, P>(&K::PAIRS, &stress.plane.membrane);
        let mut along: [Vec3; V] = from_fn(|i| sum(&N_[i], &v));
        let across = if ARC {
            let arc = Arc::new(&self.arc, w);
            let M = by_pairs::<V, P>(&K::PAIRS, &self.bending_stress::<K>(&stress.plane, &v, &arc.long));
            (0..V).for_each(|i| along[i] += sum(&M[i], &arc.long));
            arc.gradient(&from_fn(|i| sum(&M[i], &v)))
        } else {
            let M = by_pairs::<V, P>(&K::PAIRS, &stress.plane.bending);
            (0..V).for_each(|i| along[i] += sum(&M[i], &w));
            from_fn(|i| sum(&M[i], &v))
        };
        let drill = stress.plane.membrane[E - 1] * 0.5 / N as f64;
        along[0] -= drill * total(t2);
        along[1] += drill * total(t1);
        let mut gradient = NodalVectors {
            x: [Vec3::zeros(); N],
            turning: [[Vec3::zeros(); N], [drill * v[1]; N], [-drill * v[0]; N]],
        };
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let (edge, half, bulge) = (&self.edges[e], 0.5 * stress.shear[e], stress.plane.membrane[P + e]);
            let force =
                half * (d[a] + d[b]) + bulge * (edge.vector(0, &t1[a], &t2[a]) + edge.vector(1, &t1[b], &t2[b]));
            gradient.x[a] -= force;
            gradient.x[b] += force;
            let length = x[b] - x[a];
            for (node, [c1, c2]) in [a, b].into_iter().zip(edge.0) {
                gradient.turning[0][node] += half * length;
                gradient.turning[1][node] += bulge * c1 * length;
                gradient.turning[2][node] += bulge * c2 * length;
            }
        }
        for i in 0..V {
            for a in 0..N {
                gradient.x[a] += self.slopes[i][a] * along[i];
                gradient.turning[0][a] += self.slopes[i][a] * across[i];
            }
        }
        gradient
    }

    /// σ·∂²ε; with `ARC` without bending, which [`Bending`] adds.
    #[inline(always)]
    pub fn strain_hessian<K: Interpolation<N, V, P>, const ARC: bool>(
        &self,
        stress: &Strains<N, P, E>,
    ) -> StrainHessian<N> {
        let mut out = StrainHessian { xx: [[0.0; N]; N], xd: [[[0.0; N]; N]; 3] };
        let parts = [&stress.plane.membrane[..], &stress.plane.bending[..]];
        for (part, plane) in parts.into_iter().enumerate().take(if ARC { 1 } else { 2 }) {
            let Q = by_pairs::<V, P>(&K::PAIRS, plane);
            let to = if part == 0 { &mut out.xx } else { &mut out.xd[0] };
            for a in 0..N {
                let half: [f64; V] = from_fn(|j| (0..V).map(|i| self.slopes[i][a] * Q[i][j]).sum());
                for b in 0..N {
                    to[a][b] = (0..V).map(|j| half[j] * self.slopes[j][b]).sum();
                }
            }
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let (half, bulge) = (0.5 * stress.shear[e], stress.plane.membrane[P + e]);
            for (to, [c1, c2]) in [a, b].into_iter().zip(self.edges[e].0) {
                for (k, c) in [half, bulge * c1, bulge * c2].into_iter().enumerate() {
                    out.xd[k][b][to] += c;
                    out.xd[k][a][to] -= c;
                }
            }
        }
        let drill = stress.plane.membrane[E - 1] * 0.5 / N as f64;
        for a in 0..N {
            let (first, second) = (drill * self.slopes[1][a], drill * self.slopes[0][a]);
            for b in 0..N {
                out.xd[1][a][b] += first;
                out.xd[2][a][b] -= second;
            }
        }
        out
    }
}

/// The first three numbers of bending, by the slopes of positions and directors.
#[inline(always)]
pub(super) fn first_bending<const V: usize>(v: &[Vec3; V], w: &[Vec3; V]) -> [f64; 3] {
    [v[0].dot(&w[0]), v[1].dot(&w[1]), v[0].dot(&w[1]) + v[1].dot(&w[0])]
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
    /// Of the element under a stress in its plane.
    #[inline(always)]
    pub fn new<K: Interpolation<N, V, P>, const N: usize, const P: usize, const E: usize, S>(
        element: &Shell<N, V, P, E, S>,
        plane: &InPlane<P, E>,
        motion: &NodalVectors<N>,
    ) -> Self {
        let v = NodalVectors::slopes(&element.slopes, &motion.x);
        let arc = Arc::new(&element.arc, NodalVectors::slopes(&element.slopes, &motion.turning[0]));
        let Q = by_pairs(&K::PAIRS, &element.bending_stress::<K>(plane, &v, &arc.long));
        Bending { arc, p: from_fn(|k| sum(&Q[k], &v)), Q }
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const E: usize, S> Shells<K, N, V, P, E, S>
where
    K: Interpolation<N, V, P>,
    S: ShellSection<P, E>,
{
    /// The stress of damping.
    #[inline(always)]
    pub(super) fn viscous_stress(
        &self,
        element: &Shell<N, V, P, E, S>,
        motion: &NodalVectors<N>,
        nodes: &[Node],
    ) -> Strains<N, P, E> {
        let rates = element.strain_rates::<K>(motion, &element.rates(motion, nodes));
        let plane = element.section.elastic().stress(&rates.plane);
        let mut stress = Strains { shear: element.edge_stress::<K>(&rates.shear, &plane), plane };
        let times = |a: &mut [f64]| a.iter_mut().for_each(|a| *a *= self.damping);
        times(&mut stress.plane.membrane);
        times(&mut stress.plane.bending);
        times(&mut stress.shear);
        stress
    }
}

impl<const N: usize, const V: usize, const P: usize, const E: usize, S: ShellSection<P, E>> Shell<N, V, P, E, S> {
    /// The elastic stress at the given strains.
    #[inline(always)]
    pub fn elastic_stress(&self, strains: &Strains<N, P, E>) -> Strains<N, P, E> {
        let plane = self.section.elastic().stress(&strains.plane);
        Strains { plane, shear: self.shear_stress(&strains.shear) }
    }

    /// Elastic energy at a strain: in the plane, and of transverse shear.
    pub fn elastic_energy(&self, strains: &Strains<N, P, E>, now: &Configuration) -> [f64; 2] {
        let shear = self.shear_stress(&strains.shear);
        let shear = 0.5 * shear.iter().zip(&strains.shear).map(|(a, b)| a * b).sum::<f64>();
        [self.section.energy(&strains.plane, now), shear]
    }
}
