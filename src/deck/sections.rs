//! `[sections.x]`: the cross sections of beams.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::Maybe;
use super::words::kinds::Kinds;
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
