//! The in-line joint keeps a point of one part on a line that is fixed to the other.

use super::kind::{AXIS, Coordinate, JointKind, MakeJoint, one_axis, sliding};

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "in-line",
    aliases: &["point-on-line"],
    guesses: &["inline", "on-line", "slot"],
    about: "All rotations are free, and the way of `from` along `axis`: a ball in a straight slot that `to` carries. 2 constraint \
            equations.",
    keys: &[AXIS],
    make: MakeJoint {
        axes: one_axis,
        ends_meet: true,
        equations: |axes, d, _| sliding(axes, d, Vec::new()),
        coordinates: &[Coordinate::Distance],
        carries_across: true,
    },
};
