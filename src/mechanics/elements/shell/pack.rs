//! Kinematics and forces of eight shell elements side by side: from the motion of their nodes to strains, their rates and the gradient of
//! energy. An element has bitwise the same result in any of the eight places.

use super::arc::Slopes;
use super::camber::Camber;
use super::edge::EdgeTangents;
use super::edge_bending::EdgeBending;
use super::in_plane::{InPlane, product};
use super::interpolation::{Interpolation, Quadrilateral, Triangle};
use super::rolled_edges::RolledEdges;
use super::section::{InPlaneSection, ShellSections, StiffnessPack};
use crate::elements::heat::HeatNodes;
use crate::state::{Configuration, Node};
use base::math::Vec3;
use base::math::lanes::{LANES, Lanes, lanes};
use base::math::number::LaneVec3;
use std::array::from_fn;
use std::marker::PhantomData;
use std::sync::Arc;

/// A group of shells of one interpolation `K`, whose sections are of type `S`.
pub struct Shells<K, const N: usize, const V: usize, const P: usize, const E: usize, S = StiffnessPack<P, E, Lanes>> {
    /// The elements, eight by eight.
    pub(super) packs: Vec<ShellPack<N, V, P, E, S>>,
    /// The number of history variables of all.
    pub(super) history: usize,
    /// Rayleigh factor on the stiffness (time): stress += factor · C · strain rate.
    pub(super) damping: f64,
    /// Temperatures; `None` where nothing heats the shells.
    pub(super) heat: Option<Arc<HeatNodes>>,
    /// The interpolation, which holds no data.
    pub(super) interpolation: PhantomData<K>,
}

/// Quadrilaterals of four nodes.
pub type Quadrilaterals<S = StiffnessPack<6, 11, Lanes>> = Shells<Quadrilateral, 4, 3, 6, 11, S>;
/// Triangles of three nodes.
pub type Triangles<S = StiffnessPack<3, 7, Lanes>> = Shells<Triangle, 3, 2, 3, 7, S>;

/// One undeformed element: N nodes, V slopes of the surface, P products of them, E numbers of the membrane.
pub(super) struct Shell<const N: usize, const V: usize, const P: usize, const E: usize> {
    /// Nodes, counter-clockwise about the normal.
    pub nodes: [usize; N],
    /// Positions of the nodes, relative to the first.
    pub X: [Vec3; N],
    /// Directors at t = 0.
    pub D: [Vec3; N],
    /// Tangents of the nodes at t = 0: the axes of the element, turned until they are normal to the directors.
    pub T: [[Vec3; 2]; N],
    /// The slopes v_i = Σ slopes[i][a] x_a.
    pub slopes: [[f64; N]; V],
    /// S of [`super::arc`].
    pub arc: [[f64; 2]; 2],
    /// Stretch by curvature.
    pub camber: Camber<f64>,
    /// The edges.
    pub edges: [EdgeTangents; N],
    /// Stiffness of the shear strains at the edges.
    pub shear: [[f64; N]; N],
    /// Curvature by those strains.
    pub bent: EdgeBending<f64, N>,
    /// The section in its plane.
    pub section: InPlaneSection<P, E>,
}

/// Eight elements. Lanes beyond the last element repeat it.
pub(super) struct ShellPack<const N: usize, const V: usize, const P: usize, const E: usize, S> {
    /// The number of elements.
    pub count: usize,
    /// Nodes by lane.
    pub nodes: [[usize; N]; LANES],
    /// Director and tangents of each node at t = 0.
    pub axes: [[LaneVec3; 3]; N],
    /// `slopes` of [`Shell`]; the next three fields are its fields too.
    pub slopes: [[Lanes; N]; V],
    pub arc: [[Lanes; 2]; 2],
    pub camber: Camber<Lanes>,
    pub edges: [[[Lanes; 2]; 2]; N],
    /// The part of bulges in the curvature; `None` where all edges are straight.
    pub rolled: Option<RolledEdges<N>>,
    pub shear: [[Lanes; N]; N],
    pub bent: EdgeBending<Lanes, N>,
    /// Strains at t = 0.
    pub start: Strains<N, P, E>,
    /// Strains by temperature; `None` where nothing heats the elements.
    pub heat: Option<Box<PackHeat<N, P, E>>>,
    /// The sections side by side.
    pub sections: S,
}

