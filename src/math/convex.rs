//! Convex shapes about an origin inside: polyhedra, and what is round about a segment.

use super::Vec3;
use super::polyhedron::Polyhedron;
use std::sync::Arc;

/// A convex shape.
#[derive(Debug, Clone, PartialEq)]
pub enum ConvexShape {
    /// A box, or the hull of points.
    Polyhedron(Arc<Polyhedron>),
    /// A capsule, or a sphere.
    Spherocylinder(Spherocylinder),
}

/// All that is no farther than a radius from a segment through the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spherocylinder {
    /// Vector from the origin to one end of the segment, the other lying opposite; zero of a sphere.
    pub half: Vec3,
    /// The radius.
    pub radius: f64,
}

impl ConvexShape {
    /// True for a sphere.
    pub fn is_sphere(&self) -> bool {
        matches!(self, ConvexShape::Spherocylinder(shape) if shape.half == Vec3::zeros())
    }

    /// The polyhedron that it is, where it is one.
    pub fn as_polyhedron(&self) -> Option<&Arc<Polyhedron>> {
        match self {
            ConvexShape::Polyhedron(shape) => Some(shape),
            ConvexShape::Spherocylinder(_) => None,
        }
    }

    /// Half its edges, where it is a cuboid.
    pub fn half_edges(&self) -> Option<&Vec3> {
        self.as_polyhedron()?.half()
    }

    /// Radius of the ball about the origin that holds it.
    pub fn reach(&self) -> f64 {
        match self {
            ConvexShape::Polyhedron(shape) => shape.reach(),
            ConvexShape::Spherocylinder(shape) => shape.half.norm() + shape.radius,
        }
    }

    /// Its least width.
    pub fn least(&self) -> f64 {
        match self {
            ConvexShape::Polyhedron(shape) => shape.least(),
            ConvexShape::Spherocylinder(shape) => 2.0 * shape.radius,
        }
    }

    /// The point that lies farthest along a unit vector.
    pub fn farthest(&self, axis: &Vec3) -> Vec3 {
        match self {
            ConvexShape::Polyhedron(shape) => shape.farthest(axis),
            ConvexShape::Spherocylinder(shape) => {
                let end = if shape.half.dot(axis) < 0.0 { -shape.half } else { shape.half };
                end + shape.radius * axis
            }
        }
    }

    /// Distance of a point from the polyhedron, negative inside, or from the segment, and its gradient.
    pub fn distance_from_core(&self, y: &Vec3) -> (f64, Vec3) {
        match self {
            ConvexShape::Polyhedron(shape) => shape.distance_and_gradient(y),
            ConvexShape::Spherocylinder(shape) => {
                let squared = shape.half.norm_squared();
                let part = if squared > 0.0 { (y.dot(&shape.half) / squared).clamp(-1.0, 1.0) } else { 0.0 };
                let away = y - part * shape.half;
                let d = away.norm();
                // On the segment itself any direction across it leads out.
                let n = if d > 0.0 { away / d } else { super::frame_along(&direction(&shape.half)).column(0).into() };
                (d, n)
            }
        }
    }

    /// How far beyond the core of [`ConvexShape::distance_from_core`] its surface lies.
    pub fn rounding(&self) -> f64 {
        match self {
            ConvexShape::Polyhedron(_) => 0.0,
            ConvexShape::Spherocylinder(shape) => shape.radius,
        }
    }
}

/// The direction of a segment, or any where it has no length.
fn direction(half: &Vec3) -> Vec3 {
    half.try_normalize(0.0).unwrap_or_else(Vec3::x)
}
