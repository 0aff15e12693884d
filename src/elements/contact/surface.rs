//! Surfaces that others touch: the signed distance of a point, its normal and its curvature, all in closed form.
//!
//! Inside, the distance is that to the nearest part of the surface, negative. Its gradient n has length one and its Hessian
//! is that of the surface parallel to it through the point; both jump where two parts of the surface are equally near.

use crate::math::{Mat3, Vec3};

/// A surface in the frame of the node that carries it.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// From the node to the shape's own origin.
    pub center: Vec3,
    /// Columns: the shape's axes. A plane is normal to the third, a cylinder and a capsule lie along it.
    pub axes: Mat3,
    pub shape: Shape,
}

/// Around its origin, in its own axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// All that lies below.
    Plane,
    /// Half the edges.
    Box {
        half: [f64; 3],
    },
    Sphere {
        radius: f64,
    },
    /// With flat ends; half its length.
    Cylinder {
        radius: f64,
        half: f64,
    },
    /// All that is nearer than the radius to a line; half of that.
    Capsule {
        radius: f64,
        half: f64,
    },
}

/// The point of a surface closest to a given one, as far as forces need it; in the frame of that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestPoint {
    pub distance: f64,
    /// Outward, away from the surface.
    pub n: Vec3,
    /// ∂n/∂p.
    pub H: Mat3,
}

impl Surface {
    /// The closest point to p, given in the frame of the node.
    #[inline]
    pub fn closest_point(&self, p: &Vec3) -> ClosestPoint {
        let y = self.axes.tr_mul(&(p - self.center));
        let local = self.shape.closest_point(&y);
        ClosestPoint {
            distance: local.distance,
            n: self.axes * local.n,
            H: self.axes * local.H * self.axes.transpose(),
        }
    }

    /// The distance alone.
    #[inline]
    pub fn distance(&self, p: &Vec3) -> f64 {
        self.shape.distance(&self.axes.tr_mul(&(p - self.center)))
    }

    /// Radius of a ball about the shape's origin that holds it; infinite for a plane.
    pub fn reach(&self) -> f64 {
        match self.shape {
            Shape::Plane => f64::INFINITY,
            Shape::Box { half } => Vec3::from(half).norm(),
            Shape::Sphere { radius } => radius,
            Shape::Cylinder { radius, half } => radius.hypot(half),
            Shape::Capsule { radius, half } => radius + half,
        }
    }

    /// True when a point in the plane through the shape's origin normal to a global axis feels no force out of that plane.
    pub fn keeps(&self, axis: usize) -> bool {
        let e = self.axes.transpose() * Vec3::ith(axis, 1.0);
        let along = |i: usize| e[i].abs() > 1.0 - 1e-12;
        let across = |i: usize| e[i].abs() < 1e-12;
        match self.shape {
            Shape::Sphere { .. } => true,
            Shape::Plane => across(2),
            Shape::Capsule { .. } => across(2) || along(2),
            Shape::Cylinder { radius, half } => across(2) || along(2) && half > radius,
            // Inside, the nearest face must not be one of the two that lie along the plane.
            Shape::Box { half } => (0..3).any(|i| along(i) && (0..3).any(|j| j != i && half[j] < half[i])),
        }
    }
}

impl Shape {
    #[inline]
    fn distance(&self, y: &Vec3) -> f64 {
        let corner = |a: f64, b: f64| a.max(0.0).hypot(b.max(0.0)) + a.max(b).min(0.0);
        match *self {
            Shape::Plane => y.z,
            Shape::Sphere { radius } => y.norm() - radius,
            Shape::Capsule { radius, half } => (y - Vec3::new(0.0, 0.0, y.z.clamp(-half, half))).norm() - radius,
            Shape::Cylinder { radius, half } => corner(y.x.hypot(y.y) - radius, y.z.abs() - half),
            Shape::Box { half } => {
                let q = y.abs() - Vec3::from(half);
                q.sup(&Vec3::zeros()).norm() + q.max().min(0.0)
            }
        }
    }

    fn closest_point(&self, y: &Vec3) -> ClosestPoint {
        match *self {
            Shape::Plane => ClosestPoint { distance: y.z, n: Vec3::z(), H: Mat3::zeros() },
            Shape::Sphere { radius } => round(y, radius, &Mat3::identity()),
            Shape::Capsule { radius, half } if y.z.abs() < half => {
                round(&Vec3::new(y.x, y.y, 0.0), radius, &Mat3::from_diagonal(&Vec3::new(1.0, 1.0, 0.0)))
            }
            Shape::Capsule { radius, half } => {
                round(&(y - Vec3::new(0.0, 0.0, half.copysign(y.z))), radius, &Mat3::identity())
            }
            Shape::Cylinder { radius, half } => cylinder(y, radius, half),
            Shape::Box { half } => cuboid(y, &half),
        }
    }
}

/// Around a centre (or a line, with `free` the projection across it).
fn round(y: &Vec3, radius: f64, free: &Mat3) -> ClosestPoint {
    let rho = y.norm();
    // In the middle any direction leads out.
    if rho <= f64::MIN_POSITIVE {
        return ClosestPoint { distance: -radius, n: Vec3::x(), H: Mat3::zeros() };
    }
    let n = y / rho;
    ClosestPoint { distance: rho - radius, n, H: (free - n * n.transpose()) / rho }
}

