//! One error bar.

use base::snapshot::keep;
use serde::Serialize;

/// Of 1240 columns of 19 decks at three tolerances 94 % were within three times the error told at the time of the value itself, ...
const AT_THE_TIME: f64 = 3.0;
/// ... or this multiple of the largest at the times of comparison, whichever is larger.
const ANYWHERE: f64 = 1.5;

/// Where two runs differ by a larger part of a value, no order of convergence is to be relied on: the better one may be as wrong.
const ASYMPTOTIC: f64 = 0.1;

/// The largest value of a column with the errors that are left in it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorBar {
    /// The file of the table.
    pub table: &'static str,
    /// The column.
    pub column: &'static str,
    /// The subject of the row; empty for the whole scene.
    pub at: String,
    /// The time of the value.
    pub time: f64,
    /// The value of largest magnitude in the column, with its sign.
    pub value: f64,
    /// The estimated bound of the error by the steps; `None` if it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_error: Option<f64>,
    /// The same bound for the error by the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh_error: Option<f64>,
    /// The sum of both bounds, the largest in the column over all compared times and rows; `None` if the table is too large.
    pub anywhere: Option<f64>,
}

/// The error of a value, estimated by another run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Told {
    /// A bound of the error by estimate.
    pub error: Option<f64>,
    /// The largest error at any time that was compared.
    pub anywhere: Option<f64>,
}

keep!(Told: Default { error, anywhere });

impl Told {
    /// From the value of one run, that of the other at the same time if it is known, and the largest difference at any compared time. The
    /// errors of the other run are larger by the factor `apart`.
    pub fn by([value, other]: [Option<f64>; 2], anywhere: Option<f64>, apart: f64) -> Told {
        let at_the_time = value.zip(other).map(|(value, other)| (value - other).abs());
        let difference = value.zip(at_the_time.or(anywhere));
        let differs = difference.is_some_and(|(value, difference)| difference > ASYMPTOTIC * value.abs());
        let apart = if differs { apart.min(2.0) } else { apart };
        // Where the difference at the time itself is not known, the largest stands for it.
        let share = if at_the_time.is_some() { ANYWHERE } else { AT_THE_TIME };
        let [at_the_time, anywhere] = [at_the_time, anywhere].map(|difference| difference.map(|d| d / (apart - 1.0)));
        let bars = [at_the_time.map(|error| AT_THE_TIME * error), anywhere.map(|error| share * error)];
        Told { error: bars.into_iter().flatten().filter(|bar| bar.is_finite()).reduce(f64::max), anywhere }
    }
}
