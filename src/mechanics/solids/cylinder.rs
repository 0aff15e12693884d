//! The cylinder, solid or hollow.

use super::hollow::{self, AXIS, LENGTH, RADIUS};
use super::kind::SolidKind;
use base::words::kinds::{Form, Key};

/// The solid's word, keys and maker.
pub static KIND: SolidKind = SolidKind {
    word: "cylinder",
    aliases: &[],
    guesses: &["disc", "disk", "rod"],
    about: "A solid or hollow cylinder.",
    keys: &[
        RADIUS,
        Key { name: "inner_radius", form: Form::Number, about: "Inner radius. Default: 0, solid." },
        LENGTH,
        AXIS,
    ],
    make: |given| hollow::read(given, |given, _| Some((given.not_negative("inner_radius", 0.0), "inner_radius"))),
};
