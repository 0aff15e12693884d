//! `[[equations]]`: linear equations between displacements.

use schemars::JsonSchema;
use serde::Deserialize;

use super::stages::StopQuantity;
use super::words::{Maybe, Table};
use base::diagnostic::At;

/// A linear equation between displacements or rotations, counted from t = 0: the sum of all terms is zero. A multiplier holds it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Equation {
    /// Name, for messages.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// The terms, two or more.
    #[schemars(required)]
    pub terms: Maybe<Vec<At<Table<Term>>>>,
}

/// A term of an equation: a factor times a displacement.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Term {
    /// Name of a point or body.
    #[schemars(required)]
    pub node: Maybe<String>,
    /// Its displacement, or component of its rotation vector.
    #[schemars(required)]
    pub dof: Maybe<StopQuantity>,
    /// The factor, not zero.
    #[schemars(required)]
    pub factor: Maybe<f64>,
}
