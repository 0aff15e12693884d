//! The tube: a hollow cylinder, by its inner radius or the thickness of its wall.

use super::hollow::{self, AXIS, LENGTH, RADIUS};
use super::kind::SolidKind;
use base::words::kinds::{Form, Given, Key};

/// The solid's word, keys and maker.
pub static KIND: SolidKind = SolidKind {
    word: "tube",
    aliases: &[],
    guesses: &["pipe", "ring"],
    about: "A hollow cylinder.",
    keys: &[
        RADIUS,
        Key { name: "inner_radius", form: Form::Number, about: "Inner radius, instead of the thickness." },
        Key { name: "thickness", form: Form::Number, about: "Thickness of the wall, instead of the inner radius." },
        LENGTH,
        AXIS,
    ],
    make: |given| hollow::read(given, hole),
};

fn hole(given: &mut Given, radius: f64) -> Option<(f64, &'static str)> {
    match (given.has("inner_radius"), given.has("thickness")) {
        (true, true) => given.error("thickness", "a tube needs `thickness` or `inner_radius`, not both"),
        (true, false) => Some((given.not_negative("inner_radius", 0.0), "inner_radius")),
        (false, true) => Some((radius - given.positive("thickness")?, "thickness")),
        (false, false) => given.require_either("thickness", "inner_radius"),
    }
}
