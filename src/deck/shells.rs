//! `[[shells]]`: patches between three or four points, flat or on a surface of revolution, or the faces of a mesh.

use schemars::JsonSchema;
use serde::Deserialize;

use super::part_damping::PartDamping;
use super::part_table::{MassKind, PartTable, ReducedTable, names};
use super::words::{Maybe, Named, Names, NumberOrTable, OneOrMany, Table, Vector};
use base::diagnostic::At;

/// A patch of shell elements, or those of a group of the mesh. Its name represents all of its nodes, and `name.edge1` to `name.edge4` those
/// of an edge: edge1 runs from the first corner to the second, and so on. Patches that share corners share the nodes between them.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shell {
    /// Name; left out with `group`, the name of the group.
    pub name: Maybe<String>,
    /// Names of four points in order round the patch, or of three.
    pub corners: Maybe<Names>,
    /// Name of a group of the mesh, instead of `corners`, `elements`, `kind`, `order` and `surface`: its triangles and
    /// quadrilaterals. Normals at nodes are those of the elements round them, each weighted by its angle there,
    /// on the same side of folds of more than 31 degrees.
    pub group: Maybe<String>,
    /// Elements along edge1 and along edge2, 1 or more, or one number for all edges.
    pub elements: Maybe<OneOrMany<u64>>,
    /// Thickness, above 0.
    #[schemars(required)]
    pub thickness: Maybe<f64>,
    /// Thickness at some nodes instead of `thickness`, above 0, by names of points, edges or sets: `{ tip = 0.01, "mesh.17" = 0.02 }`. A later
    /// entry counts. Each element has the mean of its corners; contacts take `thickness`.
    #[serde(default)]
    pub nodal_thickness: Named<f64>,
    /// Distance of the mid-surface from the nodes, along the normals at the nodes; rigid arms join both. Default: 0.
    pub offset: Maybe<f64>,
    /// Name of a material.
    #[schemars(required)]
    pub material: Maybe<String>,
    /// The elements. Default: "quadrilateral"; a patch of three corners has triangles.
    pub kind: Maybe<ElementKind>,
    /// Degree of the sides of its elements, 1 or 2. Elements of order 2 have a node on each side, and quadrilaterals one in the middle;
    /// they follow curved surfaces. Elements of a group have the order of the mesh. Default: 1.
    pub order: Maybe<u64>,
    /// Integration points through the thickness, 2 to 10 or an even number up to 24, for shells whose material yields. Default: 8,
    /// which give the moment within 1 % of the plastic moment.
    pub layers: Maybe<u64>,
    /// Strain of the surface in shells whose material yields. Default: "green".
    pub strain: Maybe<StrainMeasure>,
    /// The surface on which the patch lies. Default: straight lines between opposite edges.
    pub surface: Maybe<Table<PatchSurface>>,
    /// Direction whose projection on the surface is axis 1 of results. If it is normal to the surface, the global axis farthest from the
    /// normal is used. Default: global x, and y where x is normal to the surface.
    pub axis: Maybe<Vector>,
    /// Mass matrix. Default: "lumped".
    pub mass: Maybe<MassKind>,
    /// The shell is a rigid body of its name, with the mass and inertia of its elements. Default: false.
    pub rigid: Maybe<bool>,
    /// The shell deforms by so many modes with a fixed interface, and by the static shapes of the interface. The interface are its points
    /// in the deck, and nodes that other parts, joints, supports and point loads share with it. Displacements are small in a frame that moves with the interface. Default: each node moves.
    pub reduced: Maybe<NumberOrTable<Table<ReducedTable>>>,
    /// Stiffness per area of an elastic foundation, force per length cubed, along global x, y and z, 0 or more. It acts on the nodes as springs
    /// to the ground, which links.csv lists. Default: none.
    pub foundation: Maybe<Vector>,
    /// Rayleigh damping of this part, `{ alpha, beta }`. Default: that of `[damping]`.
    pub damping: Maybe<Table<PartDamping>>,
}

impl PartTable for Shell {
    fn name(&self) -> Option<&At<String>> {
        self.name.as_ref()
    }

    fn group(&self) -> Option<&At<String>> {
        self.group.as_ref()
    }

    fn members(&self) -> Vec<&At<String>> {
        names(&self.corners)
    }

    fn is_node_list(&self) -> bool {
        true
    }

    /// A group has no corners. Wrong numbers of corners are reported where the shell is read.
    fn named_edges(&self) -> usize {
        match &self.corners {
            _ if self.group.is_some() => 0,
            Some(corners) if corners.values.len() == 3 => 3,
            _ => 4,
        }
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

    fn rigid(&self) -> Option<bool> {
        Some(self.rigid.as_ref().is_some_and(|at| at.value))
    }

    fn reduced(&self) -> Option<&At<NumberOrTable<Table<ReducedTable>>>> {
        self.reduced.as_ref()
    }
}

/// The kind of elements that a patch is divided into.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ElementKind {
    /// Four-node elements with assumed transverse shear strains; of nine nodes with `order = 2`.
    Quadrilateral,
    /// Three-node elements with assumed transverse shear strains; of six nodes with `order = 2`.
    Triangle,
}

/// Strain measure of a yielding shell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StrainMeasure {
    /// Green's, and yield in the stress conjugate to it, on the thickness at t = 0: for strains of some per cent.
    Green,
    /// Logarithmic strain and true stress, with the thickness after plastic flow: for sheets that stretch by 5 % and more.
    Logarithmic,
}

/// Where the nodes between the corners lie. With an axis, edges are straight in the coordinates about it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatchSurface {
    /// The surface.
    #[schemars(required)]
    pub kind: Maybe<SurfaceKind>,
    /// A point of the axis, or the centre of the sphere, global coordinates. Default: the origin.
    pub center: Maybe<Vector>,
    /// Direction of the axis; a cylinder needs it. A sphere without it uses edges along great circles.
    pub axis: Maybe<Vector>,
}

/// Coordinates that interpolate points between the edges of a patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SurfaceKind {
    /// Radius, angle and height about the axis: also cones and flat rings.
    Cylinder,
    /// Radius, longitude and latitude about the axis.
    Sphere,
}
