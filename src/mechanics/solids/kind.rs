//! Description of a solid.

use super::outline::Outline;
use base::math::convex::ConvexShape;
use base::math::{Mat3, Vec3};
use base::words::kinds::{Given, Kind};
use std::fmt;
use std::sync::Arc;

/// A kind of solid that the deck can name, with the reader of its keys; `None` for a wrong key.
pub type SolidKind = Kind<fn(&mut Given) -> Option<Solid>>;

/// A homogeneous solid.
#[derive(Debug, Clone)]
pub struct Solid {
    /// Its drawing and its contact points.
    pub shape: Arc<dyn SolidShape>,
    /// About the centre, per unit of mass.
    pub inertia: Mat3,
    /// Volume.
    pub volume: f64,
    /// Its centre, if the keys define one: global coordinates at t = 0.
    pub center: Option<Vec3>,
}

/// Drawing and contact points of a body: points about the centre of mass in body axes.
pub trait SolidShape: fmt::Debug + Send + Sync {
    /// The outline for drawing.
    fn outline(&self) -> Outline;

    /// `between`: how many points are asked for between corners or rims.
    fn touching(&self, between: usize) -> Touching;

    /// Widest opening between its contact points: a ball of a smaller diameter passes there.
    fn opening(&self, _between: usize) -> Option<f64> {
        None
    }

    /// True if it has a through hole, which contact treats as closed.
    fn has_hole(&self) -> bool {
        false
    }

    /// Its convex shape in body axes for contact of whole bodies; a ball is a point instead.
    fn as_convex(&self) -> Option<ConvexShape> {
        None
    }
}

/// Contact points of a body.
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
