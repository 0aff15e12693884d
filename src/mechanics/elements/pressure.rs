//! Follower pressure: it acts on the deformed area of a face, against its normal.
//!
//! The forces on the nodes of a face x(ξ, η) are f_a = −p ∫ N_a x,ξ × x,η dξ dη. About the normal the nodes run counter-clockwise. The
//! integral is a polynomial of second degree in the node positions; the code below writes it out for linear and bilinear x. f is −p times
//! the derivative of the volume under the face. A closed surface therefore has the potential p V and a symmetric stiffness; at a free edge
//! the stiffness is unsymmetric (Schweizerhof & Ramm 1984).

use super::block::{Force, subtract};
use crate::state::Node;
use base::math::curved_faces::{CurvedFace, NineNodes, SixNodes};
use base::math::{Mat3, Vec3, skew};

/// A face under pressure, by its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// Three nodes, x linear.
    Triangle([usize; 3]),
    /// Four nodes, x bilinear.
    Quadrilateral([usize; 4]),
    /// Six nodes, x of second degree.
    CurvedTriangle([usize; 6]),
    /// Nine nodes, x of second degree along each coordinate.
    CurvedQuadrilateral([usize; 9]),
}

/// The largest number of nodes of a face.
pub const MOST_NODES: usize = 9;

/// Coefficients of the nodes of a quadrilateral in e₀, e₁, e₂, with x,ξ = e₀ + η e₂ and x,η = e₁ + ξ e₂, ξ and η from −1 to 1.
const SLOPES: [[f64; 4]; 3] = [[-0.25, 0.25, 0.25, -0.25], [-0.25, -0.25, 0.25, 0.25], [0.25, -0.25, 0.25, -0.25]];
/// Pairs (i, j) in x,ξ × x,η = Σ e_i × e_j times 1, ξ and η.
const PAIRS: [[usize; 2]; 3] = [[0, 1], [0, 2], [2, 1]];
/// ∫ N_a, ∫ N_a ξ and ∫ N_a η for each node a.
const SHARES: [[f64; 3]; 4] = [[1.0, -THIRD, -THIRD], [1.0, THIRD, -THIRD], [1.0, THIRD, THIRD], [1.0, -THIRD, THIRD]];
const THIRD: f64 = 1.0 / 3.0;

impl Face {
    /// The face of an element with three, four, six or nine nodes; none for other numbers of them.
    pub fn of(nodes: &[usize]) -> Option<Face> {
        match *nodes {
            [a, b, c] => Some(Face::Triangle([a, b, c])),
            [a, b, c, d] => Some(Face::Quadrilateral([a, b, c, d])),
            _ => match nodes.len() {
                6 => Some(Face::CurvedTriangle(nodes.try_into().ok()?)),
                9 => Some(Face::CurvedQuadrilateral(nodes.try_into().ok()?)),
                _ => None,
            },
        }
    }

    /// Its nodes, the corners counter-clockwise about the normal.
    pub fn nodes(&self) -> &[usize] {
        match self {
            Face::Triangle(nodes) => nodes,
            Face::Quadrilateral(nodes) => nodes,
            Face::CurvedTriangle(nodes) => nodes,
            Face::CurvedQuadrilateral(nodes) => nodes,
        }
    }

    /// Its nodes, to be renumbered.
    pub fn nodes_mut(&mut self) -> &mut [usize] {
        match self {
            Face::Triangle(nodes) => nodes,
            Face::Quadrilateral(nodes) => nodes,
            Face::CurvedTriangle(nodes) => nodes,
            Face::CurvedQuadrilateral(nodes) => nodes,
        }
    }

    /// ∫ N_a n dA for each of [`Face::nodes`], zero beyond them. `x` gives the position of a node.
    #[inline]
    pub fn areas(&self, x: impl Fn(usize) -> Vec3) -> [Vec3; MOST_NODES] {
        let mut areas = [Vec3::zeros(); MOST_NODES];
        match self {
            Face::Triangle([a, b, c]) => {
                let first = x(*a);
                let third = (x(*b) - first).cross(&(x(*c) - first)) / 6.0;
                areas[..3].fill(third);
            }
            Face::Quadrilateral(nodes) => {
                let e = edges(nodes, x);
                let products = PAIRS.map(|[i, j]| e[i].cross(&e[j]));
                areas[..4].copy_from_slice(&SHARES.map(|share| (0..3).map(|k| share[k] * products[k]).sum()));
            }
            Face::CurvedTriangle(nodes) => curved_areas::<SixNodes, 6>(&nodes.map(x), &mut areas),
            Face::CurvedQuadrilateral(nodes) => curved_areas::<NineNodes, 9>(&nodes.map(x), &mut areas),
        }
        areas
    }