fn cylinder(y: &Vec3, radius: f64, half: f64) -> ClosestPoint {
    let rho = y.x.hypot(y.y);
    let out = if rho > f64::MIN_POSITIVE { Vec3::new(y.x / rho, y.y / rho, 0.0) } else { Vec3::x() };
    let end = Vec3::new(0.0, 0.0, 1f64.copysign(y.z));
    let (a, b) = (rho - radius, y.z.abs() - half);
    let around = Vec3::new(-out.y, out.x, 0.0);
    let bend = if rho > f64::MIN_POSITIVE { around * around.transpose() / rho } else { Mat3::zeros() };
    if a > 0.0 && b > 0.0 {
        // The rim.
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

fn cuboid(y: &Vec3, half: &[f64; 3]) -> ClosestPoint {
    let q = y.abs() - Vec3::from(*half);
    let side = |i: usize| Vec3::ith(i, 1f64.copysign(y[i]));
    let outside = (0..3).filter(|&i| q[i] > 0.0).count();
    if outside < 2 {
        // One face, from out or in.
        let i = q.imax();
        return ClosestPoint { distance: q[i], n: side(i), H: Mat3::zeros() };
    }
    let mut n = Vec3::zeros();
    let mut free = Mat3::zeros();
    for i in (0..3).filter(|&i| q[i] > 0.0) {
        n += q[i] * side(i);
        free[(i, i)] = 1.0;
    }
    let d = n.norm();
    n /= d;
    ClosestPoint { distance: d, n, H: (free - n * n.transpose()) / d }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    pub fn shapes() -> [Shape; 5] {
        [
            Shape::Plane,
            Shape::Box { half: [0.3, 0.5, 0.8] },
            Shape::Sphere { radius: 0.6 },
            Shape::Cylinder { radius: 0.5, half: 0.7 },
            Shape::Capsule { radius: 0.4, half: 0.6 },
        ]
    }

    /// Points on the surface of a shape, dense; each lies on it by its own formula, not by the distance.
    fn cover(shape: &Shape, rng: &mut StdRng) -> Vec<Vec3> {
        let mut unit = || loop {
            let v = Vec3::from_fn(|_, _| rng.random_range(-1.0..1.0));
            if v.norm() < 1.0 && v.norm() > 0.1 {
                break v;
            }
        };
        (0..200_000)
            .map(|_| {
                let v = unit();
                let n = v.normalize();
                match *shape {
                    Shape::Plane => Vec3::new(2.0 * v.x, 2.0 * v.y, 0.0),
                    Shape::Sphere { radius } => radius * n,
                    Shape::Box { half } => {
                        let c = v / v.amax();
                        Vec3::new(c.x * half[0], c.y * half[1], c.z * half[2])
                    }
                    Shape::Capsule { radius, half } => {
                        let flat = Vec3::new(n.x, n.y, 0.0).normalize();
                        let k = v.norm();
                        if k > 0.6 {
                            radius * flat + Vec3::new(0.0, 0.0, half * (k - 0.8) / 0.2)
                        } else {
                            radius * n + Vec3::new(0.0, 0.0, half.copysign(n.z))
                        }
                    }
                    Shape::Cylinder { radius, half } => {
                        let flat = Vec3::new(n.x, n.y, 0.0).normalize();
                        let k = v.norm();
                        if k > 0.6 {
                            radius * flat + Vec3::new(0.0, 0.0, half * (k - 0.8) / 0.2)
                        } else {
                            radius * (k / 0.6) * flat + Vec3::new(0.0, 0.0, half.copysign(n.z))
                        }
                    }
                }
            })
            .collect()
    }

    #[test]
    fn the_distance_is_that_to_the_nearest_point_of_the_surface() {
        let mut rng = StdRng::seed_from_u64(1);
        for shape in shapes() {
            let points = cover(&shape, &mut rng);
            for _ in 0..40 {
                let y = Vec3::from_fn(|_, _| rng.random_range(-1.0..1.0));
                let nearest = points.iter().map(|p| (p - y).norm()).fold(f64::INFINITY, f64::min);
                let near = shape.closest_point(&y);
                // 200,000 points on a surface of some square units stand about 0.005 apart, 0.03 near the ends of the samples.
                assert!((near.distance.abs() - nearest).abs() < 0.03, "{shape:?} at {y}: {} {nearest}", near.distance);
                assert!((near.distance - shape.distance(&y)).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn normal_and_curvature_are_derivatives_of_the_distance() {
        let mut rng = StdRng::seed_from_u64(2);
        let turn = crate::math::rotation::matrix(&crate::math::rotation::exp(&Vec3::new(0.4, -0.7, 1.1)));
        for shape in shapes() {
            let surface = Surface { center: Vec3::new(0.1, 0.2, -0.3), axes: turn, shape };
            for _ in 0..100 {
                let p = Vec3::from_fn(|_, _| rng.random_range(-1.5..1.5));
                let near = surface.closest_point(&p);
                let h = 1e-5;
                let at = |i: usize, s: f64| surface.closest_point(&(p + s * Vec3::ith(i, h)));
                // Not where a step crosses from one part of the surface to another.
                if (0..3).any(|i| (at(i, 1.0).n - at(i, -1.0).n).norm() > 1e-2) {
                    continue;
                }
                for i in 0..3 {
                    let slope = (at(i, 1.0).distance - at(i, -1.0).distance) / (2.0 * h);
                    let bend = (at(i, 1.0).n - at(i, -1.0).n) / (2.0 * h);
                    // Central differences leave h² = 1e-10 times third derivatives, up to 1e3 near edges, and rounding 1e-11.
                    assert!((slope - near.n[i]).abs() < 1e-6, "{shape:?} at {p}");
                    assert!((bend - near.H.column(i)).norm() < 1e-4 * (1.0 + near.H.norm()), "{shape:?} at {p}");
                }
            }
        }
    }
}
