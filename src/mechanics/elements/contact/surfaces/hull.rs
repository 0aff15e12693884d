//! The convex hull of points.

use super::kind::{ClosestPoint, Placed, SurfaceKind, Touched};
use crate::solids::hull_points::{POINTS, hull_of};
use base::math::polyhedron::{Freedom, Polyhedron};
use base::math::{Mat3, Vec3};
use std::sync::Arc;

/// The shape's word, keys and maker.
pub const KIND: SurfaceKind<Hull> = SurfaceKind {
    word: "hull",
    aliases: &[],
    guesses: &["polyhedron", "convex", "wedge", "prism", "pyramid"],
    about: "The convex hull of points.",
    keys: &[POINTS],
    make: |given, _| {
        let (polyhedron, center) = hull_of(given)?;
        let shape = Hull { polyhedron: Arc::new(polyhedron), rounding: 0.0 };
        Some(Placed { center, axes: Mat3::identity(), shape })
    },
};

/// A convex polyhedron, and all that is no farther from it than a distance.
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    /// The polyhedron.
    pub polyhedron: Arc<Polyhedron>,
    /// The distance, 0 or more.
    pub rounding: f64,
}

impl Touched for Hull {
    fn closest_point(&self, y: &Vec3) -> ClosestPoint {
        let nearest = self.polyhedron.nearest(y);
        let d = nearest.g.norm();
        let (distance, along) = match nearest.free {
            Freedom::Face => (nearest.face_distance, nearest.face_distance),
            _ => (d, d),
        };
        let n = match d > 0.0 {
            true => nearest.g / along,
            false => nearest.normal,
        };
        let free = match nearest.free {
            Freedom::Face => Mat3::zeros(),
            Freedom::Edge(t) => (Mat3::identity() - n * n.transpose() - t * t.transpose()) / d,
            Freedom::Corner => (Mat3::identity() - n * n.transpose()) / d,
        };
        ClosestPoint { distance: distance - self.rounding, n, H: free }
    }

    #[inline]
    fn distance(&self, y: &Vec3) -> f64 {
        self.polyhedron.distance(y) - self.rounding
    }

    fn reach(&self) -> f64 {
        self.polyhedron.reach() + self.rounding
    }

    fn least(&self) -> f64 {
        self.polyhedron.least() + 2.0 * self.rounding
    }

    /// Outside, the nearest part of a symmetric hull lies in the plane; inside, faces parallel to the plane may be the nearest.
    fn keeps(&self, e: &Vec3) -> bool {
        let reach = self.polyhedron.reach();
        let beside = |face: &base::math::polyhedron::PolyhedronFace| face.normal.dot(e).abs() > 1e-12;
        let least = |wanted: bool| {
            let faces = self.polyhedron.faces().iter().filter(|face| beside(face) == wanted);
            faces.map(|face| face.offset).fold(f64::INFINITY, f64::min)
        };
        self.polyhedron.is_symmetric(e) && least(true) > least(false) + 1e-12 * reach
    }
}
