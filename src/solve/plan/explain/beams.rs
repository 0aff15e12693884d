//! Beams: how long their elements are, and how they yield.

use super::explanation::Explanation;
use crate::system::System;
use crate::system::parts::beams::merges_fibres;
use base::names::short;
use mechanics::elements::beam::IntegrationRule;
use model::{Beam, BeamElement, Model};

/// One beam, and several.
const BEAMS: [&str; 2] = ["beam", "beams"];

/// Adds lines about beams.
pub fn explain(text: &mut Explanation, model: &Model, system: &System) {
    for beam in model.each::<Beam>() {
        if beam.graded {
            let length = |e: &BeamElement| {
                let [start, end] = e.ends(beam.order).map(|node| model.nodes[node].x);
                (end - start).norm()
            };
            let lengths = beam.elements.iter().map(length);
            let [shortest, longest] =
                lengths.fold([f64::INFINITY, 0.0], |[least, most], length| [length.min(least), length.max(most)]);
            let graded = format!("elements {} to {} long, the shortest at the ends", short(shortest), short(longest));
            text.add_of("grading", BEAMS, &beam.name, graded);
        }
        let Some(yielding) = &beam.yielding else { continue };
        let (fibres, points) = (yielding.fibres(), yielding.points);
        let rule = if yielding.rule == IntegrationRule::Gauss { "Gauss" } else { "Lobatto" };
        let stress = if yielding.shear { "normal and shear stress" } else { "normal stress alone" };
        let merged = if merges_fibres(beam, system.plane) {
            "; fibres of equal strain merged, the motion being plane"
        } else {
            ""
        };
        let of = match yielding.groups.len() {
            1 => String::new(),
            materials => format!(" of {materials} kinds"),
        };
        let section =
            format!("{fibres} fibres{of} at {points} {rule} points per element, yielding under {stress}{merged}");
        text.add_of("yielding", BEAMS, &beam.name, section);
    }
}
