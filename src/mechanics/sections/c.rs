//! The channel: with sharp corners, or rolled, with flanges whose inner faces slope and radii at the web and at their ends.

use super::dimensions::{polygon, positive, smaller};
use super::fibres::{Fibre, with_area};
use super::profile::{Profile, Walled, thin};
use super::section::Section;
use super::section_shape::{CrossSection, MakeSection, SHEAR_FACTOR, SectionKind, SectionShape};
use super::stresses::SectionOutline;
use base::words::kinds::{Form, Given, Key};
use nalgebra::{Rotation2, Vector2};

/// Chords of an arc: they miss 0.1 % of the area of a root.
const CHORDS: usize = 32;

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
        Key {
            name: "flange_thickness",
            form: Form::Number,
            about: "Thickness of both flanges, above 0; with `flange_slope` that at half the width.",
        },
        Key {
            name: "root_radius",
            form: Form::Number,
            about: "Radius between web and flanges, above 0; the inner edges of the flanges' ends have half of it. Default: none, sharp corners.",
        },
        Key {
            name: "flange_slope",
            form: Form::Number,
            about: "Slope of the flanges' inner faces, above 0 and below 0.3, with `root_radius`. Default: parallel faces.",
        },
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
    let sharp = C { height: height?, width: width?, web: web?, flange: flange? };
    if !given.has("root_radius") {
        if given.has("flange_slope") {
            let hint = "give `root_radius` too, such as the thickness of the flanges, or remove `flange_slope`";
            return given.error_with("flange_slope", "`flange_slope` applies to rolled channels alone", hint);
        }
        return Some(CrossSection::Shape(Box::new(sharp)));
    }
    let root_radius = given.positive("root_radius")?;
    let slope = if given.has("flange_slope") { given.positive("flange_slope")? } else { 0.0 };
    Some(CrossSection::Shape(Box::new(RolledC { sharp, root_radius, slope })))
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

impl Walled for C {
    const FIBRES: [usize; 2] = [12, 4];

    /// The web lies along z at the side of −y and includes the corners; the flanges point to +y.
    fn profile(&self) -> Result<Profile, String> {
        let &C { height, width, web, flange } = self;
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

    fn sides(&self) -> [f64; 2] {
        [self.width, self.height]
    }
}

/// A rolled channel.
#[derive(Debug, Clone, PartialEq)]
pub struct RolledC {
    /// The channel with sharp corners and flanges of one thickness, that at half the width.
    pub sharp: C,
    /// Radius between web and flanges; the ends of the flanges have half of it.
    pub root_radius: f64,
    /// Slope of the inner faces of the flanges.
    pub slope: f64,
}

/// Points of the arc that rounds the corner at `at`, between the sides to `from` and to `to`.
fn arc(from: Vector2<f64>, at: Vector2<f64>, to: Vector2<f64>, radius: f64) -> Vec<[f64; 2]> {
    let (a, b) = ((from - at).normalize(), (to - at).normalize());
    let half = 0.5 * a.angle(&b);
    let center = at + (a + b).normalize() * (radius / half.sin());
    let start = at + a * (radius / half.tan()) - center;
    let end = at + b * (radius / half.tan()) - center;
    let turn = Rotation2::rotation_between(&start, &end).angle();
    let point = |k: usize| center + Rotation2::new(turn * k as f64 / CHORDS as f64) * start;
    (0..=CHORDS).map(|k| point(k).into()).collect()
}

impl RolledC {
    /// The contour, counter-clockwise, with y from the back of the web and z from half the height.
    fn contour(&self) -> Vec<[f64; 2]> {
        let C { height, width, web, flange } = self.sharp;
        let inner = |y: f64| Vector2::new(y, 0.5 * height - flange + self.slope * (y - 0.5 * width));
        let tip = Vector2::new(width, 0.5 * height);
        let mut upper = vec![[width, 0.5 * height]];
        upper.extend(arc(tip, inner(width), inner(web), 0.5 * self.root_radius));
        upper.extend(arc(inner(width), inner(web), Vector2::new(web, 0.0), self.root_radius));
        let lower = upper.iter().map(|[y, z]| [*y, -z]);
        let back = [[0.0, 0.5 * height], [0.0, -0.5 * height]];
        back.into_iter().chain(lower).chain(upper.iter().rev().copied()).collect()
    }

    /// Torsion constant with the bulges where web and flanges meet, of flanges as thick as at half their width (El Darwish & Johnston 1965).
    fn torsion(&self) -> f64 {
        let C { height, width, web: t, flange } = self.sharp;
        let r = self.root_radius;
        let circle = 2.0 * (3.0 * r + t + flange - (2.0 * (2.0 * r + t) * (2.0 * r + flange)).sqrt());
        let (thin, round) = (t / flange, r / flange);
        let share = -0.0908 + 0.2621 * thin + 0.1231 * round - 0.0752 * thin * round - 0.0945 * thin * thin;
        let walls = 2.0 / 3.0 * width * flange.powi(3) + (height - 2.0 * flange) * t.powi(3) / 3.0;
        walls + 2.0 * share * circle.powi(4) - 0.42 * flange.powi(4)
    }

    /// How far the centroid of this section is from that of the sharp one along y.
    fn shift(&self) -> Result<f64, String> {
        let C { height, width, web, flange } = self.sharp;
        let area = height * web + 2.0 * (width - web) * flange;
        let sharp = (0.5 * height * web * web + (width - web) * flange * (width + web)) / area;
        let (_, [y, _], _) = polygon(&self.checked_contour()?);
        Ok(y - sharp)
    }

