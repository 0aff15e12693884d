//! The spherical joint keeps the ends together and allows all rotations.

use super::kind::{JointKind, MakeJoint, meeting, no_axis};

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "spherical",
    aliases: &["ball"],
    guesses: &["ball-and-socket"],
    about: "Three rotations are free: a ball-and-socket joint. 3 constraint equations.",
    keys: &[],
    make: MakeJoint {
        axes: no_axis,
        ends_meet: true,
        equations: |_, d, _| meeting(d, Vec::new()),
        coordinates: &[],
        carries_across: false,
    },
};
