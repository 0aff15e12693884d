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
    /// Thickness of the cover round `core`, above 0, of shape "rectangle" or "circle".
    pub cover: Maybe<f64>,
    /// Name of a material of model "concrete" within `cover`, such as concrete that hoops confine. Default: the material of the beam throughout.
    pub core: Maybe<String>,
    /// Bars of steel along the beam, in concrete of shape "rectangle", "circle" or "tube". They replace the concrete that they displace.
    pub bars: Maybe<Vec<At<Table<SectionBars>>>>,
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
