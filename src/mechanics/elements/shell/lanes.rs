//! Forces of eight shell elements side by side, each with the bits that it has by itself: the formulas are those of
//! [`super::kinematics`], in the same order.

use super::camber::Camber;
use super::edge_bending::EdgeBending;
use super::interpolation::Interpolation;
use super::packed::InPlaneLanes;
use crate::elements::block::Force;
use crate::state::Node;
use base::math::lanes::{LANES, Lanes, lanes};
use base::math::number::LaneVec3;
use std::array::from_fn;

/// Eight elements. Lanes beyond the last element repeat it.
pub(super) struct ShellPack<const N: usize, const V: usize, const P: usize, const E: usize, B> {
    /// The number of elements.
    pub count: usize,
    /// Nodes by lane.
    pub nodes: [[usize; LANES]; N],
    /// Director and tangents of each node at t = 0.
    pub axes: [[LaneVec3; 3]; N],
    /// Of [`super::kinematics::Shell`], like those that follow.
    pub slopes: [[Lanes; N]; V],
    pub arc: [[Lanes; 2]; 2],
    pub camber: Camber<Lanes>,
    pub edges: [[[Lanes; 2]; 2]; N],
    pub start: InPlaneLanes<P, E>,
    pub start_shear: [Lanes; N],
    pub shear: [[Lanes; N]; N],
    pub bent: EdgeBending<Lanes, N>,
    /// The sections side by side.
    pub sections: B,
}

/// Positions of the nodes from the first, and their directors and tangents.
pub(super) struct Motion<const N: usize> {
    pub x: [LaneVec3; N],
    pub turning: [[LaneVec3; N]; 3],
}

/// Slopes of positions and directors, and the lengthened ones of [`super::arc`].
pub(super) struct Slopes<const V: usize> {
    pub v: [LaneVec3; V],
    pub w: [LaneVec3; V],
    pub long: [LaneVec3; V],
    pub y: [LaneVec3; 2],
    pub H: [[Lanes; 2]; 2],
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

impl<const N: usize, const V: usize, const P: usize, const E: usize, B> ShellPack<N, V, P, E, B> {
    #[inline(always)]
    pub fn gather(&self, nodes: &[Node]) -> Motion<N> {
        let mut motion = Motion { x: [LaneVec3::ZERO; N], turning: [[LaneVec3::ZERO; N]; 3] };
        let mut first = [LaneVec3::ZERO; 2];
        for a in 0..N {
            let at: [&Node; LANES] = from_fn(|lane| &nodes[self.nodes[a][lane]]);
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
            (0..3).for_each(|k| motion.turning[k][a] = turned[k]);
        }
        motion
    }

    #[inline(always)]
    pub fn slopes(&self, motion: &Motion<N>) -> Slopes<V> {
        let v: [LaneVec3; V] = from_fn(|i| sum(&self.slopes[i], &motion.x));
        let w: [LaneVec3; V] = from_fn(|i| sum(&self.slopes[i], &motion.turning[0]));
        let S = &self.arc;
        let y = [S[0][0] * w[0] + S[0][1] * w[1], S[1][0] * w[0] + S[1][1] * w[1]];
        let H = [[y[0].dot(&w[0]), y[0].dot(&w[1])], [y[1].dot(&w[0]), y[1].dot(&w[1])]];
        let mut long = w;
        for b in 0..2 {
            long[b] += H[0][b] * w[0] + H[1][b] * w[1];
        }
        Slopes { v, w, long, y, H }
    }

    /// The vector of edge `e` by the tangents of its ends, see [`super::edge`].
    #[inline(always)]
    pub fn bulging(&self, e: usize, [a, b]: [usize; 2], [_, t1, t2]: &[[LaneVec3; N]; 3]) -> LaneVec3 {
        let [at_a, at_b] = self.edges[e];
        (at_a[0] * t1[a] + at_a[1] * t2[a]) + (at_b[0] * t1[b] + at_b[1] * t2[b])
    }

