//! `[[links]]`: springs, dampers and gaps between two points.

use schemars::JsonSchema;
use serde::Deserialize;

use super::hysteresis::{Deterioration, Pinching};
use super::part_damping::SpringDamping;
use super::part_table::PartTable;
use super::words::{Maybe, Names, NumberOrTable, Numbers, Table, Vector};
use base::diagnostic::At;

/// A spring and damper between two ends, along the line between them, along a direction, or a bushing.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Link {
    /// Name, for messages, results and `[[expect]]`.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// The first end.
    #[schemars(required)]
    pub from: Maybe<Table<End>>,
    /// The second end.
    #[schemars(required)]
    pub to: Maybe<Table<End>>,
    /// Force against elongation. Default: "linear".
    pub law: Maybe<LinkLaw>,
    /// Force per elongation, above 0; of a linear link also 0. Of an isolator, force per displacement across its first axis before it slips or
    /// yields. (linear, compression-only, tension-only, yielding, bouc-wen, ibarra-medina-krawinkler, friction-pendulum, lead-rubber)
    pub stiffness: Maybe<f64>,
    /// Force per rate of elongation, 0 or more, or `{ beta, viscous }`. Default: 0, and beta of `[damping]`.
    pub damping: Maybe<NumberOrTable<Table<SpringDamping>>>,
    /// Free play before the link acts, a length of 0 or more. Default: 0. (compression-only, tension-only)
    pub gap: Maybe<f64>,
    /// Force at first yield, above 0. (yielding, bouc-wen, ibarra-medina-krawinkler, lead-rubber)
    pub yield_force: Maybe<f64>,
    /// Slope beyond yielding, 0 or more, below `stiffness`. Default: 0. (yielding, bouc-wen, ibarra-medina-krawinkler,
    /// lead-rubber)
    pub post_yield_stiffness: Maybe<f64>,
    /// [[elongation, force], ...], up to 6, from first yield on, instead of `stiffness` and the yield keys. The curve of first loading is
    /// symmetric, each line less steep than the one before, and constant after the last. Unloading follows it twice as large. (yielding)
    /// Of pinching, up to 3 points, which may fall; beyond the last the force is constant.
    pub backbone: Maybe<Vec<At<Numbers<2>>>>,
    /// How yielding in one sense changes that in the other. Default: "kinematic". (yielding)
    pub hardening: Maybe<LinkHardening>,
    /// How sharp the knee at yielding is, 1 or more. Default: 2. (bouc-wen)
    pub exponent: Maybe<f64>,
    /// Share of the unloading term, 0.5 to 1: 0.5 unloads along the first slope, more bulges. Default: 0.5. (bouc-wen)
    pub unloading: Maybe<f64>,
    /// Loss of strength by the energy of hysteresis, in units of yield force times yield elongation, 0 or more. Default: 0. (bouc-wen)
    pub strength_loss: Maybe<f64>,
    /// Loss of stiffness, likewise. Default: 0. (bouc-wen)
    pub stiffness_loss: Maybe<f64>,
    /// Capping of the backbone, and its deterioration with dissipation. (ibarra-medina-krawinkler)
    pub deterioration: Maybe<Table<Deterioration>>,
    /// Reloading towards the largest elongation so far. (pinching)
    pub pinching: Maybe<Table<Pinching>>,
    /// Force per displacement along the first of `axes`, above 0: in compression of a pendulum, in both senses of rubber.
    /// (friction-pendulum, lead-rubber)
    pub axial_stiffness: Maybe<f64>,
    /// Effective radius of the dish, above 0. The force N u/R restores the slider, which rises by u²/2R. (friction-pendulum)
    pub radius: Maybe<f64>,
    /// Coefficient of friction of the slider, 0 or more, or { slow, fast, rate }. (friction-pendulum)
    pub friction: Maybe<NumberOrTable<Table<SlidingFriction>>>,
    /// Force at zero elongation, tension positive. Default: 0. (linear)
    pub preload: Maybe<f64>,
    /// Force of tightening, not 0, tension positive. The link is tightened in its first stage, which is static, or in a static analysis.
    /// The length taken up is kept in later stages, as by a tightened nut. (linear, table, tension-only without `gap`)
    pub pretension: Maybe<f64>,
    /// Length without force, or projection without force along `direction`. Default: as the ends lie at t = 0.
    pub free_length: Maybe<f64>,
    /// Fixed global direction from `from` to `to`, for coincident points and bumpers. Default: along the line
    /// between the ends, which turns round when one end passes the other.
    pub direction: Maybe<Vector>,
    /// [[elongation, force], ...], two or more, elongations increasing; tension positive. (table)
    pub points: Maybe<Vec<At<Numbers<2>>>>,
    /// Six stiffnesses [x, y, z, about x, about y, about z] in the frame of the first end, force per length and moment per radian, instead
    /// of a law. The ends may turn without limit about the axis whose stiffness differs from the other two, or else the softest, and full
    /// turns count. About other axes a run ends at half a turn.
    pub bushing: Maybe<Numbers<6>>,
    /// Six damping values of the bushing, force per velocity and moment per angular velocity. Default: 0.
    pub bushing_damping: Maybe<Numbers<6>>,
    /// Full matrices of a bearing or mount, instead of a law or a bushing. One table, or several by rising `speed`. The first of `axes` is that
    /// of the shaft, which may turn without limit.
    pub matrices: Maybe<Vec<At<Table<LinkMatrices>>>>,
    /// Failure forces of the link, after which it carries nothing. Default: it does not.
    pub failure: Maybe<Table<Failure>>,
    /// Names of the stages in which it acts. Default: all.
    pub stages: Maybe<Names>,
    /// Axes of the bushing, bearing or isolator, global at t = 0: its x, and a vector in its x-y plane. They turn with the first end. The x axis of
    /// an isolator is normal to its dish or layers, from `from`, which holds the dish, to `to`. Default: global axes; required for isolators.
    pub axes: Maybe<Vec<Vector>>,
}

