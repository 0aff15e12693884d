//! `[[bars]]`: parts that stretch and do not bend, along paths of points.

use schemars::JsonSchema;
use serde::Deserialize;

use super::part_damping::PartDamping;
use super::part_table::{MassKind, PartTable, names};
use super::words::{Maybe, Names, OneOrMany, Table};
use base::diagnostic::At;

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
    /// Rayleigh damping of this part, `{ alpha, beta }`. Default: that of `[damping]`.
    pub damping: Maybe<Table<PartDamping>>,
}

impl PartTable for Bar {
    fn name(&self) -> Option<&At<String>> {
        self.name.as_ref()
    }

    fn members(&self) -> Vec<&At<String>> {
        names(&self.path)
    }

    fn damping(&self) -> Option<&At<Table<PartDamping>>> {
        self.damping.as_ref()
    }

    fn material(&self) -> Option<&At<String>> {
        self.material.as_ref()
    }

    /// A bar cut in two would have a hinge between its halves, so only cables are subdivided.
    fn elements(&self) -> Option<&At<OneOrMany<u64>>> {
        self.elements.as_ref().filter(|at| at.values.iter().any(|count| count.value > 1))
    }
}
