//! `[amplitudes.x]`: functions of time.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{ColumnName, Maybe, Numbers, OneOrMany};
use base::diagnostic::At;

/// A function of time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Amplitude {
    /// The function.
    #[schemars(required)]
    pub kind: Maybe<AmplitudeKind>,
    /// [[time, value], ...], two or more, times increasing; `interpolation` joins them. `before` and `after` set the values outside; by
    /// default the first and last value are held. (table)
    pub points: Maybe<Vec<At<Numbers<2>>>>,
    /// A file with the points instead; the path is relative to the deck. Headers of PEER (.AT2, .VT2, .DT2), ESM, K-NET and CSMIP (volume
    /// 2) are recognized. Their values are read row by row, with the time step and unit of the header. Other files have columns between
    /// commas, semicolons, tabs or blanks, also as spreadsheets write them, or `rows`. With `units` times of headers and of columns such as
    /// `t [ms]` are converted, with a note. (table)
    pub file: Maybe<String>,
    /// The columns of time and value in the file, by name or by number from 1; with `time_step` that of the value alone. Default: the only
    /// ones. (table)
    pub columns: Maybe<OneOrMany<ColumnName>>,
    /// True for a file with values row by row, any number in a row; needs `time_step` if no header gives it. Default: true with a header of
    /// a data base, else false. (table)
    pub rows: Maybe<bool>,
    /// The time between two values of a file without times, above 0; the first is at 0. (table)
    pub time_step: Maybe<f64>,
    /// The curve between the points. Default: "linear"; for positions and velocities prescribed by a support or joint in dynamics "cubic"
    /// between the corners of the table. (table)
    pub interpolation: Maybe<Interpolation>,
    /// Factor on the values, such as 9.81 for a record in g. Default: 1; with `units` and a header that names a unit, the factor from that unit to
    /// the deck's. (table)
    pub scale: Maybe<f64>,
    /// Unit of the values of a file, such as "g", "m/s2", "cm/s2", "m/s" or "cm". rdsolve converts them to `units`. Every `scale` is then a
    /// factor on the whole record. Default: that of the header. (table)
    pub unit: Maybe<String>,
    /// Time shift of all points. Default: 0; a file of `base_acceleration` whose times begin at 0 begins with the first dynamic stage.
    /// (table)
    pub shift: Maybe<f64>,
    /// Value before the first time. Default: the first value, with a warning if it is not zero and the run starts earlier. (table)
    pub before: Maybe<Beyond>,
    /// Value after the last time. Default: the last value, with a warning if it is not zero and the run continues; a file that moves the ground
    /// alone falls to zero over one more interval. (table)
    pub after: Maybe<Beyond>,
    /// Name of the stage from whose start the times count. Default: they are times of the run.
    pub stage: Maybe<String>,
    /// Cycles per unit of time, above 0. (sine, sine-squared)
    pub frequency: Maybe<f64>,
    /// Radians per unit of time, above 0, instead of `frequency`. (sine, sine-squared)
    pub angular_frequency: Maybe<f64>,
    /// Phase in radians. Default: 0. (sine, harmonic)
    pub phase: Maybe<f64>,
    /// Phase in degrees, instead of `phase`. (sine, harmonic)
    pub phase_degrees: Maybe<f64>,
    /// Time before which the function is zero. Default: 0. (sine, sine-squared, ramp, step)
    pub start: Maybe<f64>,
    /// Time after which the function is zero; a ramp ends there at 1 and stays. Default: never; a ramp needs
    /// it. (sine, sine-squared, ramp, step)
    pub end: Maybe<f64>,
}

/// The function of time of an amplitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AmplitudeKind {
    /// Lines or curves through `points`, or through those of a `file`.
    Table,
    /// sin(w (t - start) + phase) from `start` to `end`.
    Sine,
    /// sin^2(w (t - start)) from `start` to `end`.
    SineSquared,
    /// From 0 at `start` linearly to 1 at `end`, then 1.
    Ramp,
    /// 1 from `start` to `end`, otherwise 0.
    Step,
    /// 1 at all times.
    Constant,
    /// cos(w t + phase) at each frequency of a frequency response, which alone has any.
    Harmonic,
}

/// The curve between the points of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// A spline of cubics with continuous second derivatives, at rest where the values rest.
    Cubic,
    /// A spline of cubics with continuous second derivatives, which are zero at both ends.
    Natural,
    /// A spline of cubics with continuous second derivatives, at rest at both ends.
    Clamped,
    /// Cubics with continuous first derivatives that do not overshoot, at rest at both ends.
    Monotone,
}

/// Beyond the ends of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Beyond {
    /// The value at the end is held.
    Hold,
    /// Zero: the value jumps at the end.
    Zero,
}
