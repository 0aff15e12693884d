//! One facet of a surface of nodes: a triangle, a quadrilateral, a line with a tube around it, or a single node with a ball around it.
//!
//! A quadrilateral is four triangles about the mean of its nodes. Every point is thus a weighted sum of nodes, and coplanar facets of any
//! shape join without a seam.

use crate::state::Node;
use base::math::{Mat3, Vec3};

/// Largest number of corners of a facet.
pub const MOST_CORNERS: usize = 4;

/// A facet by its nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    /// Its corners; the first `corners` of them count, and the others repeat the first.
    pub nodes: [usize; MOST_CORNERS],
    /// Number of corners: 1, 2, 3 or 4.
    pub corners: usize,
    /// Half the thickness; for a line or a single node, the radius of the tube or ball around it.
    pub half: f64,
    /// Radius of a ball for the moment of friction on its node; 0 for other facets.
    pub rolling_radius: f64,
    /// True for a free edge of the surface, by edges from each corner to the next.
    pub(super) free_edges: [bool; MOST_CORNERS],
    /// True for a corner on a free edge.
    pub(super) free_nodes: [bool; MOST_CORNERS],
    /// True where its nodes run against those of its neighbours.
    pub(super) is_turned: bool,
    /// Which of the four triangles of a quadrilateral it is; `None` for all of it, and for others.
    pub(super) piece: Option<usize>,
    /// Identifiers of its corners: nodes, or the middle of a quadrilateral with a number beyond those of nodes.
    pub(super) names: [usize; 3],
}

/// The part of a triangle on which a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Region {
    /// The interior of a triangle.
    Interior,
    /// The edge from this corner to the next.
    Edge(usize),
    /// This corner.
    Vertex(usize),
}

/// The point of a facet closest to a given one.
#[derive(Debug, Clone, Copy)]
pub(super) struct FacetPoint {
    /// The number of the triangle, of a quadrilateral.
    pub triangle: usize,
    /// Shares of the corners of the triangle.
    pub N: [f64; 3],
    /// Where on the triangle it lies.
    pub region: Region,
    /// From there to the given point, global components.
    pub g: Vec3,
}

impl Facet {
    /// A facet by its corners.
    pub fn new(corners: &[usize], half: f64) -> Facet {
        let mut nodes = [corners[0]; MOST_CORNERS];
        nodes[..corners.len()].copy_from_slice(corners);
        Facet {
            nodes,
            corners: corners.len(),
            half,
            rolling_radius: 0.0,
            free_edges: [false; MOST_CORNERS],
            free_nodes: [false; MOST_CORNERS],
            is_turned: false,
            piece: None,
            names: [nodes[0], nodes[1], nodes[2]],
        }
    }

    /// Splits a quadrilateral into its four triangles; `middle` is the identifier of its middle. Other facets are returned whole.
    pub(super) fn pieces(&self, middle: usize) -> Vec<Facet> {
        if self.corners < 4 {
            return vec![self.clone()];
        }
        let piece = |k: usize| Facet {
            piece: Some(k),
            names: [self.nodes[k], self.nodes[(k + 1) % 4], middle],
            ..self.clone()
        };
        (0..4).map(piece).collect()
    }

    /// A node with a ball around it.
    pub fn ball(node: usize, radius: f64, rolling_radius: f64) -> Facet {
        Facet { rolling_radius, ..Facet::new(&[node], radius) }
    }

