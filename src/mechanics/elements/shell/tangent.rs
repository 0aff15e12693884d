//! Tangents of eight shell elements side by side: BᵀCB of their strains and σ·∂²ε.
//!
//! Only half of the matrix is computed, for the motion relative to the first node. The rest follows by symmetry, and because a translation
//! of all nodes causes no force. Only a node's own rotations have a part that is not symmetric, and damping.

use super::arc::Slopes;
use super::in_plane::{InPlane, LinearisedPlane};
use super::interpolation::Interpolation;
use super::lane_matrix::{LaneMatrix, complete, hold_translations, product, subtract_skew};
use super::pack::{Motion, ShellPack, Strains, by_pairs, sum, total};
use super::section::ShellSections;
use crate::elements::block::Moduli;
use crate::state::{Configuration, Node};
use base::math::lanes::{Lanes, fma};
use base::math::number::LaneVec3;
use std::array::from_fn;

/// A row of B by the positions and the rotations of the nodes. Nothing is kept for the position of the first node.
#[derive(Clone, Copy)]
struct Row<const N: usize> {
    x: [LaneVec3; N],
    theta: [LaneVec3; N],
}

/// The rows of B: one for each strain.
struct Rows<const N: usize, const P: usize, const E: usize> {
    membrane: [Row<N>; E],
    bending: [Row<N>; P],
    shear: [Row<N>; N],
}

/// y ← y + s x.
#[inline(always)]
fn add_vector(y: &mut LaneVec3, s: Lanes, x: &LaneVec3) {
    (0..3).for_each(|i| y.0[i] = fma(s, x.0[i], y.0[i]));
}

impl<const N: usize> Row<N> {
    const ZERO: Self = Row { x: [LaneVec3::ZERO; N], theta: [LaneVec3::ZERO; N] };

    /// Adds s times a row.
    #[inline(always)]
    fn add(&mut self, s: Lanes, row: &Self) {
        self.add_positions(s, row);
        (0..N).for_each(|a| add_vector(&mut self.theta[a], s, &row.theta[a]));
    }

    /// Adds s times a row that has nothing by rotations.
    #[inline(always)]
    fn add_positions(&mut self, s: Lanes, row: &Self) {
        (1..N).for_each(|a| add_vector(&mut self.x[a], s, &row.x[a]));
    }

    /// Adds this transposed times a row, without the position of the first node.
    fn add_product(&self, X: &Self, H: &mut LaneMatrix<N>) {
        let entry = |row: &Self, b: usize, j: usize| if j < 3 { row.x[b].0[j] } else { row.theta[b].0[j - 3] };
        for (a, H) in H.iter_mut().enumerate() {
            for (i, H) in H.iter_mut().enumerate() {
                let s = entry(self, a, i);
                for (b, H) in H.iter_mut().enumerate() {
                    (0..6).for_each(|j| H[j] = fma(s, entry(X, b, j), H[j]));
                }
            }
        }
    }

    /// Adds s times the row of an edge.
    #[inline(always)]
    fn add_edge(&mut self, ends: [usize; 2], s: Lanes, row: &Self) {
        for a in ends {
            if a > 0 {
                add_vector(&mut self.x[a], s, &row.x[a]);
            }
            add_vector(&mut self.theta[a], s, &row.theta[a]);
        }
    }
}

impl<const N: usize, const P: usize, const E: usize> Rows<N, P, E> {
    const ZERO: Self = Rows { membrane: [Row::ZERO; E], bending: [Row::ZERO; P], shear: [Row::ZERO; N] };

    /// Each row.
    fn all(&self) -> impl Iterator<Item = &Row<N>> {
        self.membrane.iter().chain(&self.bending).chain(&self.shear)
    }

    /// Each row, to be changed.
    fn all_mut(&mut self) -> impl Iterator<Item = &mut Row<N>> {
        self.membrane.iter_mut().chain(&mut self.bending).chain(&mut self.shear)
    }

    /// Adds the rows of the membrane, times the stiffnesses `C`, to a row of C B.
    #[inline(always)]
    fn add_membrane<K: Interpolation<N, V, P>, const V: usize>(&self, C: impl Fn(usize) -> Lanes, row: &mut Row<N>) {
        for m in 0..P {
            // Only the first three products of slopes depend on rotations, by the curvature.
            if K::CAMBERED && m < 3 {
                row.add(C(m), &self.membrane[m]);
            } else {
                row.add_positions(C(m), &self.membrane[m]);
            }
        }
        for (e, ends) in K::EDGES.into_iter().enumerate() {
            row.add_edge(ends, C(P + e), &self.membrane[P + e]);
        }
        row.add(C(E - 1), &self.membrane[E - 1]);
    }

