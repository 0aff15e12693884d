//! `[[stages]]`: analyses in sequence, each from the state at the end of the stage before.

use schemars::JsonSchema;
use serde::Deserialize;

use super::analysis::{Control, Integrator, Iteration, ResponseWord, SpeedRange};
use super::words::kinds::OneOf;
use super::words::{Frequencies, Maybe, NumberOrAuto, Table};

/// A stage of a run. A stage starts from positions, rotations, plastic strains, contacts with friction, and multipliers of joints of the
/// stage before. A dynamic stage also inherits velocities. Time runs on.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Name, for `stages` of other tables, for results and messages.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// What is computed.
    #[schemars(required)]
    pub kind: Maybe<StageKind>,
    /// How long a static or dynamic stage lasts, above 0, unless it stops before. With control = "displacement" the time after which loads
    /// without amplitude have their value, 1 by default.
    pub duration: Maybe<f64>,
    /// Length of its time steps, or load steps, above 0; in a dynamic stage also "auto".
    pub time_step: Maybe<NumberOrAuto>,
    /// With time_step = "auto": as in `[analysis]`, over the stage. Default: that of `[analysis]`, or 1e-3.
    pub error_tolerance: Maybe<f64>,
    /// Shortest step, above 0. Default: that of `[analysis]`, or time_step / 2^20; with an automatic step duration / 10^9.
    pub least_step: Maybe<f64>,
    /// The stage ends where this is reached, or after `duration`. With control = "displacement" loads without amplitude grow beyond their
    /// value until it is reached; without such loads the stage ends after `duration` too.
    pub stop: Maybe<Table<Stop>>,
    /// With "static": how the stage advances. Default: "time". With "arc-length" and "displacement" the time follows the load, and `stop` is
    /// by a displacement.
    pub control: Maybe<Control>,
    /// As in `[analysis]`.
    pub increment: Maybe<f64>,
    /// As in `[analysis]`.
    pub steps: Maybe<u64>,
    /// As in `[analysis]`.
    pub growth: Maybe<f64>,
    /// With "modal" and "buckling", as in `[analysis]`: number of modes. Default: 10.
    pub modes: Maybe<u64>,
    /// With "modal", instead of `modes`: all modes up to this frequency, above 0.
    pub up_to: Maybe<f64>,
    /// With "modal": complex modes, with damping and gyroscopic moments. Default: false.
    pub damped: Maybe<bool>,
    /// As in `[analysis]`.
    pub speeds: Maybe<Table<SpeedRange>>,
    /// With "frequency-response", as in `[analysis]`.
    pub frequencies: Maybe<Frequencies>,
    /// With "frequency-response", as in `[analysis]`. Default: "direct".
    pub method: Maybe<ResponseWord>,
    /// With "frequency-response" and method = "modal", as in `[analysis]`. Default: 0.
    pub damping_ratio: Maybe<f64>,
    /// The time integration scheme of this stage. Default: that of `[integrator]`.
    pub integrator: Maybe<OneOf<Integrator>>,
    /// The iteration of this stage. Default: that of `[iteration]`.
    pub iteration: Maybe<Table<Iteration>>,
}

/// The kind of a stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StageKind {
    /// Load stepping without inertia. A load without an amplitude grows over its first static stage, and stays.
    Static,
    /// Motion in time. A load without an amplitude that first acts here acts at once.
    Dynamic,
    /// Natural modes about the state that has been reached. No time passes.
    Modal,
    /// Load factors at which the current state buckles under the loads that first act here. No time passes.
    Buckling,
    /// The steady motion under loads and supports with amplitudes of kind "harmonic", about the current state. No time passes.
    FrequencyResponse,
}

/// Where a stage ends before its time: `{ at = "crown", quantity = "uz", value = -0.1 }`, `{ load = "ram", work = 4375.0 }`,
/// `{ load = "ram", force = 2e5 }` or `{ time = 2.5 }`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// Name of a point or body.
    pub at: Maybe<String>,
    /// Its displacement or rotation, counted from t = 0.
    pub quantity: Maybe<StopQuantity>,
    /// The value that it passes, from either side.
    pub value: Maybe<f64>,
    /// Name of a load, or of a support with a motion.
    pub load: Maybe<String>,
    /// Work that it has done since the stage began.
    pub work: Maybe<f64>,
    /// Magnitude of the force that it exerts, above 0: the sum over its points.
    pub force: Maybe<f64>,
    /// Time of the run.
    pub time: Maybe<f64>,
    /// False for a limit that need not be reached: the stage then ends after `duration`. Default: true, and a stage that ends before it
    /// reaches the value ends the run with exit code 5.
    pub required: Maybe<bool>,
}

/// A displacement by its direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum StopQuantity {
    /// Displacement along global x.
    Ux,
    /// Displacement along global y.
    Uy,
    /// Displacement along global z.
    Uz,
    /// Component of the rotation vector along global x.
    Rx,
    /// Component of the rotation vector along global y.
    Ry,
    /// Component of the rotation vector along global z.
    Rz,
}
