//! The circular cylinder with flat ends.

use super::polyhedron::Polyhedron;
use super::{Mat3, Vec3};

/// Sides of the prism that replaces a cylinder in contacts of edges.
const SIDES: usize = 16;

/// A circular cylinder with flat ends about the origin.
#[derive(Debug, Clone, PartialEq)]
pub struct RoundCylinder {
    radius: f64,
    half: f64,
    axes: Mat3,
}

impl RoundCylinder {
    /// Of a radius and half a length, along the third of `axes`, which are its columns.
    pub fn new(radius: f64, half: f64, axes: Mat3) -> Self {
        RoundCylinder { radius, half, axes }
    }

    /// The radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Half its length.
    pub fn half(&self) -> f64 {
        self.half
    }

    /// Columns: its axes. It lies along the third.
    pub fn axes(&self) -> &Mat3 {
        &self.axes
    }

    /// A regular prism within it, in its own axes; the middle of a side lies on the first.
    pub fn prism_within(&self) -> Polyhedron {
        Polyhedron::prism(SIDES, self.radius, self.half)
    }

    /// Radius of the ball about the origin that holds it.
    pub fn reach(&self) -> f64 {
        self.radius.hypot(self.half)
    }

    /// The extent along a direction in axes of the cylinder, times the length of the direction vector.
    pub fn reach_along(&self, along: &Vec3) -> f64 {
        self.radius * along.x.hypot(along.y) + self.half * along.z.abs()
    }

    /// Its least width.
    pub fn least(&self) -> f64 {
        2.0 * self.radius.min(self.half)
    }

    /// The farthest point along a direction, in the cylinder's axes; the centre of all farthest points if there are several.
    pub fn farthest_in_axes(&self, along: &Vec3) -> Vec3 {
        /// Sines below this are rounding.
        const LEVEL: f64 = 1e-12;
        let (across, size) = (along.x.hypot(along.y), along.norm());
        let round = if across > LEVEL * size { self.radius / across } else { 0.0 };
        let end = if along.z.abs() > LEVEL * size { self.half.copysign(along.z) } else { 0.0 };
        Vec3::new(round * along.x, round * along.y, end)
    }

    /// The point that lies farthest along a direction.
    pub fn farthest(&self, along: &Vec3) -> Vec3 {
        self.axes * self.farthest_in_axes(&self.axes.tr_mul(along))
    }

    /// The distance of a point, negative inside, and its gradient.
    pub fn distance_and_gradient(&self, y: &Vec3) -> (f64, Vec3) {
        let (d, n) = self.distance_in_axes(&self.axes.tr_mul(y));
        (d, self.axes * n)
    }

    /// Like the distance above, in the cylinder's axes.
    pub fn distance_in_axes(&self, y: &Vec3) -> (f64, Vec3) {
        let rho = y.x.hypot(y.y);
        // On the axis itself any direction across it leads out.
        let out = if rho > f64::MIN_POSITIVE { Vec3::new(y.x / rho, y.y / rho, 0.0) } else { Vec3::x() };
        let end = Vec3::new(0.0, 0.0, 1f64.copysign(y.z));
        match (rho - self.radius, y.z.abs() - self.half) {
            (a, b) if a > 0.0 && b > 0.0 => {
                let d = a.hypot(b);
                (d, (a * out + b * end) / d)
            }
            (a, b) if a > b => (a, out),
            (_, b) => (b, end),
        }
    }
}