    fn checked_contour(&self) -> Result<Vec<[f64; 2]>, String> {
        let C { height, width, web, flange } = self.sharp;
        smaller(("flange_slope", self.slope), ("the largest slope", 0.3), "it must be less than")?;
        let [root, end] = [0.5, -0.5].map(|side| flange + self.slope * side * (width - web));
        let room = (width - web).min(0.5 * height - root);
        smaller(
            ("root_radius", 1.5 * self.root_radius),
            ("the room beside the web", room),
            "1.5 times it must be less than",
        )?;
        smaller(
            ("root_radius", 0.5 * self.root_radius),
            ("the end of the flange", end),
            "half of it must be less than",
        )?;
        Ok(self.contour())
    }
}

impl SectionShape for RolledC {
    fn section(&self, nu: f64) -> Result<Section, String> {
        let sharp = self.sharp.section(nu)?;
        let (area, [y, _], [Iy, Iz, _]) = polygon(&self.checked_contour()?);
        // The moment of the flow in flanges that become thinner, about the middle of the web.
        let C { height, width, web, flange } = self.sharp;
        let (b, h) = (width - 0.5 * web, height - flange);
        let before = 0.5 * h * h / Iy * (0.5 * flange * b * b - self.slope * b.powi(3) / 12.0);
        let shear_center = [0.5 * web - before - y, 0.0];
        Ok(Section { area, Iy, Iz, torsion: self.torsion(), shear_center, ..sharp })
    }

    fn default_fibres(&self, share: Option<usize>) -> Result<[usize; 2], String> {
        self.sharp.default_fibres(share)
    }

    /// Fibres of the sharp channel with the area of this one, moved so that their second moments are those of this one.
    fn lay_fibres(&self, counts: [usize; 2], section: &Section) -> Result<Vec<Fibre>, String> {
        let mut fibres = with_area(section.area, self.sharp.lay_fibres(counts, section)?);
        let moment = |of: fn(&Fibre) -> f64| fibres.iter().map(|fibre| fibre.area * of(fibre).powi(2)).sum::<f64>();
        let y = (section.Iz / moment(|fibre| fibre.y)).sqrt();
        let z = (section.Iy / moment(|fibre| fibre.z)).sqrt();
        fibres.iter_mut().for_each(|fibre| (fibre.y, fibre.z) = (fibre.y * y, fibre.z * z));
        Ok(fibres)
    }

    fn outline(&self, nu: f64, section: &Section) -> Option<SectionOutline> {
        let shift = self.shift().ok()?;
        let SectionOutline::Points(mut points) = self.sharp.outline(nu, section)? else { return None };
        points.iter_mut().for_each(|point| point.at[0] -= shift);
        Some(SectionOutline::Points(points))
    }

    fn half_depth(&self) -> f64 {
        self.sharp.half_depth()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::tests::{channel, close};

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

    /// EN 10365, UPN 200: 32.2 cm², 1910 and 148 cm⁴, I_t = 11.9 cm⁴, the centroid at 2.01 cm and the shear centre 3.94 cm before it. The shear
    /// flow follows middle lines at right angles: 2.5 %.
    #[test]
    fn channel_of_the_standard() {
        let sharp = C { height: 200.0, width: 75.0, web: 8.5, flange: 11.5 };
        let shape = RolledC { sharp, root_radius: 11.5, slope: 0.08 };
        let section = shape.section(0.3).unwrap();
        let found = [section.area / 1e2, section.Iy / 1e4, section.Iz / 1e4, section.torsion / 1e4];
        found.into_iter().zip([32.2, 1910.0, 148.0, 11.9]).for_each(|(found, known)| close(found, known, 5e-3));
        close(polygon(&shape.contour()).1[0], 20.1, 5e-3);
        close(-section.shear_center[0], 39.4, 3e-2);
        let fibres = shape.lay_fibres([12, 4], &section).unwrap();
        let sum = |of: fn(&Fibre) -> f64| fibres.iter().map(|fibre| fibre.area * of(fibre)).sum::<f64>();
        close(sum(|_| 1.0), section.area, 1e-13);
        close(sum(|fibre| fibre.y * fibre.y), section.Iz, 1e-12);
        assert!(sum(|fibre| fibre.y).abs() < 1e-12 * section.area * 75.0);
    }

    /// Without slope it is the sharp channel with two roots more and two ends less, known in closed form; ends have half the radius.
    #[test]
    fn parallel_flanges_have_the_corners_of_circles() {
        let sharp = C { height: 200.0, width: 75.0, web: 8.5, flange: 11.5 };
        let section = RolledC { sharp: sharp.clone(), root_radius: 11.5, slope: 0.0 }.section(0.3).unwrap();
        let corner = (1.0 - std::f64::consts::FRAC_PI_4) * 11.5 * 11.5;
        // Of 32 chords each arc misses 0.1 % of its corner.
        let corners = section.area - sharp.section(0.3).unwrap().area;
        close(corners, 2.0 * corner * (1.0 - 0.25), 2e-3);
    }

    #[test]
    fn nonsense_is_named() {
        let sharp = C { height: 200.0, width: 75.0, web: 8.5, flange: 11.5 };
        let said = |root_radius: f64, slope: f64| {
            RolledC { sharp: sharp.clone(), root_radius, slope }.section(0.3).unwrap_err()
        };
        assert!(said(60.0, 0.08).contains("root_radius"));
        assert!(said(11.5, 0.4).contains("flange_slope"));
        assert!(said(11.5, 0.29).contains("the end of the flange"));
    }
}
