//! `[sections.x]`: the cross sections of beams.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::kinds::Kinds;
use super::words::{Maybe, Numbers, Table};
use base::diagnostic::At;
use mechanics::sections::section_shape::MakeSection;
use mechanics::sections::{SECTIONS, SectionKind};

/// The cross section of a beam, in its local axes: width along y, height along z.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Name of a steel profile, instead of `shape` and dimensions: "IPE 200", "HEA 300", "HE 300 B", "UPN 200", "L 100x10", "L 100x65x8",
    /// "CHS 114.3x5", "SHS 100x5", "RHS 200x100x8", "W14x90" or "HSS 8x4x3/8", its web or longer side along local z.
    pub profile: Maybe<String>,
    /// Unit of length of the deck, "m", "cm", "mm", "in" or "ft", in which the dimensions of `profile` are taken. Default: that of `units`.
    pub unit: Maybe<String>,
    /// Mass per length besides that of the material, such as floors, cladding and contents, 0 or more; it lies on the axis. Default: 0.
    pub added_mass: Maybe<f64>,
    /// Thickness of the cover round `core`, above 0, of shape "rectangle" or "circle".
    pub cover: Maybe<f64>,
    /// Name of a material of model "concrete" within `cover`, such as concrete that hoops confine. Default: the material of the beam throughout.
    pub core: Maybe<String>,
    /// Bars of steel along the beam, in concrete of shape "rectangle", "circle" or "tube". They replace the concrete that they displace.
    pub bars: Maybe<Vec<At<Table<SectionBars>>>>,
    /// Areas of the section, of one elastic material each, of shape "polygons". They may touch along edges and must not overlap. Finite elements of
    /// the section give its matrix of stiffness.
    pub polygons: Maybe<Vec<At<Table<SectionPolygon>>>>,
}

/// An area of a cross section: an outline, with holes or without.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionPolygon {
    /// Corners `[y, z]` of the outline, in order round it, three or more.
    #[schemars(required)]
    pub points: Maybe<Vec<Numbers<2>>>,
    /// Outlines of holes within it, each a list of corners. Other polygons may fill them.
    pub holes: Maybe<Vec<Vec<Numbers<2>>>>,
    /// Name of an elastic material. Default: that of the beam.
    pub material: Maybe<String>,
    /// A layer with fibres, instead of `material`.
    pub lamina: Maybe<Table<SectionLamina>>,
}

/// An orthotropic layer: axis 1 along its fibres, 2 across them in the layer, 3 through it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionLamina {
    /// Young's moduli `[E1, E2, E3]`, above 0.
    #[schemars(required)]
    pub youngs_moduli: Maybe<Numbers<3>>,
    /// Shear moduli `[G12, G13, G23]`, above 0.
    #[schemars(required)]
    pub shear_moduli: Maybe<Numbers<3>>,
    /// Poisson's ratios `[nu12, nu13, nu23]`: `nu12` is the shortening along 2 over the strain along 1 under stress along 1.
    #[schemars(required)]
    pub poisson_ratios: Maybe<Numbers<3>>,
    /// Density, above 0, where the beam needs a mass.
    pub density: Maybe<f64>,
    /// Direction `[y, z]` of the layer in the section.
    #[schemars(required)]
    pub direction: Maybe<Numbers<2>>,
    /// Angle of the fibres from the axis of the beam towards `direction`, radians. Default: 0.
    pub angle: Maybe<f64>,
}

/// Bars of one material and one size in a section: one, several on a line, or several on a circle.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionBars {
    /// Name of a material of model "elastic", "elastic-plastic", "elastic-viscoplastic" or "menegotto-pinto".
    #[schemars(required)]
    pub material: Maybe<String>,
    /// Diameter of a bar, above 0.
    pub diameter: Maybe<f64>,
    /// Area of a bar, above 0, instead of `diameter`.
    pub area: Maybe<f64>,
    /// Place `[y, z]` of a single bar from the centroid of the section.
    pub at: Maybe<Numbers<2>>,
    /// Place `[y, z]` of the first of `count` bars on a line.
    pub from: Maybe<Numbers<2>>,
    /// Place `[y, z]` of the last of these bars.
    pub to: Maybe<Numbers<2>>,
    /// Radius of the circle about the centroid on which `count` bars stand, the first along local y.
    pub circle: Maybe<f64>,
    /// Number of bars, 2 or more on a line or on a circle.
    pub count: Maybe<u64>,
}

impl Kinds for Section {
    const CHOOSER: &'static str = "shape";
    const ABOUT: &'static str = "The shape, on which the other keys depend. Required without `profile`.";
    const REQUIRED: bool = false;
    type Make = MakeSection;

    fn list() -> &'static [&'static SectionKind] {
        SECTIONS
    }
}