    /// Calls `of` with the entries of B in a column and with the rows of `X`, where those entries are not zero for all motions of node `a`.
    #[inline(always)]
    fn column<'a, K: Interpolation<N, V, P>, const V: usize>(
        &'a self,
        (a, turns): (usize, bool),
        entry: impl Fn(&Row<N>) -> Lanes,
        X: &'a Self,
        mut of: impl FnMut(Lanes, &'a Row<N>),
    ) {
        for m in 0..P {
            if !turns || (K::CAMBERED && m < 3) {
                of(entry(&self.membrane[m]), &X.membrane[m]);
            }
            of(entry(&self.bending[m]), &X.bending[m]);
        }
        for (e, ends) in K::EDGES.into_iter().enumerate() {
            if ends.contains(&a) {
                of(entry(&self.membrane[P + e]), &X.membrane[P + e]);
                of(entry(&self.shear[e]), &X.shear[e]);
            }
        }
        of(entry(&self.membrane[E - 1]), &X.membrane[E - 1]);
    }

    /// The upper half of BᵀX, without the position of the first node: positions by positions, positions by rotations (from rows of
    /// rotations), rotations by rotations.
    #[inline(always)]
    fn transpose_times<K: Interpolation<N, V, P>, const V: usize>(&self, X: &Self, H: &mut LaneMatrix<N>) {
        for a in 0..N {
            for k in 0..3 {
                if a > 0 {
                    let mut row = [LaneVec3::ZERO; N];
                    self.column::<K, V>(
                        (a, false),
                        |B| B.x[a].0[k],
                        X,
                        |s, X| {
                            (a..N).for_each(|b| add_vector(&mut row[b], s, &X.x[b]));
                        },
                    );
                    (a..N).for_each(|b| H[a][k][b][..3].copy_from_slice(&row[b].0));
                }
                let mut row = Row::<N>::ZERO;
                self.column::<K, V>(
                    (a, true),
                    |B| B.theta[a].0[k],
                    X,
                    |s, X| {
                        (1..N).for_each(|b| add_vector(&mut row.x[b], s, &X.x[b]));
                        (a..N).for_each(|b| add_vector(&mut row.theta[b], s, &X.theta[b]));
                    },
                );
                (a..N).for_each(|b| H[a][3 + k][b][3..].copy_from_slice(&row.theta[b].0));
                for b in 1..N {
                    (0..3).for_each(|i| H[b][i][a][3 + k] = row.x[b].0[i]);
                }
            }
        }
    }
}

