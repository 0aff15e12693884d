//! A beam between its nodes: its strains at the Gauss points, and displacements from given strains.

use crate::strategy::beam_trees::MOST_NODES;
use base::math::{Vec3, quadrature};
use base::snapshot::keep;
use mechanics::state::Node;
use nalgebra::Quaternion;

/// The most Gauss points: one less than nodes.
pub const MOST_POINTS: usize = MOST_NODES - 1;

/// The Lagrange polynomials of n Lobatto nodes at n − 1 Gauss points, and integrals of the polynomials of the points.
pub struct LineShape {
    /// Number of points.
    pub points: usize,
    value: [[f64; MOST_NODES]; MOST_POINTS],
    /// dN_a/dξ at point g.
    pub slope: [[f64; MOST_NODES]; MOST_POINTS],
    /// ∫ from −1 to node a of the polynomial that is 1 at point g and 0 at the others.
    pub integral: [[f64; MOST_POINTS]; MOST_NODES],
}

impl LineShape {
    /// The shape of a beam of `n` nodes, 2 to 5.
    pub fn new(n: usize) -> LineShape {
        let (nodes, _) = quadrature::lobatto(n);
        let (points, _) = quadrature::gauss(n - 1);
        let zero = [[0.0; MOST_NODES]; MOST_POINTS];
        let mut shape =
            LineShape { points: n - 1, value: zero, slope: zero, integral: [[0.0; MOST_POINTS]; MOST_NODES] };
        let (xi, weights) = quadrature::gauss(n);
        for (g, &at) in points.iter().enumerate() {
            for a in 0..n {
                (shape.value[g][a], shape.slope[g][a]) = lagrange(nodes, a, at);
                let half = 0.5 * (nodes[a] + 1.0);
                let terms = xi.iter().zip(weights).map(|(x, w)| w * lagrange(points, g, half * (x + 1.0) - 1.0).0);
                shape.integral[a][g] = half * terms.sum::<f64>();
            }
        }
        shape
    }
}

/// The Lagrange polynomial of node `a`, and its slope, at `x`.
fn lagrange(nodes: &[f64], a: usize, x: f64) -> (f64, f64) {
    let others = || (0..nodes.len()).filter(move |&b| b != a);
    let factor = |b: usize| (x - nodes[b]) / (nodes[a] - nodes[b]);
    let slope = others().map(|c| others().filter(|&b| b != c).map(factor).product::<f64>() / (nodes[a] - nodes[c]));
    (others().map(factor).product(), slope.sum())
}

/// A Gauss point in a configuration.
#[derive(Debug, Clone, Copy)]
pub struct LinePoint {
    /// Rotation.
    pub rotation: Quaternion<f64>,
    /// dr/dξ.
    pub tangent: Vec3,
    /// Spin of the point: Σ (w θ + θ×v) over the spins θ of the nodes.
    spins: [(f64, Vec3); MOST_NODES],
}

keep!(LinePoint { rotation, tangent, spins });

impl LinePoint {
    /// At rest.
    pub const ZERO: LinePoint = LinePoint {
        rotation: Quaternion::from_vector(nalgebra::Vector4::new(0.0, 0.0, 0.0, 1.0)),
        tangent: Vec3::new(0.0, 0.0, 0.0),
        spins: [(0.0, Vec3::new(0.0, 0.0, 0.0)); MOST_NODES],
    };

    /// Point `g` of a beam between `of`.
    pub fn new(shape: &LineShape, g: usize, of: &[usize], nodes: &[Node]) -> LinePoint {
        let mut point = LinePoint::ZERO;
        let first = nodes[of[0]].rotation;
        let mut p = Quaternion::from_parts(0.0, Vec3::zeros());
        let signed = |node: usize| {
            let q = nodes[node].rotation;
            if q.dot(&first) < 0.0 { -q } else { q }
        };
        for (a, &node) in of.iter().enumerate() {
            p += signed(node) * shape.value[g][a];
            point.tangent += shape.slope[g][a] * nodes[node].x;
        }
        let back = p.conjugate() / p.norm_squared();
        for (a, &node) in of.iter().enumerate() {
            let near = signed(node) * back * shape.value[g][a];
            point.spins[a] = (near.w, Vec3::new(near.i, near.j, near.k));
        }
        point.rotation = p / p.norm();
        point
    }

    /// The spin of the point for spins of the nodes.
    #[inline]
    pub fn spin(&self, thetas: impl Iterator<Item = Vec3>) -> Vec3 {
        thetas.zip(&self.spins).fold(Vec3::zeros(), |sum, (theta, (w, v))| sum + *w * theta + theta.cross(v))
    }

    /// The moment on the a-th node that does the work of a moment at the point.
    #[inline]
    pub fn moment_on(&self, a: usize, moment: &Vec3) -> Vec3 {
        let (w, v) = &self.spins[a];
        *w * moment + v.cross(moment)
    }
}
