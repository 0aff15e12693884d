//! Mass scaling in words: additions, parts and effects.

use super::explanation::Explanation;
use crate::system::{MassScaling, ScaledPart, System};
use crate::tolerances::explained_mass_scaling::MUCH;
use base::diagnostic::Diagnostic;
use base::names::{short, to_digits};
use mechanics::integrators::Stepping;
use model::Model;

/// Number of parts that are listed.
const LISTED: usize = 5;

/// Adds lines about mass scaling.
pub fn explain(text: &mut Explanation, model: &Model, system: &System) {
    let Some(scaling) = system.mass_scaling() else { return };
    mass_added(scaling).into_iter().for_each(|(label, line)| text.add(label, line));
    if !matches!(model.solution.scheme.stepping(), Stepping::Verlet) {
        text.notes.push("elements have the masses of the stages with central differences, because a motion goes on with the masses it has".into());
    }
    let [_, heavier, rotary] = counts(scaling);
    if heavier > 0 && model.loading.gravity.norm() > 0.0 {
        text.notes
            .push(
                "weight acts on the true masses: falling bodies fall slower by the added share, and uneven additions rotate and bend them"
                    .into(),
            );
    }
    if heavier + rotary > 0 && scaling.of_sections.is_none() && bound_by_others(model) {
        text.notes.push(
            "mass scaling raises the step of elements: links, contacts and joints may ask for shorter ones".into(),
        );
    }
}

/// Additions of mass scaling, as lines with labels.
pub fn mass_added(scaling: &MassScaling) -> Vec<(&'static str, String)> {
    let [elements, heavier, rotary] = counts(scaling);
    let step = short(scaling.critical_step);
    if let Some(own) = scaling.of_sections {
        return rotary_in_words(scaling, own);
    }
    if heavier + rotary == 0 {
        let what = format!(
            "none: each of the {elements} elements has a critical time step of {step} or more, those that are slack or have no mass aside"
        );
        return vec![("mass added", what)];
    }
    let mut lines = Vec::new();
    if heavier > 0 {
        lines.push(("mass added", heavier_in_words(scaling, heavier, elements)));
        lines.extend(parts_in_words(scaling).into_iter().map(|line| ("", line)));
    }
    if rotary > 0 {
        let what = format!(
            "inertia of {rotary} of {elements} elements is raised for a critical time step of {step}, without added mass; radii of gyration are \
             at most 0.35 of the distances of nodes"
        );
        lines.push(("rotary", what));
    }
    lines
}

/// The parts whose rotary inertia alone is raised, and by how much.
fn rotary_in_words(scaling: &MassScaling, own: f64) -> Vec<(&'static str, String)> {
    let mut raised: Vec<&ScaledPart> = scaling.parts.iter().filter(|part| part.rotary > 0).collect();
    raised.sort_by(|a, b| b.rotary_factor.total_cmp(&a.rotary_factor));
    let of_part = |part: &&ScaledPart| {
        let (name, factor) = (&part.name, to_digits(part.rotary_factor, 3));
        format!("`{name}` in {} of {} elements, up to {factor} times", part.rotary, part.elements)
    };
    let mut listed: Vec<String> = raised.iter().take(LISTED).map(of_part).collect();
    if raised.len() > LISTED {
        listed.push(format!("and {} more parts by less", raised.len() - LISTED));
    }
    let what = format!(
        "inertia is raised without added mass: {}. Elements then have a critical time step of {}, with that of their sections {}; \
         `mass_scaling = \"off\"` keeps that",
        listed.join("; "),
        to_digits(scaling.critical_step, 3),
        to_digits(own, 3)
    );
    vec![("rotary", what)]
}

/// Numbers of elements in total, with added mass, and with added rotary inertia.
fn counts(scaling: &MassScaling) -> [usize; 3] {
    let sum = |of: fn(&ScaledPart) -> usize| scaling.parts.iter().map(of).sum();
    [sum(|part| part.elements), sum(|part| part.heavier), sum(|part| part.rotary)]
}

/// True where something besides elements may bound the step.
fn bound_by_others(model: &Model) -> bool {
    model.parts.iter().any(|part| !part.kind().is_deformable())
}

fn heavier_in_words(scaling: &MassScaling, heavier: usize, elements: usize) -> String {
    let factor = scaling.parts.iter().map(|part| part.factor).fold(1.0, f64::max);
    format!(
        "{}, {} % of the mass of the scene, to {heavier} of {elements} elements, up to {} times theirs; each then has a critical time step of {}",
        to_digits(scaling.added(), 4),
        percent(scaling.added() / scaling.mass),
        to_digits(factor, 4),
        short(scaling.critical_step)
    )
}

/// The parts with the largest shares.
fn parts_in_words(scaling: &MassScaling) -> Vec<String> {
    let given = by_share(scaling);
    let line = |part: &&ScaledPart| {
        let (name, elements) = (&part.name, part.elements);
        let (added, share) = (to_digits(part.added, 4), percent(part.share()));
        format!("`{name}`: {added}, {share} % of its mass, to {} of {elements} elements", part.heavier)
    };
    let mut lines: Vec<String> = given.iter().take(LISTED).map(line).collect();
    if given.len() > LISTED {
        lines.push(format!("and {} more parts, each by a smaller share", given.len() - LISTED));
    }
    lines
}

/// The parts that are given mass, the one with the largest share first.
fn by_share(scaling: &MassScaling) -> Vec<&ScaledPart> {
    let mut given: Vec<&ScaledPart> = scaling.parts.iter().filter(|part| part.heavier > 0).collect();
    given.sort_by(|a, b| b.share().total_cmp(&a.share()));
    given
}

fn percent(share: f64) -> String {
    to_digits(100.0 * share, 3)
}

/// A warning where much mass is added to a part.
pub fn much_mass_added(system: &System) -> Option<Diagnostic> {
    let scaling = system.mass_scaling()?;
    let most = *by_share(scaling).first()?;
    (most.share() > MUCH).then(|| {
        let message = format!(
            "mass scaling adds {} % to the mass of `{}`, {} % to that of the scene. Its frequencies are too low by {} % if this mass is spread \
             evenly, and by several times as much if it lies where a mode moves most. Momentum and impacts are too large",
            percent(most.share()),
            most.name,
            percent(scaling.added() / scaling.mass),
            percent(1.0 - (1.0 + most.share()).sqrt().recip())
        );
        Diagnostic::warning(message).hint("give a smaller `mass_scaling_step`, or a mesh without elements much smaller than the others")
    })
}
