//! `[[load_cases]]`, `[[combinations]]` and `[[envelopes]]`: what a linear analysis is solved for, and what of it is collected.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, OneOrMany};

/// A load case of a linear analysis: named loads, each with its factor. Loads that it does not name do not act in it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadCase {
    /// Name, for the column `case` of results, for combinations, envelopes and messages.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Names of loads and of supports with a motion, and "gravity" for the weight by `[environment]`. They act as at the end time.
    #[schemars(required)]
    pub loads: Maybe<Names>,
    /// A factor for each of `loads`, or one for all. Default: 1.
    pub factors: Maybe<OneOrMany<f64>>,
}

/// The sum of load cases, each with its factor. It has results of its own, like a load case.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Combination {
    /// Name, for the column `case` of results, for envelopes and messages.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Names of load cases.
    #[schemars(required)]
    pub cases: Maybe<Names>,
    /// A factor for each of `cases`, or one for all. Default: 1.
    pub factors: Maybe<OneOrMany<f64>>,
}

/// The extremes of each result over several cases. Tables have its rows with `NAME.max` and `NAME.min` in the column `case`, after those of
/// the cases.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Envelope {
    /// Name, for the column `case` of results.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Names of load cases and combinations. Default: all combinations, or all load cases where there are none.
    pub cases: Maybe<Names>,
}
