//! The angle.

use super::dimensions::{positive, rectangles, smaller};
use super::fibres::{Fibre, with_area};
use super::profile::{Profile, Walled, thin};
use super::rounded::Corner;
use super::section::Section;
use super::section_shape::{CrossSection, MakeSection, SHEAR_FACTOR, SectionKind, SectionShape, check_walls};
use super::stresses::SectionOutline;
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

impl Walled for L {
    const FIBRES: [usize; 2] = [8, 4];

    /// The corner lies at −y, −z; the upright leg includes it.
    fn profile(&self) -> Result<Profile, String> {
        let &L { height, width, vertical, horizontal } = self;
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

    fn sides(&self) -> [f64; 2] {
        [self.width, self.height]
    }
}

/// A rolled angle of one thickness: a radius between the legs, and half of it at the inner edges of their ends (EN 10056-1).
#[derive(Debug, Clone, PartialEq)]
pub struct RolledL {
    /// The legs with sharp corners.
    pub legs: L,
    /// Radius between the legs.
    pub root_radius: f64,
}

impl RolledL {
    /// The corners with their sign and the place of their centroids, from the outer edges: the root, and what both ends lack.
    fn corners(&self) -> [(f64, Corner, [f64; 2]); 3] {
        let L { height, width, vertical: t, .. } = self.legs;
        let (root, toe) = (Corner::new(self.root_radius), Corner::new(0.5 * self.root_radius));
        [
            (1.0, root, [t + root.arm; 2]),
            (-1.0, toe, [t - toe.arm, height - toe.arm]),
            (-1.0, toe, [width - toe.arm, t - toe.arm]),
        ]
    }

    /// The centroid of the sharp legs from the outer edges, and the shift of that of the rounded ones from there.
    pub(super) fn centroids(&self) -> [[f64; 2]; 2] {
        let L { height, width, vertical: t, .. } = self.legs;
        let plates = [([0.5 * t, 0.5 * height], t, height), ([0.5 * (width + t), 0.5 * t], width - t, t)];
        let (area, sharp, _) = rectangles(&plates);
        let corners = self.corners();
        let whole = area + corners.iter().map(|(sign, corner, _)| sign * corner.area).sum::<f64>();
        let shift = [0, 1].map(|axis| {
            let moment = |(sign, corner, at): &(f64, Corner, [f64; 2])| sign * corner.area * (at[axis] - sharp[axis]);
            corners.iter().map(moment).sum::<f64>() / whole
        });
        [sharp, shift]
    }
}

impl SectionShape for RolledL {
    fn section(&self, nu: f64) -> Result<Section, String> {
        let L { height, width, vertical, horizontal } = self.legs;
        if vertical != horizontal {
            return Err("`root_radius` needs legs of one thickness".to_owned());
        }
        let mut section = self.legs.section(nu)?;
        smaller(
            ("root_radius", self.root_radius),
            ("the shorter leg", width.min(height) - vertical),
            "it must be less than",
        )?;
        smaller(("root_radius", 0.5 * self.root_radius), ("thickness", vertical), "half of it must be less than")?;
        let [sharp, [y0, z0]] = self.centroids();
        for (sign, corner, at) in self.corners() {
            let (y, z) = (at[0] - sharp[0], at[1] - sharp[1]);
            section.area += sign * corner.area;
            section.Iy += sign * (corner.moment + corner.area * z * z);
            section.Iz += sign * (corner.moment + corner.area * y * y);
            section.Iyz += sign * (corner.product + corner.area * y * z);
        }
        section.Iy -= section.area * z0 * z0;
        section.Iz -= section.area * y0 * y0;
        section.Iyz -= section.area * y0 * z0;
        let [ys, zs] = section.shear_center;
        Ok(Section { shear_center: [ys - y0, zs - z0], ..section })
    }

    fn default_fibres(&self, share: Option<usize>) -> Result<[usize; 2], String> {
        self.legs.default_fibres(share)
    }

    /// Fibres of the sharp legs with the area of the rounded ones, about their own centroid.
    fn lay_fibres(&self, counts: [usize; 2], section: &Section) -> Result<Vec<Fibre>, String> {
        Ok(with_area(section.area, self.legs.lay_fibres(counts, section)?))
    }

    fn outline(&self, nu: f64, section: &Section) -> Option<SectionOutline> {
        let [_, [y0, z0]] = self.centroids();
        let SectionOutline::Points(mut points) = self.legs.outline(nu, section)? else { return None };
        points.iter_mut().for_each(|point| point.at = [point.at[0] - y0, point.at[1] - z0]);
        Some(SectionOutline::Points(points))
    }

    fn half_depth(&self) -> f64 {
        self.legs.half_depth()
    }
}

#[cfg(test)]
mod tests {
    use crate::sections::dimensions::rectangles;
    use crate::sections::tests::{angle, close};

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
