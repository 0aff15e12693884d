//! `[[joints]]`: constraints between two bodies or points.

use schemars::JsonSchema;
use serde::Deserialize;

use super::hysteresis::{Deterioration, Pinching};
use super::links::End;
use super::part_damping::SpringDamping;
use super::words::kinds::Kinds;
use super::words::{Maybe, Names, NumberOrTable, Numbers, Table};
use base::diagnostic::At;
use mechanics::constraints::joints::kind::{Coordinate, MakeJoint};
use mechanics::constraints::joints::{JOINTS, JointKind};

/// Two ends that may move against each other only as the kind of joint allows; Lagrange multipliers hold them.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Name, for messages, results and `[[expect]]`.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// The first end.
    #[schemars(required)]
    pub from: Maybe<Table<End>>,
    /// The second end. On a body its `point` may be omitted: it is then at the place of `from` (not with "distance").
    #[schemars(required)]
    pub to: Maybe<Table<End>>,
    /// Names of the stages in which it acts; it joins its ends as it finds them. Default: all.
    pub stages: Maybe<Names>,
    /// Coordinate for the keys below, if a joint has two: "angle" about `axis` in radians, with turns counted, or "distance" along it. It
    /// is that of `to` from `from`, zero at t = 0. Default: "angle" of a screw, "distance" of a cylindrical joint. (revolute, prismatic,
    /// cylindrical, screw, planar, in-line; the same for all that follows)
    pub coordinate: Maybe<Coordinate>,
    /// Prescribes the coordinate; joints.csv has the effort and the power.
    pub motion: Maybe<Table<JointMotion>>,
    /// Ties the coordinate to that of another joint, as gears, belts, racks and pinions do.
    pub gear: Maybe<Table<JointGear>>,
    /// A force or moment along the coordinate, on `to` and as much against it on `from`: a motor.
    pub effort: Maybe<Table<Effort>>,
    /// Force per length, or moment per radian, of a spring along the coordinate, 0 or more. Default: 0.
    pub stiffness: Maybe<f64>,
    /// Coordinate of the unloaded spring. Default: 0.
    pub rest: Maybe<f64>,
    /// Force per velocity, or moment per angular velocity, of a damper along the coordinate, 0 or more, or `{ beta, viscous }`.
    /// Default: 0, and beta of `[damping]`.
    pub damping: Maybe<NumberOrTable<Table<SpringDamping>>>,
    /// The least and the largest coordinate, between stops on either side; they hold 0, where the joint starts.
    pub limits: Maybe<Numbers<2>>,
    /// Force per length, or moment per radian, of the stops, above 0. Required with `limits`.
    pub limit_stiffness: Maybe<f64>,
    /// Part of the speed that an impact on a stop gives back, from 0.01 to 1. Default: 1.
    pub restitution: Maybe<f64>,
    /// Coefficient of dry friction, 0 or more: it slips at this times the force that the joint carries across its axis, for an angle times
    /// `radius` too. Default: 0. (revolute, prismatic, cylindrical, in-line)
    pub friction: Maybe<f64>,
    /// Radius of the pin on which friction of an angle acts, above 0.
    pub radius: Maybe<f64>,
    /// Dry friction against an angle: slip moment, 0 or more, independent of the joint's load. Default: 0.
    pub friction_moment: Maybe<f64>,
    /// Dry friction against a distance: slip force, 0 or more, independent of the joint's load. Default: 0.
    pub friction_force: Maybe<f64>,
    /// Yield moment of a hinge, above 0. `stiffness` is required and is the slope up to it, `post_yield_stiffness` the slope beyond, with
    /// kinematic hardening.
    pub yield_moment: Maybe<f64>,
    /// Yield force of a joint along a distance, likewise.
    pub yield_force: Maybe<f64>,
    /// Slope of moment or force beyond yielding, 0 or more, below `stiffness`. Default: 0. (with `yield_moment`, `yield_force`)
    pub post_yield_stiffness: Maybe<f64>,
    /// [[coordinate, moment or force], ...], up to 6, from first yield on, instead of `stiffness` and the yield keys. The curve of first
    /// loading is symmetric, each line less steep than the one before, and constant after the last. Unloading and reloading follow it twice
    /// as large.
    pub backbone: Maybe<Vec<At<Numbers<2>>>>,
    /// Capping of the backbone, and its deterioration with dissipation. (with `yield_moment`, `yield_force`)
    pub deterioration: Maybe<Table<Deterioration>>,
    /// Reloading towards the largest coordinate so far. The `backbone` has up to 3 points, and may fall. (with `backbone`)
    pub pinching: Maybe<Table<Pinching>>,
    /// By how much the joint gives before friction slips, above 0: what sticks is held by a stiff spring, and comes back. Default:
    /// 1e-4 radians, or 1e-5 of the size of the scene.
    pub stick: Maybe<f64>,
}

/// A prescribed coordinate, or its rate, as a function of time: one of the three quantities times an amplitude.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointMotion {
    /// Coordinate for the amplitude 1, which the amplitude must then give; it begins at zero.
    pub position: Maybe<f64>,
    /// Rate of the coordinate for the amplitude 1; integrated from zero on.
    pub velocity: Maybe<f64>,
    /// Second rate of the coordinate for the amplitude 1; integrated twice, from rest.
    pub acceleration: Maybe<f64>,
    /// Name of an amplitude. Default: constant (velocity, acceleration).
    pub amplitude: Maybe<String>,
}

/// A joint whose coordinate is always a multiple of that of another joint, without play.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointGear {
    /// Name of the other joint; it may be geared itself, to a third one.
    #[schemars(required)]
    pub joint: Maybe<String>,
    /// This coordinate per that of the other joint, not zero: radians per radian, or lengths. Negative for outer gears about parallel axes,
    /// positive for a belt over pulleys.
    #[schemars(required)]
    pub ratio: Maybe<f64>,
}

/// A force or moment between the ends of a joint.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Effort {
    /// Force along the axis, or moment about it, on `to`.
    #[schemars(required)]
    pub value: Maybe<f64>,
    /// Name of an amplitude that multiplies it. Default: constant in a dynamic analysis, growing linearly to the end time in a static
    /// one.
    pub amplitude: Maybe<String>,
}

impl Kinds for Joint {
    const CHOOSER: &'static str = "kind";
    const ABOUT: &'static str = "What the joint leaves free.";
    const REQUIRED: bool = true;
    type Make = MakeJoint;

    fn list() -> &'static [&'static JointKind] {
        JOINTS
    }
}
