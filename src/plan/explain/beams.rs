//! Beams: how they yield.

use super::explanation::Explanation;
use crate::elements::beam::IntegrationRule;
use crate::model::{Beam, Model};
use crate::system::System;
use crate::system::parts::beams::merges_fibres;

/// Adds lines about beams.
pub fn explain(text: &mut Explanation, model: &Model, system: &System) {
    for beam in model.each::<Beam>() {
        let Some(yielding) = &beam.yielding else { continue };
        let (fibres, points) = (yielding.fibres.len(), yielding.points);
        let rule = if yielding.rule == IntegrationRule::Gauss { "Gauss" } else { "Lobatto" };
        let stress = if yielding.shear { "normal and shear stress" } else { "normal stress alone" };
        let merged = if merges_fibres(beam, system.plane) {
            "; fibres of equal strain merged, the motion being plane"
        } else {
            ""
        };
        let section = format!("{fibres} fibres at {points} {rule} points per element, yielding under {stress}{merged}");
        text.add("yielding", format!("beam `{}`: {section}", beam.name));
    }
}
