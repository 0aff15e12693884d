//! `[[loads]]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, Vector};

/// A force or moment on points or bodies, or spread over shells.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Names of points, bodies, shells, edges or sets; each node gets the whole load, unless it is one per length or area.
    #[schemars(required)]
    pub at: Maybe<Names>,
    /// Force, global components.
    pub force: Maybe<Vector>,
    /// Moment, global components.
    pub moment: Maybe<Vector>,
    /// Force per length along edges of shells, global components; `at` then names edges, such as "roof.edge2",
    /// groups of segments of the mesh, or sets of nodes between which edges of shells lie.
    pub force_per_length: Maybe<Vector>,
    /// Force per area that shells have at t = 0, global components; `at` then names shells.
    pub force_per_area: Maybe<Vector>,
    /// Pressure on shells, against their normals, which see the corners go round counter-clockwise; `at` then
    /// names shells. Area and normals are those of t = 0, with `follower` the current ones.
    pub pressure: Maybe<f64>,
    /// A force or moment turns with its node, a pressure follows the surface. Default: false.
    pub follower: Maybe<bool>,
    /// Name, by which a stage that stops finds the load. Default: none.
    pub name: Maybe<String>,
    /// Names of the stages in which it acts. Default: all.
    pub stages: Maybe<Names>,
    /// Name of an amplitude that multiplies the load. Default: constant in a dynamic analysis, growing linearly
    /// to the end time in a static one. With stages it grows over the static stage in which it first acts, and stays.
    pub amplitude: Maybe<String>,
}
