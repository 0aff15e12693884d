//! The surfaces that others touch: the signed distance of a point, its normal and its curvature, all in closed form. One more is a
//! file of its own and an entry of the list.

pub mod capsule;
pub mod cuboid;
pub mod cylinder;
pub mod kind;
pub mod plane;
pub mod sight;
pub mod sphere;

use crate::math::Vec3;
use kind::{ClosestPoint, Placed, SurfaceKind, Touched};

/// Makes the one type that holds any of the shapes, so that none is called through a pointer, and the list of words.
macro_rules! surfaces {
    ($($file:ident :: $Shape:ident),+ $(,)?) => {
        $(pub use $file::$Shape;)+

        /// Any of the shapes.
        #[derive(Debug, Clone, Copy, PartialEq)]
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
            /// Half the edges, where it is a box.
            pub fn as_box(&self) -> Option<Vec3> {
                if let SurfaceShape::Cuboid(cuboid) = self { Some(cuboid.half.into()) } else { None }
            }

            /// A box with half these edges.
            pub fn of_box(half: Vec3) -> SurfaceShape {
                SurfaceShape::Cuboid(Cuboid { half: half.into() })
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
}
