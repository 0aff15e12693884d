//! Outlines of solids: corners and faces about the centre of mass.

use base::math::{Mat3, Vec3};
use std::f64::consts::TAU;

/// Facets around a circle.
pub const AROUND: usize = 24;

/// Points, with edges or faces between them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outline {
    /// Corners, in body axes.
    pub points: Vec<Vec3>,
    /// Faces and solids between them.
    pub cells: Vec<OutlineCell>,
}

/// A cell of an outline by the numbers of its corners.
#[derive(Debug, Clone, PartialEq)]
pub enum OutlineCell {
    /// A line of two corners, or a face of more.
    Face(Vec<usize>),
    /// The eight points of the outline, in VTK's order.
    Hexahedron,
}

impl Outline {
    /// A circle of points about `center` in the plane of the first two axes; the index of its first point.
    pub fn circle(&mut self, center: Vec3, radius: f64, axes: &Mat3) -> usize {
        let first = self.points.len();
        self.points.extend((0..AROUND).map(|i| {
            let (sine, cosine) = (TAU * i as f64 / AROUND as f64).sin_cos();
            center + axes * Vec3::new(radius * cosine, radius * sine, 0.0)
        }));
        first
    }

    /// Quadrilaterals between two circles.
    pub fn band(&mut self, a: usize, b: usize) {
        self.cells.extend((0..AROUND).map(|i| {
            let next = (i + 1) % AROUND;
            OutlineCell::Face(vec![a + i, a + next, b + next, b + i])
        }));
    }

    /// A polygon within a circle.
    pub fn disc(&mut self, circle: usize) {
        self.cells.push(OutlineCell::Face((circle..circle + AROUND).collect()));
    }

    /// Triangles from a circle to a point.
    pub fn cone(&mut self, circle: usize, tip: usize) {
        let triangle = |i| OutlineCell::Face(vec![circle + i, circle + (i + 1) % AROUND, tip]);
        self.cells.extend((0..AROUND).map(triangle));
    }
}

/// True if every edge belongs to two faces; a hexahedron is always closed.
#[cfg(test)]
pub fn is_closed(outline: &Outline) -> bool {
    let mut edges = std::collections::HashMap::new();
    for cell in &outline.cells {
        let OutlineCell::Face(cell) = cell else { continue };
        for i in 0..cell.len() {
            let (a, b) = (cell[i], cell[(i + 1) % cell.len()]);
            *edges.entry((a.min(b), a.max(b))).or_insert(0) += 1;
        }
    }
    edges.values().all(|count| *count == 2)
}

/// The greatest distance of a point from the centre.
#[cfg(test)]
pub fn reach(outline: &Outline) -> f64 {
    outline.points.iter().map(|p| p.norm()).fold(0.0, f64::max)
}
