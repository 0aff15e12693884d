//! `[[loads]]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Named, Names, Numbers, OneOrMany, Table, Vector};
use base::diagnostic::At;

/// A force or moment on points or bodies, or spread over shells.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Names of points, bodies, shells, edges or sets; each node gets the whole load, unless it is one per length or area.
    pub at: Maybe<Names>,
    /// Instead of `at`, for temperatures and for loads per length or area: names of beams, bars, shells, groups of the mesh or sets of them; for temperatures, of whole parts.
    pub part: Maybe<Names>,
    /// Force, global components.
    pub force: Maybe<Vector>,
    /// Distance along the beams of `part` from their start, 0 or more, at which `force` and `moment` act, instead of `at`. Member end forces are exact;
    /// section forces within that element are not.
    pub distance: Maybe<f64>,
    /// Force that the nodes of `at` share in equal parts, global components, instead of `force`.
    pub total_force: Maybe<Vector>,
    /// Moment, global components.
    pub moment: Maybe<Vector>,
    /// Force per length that beams, bars or edges of shells have at t = 0, global components. Edges are those such as "roof.edge2",
    /// groups of segments of the mesh, or sets of nodes between which edges of shells lie.
    pub force_per_length: Maybe<Vector>,
    /// Force per length of beams in their section axes x (along the beam), y, z at t = 0.
    pub local: Maybe<Vector>,
    /// The `force_per_length` of beams and bars is one per length seen along the force, such as that of snow on a slope. Default: false.
    pub projected: Maybe<bool>,
    /// Factors of a load per length along a beam or bar: pairs [fraction of its length, factor], linear between them and zero outside.
    /// Default: [[0, 1], [1, 1]].
    pub profile: Maybe<Vec<At<Numbers<2>>>>,
    /// Force per area that shells have at t = 0, global components; `at` then names shells, groups of the mesh whose faces are part of
    /// shells, or sets of them.
    pub force_per_area: Maybe<Vector>,
    /// Pressure on shells, against their normals, which see the corners go round counter-clockwise; `at` names the same as for
    /// `force_per_area`. Area and normals are those of t = 0, with `follower` the current ones.
    pub pressure: Maybe<f64>,
    /// Change of temperature from the state without stress, uniform over the beams, bars and shells of `part`; their materials need
    /// `expansion`.
    pub temperature: Maybe<f64>,
    /// Change of temperature at some nodes instead of `temperature`, by names of points, edges or sets: `{ rim = 80.0, "mesh.17" = 65.0 }`. A later
    /// entry counts. Between the points of a path it is linear. Each element has the mean of its ends or corners.
    #[serde(default)]
    pub nodal_temperature: Named<f64>,
    /// Change of temperature per length across the parts of `part`, zero on the axis or reference surface: of shells one number, along the
    /// normal; of beams [along y, along z] of the section.
    pub temperature_gradient: Maybe<OneOrMany<f64>>,
    /// Centrifugal force of a rotation, in statics and modes. It acts on all masses, or on those that `part` names: beams, bars, shells,
    /// bodies, points with `[[masses]]`, groups of the mesh or sets of them.
    pub centrifugal: Maybe<Table<SteadyRotation>>,
    /// Unbalance of a rotor, in "frequency-response": mass times the vector from the spin axis to the mass at t = 0, global components. Its force
    /// turns with the node and grows with the square of the spin. All spins then follow the frequency, in the proportions of t = 0.
    pub unbalance: Maybe<Vector>,
    /// A force or moment turns with its node, a load per length with the sections of its beam, a pressure follows the surface. Default:
    /// false.
    pub follower: Maybe<bool>,
    /// Name, for `stop` of a stage and for `[[load_cases]]`. Default: none.
    pub name: Maybe<String>,
    /// Names of the stages in which it acts. Default: all.
    pub stages: Maybe<Names>,
    /// Name of an amplitude that multiplies the load, or the speed of a centrifugal one. Default: constant in a dynamic analysis, growing linearly to the end time in a static
    /// one. In stages it grows over its first static stage, and stays.
    pub amplitude: Maybe<String>,
}

/// A steady rotation about an axis fixed in space. Forces act at the deformed places, with `geometry = "linear"` at those of t = 0.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SteadyRotation {
    /// Angular velocity, radians per unit of time; its sign does not count.
    #[schemars(required)]
    pub speed: Maybe<f64>,
    /// Direction of the axis; its length does not count.
    #[schemars(required)]
    pub axis: Maybe<Vector>,
    /// A point on the axis. Default: [0, 0, 0].
    pub about: Maybe<Vector>,
}