impl<const N: usize, const V: usize, const P: usize, const E: usize, S> ShellPack<N, V, P, E, S> {
    /// ∂ε/∂(x, θ).
    #[inline(always)]
    fn rows<K: Interpolation<N, V, P>>(&self, motion: &Motion<N>, slopes: &Slopes<V>, rows: &mut Rows<N, P, E>) {
        let Motion { x, triads } = motion;
        let ([d, t1, t2], Slopes { v, long, .. }) = (triads, slopes);
        for (n, [i, j]) in K::PAIRS.into_iter().enumerate() {
            let mut y = [LaneVec3::ZERO; V];
            y[i] = v[j];
            y[j] = v[i];
            let g = slopes.gradient(&y);
            for a in 0..N {
                let [s, t] = [self.slopes[i][a], self.slopes[j][a]];
                let by = |v: &[LaneVec3; V]| if i == j { s * v[i] } else { s * v[j] + t * v[i] };
                let across = sum(&from_fn(|i| self.slopes[i][a]), &g);
                rows.membrane[n].x[a] = by(v);
                rows.bending[n].x[a] = by(long);
                rows.bending[n].theta[a] = d[a].cross(&across);
            }
        }
        if K::CAMBERED && slopes.by_arcs {
            for (m, slopes) in self.camber.slopes(&slopes.first_bending()).into_iter().enumerate() {
                (0..3).for_each(|n| rows.membrane[m].add(slopes[n], &rows.bending[n]));
            }
        }
        let half = Lanes::splat(0.5);
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let (length, mean) = (x[b] - x[a], half * (d[a] + d[b]));
            let bulge = self.bulging(e, [a, b], triads);
            for ((node, sign), [c1, c2]) in [(a, -1.0), (b, 1.0)].into_iter().zip(self.edges[e]) {
                rows.shear[e].x[node] = Lanes::splat(sign) * mean;
                rows.shear[e].theta[node] = d[node].cross(&(half * length));
                rows.membrane[P + e].x[node] = Lanes::splat(sign) * bulge;
                rows.membrane[P + e].theta[node] = (c1 * t1[node] + c2 * t2[node]).cross(&length);
            }
        }
        let mean = Lanes::splat(0.5 / N as f64);
        let (all1, all2) = (mean * total(t1), mean * total(t2));
        for a in 0..N {
            rows.membrane[E - 1].x[a] = self.slopes[1][a] * all1 - self.slopes[0][a] * all2;
            rows.membrane[E - 1].theta[a] = mean * (t1[a].cross(&v[1]) - t2[a].cross(&v[0]));
        }
    }

    /// C B, with the change of the camber under the membrane stress.
    #[inline(always)]
    fn times<K: Interpolation<N, V, P>>(
        &self,
        C: &LinearisedPlane<P, E, Lanes>,
        rolled: Option<&Rolled<N>>,
        B: &Rows<N, P, E>,
        CB: &mut Rows<N, P, E>,
    ) {
        let mut bending = B.bending;
        if let Some(rolled) = rolled {
            rolled.turn::<K, V, P, E>(B, &mut bending);
        }
        if K::EDGES_BEND {
            for (row, by) in bending.iter_mut().zip(&self.bent.0) {
                (0..N).for_each(|e| row.add_edge(K::EDGES[e], by[e], &B.shear[e]));
            }
        }
        for i in 0..E {
            let mut row = Row::ZERO;
            B.add_membrane::<K, V>(|j| C.N[i][j], &mut row);
            if C.coupled {
                (0..P).for_each(|j| row.add(C.NM[i][j], &bending[j]));
            }
            CB.membrane[i] = row;
        }
        for i in 0..P {
            let mut row = Row::ZERO;
            (0..P).for_each(|j| row.add(C.M[i][j], &bending[j]));
            if C.coupled {
                B.add_membrane::<K, V>(|j| C.NM[j][i], &mut row);
            }
            CB.bending[i] = row;
        }
        for i in 0..N {
            let mut row = Row::ZERO;
            (0..N).for_each(|e| row.add_edge(K::EDGES[e], self.shear[i][e], &B.shear[e]));
            if K::EDGES_BEND {
                (0..3).for_each(|n| row.add(self.bent.0[n][i], &CB.bending[n]));
            }
            CB.shear[i] = row;
        }
        if let Some(rolled) = rolled {
            rolled.pull_back::<K, V, P, E>(B, CB);
        }
        if K::CAMBERED {
            for n in 0..3 {
                for k in 0..3 {
                    let Q = |m: usize| C.stress.membrane[m] * self.camber.0[m][n][k];
                    CB.bending[n].add(Q(0) + Q(1) + Q(2), &B.bending[k]);
                }
            }
        }
    }

    /// σ·∂²ε at the slopes, in the half of a matrix that stands.
    #[inline(always)]
    fn add_strain_hessian<K: Interpolation<N, V, P>>(
        &self,
        stress: &Strains<N, P, E>,
        motion: &Motion<N>,
        slopes: &Slopes<V>,
        H: &mut LaneMatrix<N>,
    ) {
        self.add_bending::<K>(&stress.plane, motion, slopes, H);
        self.add_bilinear::<K>(stress, motion, H);
    }

    /// σ·∂²ε of the bilinear terms: products of slopes, bulges, drilling and shear.
    #[inline(always)]
    fn add_bilinear<K: Interpolation<N, V, P>>(
        &self,
        Strains { plane, shear }: &Strains<N, P, E>,
        motion: &Motion<N>,
        H: &mut LaneMatrix<N>,
    ) {
        let membrane = &plane.membrane;
        let [d, t1, t2] = &motion.triads;
        let Q = by_pairs::<V, P>(&K::PAIRS, membrane);
        for a in 1..N {
            let half: [Lanes; V] = from_fn(|j| product(|i| self.slopes[i][a] * Q[i][j], V));
            for b in a..N {
                let xx = product(|j| half[j] * self.slopes[j][b], V);
                (0..3).for_each(|i| H[a][i][b][i] += xx);
            }
        }
        let drill = membrane[E - 1] * Lanes::splat(0.5 / N as f64);
        let mut c: [[LaneVec3; N]; N] = from_fn(|a| {
            let (first, second) = (drill * self.slopes[1][a], drill * self.slopes[0][a]);
            from_fn(|b| first * t1[b] - second * t2[b])
        });
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let (half, bulge) = (Lanes::splat(0.5) * shear[e], membrane[P + e]);
            for (to, [c1, c2]) in [a, b].into_iter().zip(self.edges[e]) {
                let u = half * d[to] + bulge * (c1 * t1[to] + c2 * t2[to]);
                c[b][to] += u;
                c[a][to] -= u;
            }
        }
        // δd = δθ × d: −[c]~ by position and rotation.
        for a in 1..N {
            (0..N).for_each(|b| subtract_skew(&c[a][b], a, b, H));
        }
    }

    /// σ·∂²ε of bending measured by angles. All its terms are products of vectors: with s the slopes by a node, (skew d) u vᵀ (−skew d) =
    /// (d × u) (d × v)ᵀ.
    #[inline(always)]
    fn add_bending<K: Interpolation<N, V, P>>(
        &self,
        plane: &InPlane<P, E, Lanes>,
        motion: &Motion<N>,
        slopes: &Slopes<V>,
        H: &mut LaneMatrix<N>,
    ) {
        let (d, Slopes { v, w, y, .. }) = (&motion.triads[0], slopes);
        let Q = by_pairs::<V, P>(&K::PAIRS, &plane.bending);
        let p: [LaneVec3; V] = from_fn(|k| sum(&Q[k], v));
        let pair = |s: &[Lanes; 2], of: &[LaneVec3; 2]| s[0] * of[0] + s[1] * of[1];
        let s: [[Lanes; 2]; N] = from_fn(|a| [self.slopes[0][a], self.slopes[1][a]]);
        let (w, two) = ([w[0], w[1]], [p[0], p[1]]);
        let (Y, P_): ([_; N], [_; N]) = (from_fn(|a| pair(&s[a], y)), from_fn(|a| pair(&s[a], &two)));
        // Mixed: Σ_i s_ia ∂²/∂v_i∂w_k.
        let u: [LaneVec3; V] = from_fn(|i| pair(&[Q[i][0], Q[i][1]], &w));
        let k: [[Lanes; 2]; V] =
            from_fn(|i| from_fn(|k| slopes.H[k][0] * Q[i][0] + slopes.H[k][1] * Q[i][1] + Q[i][k]));
        let turned = |of: &[LaneVec3; 2]| -> [[LaneVec3; 2]; N] { from_fn(|a| of.map(|of| d[a].cross(&of))) };
        let (dw, dp, dy) = (turned(&w), turned(&two), turned(y));
        for a in 1..N {
            let along: [Lanes; V] = from_fn(|i| self.slopes[i][a]);
            let U = sum(&along, &u);
            for b in 0..N {
                let q = |k: usize| product(|i| along[i] * Q[i][k], V);
                let even = s[b][0] * product(|i| along[i] * k[i][0], V) + s[b][1] * product(|i| along[i] * k[i][1], V);
                let even = if V > 2 { even + self.slopes[V - 1][b] * q(V - 1) } else { even };
                let of_A = s[b][0] * q(0) + s[b][1] * q(1);
                let dU = d[b].cross(&U);
                for i in 0..3 {
                    for j in 0..3 {
                        let A = w[0].0[i] * dy[b][0].0[j] + w[1].0[i] * dy[b][1].0[j];
                        H[a][i][b][3 + j] += Y[b].0[i] * dU.0[j] + of_A * A;
                    }
                }
                subtract_skew(&(even * d[b]), a, b, H);
            }
        }
        let P2: [[Lanes; 2]; 2] = from_fn(|k| from_fn(|l| two[l].dot(&y[k]) + two[k].dot(&y[l])));
        let form = |M: &[[Lanes; 2]; 2], a: usize, b: usize| {
            let row = |k: usize| M[k][0] * s[b][0] + M[k][1] * s[b][1];
            s[a][0] * row(0) + s[a][1] * row(1)
        };
        for a in 0..N {
            for b in a..N {
                let (S, even) = (form(&slopes.S, a, b), form(&P2, a, b));
                let (first, second) = (d[a].cross(&P_[b]), d[a].cross(&Y[b]));
                let (other, another) = (d[b].cross(&Y[a]), d[b].cross(&P_[a]));
                for i in 0..3 {
                    for j in 0..3 {
                        let of = |c: usize| dp[a][c].0[i] * dw[b][c].0[j] + dw[a][c].0[i] * dp[b][c].0[j];
                        let outer = first.0[i] * other.0[j] + second.0[i] * another.0[j];
                        H[a][3 + i][b][3 + j] += S * (of(0) + of(1)) + outer - even * d[b].0[i] * d[a].0[j];
                    }
                    H[a][3 + i][b][3 + i] += even * d[a].dot(&d[b]);
                }
            }
        }
    }
}