    /// Its corners.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes[..self.corners]
    }

    /// True for a node with a ball around it.
    pub fn is_ball(&self) -> bool {
        self.corners == 1
    }

    /// True for a line with a tube around it.
    pub fn is_line(&self) -> bool {
        self.corners == 2
    }

    /// True for triangles and quadrilaterals, which have two sides and a normal.
    pub(super) fn has_sides(&self) -> bool {
        self.corners > 2
    }

    /// The places of its corners relative to a point that lies at `x` from the node `origin`.
    #[inline]
    pub(super) fn seen_from(&self, x: &Vec3, origin: &Node, nodes: &[Node]) -> [Vec3; MOST_CORNERS] {
        let seen = |node: usize| nodes[node].relative_position(origin) - x;
        if self.is_ball() { [seen(self.nodes[0]); MOST_CORNERS] } else { self.nodes.map(seen) }
    }

    /// Number of its triangles.
    pub(super) fn triangles(&self) -> usize {
        if self.corners == 4 && self.piece.is_none() { 4 } else { 1 }
    }

    /// The share of each node in each corner of a triangle.
    pub(super) fn corner_weights(&self, triangle: usize) -> [[f64; MOST_CORNERS]; 3] {
        let unit = |k: usize| std::array::from_fn(|j| f64::from(u8::from(j == k)));
        match self.corners {
            4 => [unit(triangle), unit((triangle + 1) % 4), [0.25; MOST_CORNERS]],
            3 => [unit(0), unit(1), unit(2)],
            2 => [unit(0), unit(1), unit(0)],
            _ => [unit(0); 3],
        }
    }

    /// The corners of a triangle from those of the facet.
    #[inline]
    pub(super) fn triangle(&self, triangle: usize, p: &[Vec3; MOST_CORNERS]) -> [Vec3; 3] {
        match self.corners {
            4 => [p[triangle], p[(triangle + 1) % 4], 0.25 * ((p[0] + p[2]) + (p[1] + p[3]))],
            _ => [p[0], p[1], p[2]],
        }
    }

    /// The point closest to the origin of `p`, the places of the corners.
    #[inline]
    pub(super) fn closest(&self, p: &[Vec3; MOST_CORNERS]) -> FacetPoint {
        if self.is_ball() {
            return FacetPoint { triangle: 0, N: [1.0, 0.0, 0.0], region: Region::Vertex(0), g: -p[0] };
        }
        if self.is_line() {
            let (s, region) = closest_on_line(&p[0], &p[1]);
            let N = [1.0 - s, s, 0.0];
            return FacetPoint { triangle: 0, N, region, g: -(N[0] * p[0] + N[1] * p[1]) };
        }
        let mut best: Option<(f64, FacetPoint)> = None;
        for triangle in (0..self.triangles()).map(|k| self.piece.unwrap_or(k)) {
            let corners = self.triangle(triangle, p);
            let (N, region) = closest_on_triangle(&corners);
            let y = N[0] * corners[0] + N[1] * corners[1] + N[2] * corners[2];
            let square = y.norm_squared();
            if best.as_ref().is_none_or(|(least, _)| square < *least) {
                best = Some((square, FacetPoint { triangle, N, region, g: -y }));
            }
        }
        best.map_or(FacetPoint { triangle: 0, N: [1.0, 0.0, 0.0], region: Region::Vertex(0), g: -p[0] }, |best| best.1)
    }

    /// The foot of the perpendicular from the origin on the plane of a triangle, within it or beyond its rim; `p` are the places of the corners.
    pub(super) fn foot(&self, p: &[Vec3; MOST_CORNERS]) -> FacetPoint {
        let triangle = self.piece.unwrap_or(0);
        let [a, b, c] = self.triangle(triangle, p);
        let (u, v) = (b - a, c - a);
        let n = u.cross(&v);
        let square = n.norm_squared().max(f64::MIN_POSITIVE);
        let (s, t) = (-a.dot(&v.cross(&n)) / square, -a.dot(&n.cross(&u)) / square);
        FacetPoint { triangle, N: [1.0 - s - t, s, t], region: Region::Interior, g: n * (-a.dot(&n) / square) }
    }

    /// The share of each node in a point of the facet.
    #[inline]
    pub(super) fn weights(&self, at: &FacetPoint) -> [f64; MOST_CORNERS] {
        if self.is_ball() {
            return [1.0, 0.0, 0.0, 0.0];
        }
        let C = self.corner_weights(at.triangle);
        std::array::from_fn(|j| (0..3).map(|i| at.N[i] * C[i][j]).sum())
    }

    /// The names of the corners between which a point on the rim of a triangle lies; none inside.
    #[inline]
    pub(super) fn rim(&self, at: &FacetPoint) -> [Option<usize>; 2] {
        match at.region {
            Region::Interior => [None; 2],
            Region::Vertex(k) => [Some(self.names[k]), None],
            Region::Edge(_) if self.is_line() => [None; 2],
            Region::Edge(k) => [Some(self.names[k]), Some(self.names[(k + 1) % 3])],
        }
    }

    /// True where the surface ends at a point of the rim: there it has no sides.
    pub(super) fn is_free(&self, at: &FacetPoint) -> bool {
        if !self.has_sides() {
            return false;
        }
        // The third corner of a quadrilateral's triangle lies inside.
        let corner = |k: usize| match self.corners {
            4 => (k < 2).then_some((at.triangle + k) % 4),
            _ => Some(k),
        };
        match at.region {
            Region::Interior => false,
            Region::Vertex(k) => corner(k).is_some_and(|k| self.free_nodes[k]),
            Region::Edge(k) => (self.corners == 3 || k == 0) && corner(k).is_some_and(|k| self.free_edges[k]),
        }
    }

    /// The unit normal of a triangle, on the same side throughout a connected surface; zero for lines and balls.
    #[inline]
    pub(super) fn normal(&self, triangle: usize, p: &[Vec3; MOST_CORNERS]) -> Vec3 {
        if !self.has_sides() {
            return Vec3::zeros();
        }
        let [a, b, c] = self.triangle(triangle, p);
        let n = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        if self.is_turned { -n } else { n }
    }

    /// The unit vector toward a point at `g` from its nearest point: the normal, or the direction of `g` for lines and balls.
    #[inline]
    pub(super) fn facing(&self, at: &FacetPoint, p: &[Vec3; MOST_CORNERS]) -> Vec3 {
        match self.has_sides() {
            true => self.normal(at.triangle, p),
            false => at.g.try_normalize(0.0).unwrap_or_else(Vec3::zeros),
        }
    }

    /// The unit vector of the part of `g` across a line; zero for a `g` along it.
    pub(super) fn across(&self, g: &Vec3, p: &[Vec3; MOST_CORNERS]) -> Vec3 {
        let along = p[1] - p[0];
        let across = g - along * (g.dot(&along) / along.norm_squared());
        across.try_normalize(1e-9 * along.norm()).unwrap_or_else(Vec3::zeros)
    }

    /// A unit vector out of the middle of a line or a ball.
    pub(super) fn outward(&self, p: &[Vec3; MOST_CORNERS]) -> Vec3 {
        match self.is_line() {
            true => {
                let along = p[1] - p[0];
                along.cross(&Vec3::ith(along.iamin(), 1.0)).try_normalize(0.0).unwrap_or_else(Vec3::x)
            }
            false => Vec3::x(),
        }
    }

    /// Base vectors that stretch with the facet, from its first node: along two of its sides, and the normal. A vector with constant
    /// components in them moves with the material. Of a ball or a line they are the axes of its first node.
    pub(super) fn base(&self, nodes: &[Node]) -> Mat3 {
        let frame = self.frame(nodes);
        if !self.has_sides() {
            return frame;
        }
        let from = |k: usize| nodes[self.nodes[k]].relative_position(&nodes[self.nodes[0]]);
        spread_apart(&from(1), &from(self.corners - 1), &frame)
    }

    /// The components of a vector in those base vectors.
    pub(super) fn components(&self, v: &Vec3, nodes: &[Node]) -> Vec3 {
        let base = self.base(nodes);
        if !self.has_sides() {
            return base.tr_mul(v);
        }
        base.try_inverse().map_or(*v, |inverse| inverse * v)
    }

    /// An origin and axes that go along with the facet: the columns of a rotation, global components. The origin is its first node.
    pub(super) fn frame(&self, nodes: &[Node]) -> Mat3 {
        let first = &nodes[self.nodes[0]];
        if !self.has_sides() {
            return first.R();
        }
        let from = |k: usize| nodes[self.nodes[k]].relative_position(first);
        let along = from(1);
        let across = if self.corners == 4 { from(2).cross(&(from(3) - along)) } else { along.cross(&from(2)) };
        let n = across.try_normalize(0.0).unwrap_or_else(Vec3::z);
        let e = (along - n.dot(&along) * n).try_normalize(0.0).unwrap_or_else(Vec3::x);
        Mat3::from_columns(&[e, n.cross(&e), n])
    }
}

