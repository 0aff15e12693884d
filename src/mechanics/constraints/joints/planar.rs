//! The planar joint allows displacements in a plane and rotation about its normal.

use super::kind::{AXIS, Coordinate, JointKind, MakeJoint, in_plane, one_axis};
use crate::constraints::joint::rotations;

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "planar",
    aliases: &[],
    guesses: &["plane", "sliding-plane"],
    about: "The displacements across `axis` and the rotation about it are free: two plates that slide upon each other. 3 constraint \
            equations.",
    keys: &[AXIS],
    make: MakeJoint {
        axes: one_axis,
        ends_meet: true,
        equations: |axes, d, _| in_plane(axes, d).chain(rotations([false, true, true], axes)).collect(),
        coordinates: &[Coordinate::Angle],
        carries_across: false,
    },
};
