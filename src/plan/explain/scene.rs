//! The scene in words, and its unknowns.

use super::explanation::Explanation;
use crate::elements::beam::IntegrationRule;
use crate::model::{Bar, Beam, Contact, MeshFile, Model, Part, PartKind, PartType, Shell};
use crate::names::{joined, short};
use crate::plan::Plan;
use crate::system::System;

/// Adds lines about the scene.
pub fn explain(text: &mut Explanation, plan: &Plan, model: &Model, system: &System) {
    text.add("scene", counts(model));
    if let Some(MeshFile { path, nodes, elements, used, .. }) = &model.origin.mesh {
        text.add("mesh", format!("`{path}`: {nodes} nodes, {elements} elements, {used} of them in parts"));
    }
    for rigid in &model.origin.rigid {
        let body = &model.bodies[rigid.body];
        let words: Vec<&str> = rigid.parts.iter().map(String::as_str).collect();
        let (of, mass, elements) = (joined(&words), short(body.mass), rigid.elements);
        text.add("rigid", format!("{of} as body `{}`, mass {mass}, in place of its {elements} elements", body.name));
    }
    text.add("unknowns", plan.dofs.unknowns().to_string());
    let multipliers = system.multipliers();
    if multipliers > 0 {
        let what = "constraint equations with Lagrange multipliers, projected onto at the end of each step";
        text.add("joints", format!("{multipliers} {what}"));
    }
    yielding(text, model, system);
    for contact in model.each::<Contact>() {
        text.add("contact", contact_in_words(model, contact));
    }
}

/// The number of things of each kind.
fn counts(model: &Model) -> String {
    let parts = PartKind::ALL.map(|kind| {
        let of_kind = model.parts.iter().filter(|part| part.kind() == kind);
        (of_kind.map(Part::counted).sum(), kind.counted_as())
    });
    let before = [(model.nodes.len(), ["node", "nodes"]), (model.bodies.len(), ["body", "bodies"])];
    let after = [
        (model.constraints.dependents.len(), ["dependent node", "dependent nodes"]),
        (model.constraints.joints.len(), ["joint", "joints"]),
    ];
    let all = [&before[..], &parts, &after].concat();
    let counted = |(count, [one, more]): (usize, [&str; 2])| format!("{count} {}", if count == 1 { one } else { more });
    all.into_iter().filter(|(count, _)| *count > 0).map(counted).collect::<Vec<_>>().join(", ")
}

fn yielding(text: &mut Explanation, model: &Model, system: &System) {
    for beam in model.each::<Beam>() {
        let Some(yielding) = &beam.yielding else { continue };
        let (fibres, points) = (yielding.fibres.len(), yielding.points);
        let rule = if yielding.rule == IntegrationRule::Gauss { "Gauss" } else { "Lobatto" };
        let stress = if yielding.shear { "normal and shear stress" } else { "normal stress alone" };
        let merged =
            if system.merges_fibres(beam) { "; fibres of equal strain merged, the motion being plane" } else { "" };
        let section = format!("{fibres} fibres at {points} {rule} points per element, yielding under {stress}{merged}");
        text.add("yielding", format!("beam `{}`: {section}", beam.name));
    }
    for bar in model.each::<Bar>().filter(|bar| bar.yielding.is_some()) {
        text.add("yielding", format!("bar `{}`: under normal stress", bar.name));
    }
    for part in model.parts.chunk_by(Part::is_one_with) {
        let Some(shell) = Shell::of(&part[0]) else { continue };
        let Some(yielding) = &shell.yielding else { continue };
        let what = format!("{} layers, yielding in plane stress; transverse shear elastic", yielding.layers);
        text.add("yielding", format!("shell `{}`: {what}", shell.name));
    }
}

/// The two sides of a contact and its law.
fn contact_in_words(model: &Model, contact: &Contact) -> String {
    let shape = contact.surface.shape.word();
    let carrier = model.bodies.iter().find(|body| body.node == contact.node);
    let on = carrier.map_or("the ground".to_string(), |body| format!("body `{}`", body.name));
    let (name, count) = (&contact.name, contact.points.len());
    let points = if count == 1 { "point" } else { "points" };
    let radius = contact.points.iter().map(|point| point.radius).fold(0.0, f64::max);
    let radius = if radius > 0.0 { format!(" of contact radius {}", short(radius)) } else { String::new() };
    let pair = format!("`{name}`: {count} {points}{radius} against a {shape} on {on}");
    let Some(law) = &contact.law else { return format!("{pair}; clearance monitor, no force acts") };
    let chosen = if contact.chosen { " (chosen so that an impact lasts 20 steps)" } else { "" };
    let stiffness = format!("penalty stiffness {}{chosen}", short(law.stiffness));
    match law.resolution {
        limit if limit < f64::INFINITY => {
            format!("{pair}; {stiffness}; steps during impacts at most {}", short(limit))
        }
        _ => format!("{pair}; {stiffness}"),
    }
}
