//! `[[beams]]`: parts that bend, along paths of points or along the segments of a mesh.

use schemars::JsonSchema;
use serde::Deserialize;

use super::part_damping::PartDamping;
use super::part_table::{MassKind, PartTable, ReducedTable, names};
use super::words::{Directions, Maybe, Names, NumberOrTable, Numbers, OneOrMany, Table, Vector};
use base::diagnostic::At;
use mechanics::elements::beam::{DEFAULT_ORDER, IntegrationRule};

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
    /// File of BeamDyn with sections by station, instead of `stations` and `material`: a blade file, or a primary file, which adds the twist by its key
    /// points. The path is relative to the deck's folder. The x axis of the file lies along local y, and its y axis along local z.
    pub station_file: Maybe<String>,
    /// Elements per segment, 1 or more, or a list with one number for each segment.
    pub elements: Maybe<OneOrMany<u64>>,
    /// Length of the first and last element of a segment over that of its longest, above 0 to 1, or a list with one for each segment. From
    /// either end to the middle element lengths grow by a constant factor. For plastic hinges at the ends of legs, and other short ends; 3
    /// elements or more. Default: 1, all of one length.
    pub grading: Maybe<OneOrMany<f64>>,
    /// Name of a material; left out where the section gives stiffnesses.
    pub material: Maybe<String>,
    /// Name of a section. Required without `stations` and `station_file`.
    pub section: Maybe<String>,
    /// Sections by station along the beam instead of `section`, from `at = 0` to `at = 1`. Between stations whose sections have one shape and the same
    /// keys, dimensions are linear; between others, the matrices of stiffness and mass are. Convergence is fastest if stations lie at points of the path.
    pub stations: Maybe<Vec<At<Table<Station>>>>,
    /// A vector in the plane of local x (along the beam) and local y, global at t = 0; not parallel to the beam.
    #[schemars(required)]
    pub orientation: Maybe<Vector>,
    /// Polynomial degree of an element, 1 to 4; it has order + 1 nodes. Default: 3.
    pub order: Maybe<u64>,
    /// Mass matrix. Default: "lumped".
    pub mass: Maybe<MassKind>,
    /// The beam is a rigid body of its name, with the mass and inertia of its elements. Default: false.
    pub rigid: Maybe<bool>,
    /// The beam deforms by so many modes with a fixed interface, and by the static shapes of the interface. The interface are its points
    /// in the deck, and nodes that other parts, joints, supports and point loads share with it. Displacements are small in a frame that moves with the interface. Default: each node moves.
    pub reduced: Maybe<NumberOrTable<Table<ReducedTable>>>,
    /// Keep the rotary inertia of the section. Default: true.
    pub rotary_inertia: Maybe<bool>,
    /// The beam deforms in shear; false: its shear stiffness is 10,000 times that of the section, as beams of Euler and Bernoulli have it.
    /// Not with explicit schemes, whose steps would become shorter. Default: true.
    pub shear: Maybe<bool>,
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
    /// Stiffness per length of an elastic foundation, force per length squared, along global x, y and z, 0 or more. It acts on the nodes as
    /// springs to the ground, which links.csv lists. Default: none.
    pub foundation: Maybe<Vector>,
    /// Rotations that the ends release, in the local axes of the beam: `{ start = ["ry", "rz"], end = "ry" }`. A released end is a node of its own, held to
    /// its point in all other directions. With `group` both ends of each line of segments are released, its start being where its segments start.
    /// Default: none.
    pub release: Maybe<Table<Release>>,
    /// Rayleigh damping of this part, `{ alpha, beta }`. Default: that of `[damping]`.
    pub damping: Maybe<Table<PartDamping>>,
}

/// The section at a place along a beam.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Station {
    /// Place as a part of the length of the beam, from 0 to 1 and above that of the station before.
    #[schemars(required)]
    pub at: Maybe<f64>,
    /// Name of a section.
    #[schemars(required)]
    pub section: Maybe<String>,
    /// Angle of the axes of the section about local x, from the axes by `orientation`, radians; linear between stations. Default: 0.
    pub twist: Maybe<f64>,
    /// Place `[y, z]` of the section from the axis of the beam, along the axes by `orientation`; linear between stations. Default: none.
    pub offset: Maybe<Numbers<2>>,
}

/// Rotations that are released at the ends of a beam, in its local axes.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Release {
    /// Rotations at the first point of the path, or the start of each line of the group. Default: none.
    pub start: Maybe<Directions>,
    /// Rotations at the last point of the path, or the end of each line of the group. Default: none.
    pub end: Maybe<Directions>,
}

impl PartTable for Beam {
    fn name(&self) -> Option<&At<String>> {
        self.name.as_ref()
    }

    fn group(&self) -> Option<&At<String>> {
        self.group.as_ref()
    }

    fn members(&self) -> Vec<&At<String>> {
        names(&self.path)
    }

    /// The nodes of a path have names, or stand between two named nodes.
    fn is_node_list(&self) -> bool {
        self.group.is_some()
    }

    fn damping(&self) -> Option<&At<Table<PartDamping>>> {
        self.damping.as_ref()
    }

    fn material(&self) -> Option<&At<String>> {
        self.material.as_ref()
    }

    fn elements(&self) -> Option<&At<OneOrMany<u64>>> {
        self.elements.as_ref()
    }

    fn order(&self) -> Option<u64> {
        Some(self.order.as_ref().map_or(DEFAULT_ORDER as u64, |order| order.value))
    }

    fn rigid(&self) -> Option<bool> {
        Some(self.rigid.as_ref().is_some_and(|at| at.value))
    }

    fn reduced(&self) -> Option<&At<NumberOrTable<Table<ReducedTable>>>> {
        self.reduced.as_ref()
    }
}
