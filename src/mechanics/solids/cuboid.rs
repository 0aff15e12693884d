//! The box.

use super::kind::{Solid, SolidKind, SolidShape, Touching};
use super::outline::{Outline, OutlineCell};
use base::math::convex::ConvexShape;
use base::math::polyhedron::Polyhedron;
use base::math::{Mat3, Vec3};
use base::words::kinds::{Form, Given, Key};
use std::sync::Arc;

/// The solid's word, keys and maker.
pub static KIND: SolidKind = SolidKind {
    word: "box",
    aliases: &[],
    guesses: &["cuboid", "cube", "block", "brick"],
    about: "A cuboid along the global axes at t = 0.",
    keys: &[Key { name: "size", form: Form::Vector, about: "Full edge lengths along the global axes at t = 0." }],
    make: read,
};

fn read(given: &mut Given) -> Option<Solid> {
    let size = given.require_vector("size")?;
    let [a, b, c] = size.into();
    if !(a > 0.0 && b > 0.0 && c > 0.0) {
        return given.error("size", "the edges of a box must be above zero");
    }
    let inertia = Vec3::new(b * b + c * c, c * c + a * a, a * a + b * b) / 12.0;
    let shape = Arc::new(SolidCuboid { size: [a, b, c], axes: Mat3::identity() });
    Some(Solid { shape, inertia: Mat3::from_diagonal(&inertia), volume: a * b * c, center: None })
}

/// A cuboid about the centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidCuboid {
    /// Full edge lengths along `axes`.
    pub size: [f64; 3],
    /// Columns: the cuboid's axes in body components.
    pub axes: Mat3,
}

impl SolidCuboid {
    /// The homogeneous cuboid of a mass and inertia: I_i = m/12 (s_j² + s_k²).
    pub fn of_inertia(mass: f64, inertia: &Mat3) -> SolidCuboid {
        let eigen = inertia.symmetric_eigen();
        let moments = eigen.eigenvalues;
        let edge = |i: usize| (6.0 * (moments.sum() - 2.0 * moments[i]).max(0.0) / mass).sqrt();
        let mut axes = eigen.eigenvectors;
        if axes.determinant() < 0.0 {
            axes.set_column(2, &-axes.column(2).into_owned());
        }
        SolidCuboid { size: [edge(0), edge(1), edge(2)], axes }
    }
}

impl SolidShape for SolidCuboid {
    fn outline(&self) -> Outline {
        const CORNERS: [[f64; 3]; 8] = [
            [-0.5, -0.5, -0.5],
            [0.5, -0.5, -0.5],
            [0.5, 0.5, -0.5],
            [-0.5, 0.5, -0.5],
            [-0.5, -0.5, 0.5],
            [0.5, -0.5, 0.5],
            [0.5, 0.5, 0.5],
            [-0.5, 0.5, 0.5],
        ];
        let size = Vec3::from(self.size);
        let points = CORNERS.map(|corner| self.axes * size.component_mul(&Vec3::from(corner))).to_vec();
        Outline { points, cells: vec![OutlineCell::Hexahedron] }
    }

    fn as_convex(&self) -> Option<ConvexShape> {
        let cuboid = || ConvexShape::Polyhedron(Arc::new(Polyhedron::cuboid(Vec3::from(self.size) * 0.5)));
        (self.axes == Mat3::identity()).then(cuboid)
    }

    /// Corners, and as many points as asked for between them, on edges and faces.
    fn touching(&self, between: usize) -> Touching {
        let n = between + 1;
        let side = |i: usize, k: usize| self.size[i] * (k as f64 / n as f64 - 0.5);
        let mut points = Vec::new();
        for k in 0..(n + 1).pow(3) {
            let at = [k % (n + 1), k / (n + 1) % (n + 1), k / (n + 1).pow(2)];
            if at.iter().any(|&k| k == 0 || k == n) {
                points.push(self.axes * Vec3::new(side(0, at[0]), side(1, at[1]), side(2, at[2])));
            }
        }
        Touching::Points { points, radius: 0.0 }
    }

    /// The diagonal of a mesh of the largest face.
    fn opening(&self, between: usize) -> Option<f64> {
        let mut size = self.size;
        size.sort_by(f64::total_cmp);
        Some(size[1].hypot(size[2]) / (between + 1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solids::outline::reach;

    #[test]
    fn the_cuboid_of_a_box_is_the_box() {
        let (m, [a, b, c]) = (12.0, [1.0, 2.0, 3.0]);
        let inertia = Mat3::from_diagonal(&Vec3::new(b * b + c * c, c * c + a * a, a * a + b * b));
        let SolidCuboid { size, axes } = SolidCuboid::of_inertia(m, &inertia);
        let mut edges = size;
        edges.sort_by(f64::total_cmp);
        // Square roots of numbers of order one.
        assert!(edges.iter().zip([a, b, c]).all(|(got, edge)| (got - edge).abs() < 1e-14), "{edges:?}");
        assert!((axes.determinant() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn its_corners_are_half_a_diagonal_away() {
        let cuboid = SolidCuboid { size: [2.0, 4.0, 4.0], axes: Mat3::identity() };
        assert!((reach(&cuboid.outline()) - 3.0).abs() < 3e-14, "round-off of a few products");
    }
}
