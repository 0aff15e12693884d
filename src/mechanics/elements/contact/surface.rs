//! A surface on the node that carries it.

use super::surfaces::kind::{ClosestPoint, Touched};
use super::surfaces::{Capsule, Cylinder, Plane, Sphere, SurfaceShape};
use base::math::convex::{ConvexShape, Spherocylinder};
use base::math::{Mat3, Vec3, frame_along};

/// A surface in the frame of the node that carries it.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Vector from the node to the shape's origin, in the frame of the node.
    pub center: Vec3,
    /// Columns: the shape's axes. A plane is normal to the third, a cylinder and a capsule lie along it.
    pub axes: Mat3,
    /// The shape.
    pub shape: SurfaceShape,
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
        self.shape.reach()
    }

    /// The smallest dimension; infinite for a plane.
    pub fn least(&self) -> f64 {
        self.shape.least()
    }

    /// The surface at the distance `rounding` outside a solid, about its node; boxes and cylinders are enlarged instead of rounded.
    pub fn of_convex(shape: &ConvexShape, rounding: f64) -> Self {
        let (axes, shape) = match shape {
            ConvexShape::Polyhedron(shape) => (Mat3::identity(), SurfaceShape::of_polyhedron(shape.clone(), rounding)),
            ConvexShape::Spherocylinder(Spherocylinder { half, radius }) => {
                let radius = radius + rounding;
                match half.try_normalize(0.0) {
                    Some(axis) => (frame_along(&axis), SurfaceShape::Capsule(Capsule { radius, half: half.norm() })),
                    None => (Mat3::identity(), SurfaceShape::Sphere(Sphere { radius })),
                }
            }
            ConvexShape::Cylinder(shape) => {
                let (radius, half) = (shape.radius() + rounding, shape.half() + rounding);
                (*shape.axes(), SurfaceShape::Cylinder(Cylinder { radius, half }))
            }
            ConvexShape::HalfSpace(_) => (Mat3::identity(), SurfaceShape::Plane(Plane)),
        };
        Surface { center: Vec3::zeros(), axes, shape }
    }

    /// The convex shape in the axes of the surface, if convex solids touch it with their full shape.
    pub fn as_convex(&self) -> Option<ConvexShape> {
        self.shape.as_convex()
    }

    /// True when a point in the plane through the shape's origin normal to a global axis feels no force out of that plane.
    pub fn keeps(&self, axis: usize) -> bool {
        self.shape.keeps(&(self.axes.transpose() * Vec3::ith(axis, 1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::contact::surfaces::Cuboid;
    use base::math::polyhedron::Polyhedron;
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};
    use std::sync::Arc;

    fn shapes() -> [SurfaceShape; 6] {
        [
            SurfaceShape::Plane(Plane),
            SurfaceShape::Cuboid(Cuboid { half: [0.3, 0.5, 0.8] }),
            SurfaceShape::Sphere(Sphere { radius: 0.6 }),
            SurfaceShape::Cylinder(Cylinder { radius: 0.5, half: 0.7 }),
            SurfaceShape::Capsule(Capsule { radius: 0.4, half: 0.6 }),
            wedge(),
        ]
    }

    /// A wedge with a blunt edge, of faces of three, four and five corners.
    fn wedge() -> SurfaceShape {
        let corners = [
            [-0.5, -0.4, -0.3],
            [0.5, -0.4, -0.3],
            [0.5, 0.4, -0.3],
            [-0.5, 0.4, -0.3],
            [-0.2, -0.4, 0.5],
            [0.3, -0.4, 0.5],
            [0.0, 0.2, 0.6],
        ];
        let hull = Polyhedron::hull(&corners.map(Vec3::from)).expect("a solid").0;
        SurfaceShape::of_polyhedron(Arc::new(hull), 0.0)
    }

    /// Points on the surface of a shape, dense; each lies on it by its own formula, not by the distance.
    fn cover(shape: &SurfaceShape, rng: &mut StdRng) -> Vec<Vec3> {
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
                match shape.clone() {
                    SurfaceShape::Hull(hull) => {
                        let faces = hull.polyhedron.faces();
                        let face = &faces[(((v.x + 1.0) * 0.5 * faces.len() as f64) as usize).min(faces.len() - 1)];
                        let corners: Vec<Vec3> = face.corners.iter().map(|&k| hull.polyhedron.corners()[k]).collect();
                        // Any point of a convex face is a mean of its corners.
                        let weights: Vec<f64> = corners.iter().map(|_| unit().x.powi(4)).collect();
                        corners.iter().zip(&weights).map(|(x, w)| *w * x).sum::<Vec3>() / weights.iter().sum::<f64>()
                    }
                    SurfaceShape::Plane(Plane) => Vec3::new(2.0 * v.x, 2.0 * v.y, 0.0),
                    SurfaceShape::Sphere(Sphere { radius }) => radius * n,
                    SurfaceShape::Cuboid(Cuboid { half }) => {
                        let c = v / v.amax();
                        Vec3::new(c.x * half[0], c.y * half[1], c.z * half[2])
                    }
                    SurfaceShape::Capsule(Capsule { radius, half }) => {
                        let flat = Vec3::new(n.x, n.y, 0.0).normalize();
                        let k = v.norm();
                        if k > 0.6 {
                            radius * flat + Vec3::new(0.0, 0.0, half * (k - 0.8) / 0.2)
                        } else {
                            radius * n + Vec3::new(0.0, 0.0, half.copysign(n.z))
                        }
                    }
                    SurfaceShape::Cylinder(Cylinder { radius, half }) => {
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
        let turn = base::math::rotation::matrix(&base::math::rotation::exp(&Vec3::new(0.4, -0.7, 1.1)));
        for shape in shapes() {
            let surface = Surface { center: Vec3::new(0.1, 0.2, -0.3), axes: turn, shape: shape.clone() };
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
