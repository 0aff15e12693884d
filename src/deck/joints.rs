//! `[[joints]]`: what holds two bodies or points together and lets them move in the rest.

use schemars::JsonSchema;
use serde::Deserialize;

use super::links::End;
use super::words::{Maybe, Table, Vector};

/// Two ends held together by multipliers. Axes turn with the bodies.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    #[schemars(required)]
    pub name: Maybe<String>,
    #[schemars(required)]
    pub kind: Maybe<Kind>,
    #[schemars(required)]
    pub from: Maybe<Table<End>>,
    /// On a body, without a `point`: where `from` lies.
    #[schemars(required)]
    pub to: Maybe<Table<End>>,
    /// About which a hinge turns, along which a slider moves, or both: cylinder; of a universal joint the arm of the cross
    /// in `from`. Global at t = 0.
    pub axis: Maybe<Vector>,
    /// The arm of the cross in `to`, square to `axis`: universal.
    pub cross_axis: Maybe<Vector>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Free to turn.
    Ball,
    /// Free to turn about `axis`.
    Hinge,
    /// Free to move along `axis`.
    Slider,
    /// Free to turn about `axis` and to move along it.
    Cylinder,
    /// Free to turn about two axes square to one another.
    Universal,
    /// Not free at all.
    Fixed,
    /// Free but for the distance of the ends: a rod without mass.
    Distance,
}
