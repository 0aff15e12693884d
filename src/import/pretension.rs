//! `*PRE-TENSION SECTION` of beams: a beam is cut at its last node, and a prismatic joint closes the cut.
//!
//! A force of the pre-tension node is the effort of the joint, so the beam carries it along the normal of the section; a displacement is its
//! motion. A section that is held in a later step gets a rigid joint there, which keeps the way that the nut has gone.

use crate::build::Build;
use crate::deck_text::{DeckTable, inline, number, quoted};
use crate::dialect::Dialect;
use crate::element_types::ElementUse;
use crate::file_content::{PretensionCard, StepProcedure};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::scopes::{NamedTarget, PlacedElement, ScopeIndex};
use crate::tied_nodes::Cut;
use crate::timeline::{GivenValue, InStep, TimeLaw, histories};
use base::math::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// Cosine of the largest angle between a beam and the normal of its section.
const ALONG: f64 = 0.99;

/// `*PRE-TENSION SECTION`.
pub fn section(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    if keyword.has("SURFACE") {
        return im.refuse(line, "rdsolve has no solids that a surface could cut: give ELEMENT= of a beam");
    }
    let of = |name: &str| keyword.value(name).map(|name| NamedTarget { is_set: false, ..im.set_target(name, line) });
    let (Some(element), Some(node)) = (of("ELEMENT"), of("NODE")) else {
        return im.refuse(line, "*PRE-TENSION SECTION needs ELEMENT= and NODE=");
    };
    let normal = block.data.first().map(|data| im.numbers(data)).unwrap_or_default();
    let at = |i: usize| normal.get(i).copied().unwrap_or(0.0);
    let is_follower =
        keyword.has("FOLLOWER") && !keyword.value("FOLLOWER").is_some_and(|value| value.eq_ignore_ascii_case("NO"));
    // A normal that turns with the beam is that of the beam.
    let normal = Vec3::new(at(0), at(1), at(2)).try_normalize(0.0).filter(|_| !is_follower);
    im.constraints.pretensions.push(PretensionCard { line, element, node, normal, is_follower });
}

/// Cuts the beams.
pub fn cut(build: &mut Build) {
    for card in build.im.constraints.pretensions.clone() {
        let (cells, node) = (build.cells(&card.element), build.node(&card.node));
        if cells.len() > 1 {
            let why = format!("ELEMENT= names {} beams, and a section cuts one: give each its section", cells.len());
            build.im.refuse(card.line, &why);
        }
        let ([at], Some(node)) = (&cells[..], node) else { continue };
        if build.tied.cuts.iter().any(|cut| cut.node == node) {
            build.im.refuse(card.line, &format!("another section has the pre-tension node {node}: give each its own"));
            continue;
        }
        let cell = build.mesh.cells[*at].clone();
        let last = match build.im.scopes.types[cell.kind].becomes {
            ElementUse::StraightBeam => 1,
            ElementUse::CurvedBeam => 2,
            _ => {
                let why = "pre-tension sections cut beams: use `pretension` of [[links]] or `free_length` of [[bars]]";
                build.im.refuse(card.line, why);
                continue;
            }
        };
        let rest = cell.nodes[last];
        let along = (build.mesh.x(rest) - build.mesh.x(cell.nodes[0])).normalize();
        let normal = normal(build, &card, &cell).unwrap_or(along);
        let sense = normal.dot(&along).signum();
        if normal.dot(&along).abs() < ALONG {
            build.im.refuse(card.line, "the normal of the section must lie along the beam");
            continue;
        }
        if sense < 0.0 && build.im.dialect != Some(Dialect::Calculix) {
            build.im.refuse(card.line, "the normal points against the beam, which pushes in CalculiX: turn it around");
            continue;
        }
        say_differences(build, &card);
        let end = build.mesh.copy_of(rest);
        build.mesh.cells[*at].nodes[last] = end;
        build.tied.cuts.push(Cut { line: card.line, node, ends: [rest, end], axis: normal * sense, sense });
    }
}

/// The normal that a section gives. That of a part turns with its instance.
fn normal(build: &Build, card: &PretensionCard, cell: &PlacedElement) -> Option<Vec3> {
    let of_part = cell.instance.filter(|_| card.element.scope != ScopeIndex::Outer);
    let turn = of_part.and_then(|at| build.im.scopes.instances[at].turn);
    card.normal.map(|normal| turn.map_or(normal, |(_, turn)| turn * normal))
}

