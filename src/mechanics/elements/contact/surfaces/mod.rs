//! The surfaces that others touch: the signed distance of a point, its normal and its curvature, all in closed form. A further shape is one
//! file and one entry of the list.

pub mod capsule;
pub mod cuboid;
pub mod cylinder;
pub mod hull;
pub mod kind;
pub mod plane;
pub mod sight;
pub mod sphere;

use base::math::convex::{ConvexShape, Spherocylinder};
use base::math::cylinder::RoundCylinder;
use base::math::polyhedron::Polyhedron;
use base::math::{Mat3, Vec3};
use kind::{ClosestPoint, Placed, SurfaceKind, Touched};
use std::sync::Arc;

/// Makes the enum of all shapes, without calls through pointers, and the list of words.
macro_rules! surfaces {
    ($($file:ident :: $Shape:ident),+ $(,)?) => {
        $(pub use $file::$Shape;)+

        /// Any of the shapes.
        #[derive(Debug, Clone, PartialEq)]
        pub enum SurfaceShape {
            $(
                #[doc = concat!("A shape of surfaces/", stringify!($file), ".rs.")]
                $Shape($Shape)
            ),+
        }

        /// All shapes, in the order of the reference.
        pub static SURFACES: &[&SurfaceKind<SurfaceShape>] = &[$(&$file::KIND.with(|given, body| {
            let Placed { center, axes, shape } = ($file::KIND.make)(given, body)?;
            Some(Placed { center, axes, shape: SurfaceShape::$Shape(shape) })
        })),+];

        impl SurfaceShape {
            /// The convex shape for contact of full shapes; a hull without its rounding.
            pub fn as_convex(&self) -> Option<ConvexShape> {
                let about = |half: f64, radius: f64| {
                    ConvexShape::Spherocylinder(Spherocylinder { half: Vec3::z() * half, radius })
                };
                match self {
                    SurfaceShape::Cuboid(cuboid) => {
                        Some(ConvexShape::Polyhedron(Arc::new(Polyhedron::cuboid(cuboid.half.into()))))
                    }
                    SurfaceShape::Hull(hull) => Some(ConvexShape::Polyhedron(hull.polyhedron.clone())),
                    SurfaceShape::Sphere(sphere) => Some(about(0.0, sphere.radius)),
                    SurfaceShape::Capsule(capsule) => Some(about(capsule.half, capsule.radius)),
                    SurfaceShape::Cylinder(of) => Some(ConvexShape::Cylinder(Arc::new(RoundCylinder::new(
                        of.radius,
                        of.half,
                        Mat3::identity(),
                    )))),
                    SurfaceShape::Plane(_) => None,
                }
            }

            /// The surface at the distance `rounding` outside a polyhedron; a box is enlarged instead of rounded.
            pub fn of_polyhedron(shape: Arc<Polyhedron>, rounding: f64) -> SurfaceShape {
                match shape.half() {
                    Some(half) => SurfaceShape::Cuboid(Cuboid { half: half.add_scalar(rounding).into() }),
                    None => SurfaceShape::Hull(Hull { polyhedron: shape, rounding }),
                }
            }

            /// The deck's word for it.
            pub fn word(&self) -> &'static str {
                match self {
                    $(SurfaceShape::$Shape(_) => $file::KIND.word),+
                }
            }
        }

        impl Touched for SurfaceShape {
            #[inline]
            fn closest_point(&self, y: &Vec3) -> ClosestPoint {
                match self {
                    $(SurfaceShape::$Shape(shape) => shape.closest_point(y)),+
                }
            }

            #[inline]
            fn distance(&self, y: &Vec3) -> f64 {
                match self {
                    $(SurfaceShape::$Shape(shape) => shape.distance(y)),+
                }
            }

            fn reach(&self) -> f64 {
                match self {
                    $(SurfaceShape::$Shape(shape) => shape.reach()),+
                }
            }

            fn least(&self) -> f64 {
                match self {
                    $(SurfaceShape::$Shape(shape) => shape.least()),+
                }
            }

            fn keeps(&self, e: &Vec3) -> bool {
                match self {
                    $(SurfaceShape::$Shape(shape) => shape.keeps(e)),+
                }
            }
        }
    };
}

surfaces! {
    plane::Plane,
    cuboid::Cuboid,
    sphere::Sphere,
    cylinder::Cylinder,
    capsule::Capsule,
    hull::Hull,
}
