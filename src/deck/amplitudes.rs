//! `[amplitudes.x]`: functions of time.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Numbers};
use crate::diagnostic::At;

/// A function of time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Amplitude {
    #[schemars(required)]
    pub kind: Maybe<AmplitudeKind>,
    /// [[time, value], ...], times increasing: table.
    pub points: Maybe<Vec<At<Numbers<2>>>>,
    /// Cycles per time: sine, sine-squared.
    pub frequency: Maybe<f64>,
    /// Radians per time, instead of frequency: sine, sine-squared.
    pub angular_frequency: Maybe<f64>,
    /// Radians. Default: 0. sine.
    pub phase: Maybe<f64>,
    /// Zero before. Default: 0. sine, sine-squared, ramp, step.
    pub start: Maybe<f64>,
    /// Zero after; a ramp stays at one. Default: never; needed by ramp. sine, sine-squared, ramp, step.
    pub end: Maybe<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AmplitudeKind {
    /// Straight lines through points.
    Table,
    /// sin(w (t - start) + phase).
    Sine,
    /// sin²(w (t - start)).
    SineSquared,
    /// From 0 at start to 1 at end.
    Ramp,
    /// 1 between start and end.
    Step,
    /// 1.
    Constant,
}