    /// Strains from t = 0, in the plane and of transverse shear.
    #[inline(always)]
    pub fn strains<K: Interpolation<N, V, P>>(
        &self,
        motion: &Motion<N>,
        Slopes { v, long: w, .. }: &Slopes<V>,
    ) -> (InPlaneLanes<P, E>, [Lanes; N]) {
        let half = Lanes::splat(0.5);
        let Motion { x, turning } = motion;
        let (mut plane, mut shear) = (InPlaneLanes::ZERO, [Lanes::ZERO; N]);
        for (n, [i, j]) in K::PAIRS.into_iter().enumerate() {
            plane.membrane[n] = if i == j { half * v[i].dot(&v[i]) } else { v[i].dot(&v[j]) };
            plane.bending[n] = if i == j { v[i].dot(&w[i]) } else { v[i].dot(&w[j]) + v[j].dot(&w[i]) };
        }
        if K::CAMBERED {
            let stretch = self.camber.stretch(half, &[plane.bending[0], plane.bending[1], plane.bending[2]]);
            (0..3).for_each(|m| plane.membrane[m] += stretch[m]);
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let along = x[b] - x[a];
            plane.membrane[P + e] = along.dot(&self.bulging(e, [a, b], turning));
            shear[e] = half * along.dot(&(turning[0][a] + turning[0][b]));
        }
        if K::EDGES_BEND {
            let more = self.bent.curvature(&shear);
            (0..3).for_each(|n| plane.bending[n] += more[n]);
        }
        let mean = Lanes::splat(0.5 / N as f64);
        plane.membrane[E - 1] = mean * (total(&turning[1]).dot(&v[1]) - total(&turning[2]).dot(&v[0]));
        (0..E).for_each(|i| plane.membrane[i] -= self.start.membrane[i]);
        (0..P).for_each(|i| plane.bending[i] -= self.start.bending[i]);
        (0..N).for_each(|i| shear[i] -= self.start_shear[i]);
        (plane, shear)
    }

    /// The derivative of energy by the numbers of bending, see [`super::kinematics::Shell::bending_stress`].
    #[inline(always)]
    pub fn bending_stress<K: Interpolation<N, V, P>>(
        &self,
        plane: &InPlaneLanes<P, E>,
        slopes: &Slopes<V>,
    ) -> [Lanes; P] {
        let mut bending = plane.bending;
        if K::CAMBERED {
            let more = self.camber.moments(&plane.membrane, &slopes.first_bending());
            (0..3).for_each(|n| bending[n] += more[n]);
        }
        bending
    }

    /// The derivative of energy by the numbers of shear, see [`super::kinematics::Shell::edge_stress`].
    #[inline(always)]
    pub fn edge_stress<K: Interpolation<N, V, P>>(&self, shear: &[Lanes; N], plane: &InPlaneLanes<P, E>) -> [Lanes; N] {
        let mut stress: [Lanes; N] = from_fn(|i| {
            let mut sum = self.shear[i][0] * shear[0];
            (1..N).for_each(|j| sum += self.shear[i][j] * shear[j]);
            sum
        });
        if K::EDGES_BEND {
            let more = self.bent.stress(&plane.bending);
            (0..N).for_each(|e| stress[e] += more[e]);
        }
        stress
    }

