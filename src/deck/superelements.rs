//! `[[superelements]]`: parts by matrices from files.

use schemars::JsonSchema;
use serde::Deserialize;

use super::part_damping::PartDamping;
use super::part_table::{PartTable, names};
use super::words::{Maybe, Names, Table, Vector};
use base::diagnostic::At;

/// A part by its stiffness and mass matrices, from files of this or another program. Its frame may move and turn without limit; in the frame
/// displacements and rotations are small. Matrices are Matrix Market files or hold `*MATRIX` of Abaqus.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Superelement {
    /// Name, for messages and results.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Names of the points that it joins, in the order of the matrices.
    #[schemars(required)]
    pub nodes: Maybe<Names>,
    /// Degrees of freedom of each point. Default: "all".
    pub dofs: Maybe<PointDofs>,
    /// File of the stiffness, relative to the deck. Rows beyond those of the points are modal amplitudes.
    #[schemars(required)]
    pub stiffness: Maybe<String>,
    /// File of the mass. Default: none.
    pub mass: Maybe<String>,
    /// File of the damping: force per velocity of a deformation. Default: none.
    pub damping_matrix: Maybe<String>,
    /// The unknown of each row, such as "tip.uz", or "mode" for a modal amplitude. Default: ux, uy, uz, rx, ry and rz of each point, then modes.
    pub unknowns: Maybe<Names>,
    /// Axes of the components, global at t = 0: their x, and a vector in their x-y plane. Default: global axes.
    pub axes: Maybe<Vec<Vector>>,
    /// Rayleigh damping of this part, `{ alpha, beta }`. Default: that of `[damping]`.
    pub damping: Maybe<Table<PartDamping>>,
}

/// The degrees of freedom of a point of a superelement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PointDofs {
    /// Three displacements and three rotations.
    #[default]
    All,
    /// Three displacements.
    Translations,
}

impl PartTable for Superelement {
    fn name(&self) -> Option<&At<String>> {
        self.name.as_ref()
    }

    fn members(&self) -> Vec<&At<String>> {
        names(&self.nodes)
    }

    fn damping(&self) -> Option<&At<Table<PartDamping>>> {
        self.damping.as_ref()
    }
}
