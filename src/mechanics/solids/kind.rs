//! What a solid says of itself.

use super::outline::Outline;
use base::math::convex::ConvexShape;
use base::math::{Mat3, Vec3};
use base::words::kinds::{Given, Kind};
use std::fmt;
use std::sync::Arc;

/// A solid that the deck can name, and what its keys give; `None` where a key is wrong.
pub type SolidKind = Kind<fn(&mut Given) -> Option<Solid>>;

/// A homogeneous solid.
#[derive(Debug, Clone)]
pub struct Solid {
    /// What is drawn of it, and where it touches.
    pub shape: Arc<dyn SolidShape>,
    /// About the centre, per unit of mass.
    pub inertia: Mat3,
    /// Volume.
    pub volume: f64,
    /// Its centre, where the keys tell where it is: global coordinates at t = 0.
    pub center: Option<Vec3>,
}

/// What is drawn of a body and where it touches others: points about the centre of mass in body axes.
pub trait SolidShape: fmt::Debug + Send + Sync {
    /// What is drawn.
    fn outline(&self) -> Outline;

    /// `between`: how many points are asked for between corners or rims.
    fn touching(&self, between: usize) -> Touching;

    /// The widest opening between its points that touch, where it touches at several: a ball of a smaller diameter passes there.
    fn opening(&self, _between: usize) -> Option<f64> {
        None
    }

    /// True where it has a hole right through, which is closed to others.
    fn has_hole(&self) -> bool {
        false
    }

    /// The convex shape that it is, in the axes of its body, where it touches others of these in full; a ball does so as a point.
    fn as_convex(&self) -> Option<ConvexShape> {
        None
    }
}

/// The points by which a body touches a surface.
#[derive(Debug, Clone, PartialEq)]
pub enum Touching {
    /// The sphere of this radius about its centre.
    Ball(f64),
    /// Points with this radius.
    Points {
        /// Where they are, from its centre in its axes.
        points: Vec<Vec3>,
        /// Their radius.
        radius: f64,
    },
    /// The nodes of the elements that make it up.
    Nodes,
}
