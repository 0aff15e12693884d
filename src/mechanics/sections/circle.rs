//! The solid circle: a tube whose wall is as thick as its radius.

use super::section_shape::{CrossSection, MakeSection, SHEAR_FACTOR, SectionKind};
use super::tube::{Tube, outer_radius};
use base::words::kinds::{Form, Given, Key};

/// The shape's word, keys and maker.
pub static KIND: SectionKind = SectionKind {
    word: "circle",
    aliases: &["round"],
    guesses: &["circular", "rod", "solid-circle", "solid-round", "cylinder", "disc", "disk"],
    about: "A solid circle: a round bar, a bolt.",
    keys: &[
        Key { name: "radius", form: Form::Number, about: "Radius, above 0." },
        Key { name: "diameter", form: Form::Number, about: "Diameter, above 0, instead of `radius`." },
        Key {
            name: "fibres",
            form: Form::Counts,
            about: "Fibres around, at least 4, and along the radius, even numbers, where the material yields. Default: [20, 4].",
        },
        SHEAR_FACTOR,
    ],
    make: MakeSection { read, takes_material: |_| true },
};

fn read(given: &mut Given, _: bool) -> Option<CrossSection> {
    let radius = outer_radius(given, "circle")?;
    Some(CrossSection::Shape(Box::new(Tube { radius, thickness: radius })))
}

#[cfg(test)]
mod tests {
    use crate::sections::tests::close;
    use crate::sections::tube::tube;
    use std::f64::consts::PI;

    /// Handbook values of a bar of 30 mm: A = π d²/4, I = π d⁴/64, J = π d⁴/32, shear factor 6/7 at ν = 0 (Cowper 1966).
    #[test]
    fn a_round_bar_has_handbook_values() {
        let d: f64 = 0.03;
        let bar = tube(0.5 * d, 0.5 * d, 0.0).unwrap();
        close(bar.area, PI * d.powi(2) / 4.0, 1e-15);
        close(bar.Iy, PI * d.powi(4) / 64.0, 1e-15);
        close(bar.torsion, PI * d.powi(4) / 32.0, 1e-15);
        close(bar.shear[1], 6.0 / 7.0 * bar.area, 1e-15);
    }
}
