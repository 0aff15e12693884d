//! `[[expect]]`: values the run must reach.

use schemars::JsonSchema;
use serde::Deserialize;

use super::analysis::DisplacementTarget;
use super::words::{Maybe, Table, TimeOrEnd};

/// A value that is checked at the end of the run; a miss ends it with exit code 5.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Name of a point, body, beam, bar, shell, link, joint, contact or drift, of a set with supports, "energy", or "analysis" for its time.
    /// Required without `mode`.
    pub at: Maybe<String>,
    /// Instead of `at`: number of a mode, 1 or more; the quantity is then a column of modes.csv, and needs no time.
    pub mode: Maybe<u64>,
    /// Instead of `at`: number of a critical speed among those of every kind, torsion included, the lowest 1; the quantity is then a column of critical_speeds.csv.
    pub critical_speed: Maybe<u64>,
    /// A column of nodes.csv, bodies.csv, links.csv, contacts.csv, joints.csv, drifts.csv or energy.csv. For a joint, "fx" to "mz" act on its
    /// first part (`from`). For a supported point, body or set they are the reaction of its supports on the structure. For a contact "force", and
    /// for a joint "force" and "moment", are magnitudes. Section forces of a beam ("N" to "Mz"), a bar ("N") or a shell ("N11" to "Q2") are those of
    /// largest magnitude in the part, with
    /// sign; so are "von_mises_bottom" and "von_mises_top". "sigma_max", "tau_max", "von_mises" and "plastic_strain" are the largest in the part.
    /// "sigma_min" is the smallest.
    #[schemars(required)]
    pub quantity: Maybe<String>,
    /// In a linear analysis with `[[load_cases]]`, instead of `time`: name of a load case or combination. With `peak` the extreme is taken
    /// over all cases instead.
    pub case: Maybe<String>,
    /// Time of the value, or "end" for that of the run, or of its `stage`; with arc-length control, the first time the load reaches it.
    pub time: Maybe<TimeOrEnd>,
    /// With arc-length control, instead of `time`: where a displacement passes a value. A step ends there.
    pub when: Maybe<Table<DisplacementTarget>>,
    /// Instead of `time`, in a frequency response: the frequency, which is computed besides those of `[analysis]`. The quantity is then a
    /// column of response.csv, or for a link of response_links.csv.
    pub frequency: Maybe<f64>,
    /// An extreme over the whole run, or over all frequencies, instead of `time`.
    pub peak: Maybe<Peak>,
    /// Name of a stage. A `value` is that at its end. `peak` and bounds take an extreme of the stage, and the inherited state counts. With
    /// `time = "end"` a bound is one of the value at the end.
    pub stage: Maybe<String>,
    /// The expected value. Left out with a bound.
    pub value: Maybe<f64>,
    /// Lower bound, instead of `value` and its tolerance; over the whole run or `stage` where neither `time` nor `peak` says when.
    pub at_least: Maybe<f64>,
    /// Upper bound, instead of `value` and its tolerance; over the whole run or `stage` where neither `time` nor `peak` says when.
    pub at_most: Maybe<f64>,
    /// Tolerance relative to the value, above 0.
    pub tolerance: Maybe<f64>,
    /// Absolute tolerance, above 0, instead of a relative one.
    pub absolute_tolerance: Maybe<f64>,
    /// Where the value comes from: author, year, table or figure.
    pub source: Maybe<String>,
}

impl Expect {
    /// True for a value of a mode or of a critical speed, which has no time.
    pub fn is_of_modes(&self) -> bool {
        self.mode.is_some() || self.critical_speed.is_some()
    }
}

/// An extreme value over the whole run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Peak {
    /// The greatest value.
    Max,
    /// The least value.
    Min,
    /// The value, with its sign, where it is greatest in size; bounds are those of the size.
    Abs,
}