/// Tells what the other program does with the beam and with the normal.
fn say_differences(build: &mut Build, card: &PretensionCard) {
    if build.im.dialect == Some(Dialect::Calculix) {
        let how = "the beam stays, with its stiffness; CalculiX removes it and ties its nodes along the normal alone";
        build.im.change(card.line, how);
    } else if !card.is_follower && build.im.steps.list.iter().any(|step| step.is_nonlinear()) {
        build.im.change(card.line, "the normal of the section turns with the beam; Abaqus keeps it without FOLLOWER");
    }
}

/// These nodes, and the ends that beams have at them beyond their cuts.
pub fn with_ends(build: &Build, mut nodes: Vec<u64>) -> Vec<u64> {
    for cut in &build.tied.cuts {
        if nodes.contains(&cut.ends[0]) {
            nodes.push(cut.ends[1]);
        }
    }
    nodes
}

/// What a pre-tension node has in each general step.
#[derive(Default)]
struct OfNode {
    force: Option<Vec<InStep>>,
    place: Option<Vec<InStep>>,
}

/// Closes the cuts.
pub fn joints(build: &mut Build) {
    for cut in build.tied.cuts.clone() {
        refuse_others(build, &cut);
        let of_node = of_node(build, &cut);
        let force = of_node.force;
        let Some(mut place) = of_node.place else {
            match force {
                Some(force) => pull(build, &cut, &force, None),
                None => {
                    build.im.refuse(cut.line, &format!("nothing tightens this section: node {} has no load", cut.node));
                }
            }
            continue;
        };
        hold_fixed(build, &mut place);
        let first = place.iter().position(|state| *state != InStep::Absent).unwrap_or(0);
        let InStep::Begins(start) = place[first].clone() else { continue };
        let is_fixed = is_fixed(build, start.line);
        if place[first..].contains(&InStep::Absent) {
            build.im.refuse(start.line, "a section that is held and then freed is not translated");
        } else if first == 0 {
            lead(build, &cut, &place);
        } else if !is_fixed {
            build.im.refuse(start.line, "a section that was free before is held where it is found: say FIXED");
        } else if let Some(line) = moves(&place[first + 1..]) {
            build.im.refuse(line, "a section that is held under FIXED is not moved afterwards");
        } else if let Some(force) = force.filter(|force| force[..first].iter().any(|state| *state != InStep::Absent)) {
            let (before, after) = stages(build, first);
            pull(build, &cut, &force[..first], Some(before));
            let table = table(build, &cut, ("fixed", "held"));
            build.deck.add(table.names("stages", &after));
        } else {
            build.im.refuse(start.line, "nothing tightens this section before it is held");
        }
    }
}

/// The line of the first new value.
fn moves(place: &[InStep]) -> Option<usize> {
    place.iter().find_map(|state| if let InStep::Begins(given) = state { Some(given.line) } else { None })
}

/// Refuses what a joint does not take from a pre-tension node: other directions and procedures.
fn refuse_others(build: &mut Build, cut: &Cut) {
    const ONE: &str = "a pre-tension node has the degree of freedom 1 alone";
    const STEPS: &str = "a pre-tension section is tightened in steps of statics or of motion in time alone";
    let steps = build.im.steps.list.clone();
    let before = build.im.steps.before.clone();
    for step in steps.iter().chain([&before]) {
        let procedure = step.procedure.as_ref().map(|(procedure, _)| procedure);
        let is_in_time = matches!(procedure, None | Some(StepProcedure::Static { .. } | StepProcedure::Dynamic { .. }));
        for force in &step.forces {
            if build.nodes(&force.target).contains(&cut.node) && (force.degree > 0 || !is_in_time) {
                build.im.refuse(force.line, if force.degree > 0 { ONE } else { STEPS });
            }
        }
        for place in &step.supports {
            if !build.nodes(&place.target).contains(&cut.node) {
                continue;
            }
            if place.degrees != [0] && (place.value != 0.0 || !place.degrees.contains(&0)) {
                build.im.refuse(place.line, ONE);
            } else if !is_in_time {
                build.im.refuse(place.line, STEPS);
            } else if place.history != "displacement" {
                build.im.refuse(place.line, "a pre-tension section is led by a displacement: leave TYPE out");
            }
        }
    }
}

