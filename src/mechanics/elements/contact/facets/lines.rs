//! Where two lines are nearest to each other, and how their distance changes with their ends.
//!
//! With g = x(s) − y(t) between the nearest points, u and v the vectors along the lines, f = ½ g² and the shares c of the four ends in g,
//!
//! ```text
//!  ∂f_s/∂x = c u + σ g,   ∂f_t/∂x = −c v − τ g,   ∂²f/∂x² = c c I − A M⁻¹ Aᵀ,   M = [u·u −u·v; −u·v v·v]
//! ```
//!
//! where A collects the first two for those of s and t that are not at an end, σ and τ are ∓1 at the ends of the line itself, and
//! ∂²d = (∂²f − ∂d ∂d)/d.

use super::facet::{Facet, Region};
use super::pair::{FacetPair, PairPlace};
use crate::elements::contact::point::ContactPoint;
use crate::state::Node;
use base::math::{Mat3, Vec3};

/// Two lines count as parallel below this square of the sine of their angle.
const PARALLEL: f64 = 1e-12;

/// The shares of the second ends in the nearest points of the lines from `a` to `a + u` and from `b` to `b + v`, with `r` = a − b; of lines
/// that are parallel the middle of what lies side by side (after C. Ericson, Real-Time Collision Detection, 2005, 5.1.9).
pub(super) fn nearest(r: &Vec3, u: &Vec3, v: &Vec3) -> [f64; 2] {
    let (uu, vv, uv) = (u.norm_squared(), v.norm_squared(), u.dot(v));
    let (c, f) = (u.dot(r), v.dot(r));
    if uu == 0.0 || vv == 0.0 {
        let on = |along: f64, square: f64| if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
        return if uu == 0.0 { [0.0, on(f, vv)] } else { [on(-c, uu), 0.0] };
    }
    let determinant = uu * vv - uv * uv;
    if determinant <= PARALLEL * uu * vv {
        // Where the ends of the other lie along this one.
        let (first, last) = (-c / uu, (uv - c) / uu);
        let (low, high) = (first.min(last).max(0.0), first.max(last).min(1.0));
        let s = if low <= high { 0.5 * (low + high) } else { (0.5 * (low + high)).clamp(0.0, 1.0) };
        return [s, ((f + s * uv) / vv).clamp(0.0, 1.0)];
    }
    let s = ((uv * f - c * vv) / determinant).clamp(0.0, 1.0);
    let t = (f + s * uv) / vv;
    match t {
        _ if t < 0.0 => [(-c / uu).clamp(0.0, 1.0), 0.0],
        _ if t > 1.0 => [((uv - c) / uu).clamp(0.0, 1.0), 1.0],
        _ => [s, t],
    }
}

/// The share of the second end of a line that touches in its point nearest to the line of a facet; `None` for a point.
pub(super) fn share(point: &ContactPoint, facet: &Facet, nodes: &[Node]) -> Option<f64> {
    if !point.is_line() {
        return None;
    }
    let [a, b, c, d] = [point.nodes[0], point.nodes[1], facet.nodes[0], facet.nodes[1]].map(|node| &nodes[node]);
    Some(nearest(&a.relative_position(c), &b.relative_position(a), &d.relative_position(c))[0])
}

/// True for lines whose nearest points are not told by where they cross.
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
    /// Of a pair of lines, where they are.
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
            // Of parallel lines one point slides.
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

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn the_nearest_points_are_the_nearest_of_all() {
        let mut rng = StdRng::seed_from_u64(5);
        let mut vector = || Vec3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        for round in 0..600 {
            let (a, b, u) = (vector(), 0.5 * vector(), vector());
            // Some are parallel.
            let v = if round % 3 == 0 { -0.7 * u } else { vector() };
            let [s, t] = nearest(&(a - b), &u, &v);
            let distance = (a + s * u - b - t * v).norm();
            let mut least = f64::INFINITY;
            for i in 0..=100 {
                for j in 0..=100 {
                    let (s, t) = (f64::from(i) / 100.0, f64::from(j) / 100.0);
                    least = least.min((a + s * u - b - t * v).norm());
                }
            }
            // Samples stand up to 1/100 of lengths up to 1.7 apart.
            assert!(distance <= least + 1e-12 && least < distance + 0.02, "{distance} {least}");
        }
    }
}
