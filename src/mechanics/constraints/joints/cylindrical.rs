//! The cylindrical joint allows rotation about and displacement along its axis.

use super::kind::{AXIS, Coordinate, JointKind, MakeJoint, one_axis, sliding};
use crate::constraints::joint::rotations;

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "cylindrical",
    aliases: &["cylinder"],
    guesses: &[],
    about: "The rotation about `axis` and the displacement along it are free. 4 constraint equations.",
    keys: &[AXIS],
    make: MakeJoint {
        axes: one_axis,
        ends_meet: true,
        equations: |axes, d, _| sliding(axes, d, rotations([false, true, true], axes)),
        coordinates: &[Coordinate::Distance, Coordinate::Angle],
        carries_across: true,
    },
};
