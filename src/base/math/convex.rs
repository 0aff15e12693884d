//! Convex shapes about an inner origin: polyhedra, cylinders, bodies about a segment, and the half space below the origin.

use super::Vec3;
use super::cylinder::RoundCylinder;
use super::polyhedron::Polyhedron;
use std::sync::Arc;

/// A convex shape.
#[derive(Debug, Clone, PartialEq)]
pub enum ConvexShape {
    /// A box, or the hull of points.
    Polyhedron(Arc<Polyhedron>),
    /// A capsule, or a sphere.
    Spherocylinder(Spherocylinder),
    /// A cylinder with flat ends.
    Cylinder(Arc<RoundCylinder>),
    /// The half space below the plane through the origin normal to the third axis, with a cube that moves along under the touching body.
    /// The half edge of the cube is four times the reach of that body.
    HalfSpace(Arc<Polyhedron>),
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
    /// The half space for a body of at most this reach.
    pub fn half_space(reach: f64) -> ConvexShape {
        ConvexShape::HalfSpace(Arc::new(Polyhedron::cuboid(Vec3::repeat(4.0 * reach))))
    }

    /// True for a cylinder.
    pub fn is_cylinder(&self) -> bool {
        matches!(self, ConvexShape::Cylinder(_))
    }

    /// True for a sphere.
    pub fn is_sphere(&self) -> bool {
        matches!(self, ConvexShape::Spherocylinder(shape) if shape.half == Vec3::zeros())
    }

    /// The polyhedron of the shape, if it is one.
    pub fn as_polyhedron(&self) -> Option<&Arc<Polyhedron>> {
        match self {
            ConvexShape::Polyhedron(shape) => Some(shape),
            ConvexShape::Spherocylinder(_) | ConvexShape::Cylinder(_) | ConvexShape::HalfSpace(_) => None,
        }
    }

    /// Half its edges, where it is a cuboid.
    pub fn half_edges(&self) -> Option<&Vec3> {
        self.as_polyhedron()?.half()
    }

    /// True where it is its own image in the plane through the origin normal to an axis of this number, to rounding.
    pub fn is_symmetric(&self, axis: usize) -> bool {
        match self {
            ConvexShape::Polyhedron(shape) => shape.half().is_some(),
            ConvexShape::Spherocylinder(_) => false,
            ConvexShape::Cylinder(shape) => {
                let along = shape.axes()[(axis, 2)].abs();
                !(1e-12..=1.0 - 1e-12).contains(&along)
            }
            ConvexShape::HalfSpace(_) => axis != 2,
        }
    }

    /// Radius of the bounding ball about the origin; zero for a half space.
    pub fn reach(&self) -> f64 {
        match self {
            ConvexShape::Polyhedron(shape) => shape.reach(),
            ConvexShape::Spherocylinder(shape) => shape.half.norm() + shape.radius,
            ConvexShape::Cylinder(shape) => shape.reach(),
            ConvexShape::HalfSpace(_) => 0.0,
        }
    }

    /// Its least width.
    pub fn least(&self) -> f64 {
        match self {
            ConvexShape::Polyhedron(shape) => shape.least(),
            ConvexShape::Spherocylinder(shape) => 2.0 * shape.radius,
            ConvexShape::Cylinder(shape) => shape.least(),
            ConvexShape::HalfSpace(_) => f64::INFINITY,
        }
    }

    /// The farthest point along a unit vector; the origin for a half space.
    pub fn farthest(&self, axis: &Vec3) -> Vec3 {
        match self {
            ConvexShape::Polyhedron(shape) => shape.farthest(axis),
            ConvexShape::Spherocylinder(shape) => {
                let end = if shape.half.dot(axis) < 0.0 { -shape.half } else { shape.half };
                end + shape.radius * axis
            }
            ConvexShape::Cylinder(shape) => shape.farthest(axis),
            ConvexShape::HalfSpace(_) => Vec3::zeros(),
        }
    }

    /// Distance of a point from the polyhedron, cylinder or half space, negative inside, or from the segment, and its gradient.
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
            ConvexShape::Cylinder(shape) => shape.distance_and_gradient(y),
            ConvexShape::HalfSpace(_) => (y.z, Vec3::z()),
        }
    }

    /// How far beyond the core of [`ConvexShape::distance_from_core`] its surface lies.
    pub fn rounding(&self) -> f64 {
        match self {
            ConvexShape::Polyhedron(_) | ConvexShape::Cylinder(_) | ConvexShape::HalfSpace(_) => 0.0,
            ConvexShape::Spherocylinder(shape) => shape.radius,
        }
    }
}

/// The direction of a segment, or any where it has no length.
fn direction(half: &Vec3) -> Vec3 {
    half.try_normalize(0.0).unwrap_or_else(Vec3::x)
}
