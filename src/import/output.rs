//! The output of the deck, and damping.

use crate::build::Build;
use crate::deck_text::{DeckTable, inline, quoted};
use crate::dialect::Dialect;
use crate::harmonics;

/// Adds `[damping]` and `[output]`.
pub fn output(build: &mut Build) {
    let of_modes = harmonics::rayleigh(build.im);
    if let Some(([alpha, beta], line)) = of_modes {
        build.deck.add(DeckTable::new("damping", line).number("mass_factor", alpha).number("stiffness_factor", beta));
    }
    let is_unused = harmonics::replaces_damping(build.im);
    let damped = build.im.materials.list.iter().filter(|material| is_unused && material.damping.is_some());
    let lines: Vec<usize> = damped.map(|material| material.line).collect();
    lines.into_iter().for_each(|line| build.im.ignore(line, "modes have the damping of *MODAL DAMPING alone"));
    let requests = build.im.steps.requests;
    let mut table = DeckTable::new("output", 0);
    if requests.nodes || requests.fields {
        table = table.text("nodes", "all");
    }
    if requests.reactions {
        table = table.value("reactions", "true");
    }
    if requests.sections {
        table = table.value("sections", "true");
    }
    if requests.fields {
        // Pre-processors of CalculiX read its own results; those of Abaqus read no others.
        let format = if build.im.dialect == Some(Dialect::Calculix) { "frd" } else { "vtu" };
        table = table.value("fields", inline(&[("format", quoted(format))]));
    }
    build.deck.add(table);
}