    /// Adds the forces of the pressure `p` to `F`, which is indexed by node; returns the largest of their components.
    #[inline]
    pub fn add_forces(&self, p: f64, nodes: &[Node], F: &mut [Force]) -> f64 {
        let mut largest: f64 = 0.0;
        for (&node, area) in self.nodes().iter().zip(self.areas(|n| nodes[n].x)) {
            let f = p * area;
            largest = largest.max(f.amax());
            subtract(&mut F[node], 0, &f);
        }
        largest
    }

    /// Work of a pressure that changes linearly from `p[0]` to `p[1]` while each node moves on a straight line from `from` to `to`. Power
    /// is of third degree in the way, so Simpson's rule is exact. A constant p does the work −p times the change of volume.
    pub fn work(&self, p: [f64; 2], from: &[Node], to: &[Node]) -> f64 {
        let moved = |n: usize| to[n].x - from[n].x;
        let at = |s: f64| {
            let areas = self.areas(|n| from[n].x + s * moved(n));
            let sum: f64 = self.nodes().iter().zip(areas).map(|(&n, area)| area.dot(&moved(n))).sum();
            -(p[0] + s * (p[1] - p[0])) * sum
        };
        (at(0.0) + 4.0 * at(0.5) + at(1.0)) / 6.0
    }

    /// K ← −∂f/∂x, row-major over the nodes, three components each.
    pub fn stiffness(&self, p: f64, nodes: &[Node], K: &mut [f64]) {
        let x = |n: usize| nodes[n].x;
        match self {
            Face::Triangle([a, b, c]) => {
                // ∂[(b − a) × (c − a)] by a corner is the cross product with the opposite side.
                let sides = [x(*c) - x(*b), x(*a) - x(*c), x(*b) - x(*a)].map(|side| p / 6.0 * skew(&side));
                set(K, |_, column| sides[column]);
            }
            Face::Quadrilateral(nodes) => {
                let e = edges(nodes, x).map(|e| p * skew(&e));
                let by = PAIRS.map(|[i, j]| [0, 1, 2, 3].map(|b| SLOPES[j][b] * e[i] - SLOPES[i][b] * e[j]));
                set(K, |a, b| (0..3).map(|k| SHARES[a][k] * by[k][b]).sum());
            }
            Face::CurvedTriangle(nodes) => curved_stiffness::<SixNodes, 6>(p, &nodes.map(x), K),
            Face::CurvedQuadrilateral(nodes) => curved_stiffness::<NineNodes, 9>(p, &nodes.map(x), K),
        }
    }
}

/// ∫ N_a n dA of a curved face, which its rule integrates exactly.
fn curved_areas<F: CurvedFace<N>, const N: usize>(x: &[Vec3; N], areas: &mut [Vec3; MOST_NODES]) {
    let from = x.map(|at| at - x[0]);
    for &(at, w) in F::RULE {
        let [r, s] = F::slopes(at).map(|by| (0..N).map(|a| by[a] * from[a]).sum::<Vec3>());
        let (values, area) = (F::values(at), w * r.cross(&s));
        (0..N).for_each(|a| areas[a] += values[a] * area);
    }
}

/// K ← p ∂(∫ N_a x,r × x,s)/∂x of a curved face.
fn curved_stiffness<F: CurvedFace<N>, const N: usize>(p: f64, x: &[Vec3; N], K: &mut [f64]) {
    let mut sums = [[Vec3::zeros(); N]; N];
    for &(at, w) in F::RULE {
        let by = F::slopes(at);
        let [r, s] = by.map(|by| (0..N).map(|a| by[a] * x[a]).sum::<Vec3>());
        let values = F::values(at);
        for b in 0..N {
            let turned = p * w * (by[1][b] * r - by[0][b] * s);
            (0..N).for_each(|a| sums[a][b] += values[a] * turned);
        }
    }
    set(K, |a, b| skew(&sums[a][b]));
}

/// e₀, e₁ and e₂ of a quadrilateral.
#[inline]
fn edges(nodes: &[usize; 4], x: impl Fn(usize) -> Vec3) -> [Vec3; 3] {
    let first = x(nodes[0]);
    let x = nodes.map(|n| x(n) - first);
    SLOPES.map(|slope| (0..4).map(|a| slope[a] * x[a]).sum())
}

/// K ← its 3×3 blocks, by pairs of nodes.
fn set(K: &mut [f64], block: impl Fn(usize, usize) -> Mat3) {
    let n = (K.len() / 9).isqrt();
    for a in 0..n {
        for b in 0..n {
            let block = block(a, b);
            for i in 0..3 {
                for j in 0..3 {
                    K[(3 * a + i) * 3 * n + 3 * b + j] = block[(i, j)];
                }
            }
        }
    }
}