impl<const N: usize, const V: usize, const P: usize, const E: usize, S> ShellPack<N, V, P, E, S>
where
    S: ShellSections<P, E, Lanes>,
{
    /// Tangents of the elements, see [`crate::elements::ElementBlock::tangent`], with the stresses at the nodes `stressed` where there are
    /// such.
    pub fn tangents<K: Interpolation<N, V, P>>(
        &self,
        (now, stressed): (&Configuration, Option<&[Node]>),
        moduli: Moduli,
        damping: Option<RateTerms>,
        H: &mut LaneMatrix<N>,
    ) {
        let motion = self.gather(now.nodes);
        let slopes = self.slopes(&motion);
        let strains = match stressed {
            Some(nodes) => self.strains_at::<K>(nodes),
            None => self.strains::<K>(&motion, &slopes, now.nodes),
        };
        let C = self.sections.linearise(&strains.plane, now, moduli);
        let stress = Strains { shear: self.edge_stress::<K>(&strains.shear, &C.stress), plane: C.stress };
        let (mut B, mut CB) = (Rows::ZERO, Rows::ZERO);
        self.rows::<K>(&motion, &slopes, &mut B);
        let rolled = self.rolled.as_ref().map(|rolled| Rolled {
            t: rolled.strain(&self.bulges::<K>(&motion)),
            by_bulges: rolled.by_bulges(slopes.first_bending()),
            mixed: rolled.mixed(&from_fn(|n| C.stress.bending[n])),
        });
        self.times::<K>(&C, rolled.as_ref(), &B, &mut CB);
        B.transpose_times::<K, V>(&CB, H);
        let stress = self.pulled_back::<K>(stress, &motion, &slopes);
        self.add_strain_hessian::<K>(&stress, &motion, &slopes, H);
        complete(H);
        self.gradient::<K>(&stress, &motion, &slopes).add_turning(&motion, H);
        if let Some(damping) = damping {
            self.add_damping::<K>(damping, &motion, now.nodes, [&mut B, &mut CB], H);
        }
    }

    /// Adds the derivatives of the forces of damping by positions and rotations, and `rate_weight` times those by their rates.
    fn add_damping<K: Interpolation<N, V, P>>(
        &self,
        RateTerms { factor, rate_weight }: RateTerms,
        motion: &Motion<N>,
        nodes: &[Node],
        [B, CB]: [&mut Rows<N, P, E>; 2],
        H: &mut LaneMatrix<N>,
    ) {
        let rates = self.rates(motion, nodes);
        let rows = |motion: &Motion<N>| {
            let mut rows = Rows::ZERO;
            self.rows::<K>(motion, &self.chords(motion), &mut rows);
            rows
        };
        *B = rows(motion);
        // ∂ε̇/∂(x, θ) from ε̇ = B (v, ω); θ adds a rotation to the rotation by ω.
        let (mut D, behind) = (rows(&motion.plus(1.0, &rates)), rows(&motion.plus(-1.0, &rates)));
        let (half, weight, factor_) = (Lanes::splat(0.5), Lanes::splat(rate_weight), Lanes::splat(factor));
        let omega = self.omega(nodes);
        for ((D, behind), B) in D.all_mut().zip(behind.all()).zip(B.all()) {
            for a in 0..N {
                let turned = B.theta[a].cross(&omega[a]);
                D.x[a] = factor_ * (half * (D.x[a] - behind.x[a]) + weight * B.x[a]);
                D.theta[a] = factor_ * (half * (D.theta[a] - behind.theta[a]) + turned + weight * B.theta[a]);
            }
        }
        *CB = Rows::ZERO;
        self.times::<K>(&self.sections.elastic().linearised(), None, &D, CB);
        let stress = self.viscous_stress::<K>(factor, motion, &rates);
        let (chords, mut viscous) = (self.chords(motion), [[[[Lanes::ZERO; 6]; N]; 6]; N]);
        self.add_strain_hessian::<K>(&stress, motion, &chords, &mut viscous);
        complete(&mut viscous);
        self.gradient::<K>(&stress, motion, &chords).add_turning(motion, &mut viscous);
        add(&viscous, H);
        let mut viscous = [[[[Lanes::ZERO; 6]; N]; 6]; N];
        B.all().zip(CB.all()).for_each(|(B, CB)| B.add_product(CB, &mut viscous));
        hold_translations(&mut viscous);
        add(&viscous, H);
    }
}

