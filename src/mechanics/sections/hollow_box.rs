//! The rectangular hollow section.

use super::dimensions::{positive, smaller};
use super::fibres::{Fibre, with_area};
use super::profile::{Profile, Walled};
use super::rounded::Corner;
use super::section::Section;
use super::section_shape::{CrossSection, MakeSection, SHEAR_FACTOR, SectionKind, SectionShape, check_walls};
use super::stresses::SectionOutline;
use super::wall::Wall;
use base::words::kinds::{Form, Given, Key};
use std::f64::consts::PI;

/// The shape's word, keys and maker.
pub static KIND: SectionKind = SectionKind {
    word: "box",
    aliases: &[],
    guesses: &["rhs", "shs", "hollow", "rectangular-hollow"],
    about: "A rectangular hollow section.",
    keys: &[
        Key { name: "width", form: Form::Number, about: "Length along local y, above 0." },
        Key { name: "height", form: Form::Number, about: "Length along local z, above 0." },
        Key {
            name: "thickness",
            form: Form::Numbers,
            about: "Thickness of the walls: one value, or two: of the walls normal to y, and of the walls normal to z.",
        },
        Key {
            name: "corner_radii",
            form: Form::Pair,
            about: "Radii of the corners outside and inside, above 0, of walls of one thickness. Default: none, sharp corners.",
        },
        Key {
            name: "fibres",
            form: Form::Counts,
            about: "Fibres along the longest wall and through the thickness of each, even numbers, where the material yields. Default: [8, 2].",
        },
        SHEAR_FACTOR,
    ],
    make: MakeSection { read, takes_material: |_| true },
};

fn read(given: &mut Given, _: bool) -> Option<CrossSection> {
    check_walls(given, 2)?;
    let (width, height) = (given.require_positive("width"), given.require_positive("height"));
    let walls = given.require("thickness")?;
    let (web, flange) = (*walls.first()?, *walls.last()?);
    let sharp = HollowBox { width: width?, height: height?, web, flange };
    if !given.has("corner_radii") {
        return Some(CrossSection::Shape(Box::new(sharp)));
    }
    let radii = given.require_positive_pair("corner_radii")?;
    Some(CrossSection::Shape(Box::new(RoundedBox { sharp, radii })))
}

/// A rectangular hollow section.
#[derive(Debug, Clone, PartialEq)]
pub struct HollowBox {
    /// Outer width along y.
    pub width: f64,
    /// Outer height along z.
    pub height: f64,
    /// Thickness of the two walls normal to y.
    pub web: f64,
    /// Thickness of the two walls normal to z.
    pub flange: f64,
}

impl Walled for HollowBox {
    const FIBRES: [usize; 2] = [8, 2];

    /// The walls counter-clockwise; the webs take the corners.
    ///
    /// Torsion: Bredt's cell plus the walls' own, J = 4 A_m²/∮ds/t + Σ b t³/3 over middle lines (EN 10210-2, annex A, with no corner radius).
    fn profile(&self) -> Result<Profile, String> {
        let &HollowBox { width, height, web, flange } = self;
        positive(&[("width", width), ("height", height), ("thickness", web), ("thickness", flange)])?;
        smaller(("thickness", web), ("width/2", 0.5 * width), "two walls must leave a hollow: less than")?;
        smaller(("thickness", flange), ("height/2", 0.5 * height), "two walls must leave a hollow: less than")?;
        let (b, h) = (width - web, height - flange); // of the middle line
        let (y, z) = (0.5 * b, 0.5 * h);
        let bredt = 4.0 * (b * h).powi(2) / (2.0 * (b / flange + h / web));
        Ok(Profile {
            points: vec![[-y, -z], [y, -z], [y, z], [-y, z], [-y, -z]],
            walls: (0..4)
                .map(|i| Wall { ends: [i, i + 1], thickness: if i % 2 == 0 { flange } else { web } })
                .collect(),
            plates: vec![
                ([0.0, -z], width - 2.0 * web, flange),
                ([y, 0.0], web, height),
                ([0.0, z], width - 2.0 * web, flange),
                ([-y, 0.0], web, height),
            ],
            cell: true,
            torsion: bredt + 2.0 / 3.0 * (b * flange.powi(3) + h * web.powi(3)),
        })
    }

    fn sides(&self) -> [f64; 2] {
        [self.width, self.height]
    }
}

/// A rectangular hollow section of one thickness with rounded corners.
#[derive(Debug, Clone, PartialEq)]
pub struct RoundedBox {
    /// The section with sharp corners.
    pub sharp: HollowBox,
    /// Radii of the corners outside and inside.
    pub radii: [f64; 2],
}

