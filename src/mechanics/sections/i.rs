//! The I section.

use super::dimensions::{positive, smaller};
use super::fibres::Fibre;
use super::profile::{Profile, Walled, thin};
use super::rounded::Corner;
use super::section::Section;
use super::section_shape::{CrossSection, MakeSection, SHEAR_FACTOR, SectionKind, SectionShape, pair};
use super::stresses::SectionOutline;
use base::words::kinds::{Form, Given, Key};

/// The shape's word, keys and maker.
pub static KIND: SectionKind = SectionKind {
    word: "i",
    aliases: &[],
    guesses: &["i-beam", "h", "h-beam", "wide-flange", "ipe", "w"],
    about: "An I section, web along local z; its flanges may differ.",
    keys: &[
        Key { name: "height", form: Form::Number, about: "Length along local z, above 0." },
        Key { name: "width", form: Form::Number, about: "Width of both flanges, along local y, above 0." },
        Key { name: "top_width", form: Form::Number, about: "Width of the upper flange, if the flanges differ." },
        Key { name: "bottom_width", form: Form::Number, about: "Width of the lower flange, if the flanges differ." },
        Key { name: "web_thickness", form: Form::Number, about: "Thickness of the web, above 0." },
        Key { name: "flange_thickness", form: Form::Number, about: "Thickness of both flanges, above 0." },
        Key {
            name: "top_flange_thickness",
            form: Form::Number,
            about: "Thickness of the upper flange, if the flanges differ.",
        },
        Key {
            name: "bottom_flange_thickness",
            form: Form::Number,
            about: "Thickness of the lower flange, if the flanges differ.",
        },
        Key {
            name: "root_radius",
            form: Form::Number,
            about: "Radius between web and flanges of a rolled section with equal flanges, above 0. Default: none, sharp corners.",
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
    let (height, web) = (given.require_positive("height"), given.require_positive("web_thickness"));
    let widths = pair(given, ["width", "top_width", "bottom_width"]);
    let flanges = pair(given, ["flange_thickness", "top_flange_thickness", "bottom_flange_thickness"]);
    let ([top_width, bottom_width], [top_flange, bottom_flange]) = (widths?, flanges?);
    let shape = I { height: height?, top_width, bottom_width, web: web?, top_flange, bottom_flange };
    if !given.has("root_radius") {
        return Some(CrossSection::Shape(Box::new(shape)));
    }
    let root_radius = given.positive("root_radius")?;
    Some(CrossSection::Shape(Box::new(RolledI { plates: shape, root_radius })))
}

/// An I-section.
#[derive(Debug, Clone, PartialEq)]
pub struct I {
    /// Height along z.
    pub height: f64,
    /// Width of the top flange.
    pub top_width: f64,
    /// Width of the bottom flange.
    pub bottom_width: f64,
    /// Thickness of the web.
    pub web: f64,
    /// Thickness of the top flange.
    pub top_flange: f64,
    /// Thickness of the bottom flange.
    pub bottom_flange: f64,
}

impl Walled for I {
    const FIBRES: [usize; 2] = [8, 4];

    /// The web lies on the axis y = 0; the flanges are in halves, from their free ends to the web.
    fn profile(&self) -> Result<Profile, String> {
        let &I { height, top_width, bottom_width, web, top_flange, bottom_flange } = self;
        positive(&[
            ("height", height),
            ("width", top_width),
            ("width", bottom_width),
            ("web_thickness", web),
            ("flange_thickness", top_flange),
            ("flange_thickness", bottom_flange),
        ])?;
        let narrower = top_width.min(bottom_width);
        smaller(("web_thickness", web), ("width", narrower), "the flanges must be wider than the web:")?;
        let both = ("flange_thickness", top_flange + bottom_flange);
        smaller(both, ("height", height), "both together must be less than")?;
        let clear = height - top_flange - bottom_flange;
        let (top, bottom) = (0.5 * (height - top_flange), 0.5 * (bottom_flange - height));
        let (a, b) = (0.5 * top_width, 0.5 * bottom_width);
        let points = vec![[-a, top], [a, top], [0.0, top], [-b, bottom], [b, bottom], [0.0, bottom]];
        let walls = [(0, 2, top_flange), (1, 2, top_flange), (2, 5, web), (3, 5, bottom_flange), (4, 5, bottom_flange)];
        let plates = vec![
            ([-0.5 * a, top], a, top_flange),
            ([0.5 * a, top], a, top_flange),
            ([0.0, 0.5 * (bottom_flange - top_flange)], web, clear),
            ([-0.5 * b, bottom], b, bottom_flange),
            ([0.5 * b, bottom], b, bottom_flange),
        ];
        thin(points, &walls, plates, &[top_flange, top_flange, bottom_flange, bottom_flange])
    }

    fn sides(&self) -> [f64; 2] {
        [self.top_width.max(self.bottom_width), self.height]
    }
}

/// A rolled I section: equal flanges with radii at the root of the web.
#[derive(Debug, Clone, PartialEq)]
pub struct RolledI {
    /// The plates.
    pub plates: I,
    /// Radius between web and flanges.
    pub root_radius: f64,
}

impl RolledI {
    /// The corner at each root, and the place of one.
    fn roots(&self) -> (Corner, [f64; 2]) {
        let corner = Corner::new(self.root_radius);
        let I { height, web, top_flange, .. } = self.plates;
        (corner, [0.5 * web + corner.arm, 0.5 * height - top_flange - corner.arm])
    }

    /// Saint-Venant torsion constant: flanges, web, and the bulges where they meet, by the circle that fits there (El Darwish & Johnston 1965).
    fn torsion(&self) -> f64 {
        let I { height, top_width: width, web, top_flange: flange, .. } = self.plates;
        let r = self.root_radius;
        let circle = ((r + 0.5 * web).powi(2) + (r + flange).powi(2) - r * r) / (2.0 * r + flange);
        let bulge = web / flange * (0.145 + 0.1 * r / flange) * circle.powi(4);
        2.0 / 3.0 * (width - 0.63 * flange) * flange.powi(3) + (height - 2.0 * flange) * web.powi(3) / 3.0 + 2.0 * bulge
    }
}

impl SectionShape for RolledI {
    fn section(&self, nu: f64) -> Result<Section, String> {
        let I { height, top_width, bottom_width, web, top_flange, bottom_flange } = self.plates;
        if top_width != bottom_width || top_flange != bottom_flange {
            return Err("`root_radius` needs equal flanges".to_owned());
        }
        let mut section = self.plates.section(nu)?;
        let room = (0.5 * (top_width - web)).min(0.5 * height - top_flange);
        smaller(("root_radius", self.root_radius), ("the room beside the web", room), "it must be less than")?;
        let (corner, place) = self.roots();
        corner.add(1.0, place, &mut section);
        Ok(Section { torsion: self.torsion(), ..section })
    }

    fn default_fibres(&self, share: Option<usize>) -> Result<[usize; 2], String> {
        self.plates.default_fibres(share)
    }

    fn lay_fibres(&self, counts: [usize; 2], section: &Section) -> Result<Vec<Fibre>, String> {
        let mut fibres = self.plates.lay_fibres(counts, section)?;
        let (Corner { area, .. }, [y, z]) = self.roots();
        let root = |[a, b]: [f64; 2]| Fibre { area, y: a * y, z: b * z, shear: [[0.0; 3]; 2] };
        fibres.extend([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(root));
        Ok(fibres)
    }

    fn outline(&self, nu: f64, section: &Section) -> Option<SectionOutline> {
        self.plates.outline(nu, section)
    }

    fn half_depth(&self) -> f64 {
        self.plates.half_depth()
    }
}

#[cfg(test)]
mod tests {
    use crate::sections::dimensions::rectangles;
    use crate::sections::tests::{close, i_section};

    /// Shear centre on the web, where the flanges' lateral bending balances: from the top, h I_bottom/(I_top + I_bottom).
    #[test]
    fn unequal_flanges_share_shear_by_their_moments() {
        let i = i_section(0.3, [0.2, 0.1], 0.008, [0.012, 0.015]).unwrap();
        let (top, bottom) = (0.012 * 0.2f64.powi(3), 0.015 * 0.1f64.powi(3));
        let h = 0.3 - 0.5 * (0.012 + 0.015);
        let (_, center, _) =
            rectangles(&[([0.0, 0.144], 0.2, 0.012), ([0.0, 0.0015], 0.008, 0.273), ([0.0, -0.1425], 0.1, 0.015)]);
        close(i.shear_center[1], 0.144 - h * bottom / (top + bottom) - center[1], 1e-12);
        assert!(i.shear_center[0].abs() < 1e-15);
    }

    /// IPE 200 (EN 10365: A = 28.5 cm², I_y = 1943 cm⁴, I_z = 142 cm⁴, I_t = 6.98 cm⁴) has fillets of radius 12 mm. Their area 4 r² (1 −
    /// π/4) is added here; the rest of their effect stays within the bounds. Torsion lives from its fillets.
    #[test]
    fn ipe_200_near_the_standard() {
        let i = i_section(0.2, [0.1; 2], 0.0056, [0.0085; 2]).unwrap();
        close(i.area + 4.0 * 0.012f64.powi(2) * (1.0 - std::f64::consts::FRAC_PI_4), 28.5e-4, 0.002);
        close(i.Iz, 142e-8, 0.005);
        assert!(i.Iy < 1943e-8 && i.Iy > 0.94 * 1943e-8);
        assert!(i.torsion < 6.98e-8 && i.torsion > 0.6 * 6.98e-8);
        // The web carries nearly all the shear: the shear area is its middle-line area, reduced by the parabolic distribution.
        let web = 0.0056 * (0.2 - 0.0085);
        assert!(i.shear[1] < web && i.shear[1] > 0.9 * web);
        close(i.shear[0], 5.0 / 6.0 * 2.0 * 0.1 * 0.0085, 0.001);
    }
}