/// The forces along the section and the displacements of a pre-tension node.
fn of_node(build: &mut Build, cut: &Cut) -> OfNode {
    let steps = build.im.steps.list.clone();
    let before = build.im.steps.before.supports.clone();
    let (mut forces, mut places): (BTreeMap<usize, GivenValue>, BTreeMap<usize, GivenValue>) = Default::default();
    for force in steps.iter().flat_map(|step| &step.forces) {
        if force.degree == 0 && build.nodes(&force.target).contains(&cut.node) {
            let given = GivenValue { value: force.value, amplitude: force.amplitude.clone(), line: force.line };
            forces.insert(force.line, given);
        }
    }
    for place in steps.iter().flat_map(|step| &step.supports).chain(&before) {
        if place.degrees.contains(&0) && build.nodes(&place.target).contains(&cut.node) {
            // Under FIXED it differs from all values before and after.
            let value = if place.is_fixed { f64::NAN } else { place.value };
            places.insert(place.line, GivenValue { value, amplitude: place.amplitude.clone(), line: place.line });
        }
    }
    let of = |given: Option<&GivenValue>| given.map(|given| ((), given.clone()));
    let force = histories(
        &build.timeline,
        &steps,
        Vec::new(),
        |step| step.forces.iter().filter_map(|line| of(forces.get(&line.line))).collect(),
        |step| step.new_forces,
    );
    let place = histories(
        &build.timeline,
        &steps,
        before.iter().filter_map(|line| of(places.get(&line.line))).collect(),
        |step| step.supports.iter().filter_map(|line| of(places.get(&line.line))).collect(),
        |step| step.new_supports,
    );
    OfNode { force: force.into_values().next(), place: place.into_values().next() }
}

/// A section that is held already stays where it is under FIXED; another one begins at 0.
fn hold_fixed(build: &Build, place: &mut [InStep]) {
    let mut is_held = false;
    for state in place {
        if let InStep::Begins(given) = state
            && is_fixed(build, given.line)
        {
            given.value = 0.0;
            if is_held {
                *state = InStep::Holds;
            }
        }
        is_held = *state != InStep::Absent;
    }
}

fn is_fixed(build: &Build, line: usize) -> bool {
    let steps = &build.im.steps;
    let mut all = steps.list.iter().chain([&steps.before]).flat_map(|step| &step.supports);
    all.any(|support| support.line == line && support.is_fixed)
}

/// The names of the stages before a general step, and from it on.
fn stages(build: &Build, first: usize) -> (Vec<String>, Vec<String>) {
    let at = build.timeline.general[first];
    let names: Vec<String> = build.timeline.stages.iter().map(|stage| stage.name.clone()).collect();
    (names[..at].to_vec(), names[at..].to_vec())
}

/// Adds a joint that a force closes.
fn pull(build: &mut Build, cut: &Cut, force: &[InStep], stages: Option<Vec<String>>) {
    let law = build.law_as_table(force);
    let law = TimeLaw { scale: cut.sense * law.scale, ..law };
    let keys = keys("value", &law);
    let table = table(build, cut, ("prismatic", "tightened")).numbers("axis", cut.axis.as_slice());
    let table = table.value("effort", inline(&keys));
    build.deck.add(table.in_stages(stages.as_deref()));
}

/// Adds a joint that is closed by a way.
fn lead(build: &mut Build, cut: &Cut, place: &[InStep]) {
    let law = build.law_as_table(place);
    if law.scale == 0.0 {
        let table = table(build, cut, ("fixed", "held"));
        return build.deck.add(table);
    }
    let keys = keys("position", &TimeLaw { scale: cut.sense * law.scale, ..law });
    let table = table(build, cut, ("prismatic", "tightened")).numbers("axis", cut.axis.as_slice());
    build.deck.add(table.value("motion", inline(&keys)));
}

fn keys(quantity: &'static str, law: &TimeLaw) -> Vec<(&'static str, String)> {
    let mut keys = vec![(quantity, number(law.scale))];
    keys.extend(law.amplitude.as_ref().map(|name| ("amplitude", quoted(name))));
    keys
}

fn table(build: &mut Build, cut: &Cut, (kind, name): (&str, &str)) -> DeckTable {
    let [rest, end] = cut.ends;
    build.mesh.used.extend([rest, end]);
    let name = build.deck.unique(&format!("{name}_{}", cut.node));
    let table = DeckTable::new("joints", cut.line).text("name", &name).text("kind", kind);
    table.value("from", build.end(rest, end)).value("to", build.end(end, rest))
}

/// The pre-tension nodes, which are no nodes of the model.
pub fn nodes(build: &Build) -> BTreeSet<u64> {
    build.tied.cuts.iter().map(|cut| cut.node).collect()
}