/// The temperatures of eight elements.
pub(super) struct PackHeat<const N: usize, const P: usize, const E: usize> {
    pub nodes: Arc<HeatNodes>,
    /// Factors on the change of size.
    pub factor: Lanes,
    /// Derivatives of the strains by the change of size, and by the curvature.
    pub unit: [Strains<N, P, E>; 2],
}

impl<const N: usize, const P: usize, const E: usize> PackHeat<N, P, E> {
    /// Strains less those without stress. Products of slopes are of second degree in the change of size.
    #[inline]
    pub fn less(&self, mut strains: Strains<N, P, E>, nodes: &[Node]) -> Strains<N, P, E> {
        let [growth, curvature, _] = self.nodes.strain(nodes);
        let (growth, curvature) = (self.factor * Lanes::splat(growth), Lanes::splat(curvature));
        let square = growth + Lanes::splat(0.5) * growth * growth;
        let [size, bend] = &self.unit;
        for i in 0..E {
            let growth = if i < P { square } else { growth };
            strains.plane.membrane[i] -= growth * size.plane.membrane[i] + curvature * bend.plane.membrane[i];
        }
        for i in 0..P {
            strains.plane.bending[i] -= growth * size.plane.bending[i] + curvature * bend.plane.bending[i];
        }
        for i in 0..N {
            strains.shear[i] -= growth * size.shear[i] + curvature * bend.shear[i];
        }
        strains
    }

    /// The work of a stress on the second derivative of the strains by the change of size.
    pub fn second(&self, stress: &Strains<N, P, E>, lane: usize) -> f64 {
        let [size, _] = &self.unit;
        let factor = self.factor.as_array()[lane];
        factor
            * factor
            * (0..P).map(|i| (stress.plane.membrane[i] * size.plane.membrane[i]).as_array()[lane]).sum::<f64>()
    }

    /// The derivative of the strains without stress by one of them.
    pub fn derivative(&self, of: usize, nodes: &[Node]) -> Strains<N, P, E> {
        let mut unit = self.unit[of.min(1)];
        if of == 0 {
            let growth = self.factor * Lanes::splat(self.nodes.strain(nodes)[0]);
            let square = Lanes::splat(1.0) + growth;
            (0..P).for_each(|i| unit.plane.membrane[i] = square * unit.plane.membrane[i]);
            unit.plane.membrane.iter_mut().for_each(|of| *of = self.factor * *of);
            unit.plane.bending.iter_mut().for_each(|of| *of = self.factor * *of);
            unit.shear.iter_mut().for_each(|of| *of = self.factor * *of);
        }
        unit
    }
}

/// The strains of elements, or the stresses conjugate to them.
#[derive(Clone, Copy)]
pub(super) struct Strains<const N: usize, const P: usize, const E: usize> {
    /// Membrane and bending.
    pub plane: InPlane<P, E, Lanes>,
    /// Transverse shear by edge.
    pub shear: [Lanes; N],
}

/// Positions of the nodes from the first, and their directors and tangents; or their rates, or a gradient by them.
#[derive(Clone, Copy)]
pub(super) struct Motion<const N: usize> {
    pub x: [LaneVec3; N],
    pub triads: [[LaneVec3; N]; 3],
}

#[inline(always)]
pub(super) fn sum<const V: usize>(factors: &[Lanes; V], v: &[LaneVec3; V]) -> LaneVec3 {
    let mut sum = LaneVec3::ZERO;
    for i in 0..V {
        sum += factors[i] * v[i];
    }
    sum
}

#[inline(always)]
pub(super) fn total<const N: usize>(v: &[LaneVec3; N]) -> LaneVec3 {
    let mut sum = v[0];
    for v in &v[1..] {
        sum += *v;
    }
    sum
}

