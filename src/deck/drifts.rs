//! `[[drifts]]`: relative displacements of two points.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::Maybe;

/// The displacement of a point or body relative to another, in drifts.csv.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drift {
    /// Name, for results and `[[expect]]`.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Name of the point or body that displacements are relative to.
    #[schemars(required)]
    pub from: Maybe<String>,
    /// Name of the point or body whose displacement it is.
    #[schemars(required)]
    pub to: Maybe<String>,
}
