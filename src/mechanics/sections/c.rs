//! The channel.

use super::dimensions::{positive, smaller};
use super::fibres::Fibre;
use super::profile::{Profile, thin};
use super::section::Section;
use super::section_shape::{CrossSection, MakeSection, SHEAR_FACTOR, SectionKind, SectionShape};
use super::stresses::SectionOutline;
use base::words::kinds::{Form, Given, Key};

/// The shape's word, keys and maker.
pub static KIND: SectionKind = SectionKind {
    word: "c",
    aliases: &[],
    guesses: &["channel", "u", "upn"],
    about: "A channel, web along local z, flanges towards +y.",
    keys: &[
        Key { name: "height", form: Form::Number, about: "Length along local z, above 0." },
        Key { name: "width", form: Form::Number, about: "Length along local y, above 0." },
        Key { name: "web_thickness", form: Form::Number, about: "Thickness of the web, above 0." },
        Key { name: "flange_thickness", form: Form::Number, about: "Thickness of both flanges, above 0." },
        Key {
            name: "fibres",
            form: Form::Counts,
            about: "Fibres along the longest wall and through the thickness of each, even numbers, where the material yields. Default: [12, 4].",
        },
        SHEAR_FACTOR,
    ],
    make: MakeSection { read, takes_material: |_| true },
};

fn read(given: &mut Given, _: bool) -> Option<CrossSection> {
    let (height, width) = (given.require_positive("height"), given.require_positive("width"));
    let (web, flange) = (given.require_positive("web_thickness"), given.require_positive("flange_thickness"));
    Some(CrossSection::Shape(Box::new(C { height: height?, width: width?, web: web?, flange: flange? })))
}

/// A channel section.
#[derive(Debug, Clone, PartialEq)]
pub struct C {
    /// Height along z.
    pub height: f64,
    /// Width of the flanges along y.
    pub width: f64,
    /// Thickness of the web.
    pub web: f64,
    /// Thickness of the flanges.
    pub flange: f64,
}

impl SectionShape for C {
    fn section(&self, _: f64) -> Result<Section, String> {
        channel(self.height, self.width, self.web, self.flange)
    }

    fn default_fibres(&self, _: Option<usize>) -> Result<[usize; 2], String> {
        Ok([12, 4])
    }

    fn lay_fibres(&self, counts: [usize; 2], _: &Section) -> Result<Vec<Fibre>, String> {
        Ok(c(self.height, self.width, self.web, self.flange)?.fibres(counts))
    }

    fn outline(&self, _: f64, section: &Section) -> Option<SectionOutline> {
        Some(c(self.height, self.width, self.web, self.flange).ok()?.outline(section))
    }

    fn half_depth(&self) -> f64 {
        0.5 * self.width.min(self.height)
    }
}

/// Channel: web along z at the side of −y, flanges pointing to +y.
pub fn channel(height: f64, width: f64, web: f64, flange: f64) -> Result<Section, String> {
    Ok(c(height, width, web, flange)?.section())
}

/// Walls of [`channel`]; the web includes the corners.
fn c(height: f64, width: f64, web: f64, flange: f64) -> Result<Profile, String> {
    positive(&[("height", height), ("width", width), ("web_thickness", web), ("flange_thickness", flange)])?;
    smaller(("web_thickness", web), ("width", width), "the web must leave a flange: less than")?;
    smaller(("flange_thickness", flange), ("height/2", 0.5 * height), "two flanges must leave a web: less than")?;
    let (out, z) = (0.5 * (width + web), 0.5 * (height - flange));
    let plates =
        vec![([out, z], width - web, flange), ([0.5 * web, 0.0], web, height), ([out, -z], width - web, flange)];
    let points = vec![[width, z], [0.5 * web, z], [0.5 * web, -z], [width, -z]];
    let walls = [(0, 1, flange), (1, 2, web), (3, 2, flange)];
    thin(points, &walls, plates, &[flange, flange])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::tests::close;

    /// Textbook formula, middle-line dimensions: e = 3 b² t_f / (6 b t_f + h t_w) outside the web (Timoshenko, Strength of
    /// Materials II, art. 53). The flow is integrated exactly, so only round-off remains.
    #[test]
    fn channel_shear_center_is_behind_the_web() {
        let (height, width, web, flange) = (0.2, 0.075, 0.0085, 0.0115);
        let c = channel(height, width, web, flange).unwrap();
        let (b, h) = (width - 0.5 * web, height - flange);
        let e = 3.0 * b * b * flange / (6.0 * b * flange + h * web);
        let area = height * web + 2.0 * (width - web) * flange;
        let centroid = (0.5 * height * web * web + (width - web) * flange * (width + web)) / area;
        close(c.area, area, 1e-14);
        close(c.shear_center[0], 0.5 * web - e - centroid, 1e-12);
        assert!(c.shear_center[1].abs() < 1e-15 && c.Iyz.abs() < 1e-15 * c.Iy && c.shear[2].abs() < 1e-12 * c.area);
    }
}
