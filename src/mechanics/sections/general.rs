//! The section that says its numbers itself: areas and moments, or stiffnesses and masses per length.

use super::dimensions::positive;
use super::fibres::Fibre;
use super::matrices::{LaminaMass, of_stiffness};
use super::section::{Section, Stiffness};
use super::section_shape::{CrossSection, MakeSection, SectionKind, SectionShape};
use super::stresses::SectionOutline;
use base::math::Mat6;
use base::words::kinds::Values;
use base::words::kinds::{Form, Given, Key};

/// The shape's word, keys and maker.
pub static KIND: SectionKind = SectionKind {
    word: "general",
    aliases: &[],
    guesses: &["arbitrary", "numbers", "user"],
    about: "Areas and moments, or stiffnesses and masses per length themselves.",
    keys: &[
        Key { name: "area", form: Form::Number, about: "Area, above 0." },
        Key { name: "moments", form: Form::Pair, about: "Second moments of area [about y, about z], above 0." },
        Key { name: "product_moment", form: Form::Number, about: "Product moment of area. Default: 0." },
        Key { name: "torsion_constant", form: Form::Number, about: "Saint-Venant torsion constant, above 0." },
        Key { name: "shear_areas", form: Form::Pair, about: "Shear areas [for forces along y, along z], above 0." },
        Key {
            name: "axial_stiffness",
            form: Form::Number,
            about: "E A, a force above 0, instead of area and moments; the beam then has no material.",
        },
        Key {
            name: "shear_stiffness",
            form: Form::Pair,
            about: "Shear stiffnesses G A_s [along y, along z], forces above 0, with axial_stiffness.",
        },
        Key {
            name: "torsional_stiffness",
            form: Form::Number,
            about: "G J, force times length squared, above 0, with axial_stiffness.",
        },
        Key {
            name: "bending_stiffness",
            form: Form::Pair,
            about: "E I [about y, about z], force times length squared, above 0, with axial_stiffness.",
        },
        Key {
            name: "stiffness",
            form: Form::SixRows,
            about: "Six rows of the symmetric stiffness of forces and moments [along x, y, z, about x, y, z] against strains and curvatures in this \
                    order, instead of the four stiffnesses: any coupling, as by the layers of a blade.",
        },
        Key {
            name: "mass_per_length",
            form: Form::Number,
            about: "Mass per length, 0 or more, with axial_stiffness or stiffness.",
        },
        Key {
            name: "inertia_per_length",
            form: Form::Vector,
            about: "Rotary inertia per length [about x, y, z], mass times length, 0 or more, with axial_stiffness or stiffness.",
        },
        Key {
            name: "mass",
            form: Form::SixRows,
            about: "Six rows of the symmetric mass per length of accelerations [along x, y, z, about x, y, z], instead of mass_per_length and \
                    inertia_per_length: its first moments say how far the centre of mass lies from the axis.",
        },
    ],
    make: MakeSection { read, takes_material: |values| !is_direct(values) },
};

const STIFFNESSES: [&str; 8] = [
    "stiffness",
    "axial_stiffness",
    "shear_stiffness",
    "torsional_stiffness",
    "bending_stiffness",
    "mass_per_length",
    "inertia_per_length",
    "mass",
];

/// True where a section gives its stiffnesses itself.
fn is_direct(values: &Values) -> bool {
    STIFFNESSES.iter().any(|key| values.place(key).is_some())
}

fn read(given: &mut Given, needs_mass: bool) -> Option<CrossSection> {
    if is_direct(given.values()) { stiffness(given, needs_mass) } else { shape(given) }
}

fn shape(given: &mut Given) -> Option<CrossSection> {
    let area = given.require_positive("area");
    let moments = given.require_positive_pair("moments");
    let torsion = given.require_positive("torsion_constant");
    let shear = given.require_positive_pair("shear_areas");
    let Iyz = given.number("product_moment").unwrap_or(0.0);
    let moments = moments?;
    if Iyz * Iyz >= moments[0] * moments[1] {
        return given.error("product_moment", "`product_moment` must be below the root of the product of both moments");
    }
    let shape = General { area: area?, moments, Iyz, torsion: torsion?, shear_areas: shear? };
    Some(CrossSection::Shape(Box::new(shape)))
}

