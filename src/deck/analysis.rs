//! `[analysis]`, `[integrator]` and `[iteration]`: duration, scheme, solution of each step.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::kinds::Kinds;
use super::words::{Frequencies, Maybe, NumberOrAuto, Table};
use base::math::rotation::RotationUpdate;
use mechanics::integrators::SCHEMES;
use mechanics::integrators::scheme::{MakeScheme, SchemeKind};

/// Kind and duration of the analysis.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Analysis {
    /// What is computed.
    #[schemars(required)]
    pub kind: Maybe<AnalysisKind>,
    /// Displacements that count in a static analysis. Default: "finite".
    pub geometry: Maybe<Geometry>,
    /// How a static analysis advances along its path. Default: "time".
    pub control: Maybe<Control>,
    /// The run goes from t = 0 to this time, above 0; with arc-length control until the load first reaches it. Required for "dynamic" and
    /// "static"; with control = "displacement" the time at which loads without amplitude have their value, 1 by default.
    pub end_time: Maybe<f64>,
    /// Length of the time steps, above 0, or "auto": as long as `error_tolerance` allows, with central-difference as long as is stable. Without a
    /// scheme and an error, "auto" chooses central-difference for blows of deformable parts. With arc-length control the length of the first step,
    /// which sets the arc length of the others. Required for "dynamic" without `accuracy` and for "static", without effect with control = "displacement".
    pub time_step: Maybe<NumberOrAuto>,
    /// Error of the results from time steps, iteration, mesh and contact stiffness together, relative to the largest change of each
    /// result; between 0 and 1. Pilot runs choose what meets it. Results are displacements of `[output]` nodes and of bodies, rotations of
    /// bodies, and the quantities of `[[expect]]`. In dynamics it replaces `time_step`; in statics `time_step` is the longest step.
    pub accuracy: Maybe<f64>,
    /// With time_step = "auto": error of displacements at the end of the run caused by the steps, relative to the largest displacement;
    /// between 0 and 1. Default: 1e-3; with `accuracy` its part for the steps.
    pub error_tolerance: Maybe<f64>,
    /// Shortest step, above 0: a step that does not converge is halved, but not below this. Default: time_step
    /// / 2^20; with an automatic step end_time / 10^9.
    pub least_step: Maybe<f64>,
    /// With arc-length control: the run ends where a displacement passes a value, or at `end_time`. Required with control = "displacement":
    /// the steps move this displacement to its value, and the run ends there alone, whatever the load factor becomes.
    pub stop: Maybe<Table<DisplacementTarget>>,
    /// With control = "displacement": the displacement of each step, above 0. Default: a hundredth of the value of `stop`.
    pub increment: Maybe<f64>,
    /// With arc-length control: the run ends after this number of steps, 1 or more. Default: it fails after 100000.
    pub steps: Maybe<u64>,
    /// With arc-length control: the arc length grows to at most this multiple of the first. Default: no limit.
    pub growth: Maybe<f64>,
    /// Whether motion out of a global plane is omitted where nothing can cause it. Default: "auto"; "off" for modes, which may lead
    /// anywhere.
    pub plane: Maybe<Plane>,
    /// With "modal" and "buckling": number of modes, the lowest, 1 or more. Default: 10. With "frequency-response" and method = "modal":
    /// number of those that answer with their inertia. Default: all up to four times the highest frequency.
    pub modes: Maybe<u64>,
    /// With "modal" and "frequency-response", instead of `modes`: all modes up to this frequency, above 0.
    pub up_to: Maybe<f64>,
    /// With "modal": complex modes, with damping and the gyroscopic moments of bodies that spin. Default: false.
    pub damped: Maybe<bool>,
    /// With "modal" and damped = true: speeds of rotation of the body that spins fastest at t = 0; other bodies spin in proportion. campbell.csv
    /// has the modes at each, critical_speeds.csv the critical speeds among them.
    pub speeds: Maybe<Table<SpeedRange>>,
    /// With "frequency-response": a frequency, a list of them, or { from, to, steps }; cycles per unit of time. Frequencies that
    /// `[[expect]]` names are added.
    pub frequencies: Maybe<Frequencies>,
    /// With "frequency-response": how it is found. Default: "direct".
    pub method: Maybe<ResponseWord>,
    /// With "frequency-response" and method = "modal": damping ratio of every mode, in addition to dampers; 0 or more. Default: 0.
    pub damping_ratio: Maybe<f64>,
}

/// The displacements that count in a static analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Geometry {
    /// Displacements and rotations of any size: equilibrium of the deformed structure, found by iteration.
    #[default]
    Finite,
    /// Infinitesimal displacements: one factorization of the stiffness at t = 0 serves all loads, and results are proportional to loads.
    /// Materials are elastic, and loads keep their directions. `end_time` and `time_step` may be left out; the analysis then has one
    /// instant, t = 1.
    Linear,
}

/// Method of a frequency response.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ResponseWord {
    /// Solves the equations at each frequency, with dampers, follower loads and spinning bodies.
    #[default]
    Direct,
    /// By natural modes; all others answer as springs. The cost hardly depends on the number of frequencies.
    Modal,
}

/// Speeds of rotation, evenly spaced, in radians per unit of time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeedRange {
    /// The lowest speed, 0 or more. Default: 0.
    pub from: Maybe<f64>,
    /// The highest speed, above `from`.
    #[schemars(required)]
    pub to: Maybe<f64>,
    /// Number of speeds, both ends among them, 2 to 10000. Default: 21.
    pub steps: Maybe<u64>,
}

