//! The revolute joint allows rotation about its axis.

use super::kind::{AXIS, Coordinate, JointKind, MakeJoint, meeting, one_axis};
use crate::constraints::joint::rotations;

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "revolute",
    aliases: &["hinge"],
    guesses: &["pin", "pinned", "rotational"],
    about: "The rotation about `axis` is free. 5 constraint equations.",
    keys: &[AXIS],
    make: MakeJoint {
        axes: one_axis,
        ends_meet: true,
        equations: |axes, d, _| meeting(d, rotations([false, true, true], axes)),
        coordinates: &[Coordinate::Angle],
        carries_across: true,
    },
};