/// The data of [`super::rolled_edges`] for the rows of bending.
struct Rolled<const N: usize> {
    /// Strain by the bulges.
    t: [Lanes; 3],
    /// The change of the first numbers of bending per bulge of each edge.
    by_bulges: [[Lanes; 3]; N],
    /// The second derivatives by each bulge and those numbers.
    mixed: [[Lanes; 3]; N],
}

impl<const N: usize> Rolled<N> {
    /// ∂/∂k of sym(t K), of numbers of bending by numbers of bending; `None` where it is zero.
    #[inline(always)]
    fn of_bending(&self) -> [[Option<Lanes>; 3]; 3] {
        let ([a, b, mixed], half) = (self.t, Lanes::splat(0.5));
        let of = |of: Lanes| Some(half * of);
        [[Some(a), None, of(mixed)], [None, Some(b), of(mixed)], [Some(mixed), Some(mixed), of(a + b)]]
    }

    /// Adds to the rows of the first numbers of bending what strain by bulges makes of them.
    #[inline(always)]
    fn turn<K: Interpolation<N, V, P>, const V: usize, const P: usize, const E: usize>(
        &self,
        B: &Rows<N, P, E>,
        bending: &mut [Row<N>; P],
    ) {
        for (n, row) in self.of_bending().into_iter().enumerate() {
            for (m, factor) in row.into_iter().enumerate() {
                factor.into_iter().for_each(|factor| bending[n].add(factor, &B.bending[m]));
            }
            for (e, ends) in K::EDGES.into_iter().enumerate() {
                bending[n].add_edge(ends, self.by_bulges[e][n], &B.membrane[P + e]);
            }
        }
    }