    /// The gradient Bᵀσ by positions, directors and tangents.
    #[inline(always)]
    pub fn gradient<K: Interpolation<N, V, P>>(
        &self,
        (plane, shear): (&InPlaneLanes<P, E>, &[Lanes; N]),
        Motion { x, turning }: &Motion<N>,
        slopes: &Slopes<V>,
    ) -> Motion<N> {
        let [d, t1, t2] = turning;
        let Slopes { v, long, .. } = slopes;
        let bending = self.bending_stress::<K>(plane, slopes);
        let (Q, M) = (by_pairs::<V, P>(&K::PAIRS, &plane.membrane), by_pairs::<V, P>(&K::PAIRS, &bending));
        let mut along: [LaneVec3; V] = from_fn(|i| sum(&Q[i], v));
        let bent: [LaneVec3; V] = from_fn(|i| sum(&M[i], v));
        (0..V).for_each(|i| along[i] += sum(&M[i], long));
        let across = slopes.gradient(&bent);
        let drill = plane.membrane[E - 1] * Lanes::splat(0.5) / Lanes::splat(N as f64);
        along[0] -= drill * total(t2);
        along[1] += drill * total(t1);
        let mut g =
            Motion { x: [LaneVec3::ZERO; N], turning: [[LaneVec3::ZERO; N], [drill * v[1]; N], [-drill * v[0]; N]] };
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let (half, bulge) = (Lanes::splat(0.5) * shear[e], plane.membrane[P + e]);
            let force = half * (d[a] + d[b]) + bulge * self.bulging(e, [a, b], turning);
            g.x[a] -= force;
            g.x[b] += force;
            let length = x[b] - x[a];
            for (node, [c1, c2]) in [a, b].into_iter().zip(self.edges[e]) {
                g.turning[0][node] += half * length;
                g.turning[1][node] += bulge * c1 * length;
                g.turning[2][node] += bulge * c2 * length;
            }
        }
        for i in 0..V {
            for a in 0..N {
                g.x[a] += self.slopes[i][a] * along[i];
                g.turning[0][a] += self.slopes[i][a] * across[i];
            }
        }
        g
    }

    /// Subtracts the forces of the elements from `F`, with the stress that `stress` finds for the strains in the plane.
    #[inline(always)]
    pub fn subtract_forces<K: Interpolation<N, V, P>>(
        &self,
        nodes: &[Node],
        F: &mut [Force],
        stress: impl FnOnce(&B, &InPlaneLanes<P, E>, usize) -> InPlaneLanes<P, E>,
    ) {
        let motion = self.gather(nodes);
        let slopes = self.slopes(&motion);
        let (plane, shear) = self.strains::<K>(&motion, &slopes);
        let plane = stress(&self.sections, &plane, self.count);
        let shear = self.edge_stress::<K>(&shear, &plane);
        let g = self.gradient::<K>((&plane, &shear), &motion, &slopes);
        let f: [[[f64; LANES]; 6]; N] = from_fn(|a| {
            let mut moment = LaneVec3::ZERO;
            for k in 0..3 {
                moment += motion.turning[k][a].cross(&g.turning[k][a]);
            }
            from_fn(|i| if i < 3 { g.x[a].0[i] } else { moment.0[i - 3] }.to_array())
        });
        // A node gets the forces of its elements in their order.
        for lane in 0..self.count {
            for a in 0..N {
                let F = &mut F[self.nodes[a][lane]];
                (0..6).for_each(|i| F[i] -= f[a][i][lane]);
            }
        }
    }
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

impl<const V: usize> Slopes<V> {
    /// The first three numbers of bending.
    #[inline(always)]
    pub fn first_bending(&self) -> [Lanes; 3] {
        let Slopes { v, long, .. } = self;
        [v[0].dot(&long[0]), v[1].dot(&long[1]), v[0].dot(&long[1]) + v[1].dot(&long[0])]
    }

    /// ∂(p·w′)/∂w, see [`super::arc`].
    #[inline(always)]
    pub fn gradient(&self, p: &[LaneVec3; V]) -> [LaneVec3; V] {
        let P: [[Lanes; 2]; 2] = from_fn(|k| from_fn(|b| p[b].dot(&self.y[k])));
        let mut g = *p;
        for k in 0..2 {
            for b in 0..2 {
                g[k] += self.H[k][b] * p[b] + (P[k][b] + P[b][k]) * self.w[b];
            }
        }
        g
    }
}