/// The rotation matrix times three vectors of a node.
#[inline(always)]
fn turned([w, x, y, z]: [Lanes; 4], axes: &[LaneVec3; 3]) -> [LaneVec3; 3] {
    let (one, two) = (Lanes::ONE, Lanes::splat(2.0));
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let columns = [
        LaneVec3([one - two * (yy + zz), two * (x * y + w * z), two * (x * z - w * y)]),
        LaneVec3([two * (x * y - w * z), one - two * (xx + zz), two * (y * z + w * x)]),
        LaneVec3([two * (x * z + w * y), two * (y * z - w * x), one - two * (xx + yy)]),
    ];
    axes.map(|LaneVec3([a, b, c])| a * columns[0] + b * columns[1] + c * columns[2])
}

impl<const N: usize, const P: usize, const E: usize> Strains<N, P, E> {
    /// All zero.
    pub const ZERO: Self = Strains { plane: InPlane::ZERO, shear: [Lanes::ZERO; N] };

    /// `factor` (this − other).
    #[inline(always)]
    pub fn less(mut self, other: &Self, factor: f64) -> Self {
        let factor = Lanes::splat(factor);
        (0..E).for_each(|i| self.plane.membrane[i] = factor * (self.plane.membrane[i] - other.plane.membrane[i]));
        (0..P).for_each(|i| self.plane.bending[i] = factor * (self.plane.bending[i] - other.plane.bending[i]));
        (0..N).for_each(|i| self.shear[i] = factor * (self.shear[i] - other.shear[i]));
        self
    }

    /// σ·ε of each element.
    #[inline]
    pub fn products(&self, other: &Self) -> Lanes {
        self.plane.dot(&other.plane) + product(&self.shear, &other.shear)
    }

    /// σ·ε of an element.
    pub fn dot(&self, other: &Self, lane: usize) -> f64 {
        self.products(other).as_array()[lane]
    }
}

impl<const N: usize> Motion<N> {
    /// This + s · other.
    #[inline(always)]
    pub fn plus(&self, s: f64, other: &Motion<N>) -> Motion<N> {
        let s = Lanes::splat(s);
        Motion {
            x: from_fn(|a| self.x[a] + s * other.x[a]),
            triads: from_fn(|k| from_fn(|a| self.triads[k][a] + s * other.triads[k][a])),
        }
    }
}

impl<const N: usize, const V: usize, const P: usize, const E: usize, S> ShellPack<N, V, P, E, S> {
    /// Up to eight elements with their sections.
    pub fn new<K: Interpolation<N, V, P>>(elements: &[Shell<N, V, P, E>], sections: S) -> Self {
        let at = |lane: usize| &elements[lane.min(elements.len() - 1)];
        let of = |value: &dyn Fn(&Shell<N, V, P, E>) -> f64| lanes(|lane| value(at(lane)));
        let vector = |value: &dyn Fn(&Shell<N, V, P, E>) -> Vec3| LaneVec3::gather(|lane| value(at(lane)));
        let axes: [[LaneVec3; 3]; N] =
            from_fn(|a| [vector(&|e| e.D[a]), vector(&|e| e.T[a][0]), vector(&|e| e.T[a][1])]);
        let mut pack = ShellPack {
            count: elements.len(),
            nodes: from_fn(|lane| at(lane).nodes),
            axes,
            slopes: from_fn(|i| from_fn(|a| of(&|e| e.slopes[i][a]))),
            arc: from_fn(|i| from_fn(|j| of(&|e| e.arc[i][j]))),
            camber: Camber(from_fn(|m| from_fn(|n| from_fn(|k| of(&|e| e.camber.0[m][n][k]))))),
            edges: from_fn(|i| from_fn(|j| from_fn(|k| of(&|e| e.edges[i].0[j][k])))),
            rolled: RolledEdges::new(|lane, e| at(lane).section.mean_of_membrane(P + e)),
            shear: from_fn(|i| from_fn(|j| of(&|e| e.shear[i][j]))),
            bent: EdgeBending(from_fn(|i| from_fn(|j| of(&|e| e.bent.0[i][j])))),
            start: Strains::ZERO,
            heat: None,
            sections,
        };
        let triads = from_fn(|k| from_fn(|a| axes[a][k]));
        let motion = Motion { x: from_fn(|a| vector(&|e| e.X[a])), triads };
        pack.start = pack.measure::<K>(&motion, &pack.slopes(&motion));
        pack
    }

