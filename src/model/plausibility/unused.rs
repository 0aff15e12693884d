//! Unused nodes: nodes of a mesh outside all parts, and inner nodes of rigid parts.

use crate::data::{ArcLength, CaseActor, ExpectAt, LoadOrigin, Model, StepLength, Stop, StopQuantity, When};
use mechanics::elements::pressure::Face;

/// Takes out nodes that neither the deck names nor anything acts on, and numbers the others anew. Decks without a mesh and
/// rigid parts have none.
pub fn drop_unused(model: &mut Model) {
    if model.origin.mesh.is_some() || !model.origin.rigid.is_empty() {
        let kept = kept(model);
        renumber(model, &kept);
    }
}

/// Calls `of` with every node that the model names, dependent nodes aside.
fn visit_nodes(model: &mut Model, of: &mut impl FnMut(&mut usize)) {
    visit_actors(model, of);
    model.parts.iter_mut().for_each(|part| part.visit_nodes(of));
    for load in &mut model.loading.nodal {
        of(&mut load.node);
        if let Some(LoadOrigin::Coordinate(coordinate)) = &mut load.origin {
            coordinate.ends.iter_mut().for_each(&mut *of);
        }
    }
    model.loading.pressures.iter_mut().flat_map(|load| &mut load.faces).flat_map(Face::nodes_mut).for_each(&mut *of);
    model.output.nodes.iter_mut().for_each(&mut *of);
    model.output.drifts.iter_mut().flat_map(|drift| &mut drift.ends).for_each(&mut *of);
    for expect in &mut model.expects {
        if let ExpectAt::Node(node) = &mut expect.at {
            of(node);
        }
    }
}

/// Calls `of` with every node of bodies, constraints, dampers, load cases and stops.
pub fn visit_actors(model: &mut Model, of: &mut impl FnMut(&mut usize)) {
    model.bodies.iter_mut().for_each(|body| of(&mut body.node));
    model.masses.iter_mut().for_each(|mass| of(&mut mass.node));
    for joint in &mut model.constraints.joints {
        joint.ends.iter_mut().chain(joint.more.iter_mut().map(|share| &mut share.node)).for_each(&mut *of);
    }
    let drives = model.constraints.joints.iter_mut().filter_map(|joint| joint.coordinate.as_mut()?.drive.as_mut());
    drives.for_each(|drive| of(&mut drive.node));
    model.constraints.restraints.iter_mut().for_each(|restraint| of(&mut restraint.node));
    model.constraints.targets.iter_mut().for_each(|([node, _], _)| of(node));
    model.damping.nodal.iter_mut().for_each(|damping| of(&mut damping.node));
    for expect in &mut model.expects {
        if let When::Target(target) = &mut expect.when {
            of(&mut target.node);
        }
    }
    for term in model.cases.list.iter_mut().flat_map(|case| &mut case.terms) {
        if let CaseActor::Named(actors) = &mut term.acts {
            actors.motions.iter_mut().for_each(|[node, _]| of(node));
        }
    }
    if let Some(Stop { quantity, .. }) = model.analysis.stage.as_mut().and_then(|stage| stage.stop.as_mut()) {
        match quantity {
            StopQuantity::Displacement([node, _]) => of(node),
            StopQuantity::Work(actors) | StopQuantity::Force(actors) => {
                actors.motions.iter_mut().for_each(|[node, _]| of(node));
            }
        }
    }
    if let StepLength::ArcLength(ArcLength { stop: Some(target), .. }) = &mut model.analysis.step_length {
        of(&mut target.node);
    }
}

fn kept(model: &mut Model) -> Vec<bool> {
    let mut kept: Vec<bool> = model.nodes.iter().map(|node| node.named).collect();
    visit_nodes(model, &mut |node| kept[*node] = true);
    // A dependent node needs the one that it depends on.
    let mut masters = vec![None; kept.len()];
    model.constraints.dependents.iter().for_each(|dependent| masters[dependent.node] = Some(dependent.master));
    for node in 0..kept.len() {
        let mut next = if kept[node] { masters[node] } else { None };
        while let Some(master) = next.filter(|&master| !kept[master]) {
            kept[master] = true;
            next = masters[master];
        }
    }
    kept
}

fn renumber(model: &mut Model, kept: &[bool]) {
    let mut number = Vec::with_capacity(kept.len());
    let mut count = 0;
    for &keep in kept {
        number.push(count);
        count += usize::from(keep);
    }
    let mut flags = kept.iter();
    model.nodes.retain(|_| flags.next().copied().unwrap_or(true));
    model.constraints.dependents.retain(|dependent| kept[dependent.node]);
    for dependent in &mut model.constraints.dependents {
        (dependent.node, dependent.master) = (number[dependent.node], number[dependent.master]);
    }
    visit_nodes(model, &mut |node| *node = number[*node]);
}
