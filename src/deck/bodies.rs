//! `[[bodies]]` and `[[masses]]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, Table, Vector};

/// A rigid body.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Names of shells, beams and bars that are rigid and make up the body: they give its centre, mass and inertia, and their
    /// elements are left out of the computation.
    pub parts: Maybe<Names>,
    /// Centre of mass at t = 0. Left out where parts make up the body, like mass, inertia and shape.
    pub center: Maybe<Vector>,
    /// Left out where the shape has a density.
    pub mass: Maybe<f64>,
    /// About the centre, global axes at t = 0: [xx, yy, zz] or [xx, yy, zz, xy, yz, zx].
    pub inertia: Maybe<Vec<f64>>,
    /// Gives the inertia, and the mass if it has a density; with `inertia` it is only drawn.
    pub shape: Maybe<Table<Shape>>,
    /// Of the centre at t = 0.
    pub velocity: Maybe<Vector>,
    /// At t = 0, global components, radians per time.
    pub angular_velocity: Maybe<Vector>,
}

/// A shape around the centre of mass, along the global axes at t = 0.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    #[schemars(required)]
    pub kind: Maybe<ShapeKind>,
    /// Full edge lengths: box.
    pub size: Maybe<Vector>,
    /// Outer radius: cylinder, tube, sphere.
    pub radius: Maybe<f64>,
    /// Default 0: cylinder. Tubes take it or thickness.
    pub inner_radius: Maybe<f64>,
    /// Of the wall: tube.
    pub thickness: Maybe<f64>,
    /// Cylinder, tube.
    pub length: Maybe<f64>,
    /// Direction of the length: cylinder, tube.
    pub axis: Maybe<Vector>,
    /// Mass per volume, instead of the body's mass.
    pub density: Maybe<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ShapeKind {
    Box,
    Cylinder,
    Sphere,
    Tube,
}

/// A mass on points.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mass {
    /// Names of points or sets; each gets the whole mass.
    #[schemars(required)]
    pub at: Maybe<Names>,
    #[schemars(required)]
    pub mass: Maybe<f64>,
    /// Global axes at t = 0: [xx, yy, zz] or [xx, yy, zz, xy, yz, zx]. Default: none.
    pub inertia: Maybe<Vec<f64>>,
}
