//! The distance joint keeps the distance of its ends: a rigid rod without mass between two spherical joints.

use super::kind::{JointKind, MakeJoint, no_axis};
use crate::constraints::joint::ConstraintEquation;

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "distance",
    aliases: &[],
    guesses: &["rod", "rigid-link"],
    about: "All is free but the distance of the ends: a rigid rod without mass. 1 constraint equation.",
    keys: &[],
    make: MakeJoint {
        axes: no_axis,
        ends_meet: false,
        equations: |_, d, _| vec![ConstraintEquation::Distance { length: d.norm() }],
        coordinates: &[],
        carries_across: false,
    },
};
