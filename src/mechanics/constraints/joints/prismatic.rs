//! The prismatic joint allows displacement along its axis.

use super::kind::{AXIS, Coordinate, JointKind, MakeJoint, one_axis, sliding};
use crate::constraints::joint::rotations;

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "prismatic",
    aliases: &["slider"],
    guesses: &["translational", "sliding"],
    about: "The displacement along `axis` is free. 5 constraint equations.",
    keys: &[AXIS],
    make: MakeJoint {
        axes: one_axis,
        ends_meet: true,
        equations: |axes, d, _| sliding(axes, d, rotations([true; 3], axes)),
        coordinates: &[Coordinate::Distance],
        carries_across: true,
    },
};