impl PartTable for Link {
    fn name(&self) -> Option<&At<String>> {
        self.name.as_ref()
    }

    fn members(&self) -> Vec<&At<String>> {
        [&self.from, &self.to].into_iter().flatten().filter_map(|end| end.node.as_ref()).collect()
    }
}

/// A link fails where (normal force/`normal`)^a + (shear force/`shear`)^b reaches 1. The normal force is the tension of the link, of a
/// bushing along its first axis; compression does not count. The shear force is that of a bushing along its other axes.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Failure {
    /// Normal force of failure without shear, above 0. Default: tension does not harm it.
    pub normal: Maybe<f64>,
    /// Shear force of failure without tension, above 0. Default: shear does not harm it. (bushing)
    pub shear: Maybe<f64>,
    /// The exponents [a, b], above 0. Default: [2.0, 2.0].
    pub exponents: Maybe<Numbers<2>>,
}

/// The matrices of a link: force on the second end by its motion relative to the first, with the sign of a spring. Two rows stand for y and
/// z, across the first axis; three for x, y and z; six for x, y, z and rotations about them. They need not be symmetric.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinkMatrices {
    /// Angular velocity of the second end relative to the first about the first axis, 0 or more, of either sign. Between two speeds matrices are
    /// interpolated, beyond the ends they stay. Required with several tables.
    pub speed: Maybe<f64>,
    /// Rows of the stiffness, force per length, and per radian; moments likewise. Row and column of the rotation about the first axis are 0.
    pub stiffness: Maybe<Vec<At<Vec<f64>>>>,
    /// Rows of the damping, force per velocity and per angular velocity; moments likewise. Default: 0.
    pub damping: Maybe<Vec<At<Vec<f64>>>>,
}

/// Friction of a slider, which grows with its speed: at a speed v the coefficient is fast − (fast − slow) exp(−rate v).
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlidingFriction {
    /// Coefficient at rest, 0 or more.
    #[schemars(required)]
    pub slow: Maybe<f64>,
    /// Coefficient at a high speed, 0 or more.
    #[schemars(required)]
    pub fast: Maybe<f64>,
    /// Time per length, above 0.
    #[schemars(required)]
    pub rate: Maybe<f64>,
}

/// `{ node = "name" }`, `{ body = "name", point = [x, y, z] }` or `{ ground = [x, y, z] }`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct End {
    /// Name of a point.
    pub node: Maybe<String>,
    /// Name of a body.
    pub body: Maybe<String>,
    /// The point of the body, global coordinates at t = 0. Default: its centre of mass.
    pub point: Maybe<Vector>,
    /// A point fixed in space, global coordinates.
    pub ground: Maybe<Vector>,
}

/// Hardening of a link that yields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LinkHardening {
    /// Unloading follows the backbone twice as large.
    #[default]
    Kinematic,
    /// The yield force grows with the plastic path, in both senses alike.
    Isotropic,
}

/// The law of the force over the elongation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LinkLaw {
    /// Force proportional to elongation, with a preload.
    Linear,
    /// Straight lines through `points`; the slopes at the ends go on.
    Table,
    /// Linear when shortened by more than the gap, otherwise without force: a bumper.
    CompressionOnly,
    /// Linear when lengthened by more than the gap, otherwise without force: a rope.
    TensionOnly,
    /// Straight lines with hardening: a yielding damper, an isolator, a moment connection.
    Yielding,
    /// The smooth hysteresis of Bouc and Wen, with loss of strength and stiffness: an isolator, a wire rope, a wall.
    BoucWen,
    /// Straight lines that fall beyond a cap, with deterioration by dissipation: steel that buckles or tears, a joint of a frame near collapse.
    IbarraMedinaKrawinkler,
    /// Straight lines that aim at the largest elongation so far and pinch before: cracked concrete, timber, a loose joint.
    Pinching,
    /// A slider on a spherical dish: restoring force and friction by the compression of the instant, in all directions across the first of `axes`.
    /// Lifted off, it carries nothing. It has no moments of its own; add a `bushing` for them.
    FrictionPendulum,
    /// Rubber with a lead core: shear that yields on a circle, and a linear spring along the first of `axes`. Beta of damping acts on
    /// `axial_stiffness` and `post_yield_stiffness`.
    LeadRubber,
}
