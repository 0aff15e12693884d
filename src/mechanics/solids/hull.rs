//! The convex hull of points.

use super::hull_points::{POINTS, hull_of};
use super::kind::{Solid, SolidKind, SolidShape, Touching};
use super::outline::{Outline, OutlineCell};
use base::math::Mat3;
use base::math::convex::ConvexShape;
use base::math::polyhedron::Polyhedron;
use base::words::kinds::Given;
use std::sync::Arc;

/// The solid's word, keys and maker.
pub static KIND: SolidKind = SolidKind {
    word: "hull",
    aliases: &[],
    guesses: &["polyhedron", "convex", "wedge", "prism", "pyramid", "stone", "rock"],
    about: "The convex hull of points, of even density. `center` places its centre of mass; otherwise its points define it.",
    keys: &[POINTS],
    make: read,
};

fn read(given: &mut Given) -> Option<Solid> {
    let (polyhedron, center) = hull_of(given)?;
    let moments = polyhedron.moments()?;
    let inertia = Mat3::identity() * moments.variance.trace() - moments.variance;
    let shape = Arc::new(SolidHull { polyhedron: Arc::new(polyhedron) });
    Some(Solid { shape, inertia, volume: moments.volume, center: Some(center) })
}

/// A convex polyhedron about its centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidHull {
    /// The polyhedron.
    pub polyhedron: Arc<Polyhedron>,
}

impl SolidShape for SolidHull {
    fn outline(&self) -> Outline {
        let cells = self.polyhedron.faces().iter().map(|face| OutlineCell::Face(face.corners.clone())).collect();
        Outline { points: self.polyhedron.corners().to_vec(), cells }
    }

    fn as_convex(&self) -> Option<ConvexShape> {
        Some(ConvexShape::Polyhedron(self.polyhedron.clone()))
    }

    /// Corners, and as many points as asked for on edges between them.
    fn touching(&self, between: usize) -> Touching {
        let mut points = self.polyhedron.corners().to_vec();
        for edge in self.polyhedron.edges() {
            let [a, b] = edge.ends.map(|k| self.polyhedron.corners()[k]);
            points.extend((1..=between).map(|k| a + k as f64 / (between + 1) as f64 * (b - a)));
        }
        Touching::Points { points, radius: 0.0 }
    }

    /// The longest edge; faces stay open, whatever is asked for.
    fn opening(&self, between: usize) -> Option<f64> {
        let corners = self.polyhedron.corners();
        let length = |edge: &base::math::polyhedron::PolyhedronEdge| {
            let [a, b] = edge.ends.map(|k| corners[k]);
            (b - a).norm()
        };
        Some(self.polyhedron.edges().iter().map(length).fold(0.0, f64::max) / (between + 1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solids::outline::{is_closed, reach};
    use base::math::Vec3;
    use base::math::polyhedron::Polyhedron;

    /// A regular tetrahedron of edge √8: volume 8/3, and the same moments about all axes.
    #[test]
    fn a_tetrahedron_has_its_volume_and_inertia() {
        let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]].map(Vec3::from);
        let away = Vec3::new(3.0, -5.0, 7.0);
        let (polyhedron, center) = Polyhedron::hull(&corners.map(|x| x + away)).expect("a solid");
        let moments = polyhedron.moments().expect("a volume");
        // Edge √8: V = edge³/(6√2) = 8/3; ∫x²/V = 1/20 of the sum of squares of corners = 1/5. Rounding of some sums of numbers near 10.
        assert!((center - away).norm() < 1e-14 * 20.0);
        assert!((moments.volume - 8.0 / 3.0).abs() < 1e-13);
        assert!((moments.variance - Mat3::identity() / 5.0).norm() < 1e-13);
        let outline = SolidHull { polyhedron: Arc::new(polyhedron) }.outline();
        assert!(is_closed(&outline));
        assert!((reach(&outline) - 3f64.sqrt()).abs() < 1e-13);
    }
}
