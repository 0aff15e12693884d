//! `[[bodies]]` and `[[masses]]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::kinds::{Given, Kinds, OneOf};
use super::words::{Maybe, Names, Vector};
use mechanics::solids::{SOLIDS, Solid, SolidKind};

/// A rigid body.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name, for messages, results and other tables.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Names of rigid shells, beams and bars that form the body: they give its centre, mass and inertia, and their elements are not
    /// computed.
    pub parts: Maybe<Names>,
    /// Centre of mass at t = 0, global coordinates. Omitted if `parts` form the body, like mass, inertia and shape, or if a hull or capsule
    /// stays at its points.
    pub center: Maybe<Vector>,
    /// Mass, above 0. Left out where the shape has a density. In decks of statics and buckling alone it may be 0, and left out if no gravity acts.
    pub mass: Maybe<f64>,
    /// Moments of inertia about the centre, global axes at t = 0: [xx, yy, zz] or [xx, yy, zz, xy, yz, zx], products with the sign of the
    /// matrix. May be left out like the mass.
    pub inertia: Maybe<Vec<f64>>,
    /// A solid that gives the inertia, and the mass if it has a density; with `inertia` it is only drawn.
    pub shape: Maybe<OneOf<BodyShape>>,
    /// Velocity of the centre at t = 0, global components. Default: at rest.
    pub velocity: Maybe<Vector>,
    /// Angular velocity at t = 0, global components, radians per unit of time. Default: none.
    pub angular_velocity: Maybe<Vector>,
}

/// A shape around the centre of mass, along the global axes at t = 0.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyShape {
    /// Mass per volume, above 0, instead of the body's mass.
    pub density: Maybe<f64>,
}

impl Kinds for BodyShape {
    const CHOOSER: &'static str = "kind";
    const ABOUT: &'static str = "The solid, on which the other keys depend.";
    const REQUIRED: bool = true;
    type Make = fn(&mut Given) -> Option<Solid>;

    fn list() -> &'static [&'static SolidKind] {
        SOLIDS
    }
}

/// A mass on points.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mass {
    /// Names of points, bodies or sets; each gets the whole mass.
    #[schemars(required)]
    pub at: Maybe<Names>,
    /// Mass, above 0.
    #[schemars(required)]
    pub mass: Maybe<f64>,
    /// Moments of inertia about global axes at t = 0: [xx, yy, zz] or [xx, yy, zz, xy, yz, zx]. Default: none.
    pub inertia: Maybe<Vec<f64>>,
}
