//! `*BASE MOTION`: the ground of a motion in time accelerates; displacements are relative to it, here as there.

use crate::build::Build;
use crate::deck_text::{DeckTable, inline, list, number, quoted, vector};
use crate::dialect::Dialect;
use crate::file_content::{BaseMotion, StepProcedure};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::step_cards;

/// `*BASE MOTION`.
pub fn base_motion(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let procedure = im.steps.at_hand().procedure.as_ref().map(|(procedure, _)| procedure);
    if !matches!(procedure, Some(StepProcedure::Dynamic { .. } | StepProcedure::Response(_))) {
        return im.refuse(line, "a base moves in steps of *MODAL DYNAMIC and *STEADY STATE DYNAMICS alone");
    }
    if keyword.has("BASENAME") {
        return im.refuse(line, "the ground is one base: move other supports by *BOUNDARY");
    }
    if keyword.value("TYPE").is_some_and(|of| !of.eq_ignore_ascii_case("ACCELERATION")) {
        return im.refuse(line, "the base has an acceleration in rdsolve: give TYPE=ACCELERATION");
    }
    let axis = keyword.value("DOF").and_then(|dof| dof.parse::<usize>().ok()).filter(|dof| (1..=3).contains(dof));
    let Some(axis) = axis else { return im.refuse(line, "the base moves along DOF=1, 2 or 3") };
    let Some(amplitude) = keyword.value("AMPLITUDE") else { return im.refuse(line, "*BASE MOTION needs AMPLITUDE=") };
    let Ok(scale) = keyword.value("SCALE").map_or(Ok(1.0), str::parse) else {
        return im.refuse(line, "SCALE must be a number");
    };
    if im.dialect != Some(Dialect::Abaqus) {
        im.change(line, "displacements are relative to the ground; CalculiX adds its motion");
    }
    let step = im.steps.at_hand().line;
    im.steps.base_motions.push(BaseMotion {
        line,
        step,
        axis: axis - 1,
        amplitude: amplitude.to_owned(),
        scale,
        is_imaginary: step_cards::is_imaginary(keyword),
    });
}

/// Adds the accelerations of the ground.
pub fn accelerations(build: &mut Build) {
    let motions = build.im.steps.base_motions.clone();
    let Some(first) = motions.first() else { return };
    if build.timeline.general.len() > 1 {
        return build.im.refuse(first.line, "the ground accelerates in all stages of a deck: give each step a file");
    }
    let mut accelerations = Vec::new();
    for motion in &motions {
        let Some(amplitude) = build.amplitude_of_file(&motion.amplitude, motion.line) else { continue };
        let scale = motion.scale * build.over_sine(&motion.amplitude);
        let mut direction = [0.0; 3];
        direction[motion.axis] = 1.0;
        accelerations.push(inline(&[
            ("direction", vector(&direction)),
            ("amplitude", quoted(&amplitude)),
            ("scale", number(scale)),
        ]));
    }
    let table = DeckTable::new("environment", first.line).with_lines(motions.iter().map(|motion| motion.line));
    build.deck.add(table.value("base_acceleration", list(accelerations.into_iter())));
}
