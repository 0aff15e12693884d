//! The output of the deck, and damping.

use crate::build::Build;
use crate::deck_text::{DeckTable, inline, quoted};
use crate::dialect::Dialect;
use crate::file_content::PropertyOf;
use crate::harmonics;

/// Says where damping of a material acts beyond its elements.
fn say_what_is_damped(build: &mut Build, line: usize, [alpha, beta]: [f64; 2]) {
    let has = |of: &[PropertyOf]| build.im.properties.iter().any(|card| of.contains(&card.of));
    let mut behaviors = build.im.connectors.behaviors.iter();
    let springs = has(&[PropertyOf::Spring, PropertyOf::Gap, PropertyOf::Joint])
        || behaviors.any(|behavior| behavior.stiffness.iter().any(Option::is_some));
    let masses = has(&[PropertyOf::Mass, PropertyOf::Inertia]);
    if beta != 0.0 && springs {
        build.im.change(line, "BETA of a material damps its elements; here it damps springs too");
    }
    if alpha != 0.0 && masses {
        build.im.change(line, "ALPHA of a material damps its elements; here it damps masses at nodes too");
    }
}

/// Adds `[damping]` and `[output]`.
pub fn output(build: &mut Build) {
    let of_modes = harmonics::rayleigh(build.im);
    if let Some(([alpha, beta], line)) = of_modes {
        build.deck.add(DeckTable::new("damping", line).number("mass_factor", alpha).number("stiffness_factor", beta));
    }
    let is_unused = of_modes.is_some() || harmonics::goes_by_modes(build.im);
    let damped = build.im.materials.list.iter().filter(|material| is_unused && material.damping.is_some());
    let lines: Vec<usize> = damped.map(|material| material.line).collect();
    lines.into_iter().for_each(|line| build.im.ignore(line, "modes have the damping of *MODAL DAMPING alone"));
    match build.im.materials.damping() {
        _ if is_unused => {}
        Ok(Some([alpha, beta])) => {
            let line = build.im.materials.list.iter().find(|material| material.damping.is_some()).map_or(0, |m| m.line);
            say_what_is_damped(build, line, [alpha, beta]);
            build
                .deck
                .add(DeckTable::new("damping", line).number("mass_factor", alpha).number("stiffness_factor", beta));
        }
        Ok(None) => {}
        Err(line) => {
            build.im.refuse(line, "all materials must have the same damping: [damping] holds for the whole structure")
        }
    }
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
