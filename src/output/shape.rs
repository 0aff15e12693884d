//! Bodies as they are drawn: corners and faces in body axes about the centre of mass.

use super::vtu::Cell;
use crate::math::{Mat3, Vec3};
use crate::model::Shape;
use std::f64::consts::{PI, TAU};

/// Facets around a circle.
const AROUND: usize = 24;

/// Points, and cells as lists of points.
#[derive(Default)]
pub struct Surface {
    pub points: Vec<Vec3>,
    pub cells: Vec<(Cell, Vec<usize>)>,
}

impl Surface {
    pub fn of(shape: &Shape) -> Surface {
        match *shape {
            Shape::Box { size, axes } => cuboid(size, axes),
            Shape::Sphere { radius } => sphere(radius),
            Shape::Cylinder { radius, inner_radius, length, axis } => cylinder(radius, inner_radius, length, axis),
            Shape::Faces { ref points, ref faces } => {
                let kind = |face: &[usize]| match face.len() {
                    2 => Cell::Line,
                    3 => Cell::Triangle,
                    _ => Cell::Quad,
                };
                let cells = faces.iter().map(|face| (kind(face), face.clone())).collect();
                Surface { points: points.clone(), cells }
            }
        }
    }

    /// A circle of points about `center` in the plane of the first two axes; the index of its first point.
    fn circle(&mut self, center: Vec3, radius: f64, axes: &Mat3) -> usize {
        let first = self.points.len();
        self.points.extend((0..AROUND).map(|i| {
            let (sine, cosine) = (TAU * i as f64 / AROUND as f64).sin_cos();
            center + axes * Vec3::new(radius * cosine, radius * sine, 0.0)
        }));
        first
    }

    /// Quadrilaterals between two circles.
    fn band(&mut self, a: usize, b: usize) {
        self.cells.extend((0..AROUND).map(|i| {
            let next = (i + 1) % AROUND;
            (Cell::Quad, vec![a + i, a + next, b + next, b + i])
        }));
    }

    fn disc(&mut self, circle: usize) {
        self.cells.push((Cell::Polygon, (circle..circle + AROUND).collect()));
    }

    /// Triangles from a circle to a point.
    fn cone(&mut self, circle: usize, tip: usize) {
        self.cells.extend((0..AROUND).map(|i| (Cell::Triangle, vec![circle + i, circle + (i + 1) % AROUND, tip])));
    }
}

fn cuboid(size: [f64; 3], axes: Mat3) -> Surface {
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
    let points = CORNERS.map(|corner| axes * Vec3::from(size).component_mul(&Vec3::from(corner))).to_vec();
    Surface { points, cells: vec![(Cell::Hexahedron, (0..8).collect())] }
}

fn sphere(radius: f64) -> Surface {
    let mut surface = Surface::default();
    let circles: Vec<usize> = (1..AROUND / 2)
        .map(|i| (PI * i as f64 / (AROUND / 2) as f64).sin_cos())
        .map(|(sine, cosine)| surface.circle(Vec3::z() * radius * cosine, radius * sine, &Mat3::identity()))
        .collect();
    for pair in circles.windows(2) {
        surface.band(pair[0], pair[1]);
    }
    for (circle, z) in [(circles[0], radius), (circles[circles.len() - 1], -radius)] {
        surface.points.push(Vec3::z() * z);
        surface.cone(circle, surface.points.len() - 1);
    }
    surface
}

fn cylinder(radius: f64, inner_radius: f64, length: f64, axis: Vec3) -> Surface {
    let axis = axis.try_normalize(0.0).unwrap_or_else(Vec3::x);
    // Any frame with its third axis along the cylinder; the start is the global axis farthest from it.
    let aside = axis.cross(&Vec3::ith(axis.iamin(), 1.0)).normalize();
    let axes = Mat3::from_columns(&[aside, axis.cross(&aside), axis]);
    let mut surface = Surface::default();
    let ends = [-0.5 * length * axis, 0.5 * length * axis];
    let [a, b] = ends.map(|end| surface.circle(end, radius, &axes));
    surface.band(a, b);
    if inner_radius > 0.0 {
        let [c, d] = ends.map(|end| surface.circle(end, inner_radius, &axes));
        surface.band(c, d);
        surface.band(a, c);
        surface.band(b, d);
    } else {
        surface.disc(a);
        surface.disc(b);
    }
    surface
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    /// A closed surface has every edge twice; a hexahedron is closed by itself.
    fn closed(surface: &Surface) -> bool {
        let mut edges = HashMap::new();
        for (_, cell) in surface.cells.iter().filter(|(kind, _)| *kind != Cell::Hexahedron) {
            for i in 0..cell.len() {
                let (a, b) = (cell[i], cell[(i + 1) % cell.len()]);
                *edges.entry((a.min(b), a.max(b))).or_insert(0) += 1;
            }
        }
        edges.values().all(|count| *count == 2)
    }

    #[test]
    fn bodies_are_closed_and_of_their_size() {
        let axis = Vec3::new(1.0, 2.0, -0.5);
        let size = |surface: &Surface| surface.points.iter().map(|p| p.norm()).fold(0.0, f64::max);
        let cylinder = |inner_radius| Surface::of(&Shape::Cylinder { radius: 3.0, inner_radius, length: 8.0, axis });
        for (surface, reach) in [
            (Surface::of(&Shape::Box { size: [2.0, 4.0, 4.0], axes: Mat3::identity() }), 3.0),
            (Surface::of(&Shape::Sphere { radius: 2.0 }), 2.0),
            (cylinder(0.0), 5.0),
            (cylinder(1.0), 5.0),
        ] {
            assert!(closed(&surface));
            assert!((size(&surface) - reach).abs() < 1e-14 * reach, "round-off of a few products");
        }
        let along = |p: &Vec3| p.dot(&axis.normalize()).abs();
        assert!(cylinder(1.0).points.iter().all(|p| (along(p) - 4.0).abs() < 1e-14 * 8.0));
    }
}
