//! The description of a kind of joint, and what several kinds share.

use crate::constraints::angle::Angle;
use crate::constraints::joint::{ConstraintEquation, translations};
use base::math::{Mat3, Vec3};
use base::words::kinds::{Form, Given, Key, Kind, Values};
use schemars::JsonSchema;
use serde::Deserialize;

/// A kind of joint that the deck can name.
pub type JointKind = Kind<MakeJoint>;

/// The constraint equations of a kind of joint.
#[derive(Debug)]
pub struct MakeJoint {
    /// The joint's axes as columns, global at t = 0; the first is the axis that the deck gives. `None` where a key is wrong.
    pub axes: fn(&mut Given) -> Option<Mat3>,
    /// The two ends lie at the same place at t = 0; otherwise they must not.
    pub ends_meet: bool,
    /// The constraint equations, from the axes, from x_a − x_b at t = 0, and from the values of the kind's own keys.
    pub equations: fn(&Mat3, &Vec3, &Values) -> Vec<ConstraintEquation>,
    /// The coordinates that the joint may have; the first is its own unless the deck says otherwise. None if the free motion is neither
    /// about nor along its axis.
    pub coordinates: &'static [Coordinate],
    /// True if it carries a transverse force, like a pin or a rail, for friction.
    pub carries_across: bool,
}

/// The coordinate of a joint: by how much its second end has moved from its first since t = 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Coordinate {
    /// The angle about the axis, in radians, turns counted.
    Angle,
    /// The distance along the axis.
    Distance,
    /// The distance of the ends, less that at t = 0. (actuator)
    Length,
}

impl Coordinate {
    /// The equation that locks the coordinate; its violation is the coordinate. The first of the axes is the joint's; `d` is x_a − x_b at t
    /// = 0.
    pub fn lock(self, axes: &Mat3, d: &Vec3) -> ConstraintEquation {
        match self {
            Coordinate::Angle => ConstraintEquation::Angle(Angle::about_first(axes)),
            Coordinate::Distance => ConstraintEquation::distance_along(&axes.column(0).into_owned(), d),
            Coordinate::Length => ConstraintEquation::Distance { length: d.norm() },
        }
    }

    /// Its word in the deck.
    pub fn word(self) -> &'static str {
        match self {
            Coordinate::Angle => "angle",
            Coordinate::Distance => "distance",
            Coordinate::Length => "length",
        }
    }
}

/// The key of joints with one axis.
pub const AXIS: Key = Key {
    name: "axis",
    form: Form::Vector,
    about: "Axis of the relative rotation or translation of the ends, global at t = 0; it moves with the bodies. Any length.",
};

/// Axes of joints without an axis: the global axes.
pub fn no_axis(_: &mut Given) -> Option<Mat3> {
    Some(Mat3::identity())
}

/// The axes of joints with one axis; the other two are any that make a frame with it.
pub fn one_axis(given: &mut Given) -> Option<Mat3> {
    let x = given.require_unit("axis")?;
    // Any perpendicular direction serves; this uses the global axis most nearly perpendicular.
    let y = x.cross(&Vec3::ith(x.iamin(), 1.0)).normalize();
    Some(Mat3::from_columns(&[x, y, x.cross(&y)]))
}

/// Equations that keep the ends at one place, then others.
pub fn meeting(d: &Vec3, others: Vec<ConstraintEquation>) -> Vec<ConstraintEquation> {
    translations([true; 3], d).chain(others).collect()
}

/// Equations that keep the first end on the first axis through the second, then others.
pub fn sliding(axes: &Mat3, d: &Vec3, others: Vec<ConstraintEquation>) -> Vec<ConstraintEquation> {
    let across = (1..3).map(|i| axes.column(i).into_owned()).map(|e| ConstraintEquation::BodyAxis { e, at: d.dot(&e) });
    across.chain(others).collect()
}

/// The equation that keeps the first end in the plane across the first axis through the second.
pub fn in_plane(axes: &Mat3, d: &Vec3) -> impl Iterator<Item = ConstraintEquation> {
    let e = axes.column(0).into_owned();
    std::iter::once(ConstraintEquation::BodyAxis { e, at: d.dot(&e) })
}