/// The quantity that steps advance by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Control {
    /// Time advances in given steps, and loads with it.
    Time,
    /// Steps have a given arc length in displacements; time, which drives the loads, follows and may fall: through limit points,
    /// snap-through and snap-back.
    ArcLength,
    /// Steps move the displacement of `stop` by equal increments; time, which drives the loads, follows and may fall: pushover with a
    /// pattern of loads. Loads without an amplitude all belong to the pattern, weight too; those with one of kind "constant" stay.
    Displacement,
}

/// A target displacement: a step ends when the displacement passes this value.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DisplacementTarget {
    /// Name of a point or body.
    #[schemars(required)]
    pub at: Maybe<String>,
    /// The displacement.
    #[schemars(required)]
    pub quantity: Maybe<Displacement>,
    /// The value that it passes, in units of length.
    #[schemars(required)]
    pub value: Maybe<f64>,
    /// Which of its passages through the value is meant, from either side, 1 or more. Default: 1.
    pub pass: Maybe<u64>,
    /// Of `stop`: false for a limit that need not be reached. Default: true, and a path that ends before it ends the run with exit code 5.
    pub required: Maybe<bool>,
}

/// A displacement by its direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Displacement {
    /// Displacement along global x.
    Ux,
    /// Displacement along global y.
    Uy,
    /// Displacement along global z.
    Uz,
}

/// The kind of analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AnalysisKind {
    /// Motion in time.
    #[default]
    Dynamic,
    /// Load stepping without inertia; a load without an amplitude grows linearly from 0 at t = 0 to 1 at the end time.
    Static,
    /// Natural modes about the equilibrium under the loads at t = 0.
    Modal,
    /// Load factors of the loads at t = 0 at which the structure buckles, by linear buckling analysis.
    Buckling,
    /// Amplitude and phase of the steady motion under an `unbalance`, or under loads and supports with amplitudes of kind "harmonic". All other loads
    /// hold the equilibrium at t = 0.
    FrequencyResponse,
}

/// The treatment of motion out of a global plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Plane {
    /// Omitted where nothing can cause it.
    Auto,
    /// Always computed.
    Off,
}

/// The time integration scheme, with its parameters beside it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Integrator {
    /// How rotations follow from their increments in a step. Default: "exponential", which is exact. Not with runge-kutta.
    pub rotation_update: Maybe<RotationUpdate>,
    /// With central-difference: the rotary inertia of thin shells and slender beams. Default: "rotary".
    pub mass_scaling: Maybe<RotaryInertia>,
}

impl Kinds for Integrator {
    const CHOOSER: &'static str = "scheme";
    const ABOUT: &'static str = "The scheme that integrates the motion in time. Default: \"wilson-theta\".";
    const REQUIRED: bool = false;
    type Make = MakeScheme;

    fn list() -> &'static [&'static SchemeKind] {
        SCHEMES
    }
}

/// How the equations of a step are solved.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Iteration {
    /// The stiffness matrix where material yields. Default: "auto".
    pub method: Maybe<Method>,
    /// When the matrix is formed and factorised. Default: "auto".
    pub update: Maybe<Update>,
    /// Whether the gyroscopic term of bodies enters the matrix; the converged result is the same. Default: "auto".
    pub gyroscopic: Maybe<Gyroscopic>,
    /// Convergence tolerance, relative, on the residual and on the increment; between 0 and 1. Default: 1e-8. With deformable parts and
    /// equal steps of a dissipating scheme of second order: 1/10,000 of the first correction of the step, from 1e-8 to 1e-5. Equal steps of
    /// every scheme use the smaller of this value and that part. Automatic steps use the smaller of this value and their own rule. Paths of
    /// parts that yield, by arc length or displacement: 1e-5.
    pub tolerance: Maybe<f64>,
    /// Iterations after which a step is cut back, 1 or more. Default: 20; 200 with initial-load.
    pub limit: Maybe<u64>,
}

/// Moduli of the stiffness matrix for material that yields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Newton's method with the algorithmic (consistent) tangent.
    TangentStiffness,
    /// The elastic matrix is kept; plastic stresses go to the right-hand side.
    InitialLoad,
    /// The cheaper of the two, by counts of operations and the contraction observed.
    #[default]
    Auto,
}

impl Method {
    /// As the deck writes it.
    pub fn word(self) -> &'static str {
        match self {
            Method::TangentStiffness => "tangent-stiffness",
            Method::InitialLoad => "initial-load",
            Method::Auto => "auto",
        }
    }
}

/// Where the gyroscopic term of bodies stands; its derivative is not symmetric.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Gyroscopic {
    /// In the matrix if that is unsymmetric anyway.
    #[default]
    Auto,
    /// In the matrix, which is then unsymmetric: fewer iterations.
    Left,
    /// In the residual alone: the matrix may be symmetric.
    Right,
}

/// The rotary inertia of thin shells and slender beams in steps of central differences.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RotaryInertia {
    /// Raised without added mass, so that thickness does not limit the time step.
    #[default]
    Rotary,
    /// That of the sections: thickness limits the time step.
    Off,
}

/// When the matrix is formed and factorised anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Update {
    /// In every iteration.
    Iteration,
    /// Once in every step.
    Step,
    /// When convergence has slowed so far that a factorisation costs less than the iterations it saves.
    #[default]
    Auto,
    /// Once in the run.
    Never,
}
