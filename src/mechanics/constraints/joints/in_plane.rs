//! The in-plane joint keeps a point of one part in a plane that is fixed to the other.

use super::kind::{AXIS, JointKind, MakeJoint, in_plane, one_axis};

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "in-plane",
    aliases: &["point-on-plane"],
    guesses: &["inplane", "on-plane"],
    about: "All is free but the way of `from` along `axis`: a point in a plane that `to` carries. 1 constraint equation.",
    keys: &[AXIS],
    make: MakeJoint {
        axes: one_axis,
        ends_meet: true,
        equations: |axes, d, _| in_plane(axes, d).collect(),
        coordinates: &[],
        carries_across: false,
    },
};
