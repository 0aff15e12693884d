//! The angle.

use super::dimensions::{positive, smaller};
use super::fibres::Fibre;
use super::profile::{Profile, thin};
use super::rounded::RolledL;
use super::section::Section;
use super::section_shape::{CrossSection, MakeSection, SHEAR_FACTOR, SectionKind, SectionShape, check_walls};
use super::stresses::Outline;
use base::words::kinds::{Form, Given, Key};

/// The shape's word, keys and maker.
pub static KIND: SectionKind = SectionKind {
    word: "l",
    aliases: &[],
    guesses: &["angle"],
    about: "An angle, one leg along local z, one along local y.",
    keys: &[
        Key { name: "height", form: Form::Number, about: "Length along local z, above 0." },
        Key { name: "width", form: Form::Number, about: "Length along local y, above 0." },
        Key {
            name: "thickness",
            form: Form::Numbers,
            about: "Thickness of the legs: one value, or two: of the upright leg, and of the flat leg.",
        },
        Key {
            name: "root_radius",
            form: Form::Number,
            about: "Radius between legs of one thickness, above 0; the inner edges of their ends have half of it. Default: none, sharp corners.",
        },
        Key {
            name: "fibres",
            form: Form::Counts,
            about: "Fibres along the longest wall and through the thickness of each, even numbers, where the material yields. Default: [8, 4].",
        },
        SHEAR_FACTOR,
    ],
    make: MakeSection { read, takes_material: |_| true },
};

fn read(given: &mut Given, _: bool) -> Option<CrossSection> {
    check_walls(given, 2)?;
    let (width, height) = (given.require_positive("width"), given.require_positive("height"));
    let walls = given.require("thickness")?;
    let (vertical, horizontal) = (*walls.first()?, *walls.last()?);
    let legs = L { height: height?, width: width?, vertical, horizontal };
    if !given.has("root_radius") {
        return Some(CrossSection::Shape(Box::new(legs)));
    }
    let root_radius = given.positive("root_radius")?;
    Some(CrossSection::Shape(Box::new(RolledL { legs, root_radius })))
}

/// An angle section.
#[derive(Debug, Clone, PartialEq)]
pub struct L {
    /// Height along z.
    pub height: f64,
    /// Width along y.
    pub width: f64,
    /// Thickness of the vertical leg.
    pub vertical: f64,
    /// Thickness of the horizontal leg.
    pub horizontal: f64,
}

impl SectionShape for L {
    fn section(&self, _: f64) -> Result<Section, String> {
        angle(self.height, self.width, self.vertical, self.horizontal)
    }

    fn default_fibres(&self, _: Option<usize>) -> Result<[usize; 2], String> {
        Ok([8, 4])
    }

    fn lay_fibres(&self, counts: [usize; 2], _: &Section) -> Result<Vec<Fibre>, String> {
        Ok(l(self.height, self.width, self.vertical, self.horizontal)?.fibres(counts))
    }

    fn outline(&self, _: f64, section: &Section) -> Option<Outline> {
        Some(l(self.height, self.width, self.vertical, self.horizontal).ok()?.outline(section))
    }

    fn half_depth(&self) -> f64 {
        0.5 * self.width.min(self.height)
    }
}

/// Angle: corner at −y, −z; one leg of thickness `vertical` up along z, one of thickness `horizontal` out along y.
pub fn angle(height: f64, width: f64, vertical: f64, horizontal: f64) -> Result<Section, String> {
    Ok(l(height, width, vertical, horizontal)?.section())
}

/// Walls of [`angle`]; the upright leg includes the corner.
fn l(height: f64, width: f64, vertical: f64, horizontal: f64) -> Result<Profile, String> {
    positive(&[("height", height), ("width", width), ("thickness", vertical), ("thickness", horizontal)])?;
    smaller(("thickness", vertical), ("width", width), "the upright leg must leave a flat one: less than")?;
    smaller(("thickness", horizontal), ("height", height), "the flat leg must leave an upright one: less than")?;
    let (y, z) = (0.5 * vertical, 0.5 * horizontal);
    let plates =
        vec![([y, 0.5 * height], vertical, height), ([0.5 * (width + vertical), z], width - vertical, horizontal)];
    let points = vec![[y, height], [y, z], [width, z]];
    let walls = [(0, 1, vertical), (1, 2, horizontal)];
    thin(points, &walls, plates, &[vertical, horizontal])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::dimensions::rectangles;
    use crate::sections::tests::close;

    /// Each leg's flow runs through the corner of the middle lines, so does its resultant.
    #[test]
    fn angle_shear_center_is_the_corner() {
        let l = angle(0.12, 0.08, 0.01, 0.008).unwrap();
        let (_, center, _) = rectangles(&[([0.005, 0.06], 0.01, 0.12), ([0.045, 0.004], 0.07, 0.008)]);
        close(l.shear_center[0], 0.005 - center[0], 1e-12);
        close(l.shear_center[1], 0.004 - center[1], 1e-12);
        assert!(l.Iyz < 0.0, "the legs fill the second and fourth quadrants");
    }

    /// Symmetry about the bisector: the principal axes of moments and shear areas lie at 45°. EN 10056-1, L 100×100×10: A = 19.2 cm², I =
    /// 177 cm⁴, centroid at 2.82 cm; its rounded toes reduce both by up to 2 %.
    #[test]
    fn equal_angle_has_axes_at_45_degrees() {
        let l = angle(0.1, 0.1, 0.01, 0.01).unwrap();
        close(l.Iy, l.Iz, 1e-14);
        close(l.shear[0], l.shear[1], 1e-12);
        close(l.Iy, 177e-8, 0.02);
        close(l.area, 19.2e-4, 0.011);
        close(0.005 - l.shear_center[0], 2.82e-2, 0.02);
        assert!(l.shear[2] != 0.0 && l.Iyz != 0.0);
    }
}