impl SectionShape for RoundedBox {
    fn section(&self, nu: f64) -> Result<Section, String> {
        let HollowBox { width, height, web: t, flange } = self.sharp;
        if t != flange {
            return Err("`corner_radii` need walls of one thickness".to_owned());
        }
        let mut section = self.sharp.section(nu)?;
        let [outer, inner] = self.radii;
        smaller(
            ("corner_radii", outer),
            ("half of the smaller side", 0.5 * width.min(height)),
            "they must be less than",
        )?;
        smaller(
            ("corner_radii", inner),
            ("half of the hollow", 0.5 * width.min(height) - t),
            "they must be less than",
        )?;
        for (sign, radius, wall) in [(-1.0, outer, 0.0), (1.0, inner, t)] {
            let corner = Corner::new(radius);
            let place = [width, height].map(|side| 0.5 * side - wall - corner.arm);
            corner.add(sign, place, &mut section);
        }
        // Bredt's cell and the wall's own part over the rounded middle line (EN 10210-2, annex A).
        let (radius, missing) = (0.5 * (outer + inner), 4.0 - PI);
        let length = 2.0 * (width + height - 2.0 * t) - 2.0 * radius * missing;
        let enclosed = (width - t) * (height - t) - radius * radius * missing;
        let torsion = t.powi(3) * length / 3.0 + 4.0 * enclosed * enclosed * t / length;
        Ok(Section { torsion, ..section })
    }

    fn default_fibres(&self, share: Option<usize>) -> Result<[usize; 2], String> {
        self.sharp.default_fibres(share)
    }

    /// Fibres of the section with sharp corners, with the area of this one.
    fn lay_fibres(&self, counts: [usize; 2], section: &Section) -> Result<Vec<Fibre>, String> {
        Ok(with_area(section.area, self.sharp.lay_fibres(counts, section)?))
    }

    fn outline(&self, nu: f64, section: &Section) -> Option<SectionOutline> {
        self.sharp.outline(nu, section)
    }

    fn half_depth(&self) -> f64 {
        self.sharp.half_depth()
    }
}

#[cfg(test)]
mod tests {
    use crate::sections::tests::{close, hollow_box};

    /// EN 10210-2 for SHS 100×100×5: I_t = 439 cm⁴ with corners of middle radius 1.25 t. The formula reproduces the standard's three digits
    /// with the radius, and this section, to round-off, without it.
    #[test]
    fn square_hollow_section_agrees_with_the_standard() {
        let t: f64 = 0.005;
        let standard = |radius: f64| {
            let corner = 4.0 - std::f64::consts::PI;
            let (h, A) = (4.0 * (0.1 - t) - 2.0 * radius * corner, (0.1 - t).powi(2) - radius * radius * corner);
            t.powi(3) * h / 3.0 + 4.0 * A * A * t / h
        };
        let shs = hollow_box(0.1, 0.1, t, t).unwrap();
        close(standard(1.25 * t), 439e-8, 0.5 / 439.0);
        close(shs.torsion, standard(0.0), 1e-14);
        close(shs.area, 0.1f64.powi(2) - 0.09f64.powi(2), 1e-14);
        close(shs.Iy, (0.1f64.powi(4) - 0.09f64.powi(4)) / 12.0, 1e-14);
        close(shs.Iz, shs.Iy, 1e-14);
    }

    /// By hand for a thin cell of side a under V: I = 2/3 a³t. In a web q = V t/I (3/8 a² − z²/2), in a flange q = V t/I a y/2. ∫q²/t ds =
    /// V² t (a⁵/I²) (9/40 + 1/24) = V² 3/(5 a t): the shear area is 5/12 of the whole. The bound is t/a.
    #[test]
    fn square_cell_shear_area() {
        let (a, t) = (1.0, 1e-6);
        let cell = hollow_box(a + t, a + t, t, t).unwrap();
        close(cell.shear[1], 5.0 / 3.0 * a * t, 2.0 * t);
        close(cell.shear[0], cell.shear[1], 1e-12);
        assert!(cell.shear[2].abs() < 1e-12 * cell.area);
    }

    #[test]
    fn nonsense_is_named() {
        assert_eq!(
            hollow_box(0.1, 0.2, 0.05, 0.01).unwrap_err(),
            "`thickness` is 0.05, but two walls must leave a hollow: less than width/2 = 0.05"
        );
        assert!(hollow_box(0.1, 0.2, 0.01, -0.01).unwrap_err().starts_with("`thickness` is -0.01"));
    }
}
