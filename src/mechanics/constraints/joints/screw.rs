//! The screw joint allows rotation about its axis, coupled to a displacement along it.

use super::kind::{AXIS, Coordinate, JointKind, MakeJoint, one_axis, sliding};
use crate::constraints::angle::Angle;
use crate::constraints::joint::{ConstraintEquation, rotations};
use base::math::{Mat3, Vec3};
use base::words::kinds::{Form, Given, Key, Values};

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "screw",
    aliases: &[],
    guesses: &["helical", "thread"],
    about: "The rotation about `axis` is free, and `to` goes along it by `lead` for each turn. 5 constraint equations.",
    keys: &[
        AXIS,
        Key {
            name: "lead",
            form: Form::Number,
            about: "Displacement of `to` along `axis` for each turn about it; negative for a left-hand thread, not zero.",
        },
    ],
    make: MakeJoint {
        axes: threaded_axis,
        ends_meet: true,
        equations: threaded,
        coordinates: &[Coordinate::Angle, Coordinate::Distance],
        carries_across: false,
    },
};

fn threaded_axis(given: &mut Given) -> Option<Mat3> {
    let lead = given.require("lead").and_then(|numbers| numbers.first().copied());
    let axes = one_axis(given);
    match lead? {
        0.0 => given.error("lead", "`lead` must not be zero"),
        _ => axes,
    }
}

fn threaded(axes: &Mat3, d: &Vec3, values: &Values) -> Vec<ConstraintEquation> {
    let e = axes.column(0).into_owned();
    let lead = values.numbers("lead").first().copied().unwrap_or(1.0);
    let mut equations = sliding(axes, d, rotations([false, true, true], axes));
    equations.push(ConstraintEquation::Screw { angle: Angle::about_first(axes), e, at: -d.dot(&e), lead });
    equations
}
