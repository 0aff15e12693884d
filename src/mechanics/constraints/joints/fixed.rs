//! The fixed joint welds the ends together.

use super::kind::{JointKind, MakeJoint, meeting, no_axis};
use crate::constraints::joint::rotations;

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "fixed",
    aliases: &["weld"],
    guesses: &["welded", "clamp", "rigid", "lock"],
    about: "Nothing is free: the ends are welded together. 6 constraint equations.",
    keys: &[],
    make: MakeJoint {
        axes: no_axis,
        ends_meet: true,
        equations: |axes, d, _| meeting(d, rotations([true; 3], axes)),
        coordinates: &[],
        carries_across: false,
    },
};
