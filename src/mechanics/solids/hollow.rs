//! Common part of cylinders and tubes: a cylinder with a hole along its axis, of radius zero if solid.

use super::kind::{Solid, SolidShape, Touching};
use super::outline::Outline;
use base::math::convex::ConvexShape;
use base::math::cylinder::RoundCylinder;
use base::math::{Mat3, Vec3, frame_along};
use base::words::kinds::{Form, Given, Key};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Number of points around the rim that may touch.
const RIM: usize = 16;

/// The key of the outer radius.
pub const RADIUS: Key = Key { name: "radius", form: Form::Number, about: "Outer radius, above 0." };
/// The key of the length.
pub const LENGTH: Key = Key { name: "length", form: Form::Number, about: "Length along the axis, above 0." };
/// The key of the axis.
pub const AXIS: Key =
    Key { name: "axis", form: Form::Vector, about: "Direction of the length, global at t = 0. Any length." };

/// Reads the common keys; `hole` answers with the inner radius and the key that gives it.
pub fn read(given: &mut Given, hole: fn(&mut Given, f64) -> Option<(f64, &'static str)>) -> Option<Solid> {
    let (radius, length) = (given.require_positive("radius"), given.require_positive("length"));
    let axis = given.require_unit("axis");
    let (radius, length, axis) = (radius?, length?, axis?);
    let (inner_radius, key) = hole(given, radius)?;
    if inner_radius >= radius || inner_radius < 0.0 {
        return given.error(key, format!("the wall must be thinner than the radius, {radius}"));
    }
    let squares = radius * radius + inner_radius * inner_radius;
    let (along, across) = (squares / 2.0, squares / 4.0 + length * length / 12.0);
    let inertia = Mat3::identity() * across + axis * axis.transpose() * (along - across);
    let volume = PI * (radius - inner_radius) * (radius + inner_radius) * length;
    Some(Solid {
        shape: Arc::new(HollowCylinder { radius, inner_radius, length, axis }),
        inertia,
        volume,
        center: None,
    })
}

/// A cylinder about the centre of mass, with a hole along its axis or without.
#[derive(Debug, Clone, PartialEq)]
pub struct HollowCylinder {
    /// Outer radius.
    pub radius: f64,
    /// Inner radius, 0 where it is solid.
    pub inner_radius: f64,
    /// Length along the axis.
    pub length: f64,
    /// Unit vector along the axis, in the axes of the body.
    pub axis: Vec3,
}

impl SolidShape for HollowCylinder {
    fn outline(&self) -> Outline {
        let axis = self.axis.try_normalize(0.0).unwrap_or_else(Vec3::x);
        let axes = frame_along(&axis);
        let mut outline = Outline::default();
        let ends = [-0.5 * self.length * axis, 0.5 * self.length * axis];
        let [a, b] = ends.map(|end| outline.circle(end, self.radius, &axes));
        outline.band(a, b);
        if self.inner_radius > 0.0 {
            let [c, d] = ends.map(|end| outline.circle(end, self.inner_radius, &axes));
            outline.band(c, d);
            outline.band(a, c);
            outline.band(b, d);
        } else {
            outline.disc(a);
            outline.disc(b);
        }
        outline
    }

    fn has_hole(&self) -> bool {
        self.inner_radius > 0.0
    }

    /// All within the outer radius: nothing enters the hole.
    fn as_convex(&self) -> Option<ConvexShape> {
        let cylinder = RoundCylinder::new(self.radius, 0.5 * self.length, frame_along(&self.axis));
        Some(ConvexShape::Cylinder(Arc::new(cylinder)))
    }

    /// Rims, and as many circles between them as asked for.
    fn touching(&self, between: usize) -> Touching {
        let axes = frame_along(&self.axis);
        let mut points = Vec::new();
        for end in (0..=between + 1).map(|k| self.length * (k as f64 / (between + 1) as f64 - 0.5)) {
            let rim = RIM * (between + 1);
            for k in 0..rim {
                let (sin, cos) = (TAU * k as f64 / rim as f64).sin_cos();
                points.push(axes * Vec3::new(self.radius * cos, self.radius * sin, end));
            }
        }
        Touching::Points { points, radius: 0.0 }
    }

    /// The diagonal of a mesh of its side. Its ends stay open, whatever is asked for.
    fn opening(&self, between: usize) -> Option<f64> {
        let along_rim = TAU * self.radius / RIM as f64;
        Some(self.length.hypot(along_rim) / (between + 1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solids::outline::{is_closed, reach};

    #[test]
    fn it_is_drawn_closed_and_of_its_size() {
        let axis = Vec3::new(1.0, 2.0, -0.5);
        for inner_radius in [0.0, 1.0] {
            let outline = HollowCylinder { radius: 3.0, inner_radius, length: 8.0, axis }.outline();
            assert!(is_closed(&outline));
            assert!((reach(&outline) - 5.0).abs() < 5e-14, "round-off of a few products");
            let along = |p: &Vec3| p.dot(&axis.normalize()).abs();
            assert!(outline.points.iter().all(|p| (along(p) - 4.0).abs() < 1e-14 * 8.0));
        }
    }
}