    /// The transpose of it on the rows of C B, and the second derivatives.
    #[inline(always)]
    fn pull_back<K: Interpolation<N, V, P>, const V: usize, const P: usize, const E: usize>(
        &self,
        B: &Rows<N, P, E>,
        CB: &mut Rows<N, P, E>,
    ) {
        let moments: [Row<N>; 3] = from_fn(|n| CB.bending[n]);
        for (n, row) in self.of_bending().into_iter().enumerate() {
            for (m, factor) in row.into_iter().enumerate() {
                factor.into_iter().for_each(|factor| CB.bending[m].add(factor, &moments[n]));
            }
        }
        for (e, ends) in K::EDGES.into_iter().enumerate() {
            for n in 0..3 {
                CB.membrane[P + e].add(self.by_bulges[e][n], &moments[n]);
                CB.membrane[P + e].add(self.mixed[e][n], &B.bending[n]);
                CB.bending[n].add_edge(ends, self.mixed[e][n], &B.membrane[P + e]);
            }
        }
    }
}

/// Damping of a tangent.
#[derive(Clone, Copy)]
pub(super) struct RateTerms {
    /// The factor of the stress by strain rates.
    pub factor: f64,
    /// The factor on derivatives by rates.
    pub rate_weight: f64,
}

/// H += M.
fn add<const N: usize>(M: &LaneMatrix<N>, H: &mut LaneMatrix<N>) {
    let M = M.as_flattened().as_flattened().as_flattened();
    H.as_flattened_mut().as_flattened_mut().as_flattened_mut().iter_mut().zip(M).for_each(|(h, m)| *h += *m);
}

impl<const N: usize> Motion<N> {
    /// Adds to `H` the change of the moments of this gradient that rotations make: (δθ × d) × g = (d gᵀ − (d·g) 1) δθ.
    #[inline(always)]
    fn add_turning(&self, motion: &Motion<N>, H: &mut LaneMatrix<N>) {
        for a in 0..N {
            for k in 0..3 {
                let (d, g) = (&motion.triads[k][a], &self.triads[k][a]);
                let along = d.dot(g);
                for i in 0..3 {
                    (0..3).for_each(|j| H[a][3 + i][a][3 + j] += d.0[i] * g.0[j]);
                    H[a][3 + i][a][3 + i] -= along;
                }
            }
        }
    }
}
