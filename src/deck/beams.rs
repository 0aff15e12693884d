//! `[[beams]]` and `[[bars]]`: parts along paths of points, or along the segments of a mesh.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, OneOrMany, Vector};
use crate::elements::beam::IntegrationRule;

/// A shear-flexible beam along straight segments between points, or along those of a group of the mesh.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// Default: that of the group.
    pub name: Maybe<String>,
    /// Names of points, two or more.
    pub path: Maybe<Names>,
    /// Name of a group of the mesh, instead of path and elements: each of its segments is an element.
    pub group: Maybe<String>,
    /// Elements per segment, or a list with one number for each.
    pub elements: Maybe<OneOrMany<u64>>,
    /// Name of a material; not needed where the section gives stiffnesses.
    pub material: Maybe<String>,
    /// Name of a section.
    #[schemars(required)]
    pub section: Maybe<String>,
    /// A vector in the plane of local x (along the beam) and local y.
    #[schemars(required)]
    pub orientation: Maybe<Vector>,
    /// Degree of an element's interpolation, 1 to 4; an element has order - 1 inner nodes.
    pub order: Maybe<u64>,
    /// Default: "lumped".
    pub mass: Maybe<MassKind>,
    /// The part is a rigid body of its name, with the mass and inertia of its elements. Default: false.
    pub rigid: Maybe<bool>,
    /// Keep the rotary inertia of the section. Default: true.
    pub rotary_inertia: Maybe<bool>,
    /// Rule along an element. Default: "gauss". Beams whose material yields.
    pub integration: Maybe<IntegrationRule>,
    /// Points of the rule, order to 5. Default: order, which lets the moment be straight along an element. Beams whose material
    /// yields.
    pub points: Maybe<u64>,
    /// Shear stress counts in the yield condition; false: shear and torsion stay elastic. Default: true. Beams whose material
    /// yields.
    pub shear_yields: Maybe<bool>,
    /// From the path's first point to the beam's end, rigid, global components at t = 0.
    pub offset_start: Maybe<Vector>,
    /// From the path's last point to the beam's end, rigid, global components at t = 0.
    pub offset_end: Maybe<Vector>,
}

/// A bar or cable: no bending.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bar {
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Names of points, two or more.
    #[schemars(required)]
    pub path: Maybe<Names>,
    /// Elements per segment, or a list with one number for each. Default: 1.
    pub elements: Maybe<OneOrMany<u64>>,
    /// Name of a material, with area.
    pub material: Maybe<String>,
    /// Cross-sectional area, with material.
    pub area: Maybe<f64>,
    /// E A, force; instead of material and area.
    pub axial_stiffness: Maybe<f64>,
    /// With axial_stiffness.
    pub mass_per_length: Maybe<f64>,
    /// Slack when shortened. Default: false.
    pub tension_only: Maybe<bool>,
    /// Of the whole path, without force: shorter than it lies pulls from the start, longer hangs. Default: as it lies at t = 0.
    pub free_length: Maybe<f64>,
    /// Default: "lumped".
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
