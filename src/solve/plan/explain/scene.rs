//! The scene in words, and its unknowns.

use super::explanation::Explanation;
use super::{bars, beams, contacts, links, shells};
use crate::plan::Plan;
use crate::system::System;
use base::names::{joined, short};
use model::{Joint, JointCoordinate, MeshFile, Model, Part, PartKind, Reduction, SectionFacts};

/// The lines about the parts of each kind.
const PARTS: [fn(&mut Explanation, &Model, &System); 5] =
    [beams::explain, bars::explain, shells::explain, links::explain, contacts::explain];

/// Adds lines about the scene.
pub fn explain(text: &mut Explanation, plan: &Plan, model: &Model, system: &System) {
    text.add("scene", counts(model));
    if let Some(MeshFile { path, nodes, elements, used, .. }) = &model.origin.mesh {
        text.add("mesh", format!("`{path}`: {nodes} nodes, {elements} elements, {used} of them in parts"));
    }
    model.origin.sections.iter().for_each(|facts| text.add("section", section(facts)));
    for rigid in &model.origin.rigid {
        let body = &model.bodies[rigid.body];
        let words: Vec<&str> = rigid.parts.iter().map(String::as_str).collect();
        let (of, mass, elements) = (joined(&words), short(body.mass), rigid.elements);
        text.add("rigid", format!("{of} as body `{}`, mass {mass}, in place of its {elements} elements", body.name));
    }
    let size =
        |of: &Reduction| (of.interface.len(), of.inner.len(), of.made.as_ref().map(|made| made.frequencies.len()));
    for pieces in model.reductions.chunk_by(|a, b| a.parts == b.parts && size(a) == size(b)) {
        text.add("reduced", reduced(&pieces[0], pieces.len()));
    }
    text.add("unknowns", plan.dofs.unknowns().to_string());
    let multipliers = system.multipliers();
    if multipliers > 0 {
        let what = "constraint equations with Lagrange multipliers, projected onto at the end of each step";
        text.add("joints", format!("{multipliers} {what}"));
    }
    explain_coordinates(text, model);
    PARTS.iter().for_each(|explain| explain(text, model, system));
}

/// A section of polygons in words.
fn section(facts: &SectionFacts) -> String {
    let SectionFacts { name, material, triangles, area, centroid, shear_center, stiffness } = facts;
    let place = |at: &[f64; 2]| format!("[{}, {}]", short(at[0]), short(at[1]));
    let [EA, GAy, GAz, GJ, EIy, EIz] = stiffness.matrix().diagonal().map(short).into();
    let twist = stiffness.torsion().map_or(GJ, short);
    let (centroid, center, mass) = (place(centroid), place(shear_center), short(stiffness.mass_per_length));
    let skew = match stiffness.M[(1, 2)] {
        0.0 => String::new(),
        product => format!(", product of bending {}", short(product)),
    };
    let of = material.as_ref().map_or_else(String::new, |material| format!(" of `{material}`"));
    format!(
        "`{name}`{of}: area {}, EA {EA}, GA [{GAy}, {GAz}], GJ {twist}, EI [{EIy}, {EIz}]{skew}, mass {mass} per length, centroid {centroid}, \
         shear centre {center}; {triangles} triangles",
        short(*area)
    )
}

/// A reduced part, or pieces of one, in words.
fn reduced(of: &Reduction, pieces: usize) -> String {
    let title = if pieces > 1 { format!("{pieces} pieces of {}, each", of.title) } else { of.title.clone() };
    let Some(made) = &of.made else { return title };
    let (interface, modes) = (6 * of.interface.len(), made.frequencies.len());
    let up_to = made.frequencies.last().map_or(String::new(), |last| format!(" up to {}", short(*last)));
    let shapes = match made.inertia_shapes {
        0 => String::new(),
        1 => " and 1 static shape of inertia loads".to_owned(),
        count => format!(" and {count} static shapes of inertia loads"),
    };
    let next = made.next.map_or(String::new(), |next| format!("; the next mode has {}", short(next)));
    let linear = if made.matrices.second_order.is_some() { "" } else { "; no geometric stiffness" };
    format!(
        "{title}: {interface} unknowns of the interface and {modes} modes{up_to}{shapes}, in place of {}{next}{linear}",
        interface + made.replaced
    )
}

/// Note on a plane scene whose modes may leave the plane.
pub fn plane_modes(model: &Model, system: &System) -> Option<String> {
    let analysis = &model.analysis;
    let lists_all = analysis.has_modes() && analysis.response().is_none() && !analysis.plane;
    let normal = system.plane_that_holds(model).filter(|_| lists_all)?;
    let axis = ["x", "y", "z"][normal];
    Some(format!(
        "the scene lies in a plane normal to {axis}, and its modes may lead out of it: `plane = \"auto\"` in [analysis] finds those in the plane alone"
    ))
}

/// Adds a line about the joints along whose coordinates something acts.
fn explain_coordinates(text: &mut Explanation, model: &Model) {
    let along = |joint: &Joint| {
        let JointCoordinate { drive, effort, spring, .. } = joint.coordinate.as_ref()?;
        let acts = [
            (drive.is_some_and(|drive| !drive.is_free), "driven"),
            (drive.is_some_and(|drive| drive.is_free), "geared"),
            (effort.is_some(), "motor"),
            (spring.is_some(), "coordinate counted"),
        ];
        let words: Vec<&str> = acts.iter().filter(|(acts, _)| *acts).map(|(_, word)| *word).collect();
        (!words.is_empty()).then(|| format!("`{}` ({})", joint.name, words.join(", ")))
    };
    let acting: Vec<String> = model.constraints.joints.iter().filter_map(along).collect();
    match acting.len() {
        0 => {}
        1..=6 => text.add("along", acting.join(", ")),
        many => text.add("along", format!("{many} joints: {}, …", acting[..6].join(", "))),
    }
}

/// The number of things of each kind.
fn counts(model: &Model) -> String {
    let parts = PartKind::ALL.map(|kind| {
        let of_kind = model.parts.iter().filter(|part| part.kind() == kind && part.is_listed());
        (of_kind.map(Part::counted).sum(), kind.counted_as())
    });
    let before = [
        (model.nodes.iter().filter(|node| !node.label.is_empty()).count(), ["node", "nodes"]),
        (model.bodies.len(), ["body", "bodies"]),
    ];
    let after = [
        (model.constraints.dependents.len(), ["dependent node", "dependent nodes"]),
        (model.constraints.joints.len(), ["joint", "joints"]),
    ];
    let all = [&before[..], &parts, &after].concat();
    let counted = |(count, [one, more]): (usize, [&str; 2])| format!("{count} {}", if count == 1 { one } else { more });
    all.into_iter().filter(|(count, _)| *count > 0).map(counted).collect::<Vec<_>>().join(", ")
}