    /// A vector of each node of the elements.
    #[inline(always)]
    fn of_node(&self, a: usize, nodes: &[Node], of: impl Fn(&Node) -> Vec3) -> LaneVec3 {
        LaneVec3::gather(|lane| of(&nodes[self.nodes[lane][a]]))
    }

    /// Angular velocities of the nodes.
    #[inline(always)]
    pub fn omega(&self, nodes: &[Node]) -> [LaneVec3; N] {
        from_fn(|a| self.of_node(a, nodes, |node| node.omega))
    }

    /// Rates of positions and directors.
    #[inline(always)]
    pub fn rates(&self, motion: &Motion<N>, nodes: &[Node]) -> Motion<N> {
        let v: [LaneVec3; N] = from_fn(|a| self.of_node(a, nodes, |node| node.v));
        let omega = self.omega(nodes);
        Motion { x: v.map(|of| of - v[0]), triads: motion.triads.map(|d| from_fn(|a| omega[a].cross(&d[a]))) }
    }

    /// Positions and directors of the nodes.
    #[inline(always)]
    pub fn gather(&self, nodes: &[Node]) -> Motion<N> {
        let mut motion = Motion { x: [LaneVec3::ZERO; N], triads: [[LaneVec3::ZERO; N]; 3] };
        let mut first = [LaneVec3::ZERO; 2];
        for a in 0..N {
            let at: [&Node; LANES] = from_fn(|lane| &nodes[self.nodes[lane][a]]);
            let place = [LaneVec3::gather(|lane| at[lane].x), LaneVec3::gather(|lane| at[lane].low)];
            if a == 0 {
                first = place;
            }
            motion.x[a] = (place[0] - first[0]) + (place[1] - first[1]);
            let q = [
                lanes(|lane| at[lane].rotation.w),
                lanes(|lane| at[lane].rotation.i),
                lanes(|lane| at[lane].rotation.j),
                lanes(|lane| at[lane].rotation.k),
            ];
            let turned = turned(q, &self.axes[a]);
            (0..3).for_each(|k| motion.triads[k][a] = turned[k]);
        }
        motion
    }

    /// The slopes, with bending by angles and stretch along arcs.
    #[inline(always)]
    pub fn slopes(&self, motion: &Motion<N>) -> Slopes<V> {
        self.chords(motion).lengthened(&self.arc)
    }

    /// The slopes, with bending and stretch by chords: strains are of second degree in positions and directors then.
    #[inline(always)]
    pub fn chords(&self, motion: &Motion<N>) -> Slopes<V> {
        let slopes = |of: &[LaneVec3; N]| from_fn(|i| sum(&self.slopes[i], of));
        Slopes::chords(slopes(&motion.x), slopes(&motion.triads[0]))
    }

    /// The vector of edge `e` by the tangents of its ends, see [`super::edge`].
    #[inline(always)]
    pub fn bulging(&self, e: usize, [a, b]: [usize; 2], [_, t1, t2]: &[[LaneVec3; N]; 3]) -> LaneVec3 {
        let [at_a, at_b] = self.edges[e];
        (at_a[0] * t1[a] + at_a[1] * t2[a]) + (at_b[0] * t1[b] + at_b[1] * t2[b])
    }

