//! The actuator sets the distance of its ends: a cylinder or a spindle without mass between two spherical joints.

use super::kind::{Coordinate, JointKind, MakeJoint, no_axis};

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "actuator",
    aliases: &[],
    guesses: &["hydraulic", "hydraulic-cylinder", "linear-actuator", "spindle"],
    about: "All is free; its coordinate is the distance of the ends less that at t = 0. No constraint equation without `motion`.",
    keys: &[],
    make: MakeJoint {
        axes: no_axis,
        ends_meet: false,
        equations: |_, _, _| Vec::new(),
        coordinates: &[Coordinate::Length],
        carries_across: false,
    },
};
