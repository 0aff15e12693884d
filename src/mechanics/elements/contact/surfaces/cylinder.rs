//! The cylinder with flat ends.

use super::kind::{CENTER, ClosestPoint, Placed, SurfaceKind, Touched, center, is_across, is_along};
use base::math::{Mat3, Vec3, frame_along};
use base::words::kinds::{Form, Given, Key};

/// The shape's word, keys and maker.
pub const KIND: SurfaceKind<Cylinder> = SurfaceKind {
    word: "cylinder",
    aliases: &[],
    guesses: &[],
    about: "A cylinder with flat ends.",
    keys: &[
        CENTER,
        Key { name: "radius", form: Form::Number, about: "Its radius, above 0." },
        Key { name: "axis", form: Form::Vector, about: "Direction of its length. Any length." },
        Key { name: "length", form: Form::Number, about: "Between its flat ends, above 0." },
    ],
    make: read,
};

fn read(given: &mut Given, body: Option<Vec3>) -> Option<Placed<Cylinder>> {
    let center = center(given, body);
    let (radius, length) = (given.require_positive("radius"), given.require_positive("length"));
    let axes = frame_along(&given.require_unit("axis")?);
    Some(Placed { center: center?, axes, shape: Cylinder { radius: radius?, half: 0.5 * length? } })
}

/// Along the third axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    /// Radius.
    pub radius: f64,
    /// Half its length.
    pub half: f64,
}

impl Touched for Cylinder {
    fn closest_point(&self, y: &Vec3) -> ClosestPoint {
        let rho = y.x.hypot(y.y);
        let out = if rho > f64::MIN_POSITIVE { Vec3::new(y.x / rho, y.y / rho, 0.0) } else { Vec3::x() };
        let end = Vec3::new(0.0, 0.0, 1f64.copysign(y.z));
        let (a, b) = (rho - self.radius, y.z.abs() - self.half);
        let around = Vec3::new(-out.y, out.x, 0.0);
        let bend = if rho > f64::MIN_POSITIVE { around * around.transpose() / rho } else { Mat3::zeros() };
        if a > 0.0 && b > 0.0 {
            // The rim is the nearest.
            let d = a.hypot(b);
            let n = (a * out + b * end) / d;
            let across = (b * out - a * end) / d;
            ClosestPoint { distance: d, n, H: across * across.transpose() / d + a / d * bend }
        } else if a > b {
            ClosestPoint { distance: a, n: out, H: bend }
        } else {
            ClosestPoint { distance: b, n: end, H: Mat3::zeros() }
        }
    }

    #[inline]
    fn distance(&self, y: &Vec3) -> f64 {
        let (a, b) = (y.x.hypot(y.y) - self.radius, y.z.abs() - self.half);
        a.max(0.0).hypot(b.max(0.0)) + a.max(b).min(0.0)
    }

    fn reach(&self) -> f64 {
        self.radius.hypot(self.half)
    }

    fn least(&self) -> f64 {
        2.0 * self.radius.min(self.half)
    }

    fn keeps(&self, e: &Vec3) -> bool {
        is_across(e, 2) || is_along(e, 2) && self.half > self.radius
    }
}