    /// Strains from zero, those at t = 0 included.
    #[inline(always)]
    pub fn measure<K: Interpolation<N, V, P>>(
        &self,
        motion: &Motion<N>,
        Slopes { v, long: w, by_arcs, .. }: &Slopes<V>,
    ) -> Strains<N, P, E> {
        let half = Lanes::splat(0.5);
        let Motion { x, triads } = motion;
        let Strains { mut plane, mut shear } = Strains::ZERO;
        for (n, [i, j]) in K::PAIRS.into_iter().enumerate() {
            plane.membrane[n] = if i == j { half * v[i].dot(&v[i]) } else { v[i].dot(&v[j]) };
            plane.bending[n] = if i == j { v[i].dot(&w[i]) } else { v[i].dot(&w[j]) + v[j].dot(&w[i]) };
        }
        if K::CAMBERED && *by_arcs {
            let stretch = self.camber.stretch(half, &[plane.bending[0], plane.bending[1], plane.bending[2]]);
            (0..3).for_each(|m| plane.membrane[m] += stretch[m]);
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let along = x[b] - x[a];
            plane.membrane[P + e] = along.dot(&self.bulging(e, [a, b], triads));
            shear[e] = half * along.dot(&(triads[0][a] + triads[0][b]));
        }
        if let Some(rolled) = self.rolled.as_ref().filter(|_| *by_arcs) {
            let t = rolled.strain(&from_fn(|e| plane.membrane[P + e]));
            let more = rolled.curvature(&t, from_fn(|n| plane.bending[n]));
            (0..3).for_each(|n| plane.bending[n] += more[n]);
        }
        if K::EDGES_BEND {
            let more = self.bent.curvature(&shear);
            (0..3).for_each(|n| plane.bending[n] += more[n]);
        }
        let mean = Lanes::splat(0.5 / N as f64);
        plane.membrane[E - 1] = mean * (total(&triads[1]).dot(&v[1]) - total(&triads[2]).dot(&v[0]));
        Strains { plane, shear }
    }

    /// Strains from t = 0, less those by the temperatures that are among `nodes`.
    #[inline(always)]
    pub fn strains<K: Interpolation<N, V, P>>(
        &self,
        motion: &Motion<N>,
        slopes: &Slopes<V>,
        nodes: &[Node],
    ) -> Strains<N, P, E> {
        let strains = self.measure::<K>(motion, slopes).less(&self.start, 1.0);
        match &self.heat {
            None => strains,
            Some(heat) => heat.less(strains, nodes),
        }
    }

    /// Strain rates, bending by chords: half the difference of the strains ahead and behind by a unit of time, which is exact for
    /// polynomials of second degree.
    #[inline(always)]
    pub fn strain_rates<K: Interpolation<N, V, P>>(&self, motion: &Motion<N>, rates: &Motion<N>) -> Strains<N, P, E> {
        let at = |s: f64| {
            let motion = motion.plus(s, rates);
            self.measure::<K>(&motion, &self.chords(&motion))
        };
        at(1.0).less(&at(-1.0), 0.5)
    }

    /// The stresses of transverse shear.
    #[inline(always)]
    pub fn shear_stress(&self, shear: &[Lanes; N]) -> [Lanes; N] {
        from_fn(|i| product(&self.shear[i], shear))
    }

    /// The bulges of the edges.
    #[inline(always)]
    pub fn bulges<K: Interpolation<N, V, P>>(&self, Motion { x, triads }: &Motion<N>) -> [Lanes; N] {
        from_fn(|e| {
            let [a, b] = K::EDGES[e];
            (x[b] - x[a]).dot(&self.bulging(e, [a, b], triads))
        })
    }

    /// The derivative of energy by the polynomial numbers of positions and directors: the stress, corrected for [`super::camber`] and
    /// [`super::rolled_edges`].
    #[inline(always)]
    pub fn pulled_back<K: Interpolation<N, V, P>>(
        &self,
        mut stress: Strains<N, P, E>,
        motion: &Motion<N>,
        slopes: &Slopes<V>,
    ) -> Strains<N, P, E> {
        if !slopes.by_arcs {
            return stress;
        }
        let (first, plane) = (slopes.first_bending(), &mut stress.plane);
        if let Some(rolled) = &self.rolled {
            let M: [Lanes; 3] = from_fn(|n| plane.bending[n]);
            let t = rolled.strain(&self.bulges::<K>(motion));
            let (moments, of_bulges) = (rolled.moments(&t, &M), rolled.stress(first, &M));
            (0..3).for_each(|n| plane.bending[n] += moments[n]);
            (0..N).for_each(|e| plane.membrane[P + e] += of_bulges[e]);
        }
        if K::CAMBERED {
            let more = self.camber.moments(&plane.membrane, &first);
            (0..3).for_each(|n| plane.bending[n] += more[n]);
        }
        stress
    }