/// A ball that is touched.
#[derive(Clone, Copy)]
pub(super) struct Ball {
    /// Its node.
    pub node: usize,
    /// Its radius.
    pub radius: f64,
}

impl Ball {
    /// The balls of the facets; `None` if one is no ball.
    pub fn all(facets: &[Facet]) -> Option<Vec<Ball>> {
        let ball = |facet: &Facet| facet.is_ball().then_some(Ball { node: facet.nodes[0], radius: facet.half });
        facets.iter().map(ball).collect()
    }
}

/// The share of the second end in the point of a line closest to the origin.
#[inline]
fn closest_on_line(a: &Vec3, b: &Vec3) -> (f64, Region) {
    let along = b - a;
    let square = along.norm_squared();
    let s = -a.dot(&along);
    match s {
        _ if s <= 0.0 || square == 0.0 => (0.0, Region::Vertex(0)),
        _ if s >= square => (1.0, Region::Vertex(1)),
        _ => (s / square, Region::Edge(0)),
    }
}

/// The shares of the corners in the point of a triangle closest to the origin (C. Ericson, Real-Time Collision Detection, 2005, 5.1.5).
#[inline]
fn closest_on_triangle([a, b, c]: &[Vec3; 3]) -> ([f64; 3], Region) {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (-ab.dot(a), -ac.dot(a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ([1.0, 0.0, 0.0], Region::Vertex(0));
    }
    let (d3, d4) = (-ab.dot(b), -ac.dot(b));
    if d3 >= 0.0 && d4 <= d3 {
        return ([0.0, 1.0, 0.0], Region::Vertex(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let s = d1 / (d1 - d3);
        return ([1.0 - s, s, 0.0], Region::Edge(0));
    }
    let (d5, d6) = (-ab.dot(c), -ac.dot(c));
    if d6 >= 0.0 && d5 <= d6 {
        return ([0.0, 0.0, 1.0], Region::Vertex(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let s = d2 / (d2 - d6);
        return ([1.0 - s, 0.0, s], Region::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let s = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return ([0.0, 1.0 - s, s], Region::Edge(1));
    }
    let sum = va + vb + vc;
    let (v, w) = (vb / sum, vc / sum);
    ([1.0 - v - w, v, w], Region::Interior)
}

/// Two sides of a facet and its normal as base vectors, kept apart in an almost collapsed facet: a stored vector must be recovered after
/// small motions.
fn spread_apart(u: &Vec3, v: &Vec3, frame: &Mat3) -> Mat3 {
    /// Least sine of the angle between the sides.
    const LEAST_SINE: f64 = 0.2;
    /// Least length of one, as a part of the other.
    const LEAST_RATIO: f64 = 0.05;
    let n = frame.column(2).into_owned();
    let (long, across) = (u.norm(), v.norm());
    let e = u.try_normalize(0.0).unwrap_or_else(|| frame.column(0).into_owned());
    let beside = n.cross(&e);
    let is_sound = |sine: f64| sine >= LEAST_SINE && long >= LEAST_RATIO * across && across >= LEAST_RATIO * long;
    if across > 0.0 && is_sound(v.dot(&beside) / across) {
        return Mat3::from_columns(&[*u, *v, n]);
    }
    if long == 0.0 && across == 0.0 {
        return *frame;
    }
    let along = e * long.max(LEAST_RATIO * across);
    let width = v.dot(&beside).max(LEAST_SINE * across).max(LEAST_SINE * LEAST_RATIO * long);
    Mat3::from_columns(&[along, v.dot(&e) * e + width * beside, n])
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    /// A vector stored in the base of a collapsing facet, with a corner crossing a side, does not jump; friction would otherwise pull
    /// toward a distant anchor.
    #[test]
    fn what_a_collapsed_facet_keeps_does_not_jump() {
        let mut rng = StdRng::seed_from_u64(5);
        let facet = Facet::new(&[0, 1, 2, 3], 0.0);
        for _ in 0..2000 {
            let squeeze = 10f64.powf(rng.random_range(-9.0..0.0));
            let mut corner = |x: f64, y: f64| {
                let mut noise = || squeeze * rng.random_range(-1.0..1.0);
                Node::at_rest(Vec3::new(x + noise(), squeeze * y + noise(), noise()))
            };
            let before = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
            let mut moved = before;
            moved.iter_mut().for_each(|node| node.x += 1e-12 * Vec3::from_fn(|_, _| rng.random_range(-1.0..1.0)));
            let v = Vec3::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let kept = facet.components(&v, &before);
            let back = facet.base(&before) * kept;
            // Sides at an angle of 0.2 and of lengths as 1 to 20 lose three digits.
            assert!((back - v).norm() < 1e-12, "{back} {v}");
            // Its plane may turn over, and the vector with it; its length changes only by the stretch of the base.
            let after = facet.base(&moved) * kept;
            assert!(after.norm() < 200.0 * v.norm(), "{} for {}", after.norm(), v.norm());
        }
    }

    #[test]
    fn the_closest_point_is_the_closest_of_all() {
        let mut rng = StdRng::seed_from_u64(1);
        let mut vector = || Vec3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        for corners in [3, 4] {
            for _ in 0..200 {
                let facet = Facet::new(&[0, 1, 2, 3][..corners], 0.0);
                let p = std::array::from_fn(|_| vector());
                let at = facet.closest(&p);
                let W = facet.weights(&at);
                let y: Vec3 = (0..corners).map(|k| W[k] * p[k]).sum();
                assert!((y + at.g).norm() < 1e-14, "shares and distance tell of two points");
                let mut least = f64::INFINITY;
                for triangle in 0..facet.triangles() {
                    let [a, b, c] = facet.triangle(triangle, &p);
                    for i in 0..=60 {
                        for j in 0..=60 - i {
                            let (s, t) = (f64::from(i) / 60.0, f64::from(j) / 60.0);
                            least = least.min((a + s * (b - a) + t * (c - a)).norm());
                        }
                    }
                }
                // Samples stand up to 3/60 apart.
                assert!(at.g.norm() <= least + 1e-14 && least < at.g.norm() + 0.05);
            }
        }
    }
}
