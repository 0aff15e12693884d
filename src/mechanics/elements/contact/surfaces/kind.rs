//! The registry entry of a surface, and the helpers shared by several surfaces.

use base::math::{Mat3, Vec3};
use base::words::kinds::{Form, Given, Key, Kind};

/// The shape of a surface that others touch, around its origin and in its own axes.
///
/// Inside, the distance is that to the nearest part of the surface, negative. Its gradient n has length one, and its Hessian is the
/// curvature of the parallel surface through the point. Both jump where two parts of the surface are equally near.
pub trait Touched {
    /// The signed distance of a point, its gradient and its Hessian.
    fn closest_point(&self, y: &Vec3) -> ClosestPoint;

    /// The distance alone.
    fn distance(&self, y: &Vec3) -> f64;

    /// Radius of a ball about the origin that contains it; infinite for a plane.
    fn reach(&self) -> f64;

    /// The smallest dimension; infinite where there is none.
    fn least(&self) -> f64;

    /// True when a point in the plane through the origin normal to the unit vector e feels no force out of that plane.
    fn keeps(&self, e: &Vec3) -> bool;
}

/// The point of a surface closest to a given one, as far as forces need it; in the frame of that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestPoint {
    /// Distance from the surface, negative inside.
    pub distance: f64,
    /// Outward, away from the surface.
    pub n: Vec3,
    /// ∂n/∂p.
    pub H: Mat3,
}

/// A shape that the deck can name.
pub type SurfaceKind<S> = Kind<MakeSurface<S>>;

/// Makes a shape from the keys and the centre of its body (`None` on the ground); global components at t = 0. `None` where a key is wrong.
pub type MakeSurface<S> = fn(&mut Given, Option<Vec3>) -> Option<Placed<S>>;

/// A shape with its origin and axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed<S> {
    /// Origin of the shape, global at t = 0.
    pub center: Vec3,
    /// Columns: the shape's axes.
    pub axes: Mat3,
    /// The shape.
    pub shape: S,
}

/// The key for the centre of a shape; the default is the centre of its body.
pub const CENTER: Key =
    Key { name: "center", form: Form::Vector, about: "The centre. Default: the centre of the body." };

/// The value of the key [`CENTER`].
pub fn center(given: &mut Given, body: Option<Vec3>) -> Option<Vec3> {
    match body {
        Some(body) if !given.has("center") && !given.is_unreadable("center") => Some(body),
        _ => given.require_vector("center"),
    }
}

/// True where e is the axis of this number, to rounding.
pub fn is_along(e: &Vec3, axis: usize) -> bool {
    e[axis].abs() > 1.0 - 1e-12
}

/// True where e is normal to the axis of this number, to rounding.
pub fn is_across(e: &Vec3, axis: usize) -> bool {
    e[axis].abs() < 1e-12
}

/// The closest point around a centre (or a line, with `free` the projection across it).
pub fn round(y: &Vec3, radius: f64, free: &Mat3) -> ClosestPoint {
    let rho = y.norm();
    // Any direction leads out from the middle.
    if rho <= f64::MIN_POSITIVE {
        return ClosestPoint { distance: -radius, n: Vec3::x(), H: Mat3::zeros() };
    }
    let n = y / rho;
    ClosestPoint { distance: rho - radius, n, H: (free - n * n.transpose()) / rho }
}
