//! Where two lines are nearest to each other, and how their distance changes with their ends.
//!
//! The nearest points have the difference g = x(s) − y(t), f = ½ g², with c the shares of the four ends in g. u and v are the vectors along
//! the lines:
//!
//! ```text
//!  ∂f_s/∂x = c u + σ g,   ∂f_t/∂x = −c v − τ g,   ∂²f/∂x² = c c I − A M⁻¹ Aᵀ,   M = [u·u −u·v; −u·v v·v]
//! ```
//!
//! A holds the first two for s and t unless at an end; σ and τ are ∓1 at the ends of their own line, and ∂²d = (∂²f − ∂d ∂d)/d.

use super::facet::{Facet, Region};
use super::pair::{FacetPair, PairPlace};
use crate::elements::contact::point::ContactPoint;
use crate::elements::contact::segments::{PARALLEL, nearest};
use crate::state::Node;
use base::math::{Mat3, Vec3};

/// The share of the second end of a line that touches in its point nearest to the line of a facet; `None` for a point.
pub(super) fn share(point: &ContactPoint, facet: &Facet, nodes: &[Node]) -> Option<f64> {
    if !point.is_line() {
        return None;
    }
    let [a, b, c, d] = [point.nodes[0], point.nodes[1], facet.nodes[0], facet.nodes[1]].map(|node| &nodes[node]);
    Some(nearest(&a.relative_position(c), &b.relative_position(a), &d.relative_position(c))[0])
}

/// True for parallel lines: their nearest points are not unique.
pub(super) fn are_parallel(point: &ContactPoint, facet: &Facet, nodes: &[Node]) -> bool {
    let along = |ends: &[usize]| nodes[ends[1]].relative_position(&nodes[ends[0]]);
    let (u, v) = (along(point.nodes()), along(facet.nodes()));
    let (uu, vv, uv) = (u.norm_squared(), v.norm_squared(), u.dot(&v));
    uu * vv - uv * uv <= PARALLEL * uu * vv
}

/// The second derivative of the distance by two of the four ends, as a function of their places.
pub(super) struct LineHessian {
    c: [f64; 4],
    n: Vec3,
    by_d: f64,
    /// ∂f_s/∂x and ∂f_t/∂x by ends, zero where the nearest point is an end.
    A: [[Vec3; 4]; 2],
    /// M⁻¹.
    inverse: [[f64; 2]; 2],
}

impl LineHessian {
    /// The second derivative for a pair of lines at their current place.
    pub fn new(pair: &FacetPair, place: &PairPlace, nodes: &[Node]) -> LineHessian {
        let s = pair.point.weights[1];
        let t = place.W[1];
        let along = |ends: &[usize]| nodes[ends[1]].relative_position(&nodes[ends[0]]);
        let (u, v, g) = (along(pair.point.nodes()), along(pair.facet.nodes()), place.d * place.n);
        let c = [1.0 - s, s, t - 1.0, -t];
        let by_s: [Vec3; 4] = std::array::from_fn(|i| c[i] * u + [-1.0, 1.0, 0.0, 0.0][i] * g);
        let by_t: [Vec3; 4] = std::array::from_fn(|i| -c[i] * v - [0.0, 0.0, -1.0, 1.0][i] * g);
        let (uu, vv, uv) = (u.norm_squared(), v.norm_squared(), u.dot(&v));
        let determinant = uu * vv - uv * uv;
        let free = [s > 0.0 && s < 1.0, place.at.region == Region::Edge(0)];
        let zero = [Vec3::zeros(); 4];
        let (A, inverse) = match free {
            // For parallel lines only one of the two nearest points moves.
            [true, true] if determinant > PARALLEL * uu * vv => {
                ([by_s, by_t], [[vv / determinant, uv / determinant], [uv / determinant, uu / determinant]])
            }
            [true, false] => ([by_s, zero], [[1.0 / uu, 0.0], [0.0, 0.0]]),
            [_, true] => ([zero, by_t], [[0.0, 0.0], [0.0, 1.0 / vv]]),
            [false, false] => ([zero, zero], [[0.0; 2]; 2]),
        };
        let by_d = if place.d.abs() > 1e-12 * place.reach { 1.0 / place.d } else { 0.0 };
        LineHessian { c, n: place.n, by_d, A, inverse }
    }

    /// ∂²d by the ends `i` and `j`.
    pub fn block(&self, i: usize, j: usize) -> Mat3 {
        let LineHessian { c, n, by_d, A, inverse } = self;
        let mut block = c[i] * c[j] * (Mat3::identity() - n * n.transpose());
        for p in 0..2 {
            for q in 0..2 {
                block -= inverse[p][q] * A[p][i] * A[q][j].transpose();
            }
        }
        *by_d * block
    }
}
