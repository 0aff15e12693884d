//! `[output]` and `units`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{FlagOrTable, Maybe, Names, Table};

/// Output files and their rate. t = 0 and the end are always written.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Nodes in nodes.csv: "named", "all", or names of points, parts and sets. "named" means all points of the deck, also in a list. With an
    /// empty list rdsolve does not write nodes.csv. Default: "named".
    pub nodes: Maybe<Names>,
    /// Steps between two rows of all tables, 1 or more; 1 writes every step. Default without `interval`: 1 while the tables stay below
    /// about 20 MB, otherwise 2, 5, 10 and so on; with automatic steps the steps that are far enough apart. An explicit run of a thousand
    /// elements or more has 2000 rows at most, for one costs half a step. `check` says which, and how large the tables become.
    pub every: Maybe<u64>,
    /// Time between two rows, above 0, instead of `every`: multiples of it are hit exactly.
    pub interval: Maybe<f64>,
    /// Files of the deformed shape for viewers such as ParaView.
    pub fields: Maybe<Table<Fields>>,
    /// Write energy.csv: energies, dissipation, balance and momenta. Default: true.
    pub energy: Maybe<bool>,
    /// Write links.csv: elongation, rate and force of links; of a frequency response response_links.csv besides. Default: false.
    pub links: Maybe<bool>,
    /// Write contacts.csv, gaps and forces of contacts, or contact_pairs.csv, forces between parts. `true` is { by = "contacts" }. Default:
    /// false.
    pub contacts: Maybe<FlagOrTable<ContactOutput>>,
    /// Write reactions.csv, reactions of supports and joints, and ties.csv, forces of ties. Default: false.
    pub reactions: Maybe<bool>,
    /// Write sections.csv for beams, bars.csv for bars and shells.csv for shells: stress resultants. `true` is { at = "points" }. Default: false.
    pub sections: Maybe<FlagOrTable<Sections>>,
    /// Write layers.csv: stress through the thickness of shells. Default: false.
    pub layers: Maybe<bool>,
    /// Write parts.csv: the elastic energy of each beam, bar and shell. Default: false.
    pub parts: Maybe<bool>,
    /// Write joints.csv: coordinate, rate, effort, power of drives and reactions of joints. Default: false.
    pub joints: Maybe<bool>,
    /// Seconds of run time between two checkpoints for `--resume`, above 0. Default: none but the one that is written when a signal stops
    /// the run.
    pub checkpoint: Maybe<f64>,
}

/// The places of beams that sections.csv is about.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sections {
    /// The places.
    #[schemars(required)]
    pub at: Maybe<SectionPlaces>,
}

/// Places along the elements of a beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SectionPlaces {
    /// Integration points, where strains and stresses belong together.
    Points,
    /// Both ends of each element: member end forces, in balance with the nodal loads.
    Ends,
    /// Integration points and ends.
    Both,
}

/// Rows of the tables of contacts.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactOutput {
    /// Subject of a row.
    #[schemars(required)]
    pub by: Maybe<ContactRows>,
}

/// Subject of a row in the tables of contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ContactRows {
    /// A contact of the deck, in contacts.csv.
    Contacts,
    /// Two parts or bodies that touch, in contact_pairs.csv.
    Pairs,
    /// Both tables.
    Both,
}

/// Field files.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fields {
    /// The format of the files.
    #[schemars(required)]
    pub format: Maybe<Format>,
    /// Steps between two files, 1 or more. Default: as many as give 200 files at most.
    pub every: Maybe<u64>,
}

/// The format of the files with the moving scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// VTK unstructured grids, one file a time, with a .pvd file that lists them.
    Vtu,
    /// One file `fields.frd` in ASCII as CalculiX writes it, with a block for each time and mode: displacements of nodes, and stresses at the
    /// upper side of shells. FreeCAD, PrePoMax and cgx read it.
    Frd,
}

/// Length, mass and time; `SI` is `m-kg-s`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum Units {
    /// Forces are in N, stresses in Pa, energies in J.
    #[serde(rename = "SI")]
    Si,
    /// Forces are in N, stresses in Pa, energies in J.
    #[serde(rename = "m-kg-s")]
    MKgS,
    /// Forces are in N, stresses in MPa, energies in mJ.
    #[serde(rename = "mm-t-s")]
    MmTS,
    /// Forces are in mN, stresses in kPa, energies in µJ.
    #[serde(rename = "mm-kg-s")]
    MmKgS,
    /// Forces are in kN, stresses in GPa, energies in J.
    #[serde(rename = "mm-kg-ms")]
    MmKgMs,
}

impl Units {
    /// The deck's word for it.
    pub fn label(self) -> &'static str {
        match self {
            Units::Si => "SI",
            Units::MKgS => "m-kg-s",
            Units::MmTS => "mm-t-s",
            Units::MmKgS => "mm-kg-s",
            Units::MmKgMs => "mm-kg-ms",
        }
    }

    /// Its length, mass and time in metres, kilograms and seconds.
    pub fn scales(self) -> [f64; 3] {
        match self {
            Units::Si | Units::MKgS => [1.0, 1.0, 1.0],
            Units::MmTS => [1e-3, 1e3, 1.0],
            Units::MmKgS => [1e-3, 1.0, 1.0],
            Units::MmKgMs => [1e-3, 1.0, 1e-3],
        }
    }
}