    /// The derivative of energy by the numbers of shear: the stress of shear and, by [`super::edge_bubbles`], of bending.
    #[inline(always)]
    pub fn edge_stress<K: Interpolation<N, V, P>>(
        &self,
        shear: &[Lanes; N],
        plane: &InPlane<P, E, Lanes>,
    ) -> [Lanes; N] {
        let mut stress = self.shear_stress(shear);
        if K::EDGES_BEND {
            let more = self.bent.stress(&plane.bending);
            (0..N).for_each(|e| stress[e] += more[e]);
        }
        stress
    }

    /// The gradient Bᵀσ by positions, directors and tangents, of the stress pulled back.
    #[inline(always)]
    pub fn gradient<K: Interpolation<N, V, P>>(
        &self,
        Strains { plane, shear }: &Strains<N, P, E>,
        Motion { x, triads }: &Motion<N>,
        slopes: &Slopes<V>,
    ) -> Motion<N> {
        let [d, t1, t2] = triads;
        let Slopes { v, long, .. } = slopes;
        let (Q, M) = (by_pairs::<V, P>(&K::PAIRS, &plane.membrane), by_pairs::<V, P>(&K::PAIRS, &plane.bending));
        let mut along: [LaneVec3; V] = from_fn(|i| sum(&Q[i], v));
        let bent: [LaneVec3; V] = from_fn(|i| sum(&M[i], v));
        (0..V).for_each(|i| along[i] += sum(&M[i], long));
        let across = slopes.gradient(&bent);
        let drill = plane.membrane[E - 1] * Lanes::splat(0.5) / Lanes::splat(N as f64);
        along[0] -= drill * total(t2);
        along[1] += drill * total(t1);
        let mut g =
            Motion { x: [LaneVec3::ZERO; N], triads: [[LaneVec3::ZERO; N], [drill * v[1]; N], [-drill * v[0]; N]] };
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let (half, bulge) = (Lanes::splat(0.5) * shear[e], plane.membrane[P + e]);
            let force = half * (d[a] + d[b]) + bulge * self.bulging(e, [a, b], triads);
            g.x[a] -= force;
            g.x[b] += force;
            let length = x[b] - x[a];
            for (node, [c1, c2]) in [a, b].into_iter().zip(self.edges[e]) {
                g.triads[0][node] += half * length;
                g.triads[1][node] += bulge * c1 * length;
                g.triads[2][node] += bulge * c2 * length;
            }
        }
        for i in 0..V {
            for a in 0..N {
                g.x[a] += self.slopes[i][a] * along[i];
                g.triads[0][a] += self.slopes[i][a] * across[i];
            }
        }
        g
    }
}

