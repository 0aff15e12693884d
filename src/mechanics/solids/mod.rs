//! Solids of rigid bodies: volume, inertia, drawing and contact points by shape.
//!
//! A solid lies about its centre of mass, in axes of the body, which are global at t = 0. A new solid needs a file and an entry of
//! [`SOLIDS`].

pub mod capsule;
pub mod cuboid;
pub mod cylinder;
pub mod element_faces;
pub mod hollow;
pub mod hull;
pub mod hull_points;
pub mod kind;
pub mod outline;
pub mod segment;
pub mod sphere;
pub mod tube;

pub use kind::{Solid, SolidKind, SolidShape, Touching};

use base::math::Mat3;
use std::sync::Arc;

/// All solids, in the order of the reference.
pub static SOLIDS: &[&SolidKind] =
    &[&cuboid::KIND, &cylinder::KIND, &sphere::KIND, &tube::KIND, &capsule::KIND, &hull::KIND];

/// Drawing of a body without a shape: the homogeneous cuboid of its mass and inertia.
pub fn drawn_by_inertia(mass: f64, inertia: &Mat3) -> Arc<dyn SolidShape> {
    Arc::new(cuboid::SolidCuboid::of_inertia(mass, inertia))
}