/// Stiffnesses as given; masses may be left out where nothing needs them.
fn stiffness(given: &mut Given, needs_mass: bool) -> Option<CrossSection> {
    for key in
        KIND.keys.iter().filter(|key| !STIFFNESSES.contains(&key.name) && given.has(key.name)).collect::<Vec<_>>()
    {
        given.error::<()>(key.name, format!("`{}` does not apply to a section that gives its stiffnesses", key.name));
    }
    if given.has("stiffness") {
        return coupled(given, needs_mass);
    }
    let axial = given.require_positive("axial_stiffness");
    let shear = given.require_positive_pair("shear_stiffness");
    let torsion = given.require_positive("torsional_stiffness");
    let bending = given.require_positive_pair("bending_stiffness");
    let masses = LaminaMass::read(given, needs_mass)?;
    let stiffness = Stiffness::general(axial?, shear?, torsion?, bending?, 0.0, [0.0; 3]);
    Some(CrossSection::Stiffness(Box::new(masses.of(stiffness))))
}
/// A section by the matrix of its stiffness.
fn coupled(given: &mut Given, needs_mass: bool) -> Option<CrossSection> {
    for key in STIFFNESSES[1..5].iter().filter(|key| given.has(key)).collect::<Vec<_>>() {
        given.error_with::<()>(key, format!("`{key}` does not apply beside `stiffness`"), "remove it, or the matrix");
    }
    let masses = LaminaMass::read(given, needs_mass)?;
    match of_stiffness(&Mat6::from_row_slice(given.numbers("stiffness"))) {
        Ok(own) => Some(CrossSection::Stiffness(Box::new(masses.of(own)))),
        Err([message, hint]) => given.error_with("stiffness", message, hint),
    }
}

/// A section by its area, moments and shear areas.
#[derive(Debug, Clone, PartialEq)]
pub struct General {
    /// Area.
    pub area: f64,
    /// Iy, Iz.
    pub moments: [f64; 2],
    /// Product moment ∫yz dA.
    pub Iyz: f64,
    /// Saint-Venant torsion constant.
    pub torsion: f64,
    /// Shear areas for forces along y and z.
    pub shear_areas: [f64; 2],
}

/// Why there are no fibres.
const NO_FIBRES: &str =
    "a general section has no fibres, because it gives an area without its place; give a `shape` with dimensions";

impl SectionShape for General {
    fn section(&self, _: f64) -> Result<Section, String> {
        general(self.area, self.moments, self.Iyz, self.torsion, self.shear_areas)
    }

    fn default_fibres(&self, _: Option<usize>) -> Result<[usize; 2], String> {
        Err(NO_FIBRES.into())
    }

    fn lay_fibres(&self, _: [usize; 2], _: &Section) -> Result<Vec<Fibre>, String> {
        Err(NO_FIBRES.into())
    }

    fn outline(&self, _: f64, _: &Section) -> Option<SectionOutline> {
        None
    }

    fn half_depth(&self) -> f64 {
        0.0
    }
}

/// A section given by its numbers; `moments` = [Iy, Iz]. The shear centre is the centroid.
///
/// Errors: a number that is not positive and finite, or a product of inertia too large for the moments.
pub fn general(area: f64, moments: [f64; 2], Iyz: f64, torsion: f64, shear_areas: [f64; 2]) -> Result<Section, String> {
    let [Iy, Iz] = moments;
    let [y, z] = shear_areas;
    positive(&[
        ("area", area),
        ("moments", Iy),
        ("moments", Iz),
        ("torsion_constant", torsion),
        ("shear_areas", y),
        ("shear_areas", z),
    ])?;
    if Iyz.is_nan() || Iyz * Iyz >= Iy * Iz {
        return Err(format!(
            "`product_moment` is {Iyz}, but must be smaller in size than the geometric mean of the moments, {}",
            (Iy * Iz).sqrt()
        ));
    }
    Ok(Section { area, Iy, Iz, Iyz, torsion, shear: [y, z, 0.0], shear_center: [0.0; 2] })
}