impl<const N: usize, const V: usize, const P: usize, const E: usize, S> ShellPack<N, V, P, E, S>
where
    S: ShellSections<P, E, Lanes>,
{
    /// Internal forces and moments on the nodes of the elements with the stress that `stress` finds in the plane. `damping`: factor of the
    /// stress by strain rates.
    #[inline(always)]
    pub fn forces<K: Interpolation<N, V, P>>(
        &self,
        nodes: &[Node],
        damping: f64,
        stress: impl FnOnce(&S, &InPlane<P, E, Lanes>) -> InPlane<P, E, Lanes>,
    ) -> [[Lanes; 6]; N] {
        let motion = self.gather(nodes);
        let slopes = self.slopes(&motion);
        let Strains { plane, shear } = self.strains::<K>(&motion, &slopes, nodes);
        let plane = stress(&self.sections, &plane);
        let stress = Strains { shear: self.edge_stress::<K>(&shear, &plane), plane };
        let stress = self.pulled_back::<K>(stress, &motion, &slopes);
        let mut g = self.gradient::<K>(&stress, &motion, &slopes);
        if damping > 0.0 {
            g = g.plus(1.0, &self.viscous_gradient::<K>(damping, &motion, nodes));
        }
        on_nodes(&g, &motion)
    }

    /// The forces and moments on the nodes by a stress of the elements in the plane and of shear.
    pub fn forces_of<K: Interpolation<N, V, P>>(&self, nodes: &[Node], stress: Strains<N, P, E>) -> [[Lanes; 6]; N] {
        let motion = self.gather(nodes);
        let slopes = self.slopes(&motion);
        let shear = match K::EDGES_BEND {
            true => from_fn(|e| stress.shear[e] + self.bent.stress(&stress.plane.bending)[e]),
            false => stress.shear,
        };
        let stress = self.pulled_back::<K>(Strains { shear, ..stress }, &motion, &slopes);
        on_nodes(&self.gradient::<K>(&stress, &motion, &slopes), &motion)
    }

    /// The gradient of the stress of damping.
    fn viscous_gradient<K: Interpolation<N, V, P>>(
        &self,
        damping: f64,
        motion: &Motion<N>,
        nodes: &[Node],
    ) -> Motion<N> {
        let stress = self.viscous_stress::<K>(damping, motion, &self.rates(motion, nodes));
        self.gradient::<K>(&stress, motion, &self.chords(motion))
    }

    /// The stress of damping.
    #[inline(always)]
    pub fn viscous_stress<K: Interpolation<N, V, P>>(
        &self,
        damping: f64,
        motion: &Motion<N>,
        rates: &Motion<N>,
    ) -> Strains<N, P, E> {
        let rates = self.strain_rates::<K>(motion, rates);
        let plane = self.sections.elastic().stress(&rates.plane);
        Strains { shear: self.edge_stress::<K>(&rates.shear, &plane), plane }.less(&Strains::ZERO, damping)
    }

    /// The stress of elements that have not yielded.
    pub fn elastic_stress(&self, strains: &Strains<N, P, E>) -> Strains<N, P, E> {
        Strains { plane: self.sections.elastic().stress(&strains.plane), shear: self.shear_stress(&strains.shear) }
    }

    /// Strains of the elements where their nodes are.
    pub fn strains_at<K: Interpolation<N, V, P>>(&self, nodes: &[Node]) -> Strains<N, P, E> {
        let motion = self.gather(nodes);
        self.strains::<K>(&motion, &self.slopes(&motion), nodes)
    }

    /// Elastic energy of an element at a strain: in the plane, and of transverse shear.
    pub fn energy(&self, lane: usize, strains: &Strains<N, P, E>, now: &Configuration) -> [f64; 2] {
        let shear = Strains { plane: InPlane::ZERO, shear: self.shear_stress(&strains.shear) };
        [self.sections.energy(lane, &strains.plane.lane(lane), now), 0.5 * shear.dot(strains, lane)]
    }
}

/// The gradient by positions and rotations of the nodes.
#[inline(always)]
fn on_nodes<const N: usize>(g: &Motion<N>, motion: &Motion<N>) -> [[Lanes; 6]; N] {
    from_fn(|a| {
        let mut moment = LaneVec3::ZERO;
        for k in 0..3 {
            moment += motion.triads[k][a].cross(&g.triads[k][a]);
        }
        from_fn(|i| if i < 3 { g.x[a].0[i] } else { moment.0[i - 3] })
    })
}

/// A stress as symmetric coefficients of pairs of slopes.
#[inline(always)]
pub(super) fn by_pairs<const V: usize, const P: usize>(pairs: &[[usize; 2]; P], stress: &[Lanes]) -> [[Lanes; V]; V] {
    let mut Q = [[Lanes::ZERO; V]; V];
    for (&[i, j], s) in pairs.iter().zip(stress) {
        Q[i][j] = *s;
        Q[j][i] = *s;
    }
    Q
}
