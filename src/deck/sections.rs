//! `[sections.x]`: the cross sections of beams.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::kinds::Kinds;
use mechanics::sections::section_shape::MakeSection;
use mechanics::sections::{SECTIONS, SectionKind};

/// The cross section of a beam, in its local axes: width along y, height along z.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Section {}

impl Kinds for Section {
    const CHOOSER: &'static str = "shape";
    const ABOUT: &'static str = "The shape, on which the other keys depend.";
    const REQUIRED: bool = true;
    type Make = MakeSection;

    fn list() -> &'static [&'static SectionKind] {
        SECTIONS
    }
}
