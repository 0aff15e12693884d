//! `[[beams]]` and `[[bars]]`: parts along paths of points, or along the segments of a mesh.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, OneOrMany, Vector};
use crate::elements::beam::IntegrationRule;

/// A shear-flexible beam along straight segments between points, or along those of a group of the mesh.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// Name; left out with `group`, the name of the group.
    pub name: Maybe<String>,
    /// Names of points, two or more, joined by straight segments.
    pub path: Maybe<Names>,
    /// Name of a group of the mesh, instead of `path` and `elements`: each of its segments is an element.
    pub group: Maybe<String>,
    /// Elements per segment, 1 or more, or a list with one number for each segment.
    pub elements: Maybe<OneOrMany<u64>>,
    /// Name of a material; left out where the section gives stiffnesses.
    pub material: Maybe<String>,
    /// Name of a section.
    #[schemars(required)]
    pub section: Maybe<String>,
    /// A vector in the plane of local x (along the beam) and local y, global at t = 0; not parallel to the beam.
    #[schemars(required)]
    pub orientation: Maybe<Vector>,
    /// Polynomial degree of an element, 1 to 4; it has order + 1 nodes. Default: 3.
    pub order: Maybe<u64>,
    /// Mass matrix. Default: "lumped".
    pub mass: Maybe<MassKind>,
    /// The beam is a rigid body of its name, with the mass and inertia of its elements. Default: false.
    pub rigid: Maybe<bool>,
    /// Keep the rotary inertia of the section. Default: true.
    pub rotary_inertia: Maybe<bool>,
    /// Integration rule along an element, for beams whose material yields. Default: "gauss".
    pub integration: Maybe<IntegrationRule>,
    /// Integration points of an element, `order` to 5, for beams whose material yields. Default: `order`.
    pub points: Maybe<u64>,
    /// Shear stress counts in the yield condition; false: shear and torsion stay elastic. For beams whose
    /// material yields. Default: true.
    pub shear_yields: Maybe<bool>,
    /// Rigid offset from the first point of the path to the start of the beam, global components at t = 0. Default: none.
    pub offset_start: Maybe<Vector>,
    /// Rigid offset from the last point of the path to the end of the beam, global components at t = 0. Default: none.
    pub offset_end: Maybe<Vector>,
}

/// A bar or cable: no bending.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bar {
    /// Name, for messages, results and other tables.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Names of points, two or more, joined by straight segments.
    #[schemars(required)]
    pub path: Maybe<Names>,
    /// Elements per segment, 1 or more, or a list with one number for each segment. Default: 1.
    pub elements: Maybe<OneOrMany<u64>>,
    /// Name of a material, with `area`.
    pub material: Maybe<String>,
    /// Cross-sectional area, above 0, with `material`.
    pub area: Maybe<f64>,
    /// E A, a force above 0, instead of `material` and `area`.
    pub axial_stiffness: Maybe<f64>,
    /// Mass per length, 0 or more, with `axial_stiffness`.
    pub mass_per_length: Maybe<f64>,
    /// The bar is slack when shortened, as a cable. Default: false.
    pub tension_only: Maybe<bool>,
    /// Length of the whole path without force, above 0: shorter than it lies, it pulls from the start; longer,
    /// it hangs. Default: its length at t = 0.
    pub free_length: Maybe<f64>,
    /// Mass matrix. Default: "lumped".
    pub mass: Maybe<MassKind>,
}

/// Where the mass of a part goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MassKind {
    /// At the nodes, by the element's Lobatto rule: a diagonal (lumped) mass matrix.
    #[default]
    Lumped,
    /// Translations by the element's shape functions, with off-diagonal terms; rotary inertia at the nodes.
    Consistent,
    /// Lumped, but without the mass at nodes that are rigidly attached to a body.
    FreeNodes,
    /// The part has no mass.
    None,
}
