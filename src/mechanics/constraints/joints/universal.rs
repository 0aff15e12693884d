//! The universal (Cardan, Hooke) joint allows rotation about the two arms of its cross, one arm on each end.

use super::kind::{JointKind, MakeJoint, meeting};
use crate::constraints::joint::rotations;
use base::math::Mat3;
use base::words::kinds::{Form, Given, Key};

/// The joint's word, keys and equations.
pub static KIND: JointKind = JointKind {
    word: "universal",
    aliases: &["cardan"],
    guesses: &["hooke", "u-joint"],
    about: "The rotations about `axis` and `cross_axis`, the two arms of a cross, are free. 4 constraint equations.",
    keys: &[
        Key {
            name: "axis",
            form: Form::Vector,
            about: "The arm of the cross that `from` carries, global at t = 0. Any length.",
        },
        Key {
            name: "cross_axis",
            form: Form::Vector,
            about: "The arm of the cross that `to` carries, global at t = 0, perpendicular to `axis`. Any length.",
        },
    ],
    make: MakeJoint {
        axes,
        ends_meet: true,
        equations: |axes, d, _| meeting(d, rotations([false, false, true], axes)),
        coordinates: &[],
        carries_across: false,
    },
};

/// The arms of a cross count as perpendicular below this cosine of their angle.
const SQUARE: f64 = 1e-6;

fn axes(given: &mut Given) -> Option<Mat3> {
    let (x, y) = (given.require_unit("axis"), given.require_unit("cross_axis"));
    let (x, y) = (x?, y?);
    if x.dot(&y).abs() > SQUARE {
        return given.error("cross_axis", "`cross_axis` must be perpendicular to `axis`");
    }
    let y = (y - x * x.dot(&y)).normalize();
    Some(Mat3::from_columns(&[x, y, x.cross(&y)]))
}
