//! Connectors as joints, links and bushings.

use crate::build::Build;
use crate::contact_content::ModelChange;
use crate::deck_text::{DeckTable, inline, list, number, quoted, vector};
use crate::element_types::ElementUse;
use crate::file_content::{ConnectorBehavior, ConnectorSection};
use base::math::Vec3;
use std::collections::BTreeSet;

/// A joint of the deck for a connection: its kind, whether the second node is `from`, the components that are its coordinate.
struct JointOf {
    word: &'static str,
    is_turned: bool,
    free: &'static [usize],
}

/// Joints by the types of connections, in the order of the alphabet.
const JOINTS: [(&str, JointOf); 16] = [
    ("JOIN", JointOf { word: "spherical", is_turned: false, free: &[] }),
    ("HINGE", JointOf { word: "revolute", is_turned: false, free: &[3] }),
    ("JOIN+REVOLUTE", JointOf { word: "revolute", is_turned: false, free: &[3] }),
    ("UJOINT", JointOf { word: "universal", is_turned: false, free: &[] }),
    ("JOIN+UNIVERSAL", JointOf { word: "universal", is_turned: false, free: &[] }),
    ("TRANSLATOR", JointOf { word: "prismatic", is_turned: false, free: &[0] }),
    ("ALIGN+SLOT", JointOf { word: "prismatic", is_turned: false, free: &[0] }),
    ("CYLINDRICAL", JointOf { word: "cylindrical", is_turned: false, free: &[0, 3] }),
    ("REVOLUTE+SLOT", JointOf { word: "cylindrical", is_turned: false, free: &[0, 3] }),
    ("SLOT", JointOf { word: "in-line", is_turned: true, free: &[0] }),
    ("SLIDE-PLANE", JointOf { word: "in-plane", is_turned: true, free: &[] }),
    ("PLANAR", JointOf { word: "planar", is_turned: false, free: &[] }),
    ("WELD", JointOf { word: "fixed", is_turned: false, free: &[] }),
    ("ALIGN+JOIN", JointOf { word: "fixed", is_turned: false, free: &[] }),
    ("BEAM", JointOf { word: "fixed", is_turned: false, free: &[] }),
    ("LINK", JointOf { word: "distance", is_turned: false, free: &[] }),
];

/// Adds all connectors.
pub fn connectors(build: &mut Build) {
    for section in build.im.connectors.sections.clone() {
        let kind = connection(&section);
        for at in build.cells(&section.target) {
            let cell = build.mesh.cells[at].clone();
            if build.im.scopes.types[cell.kind].becomes != ElementUse::Connector {
                continue;
            }
            let name = build.deck.unique(&format!("{}_{}", section.target.name, cell.id));
            build.mesh.used.extend(cell.nodes.iter().filter(|node| **node != 0));
            let ends = [cell.nodes[0], cell.nodes[1]];
            let table = match (&kind[..], JOINTS.iter().find(|(word, _)| *word == kind)) {
                (_, Some((_, joint))) => self::joint(build, &section, joint, (&name, ends, at)),
                ("AXIAL", _) => axial(build, &section, &name, ends),
                ("BUSHING" | "CARDAN+CARTESIAN" | "CARTESIAN+ROTATION" | "CARTESIAN", _) => {
                    Some(bushing(build, &section, &name, ends))
                }
                _ => {
                    build.im.refuse(section.line, &format!("connections of type {kind} are not translated"));
                    None
                }
            };
            if let Some(table) = table {
                if is_joint(&kind) && ["stiffness", "limits", "motion", "effort"].iter().any(|key| table.has(key)) {
                    refuse_later_coordinate(build, at);
                }
                build.deck.add_in(table, build.timeline.stages_of_cell(at));
            }
        }
    }
    refuse_bare_drives(build);
    let lines: Vec<usize> = build.im.connectors.drives.iter().map(|drive| drive.line).collect();
    if build.timeline.general.len() > 1 {
        lines.iter().for_each(|line| build.im.change(*line, "what drives a connector acts from the start of the run"));
    }
}

/// The type of a connection, its words in the order of the alphabet.
fn connection(section: &ConnectorSection) -> String {
    let mut kinds = section.kinds.clone();
    kinds.sort();
    kinds.join("+")
}

/// The type of the connection that an element is.
pub fn connection_of(build: &mut Build, cell: usize) -> Option<String> {
    let sections = build.im.connectors.sections.clone();
    sections.iter().find(|section| build.cells(&section.target).contains(&cell)).map(connection)
}

/// True for connections that become joints.
pub fn is_joint(connection: &str) -> bool {
    JOINTS.iter().any(|(word, _)| *word == connection)
}

/// Refuses loads and motions of elements that no section makes connectors.
fn refuse_bare_drives(build: &mut Build) {
    let sections = build.im.connectors.sections.clone();
    let of_sections: BTreeSet<usize> = sections.iter().flat_map(|section| build.cells(&section.target)).collect();
    for drive in build.im.connectors.drives.clone() {
        if !build.cells(&drive.target).iter().any(|at| of_sections.contains(at)) {
            build.im.refuse(drive.line, &format!("`{}` is no connector with a section", drive.target.name));
        }
    }
}

/// The axes of a connector: those of its orientation, or the global ones.
fn axes(build: &mut Build, section: &ConnectorSection) -> [Vec3; 2] {
    let global = [Vec3::x(), Vec3::y()];
    let Some(name) = &section.orientation else { return global };
    match build.im.axes.get(&name.to_lowercase()) {
        Some(Some(axes)) => *axes,
        Some(None) => global,
        None => {
            build.im.refuse(section.line, &format!("no orientation is named `{name}`"));
            global
        }
    }
}

/// The behaviour of a section; refuses a name that has none.
fn behavior(build: &mut Build, section: &ConnectorSection) -> ConnectorBehavior {
    let Some(name) = &section.behavior else { return ConnectorBehavior::default() };
    let found = build.im.connectors.behaviors.iter().find(|behavior| behavior.name == *name).cloned();
    found.unwrap_or_else(|| {
        build.im.refuse(section.line, &format!("no connector behaviour is named `{name}`"));
        ConnectorBehavior::default()
    })
}

/// Refuses two nodes at one place, which have no direction between them; returns whether they are.
pub fn refuse_one_place(build: &mut Build, line: usize, [a, b]: [u64; 2]) -> bool {
    let is_one = [a, b].iter().all(|id| build.mesh.has(*id)) && build.mesh.x(a) == build.mesh.x(b);
    if is_one {
        let why = format!("nodes {a} and {b} lie at one place, so no direction leads from one to the other");
        build.im.refuse(line, &why);
    }
    is_one
}

/// Refuses two nodes that lie apart, since a joint holds them at one place; returns whether they do.
fn refuse_apart(build: &mut Build, line: usize, [a, b]: [u64; 2]) -> bool {
    const APART: f64 = 1e-4; // of the mesh; the deck's own check is sharper
    let lies = |id: &u64| *id != 0 && build.mesh.has(*id);
    let apart = [a, b].iter().all(lies) && (build.mesh.x(a) - build.mesh.x(b)).amax() > APART * build.mesh.size();
    if apart {
        let why = format!(
            "nodes {a} and {b} lie apart, and the ends of a joint lie at one place: move one, or carry it by a rigid body"
        );
        build.im.refuse(line, &why);
    }
    apart
}

/// True for a joint that the first stage does not have: its ends need not meet at t = 0.
fn comes_later(build: &Build, cell: usize) -> bool {
    let (acts, first) = (build.timeline.acting.get(&cell), build.timeline.stages.first());
    acts.zip(first).is_some_and(|(acts, first)| !acts[first.step])
}

/// A joint between two nodes.
fn joint(
    build: &mut Build,
    section: &ConnectorSection,
    joint: &JointOf,
    (name, [a, b], cell): (&str, [u64; 2], usize),
) -> Option<DeckTable> {
    let refused = match joint.word {
        "distance" => refuse_one_place(build, section.line, [a, b]),
        _ => !comes_later(build, cell) && refuse_apart(build, section.line, [a, b]),
    };
    if refused {
        return None;
    }
    let [first, plane] = axes(build, section);
    let (from, to) = if joint.is_turned { (b, a) } else { (a, b) };
    let mut table = DeckTable::new("joints", section.line)
        .text("name", name)
        .text("kind", joint.word)
        .value("from", build.end(from, to))
        .value("to", build.end(to, from));
    if !["spherical", "fixed", "distance"].contains(&joint.word) {
        table = table.numbers("axis", first.as_slice());
    }
    if joint.word == "universal" {
        table = table.numbers("cross_axis", first.cross(&plane).normalize().as_slice());
    }
    let behavior = behavior(build, section);
    let mut acts = false;
    for component in 0..6 {
        let [stiffness, damping] = [behavior.stiffness[component], behavior.damping[component]];
        if stiffness.is_none() && damping.is_none() && behavior.stops[component].is_none() {
            continue;
        }
        if !joint.free.contains(&component) {
            build.im.refuse(
                section.line,
                &format!("a behaviour along component {} of this connection is not translated", component + 1),
            );
            continue;
        }
        if std::mem::replace(&mut acts, true) {
            build.im.refuse(section.line, "a joint has one coordinate, and here two components have a behaviour");
            continue;
        }
        if let Some(limits) = behavior.stops[component] {
            table = stops(build, section, joint, table, (component, limits));
        }
        if joint.word == "cylindrical" {
            table = table.text("coordinate", if component == 0 { "distance" } else { "angle" });
        }
        table = stiffness.map_or(table.clone(), |stiffness| table.number("stiffness", stiffness));
        table = damping.map_or(table.clone(), |damping| table.number("damping", damping));
    }
    Some(drives(build, section, joint, table, [a, b]))
}

/// Adds stops, which are stiff springs. Both nodes are at one place at t = 0, so positions are coordinates.
fn stops(
    build: &mut Build,
    section: &ConnectorSection,
    joint: &JointOf,
    table: DeckTable,
    (component, [low, high]): (usize, [f64; 2]),
) -> DeckTable {
    let size = build.mesh.size();
    let stiffness = build.rigid_stiffness() * if component > 2 { size * size } else { 1.0 };
    if !["revolute", "prismatic", "cylindrical", "in-line"].contains(&joint.word) || stiffness == 0.0 {
        build.im.refuse(
            section.line,
            "stops are translated of HINGE, TRANSLATOR, CYLINDRICAL and SLOT beside elastic parts",
        );
    } else if low > 0.0 || high < 0.0 {
        build.im.refuse(section.line, "this connector begins beyond its stops");
    } else {
        build.im.change(section.line, &format!("a stop is a spring of stiffness {stiffness:e}, not rigid"));
    }
    let limits = if joint.is_turned { [-high, -low] } else { [low, high] };
    table.numbers("limits", &limits).number("limit_stiffness", stiffness)
}

/// Adds motions and loads of the steps.
fn drives(
    build: &mut Build,
    section: &ConnectorSection,
    joint: &JointOf,
    table: DeckTable,
    ends: [u64; 2],
) -> DeckTable {
    let mut table = table;
    for drive in build.im.connectors.drives.clone() {
        let of_section = build.mesh.cell_indices(&build.im.scopes, &section.target).unwrap_or_default();
        let cells = build.cells(&drive.target);
        let is_this = cells.iter().any(|at| of_section.contains(at) && build.mesh.cells[*at].nodes[..2] == ends);
        if !is_this {
            continue;
        }
        if !joint.free.contains(&drive.component) {
            build.im.refuse(
                drive.line,
                &format!("component {} of this connection does not move by itself", drive.component + 1),
            );
            continue;
        }
        let is_rate = drive.quantity.is_some_and(|quantity| quantity != "position");
        if is_rate && build.timeline.stages.iter().any(|stage| !stage.is_dynamic) {
            let why = "a velocity or an acceleration in a static step is not translated: give the position";
            build.im.refuse(drive.line, why);
        }
        let sign = if joint.is_turned { -1.0 } else { 1.0 };
        let sign = sign * drive.amplitude.as_ref().map_or(1.0, |name| build.over_sine(name));
        let mut keys = vec![(drive.quantity.unwrap_or("value"), number(sign * drive.value))];
        if let Some(name) = &drive.amplitude {
            let name = build.amplitude_of_file(name, drive.line);
            keys.extend(name.map(|name| ("amplitude", quoted(&name))));
        } else if drive.quantity == Some("position") {
            let end = build.timeline.end().max(f64::MIN_POSITIVE);
            let ramp = DeckTable::new("amplitudes", drive.line).text("kind", "ramp").number("end", end);
            keys.push(("amplitude", quoted(&build.amplitude("ramp", ramp))));
        }
        table = table.value(if drive.quantity.is_some() { "motion" } else { "effort" }, inline(&keys));
    }
    table
}

/// A spring and damper along the line between two nodes.
fn axial(build: &mut Build, section: &ConnectorSection, name: &str, [a, b]: [u64; 2]) -> Option<DeckTable> {
    if refuse_one_place(build, section.line, [a, b]) {
        return None;
    }
    let behavior = behavior(build, section);
    refuse_rest(build, section, &behavior);
    if behavior.stiffness[1..].iter().chain(&behavior.damping[1..]).any(Option::is_some) {
        build.im.refuse(section.line, "AXIAL acts along component 1 alone");
    }
    let table = DeckTable::new("links", section.line)
        .text("name", name)
        .value("from", build.end(a, b))
        .value("to", build.end(b, a))
        .number("stiffness", behavior.stiffness[0].unwrap_or(0.0))
        .number("damping", behavior.damping[0].unwrap_or(0.0));
    Some(table)
}

/// Refuses stops, loads and motions, which links and bushings of the deck do not have.
fn refuse_rest(build: &mut Build, section: &ConnectorSection, behavior: &ConnectorBehavior) {
    if behavior.stops.iter().any(Option::is_some) {
        build.im.refuse(section.line, "stops of springs between two nodes are not translated");
    }
    let of_section = build.cells(&section.target);
    for drive in build.im.connectors.drives.clone() {
        if build.cells(&drive.target).iter().any(|at| of_section.contains(at)) {
            build.im.refuse(drive.line, "loads and motions of a connection that is a spring are not translated");
        }
    }
}

/// Springs and dampers along and about three axes.
fn bushing(build: &mut Build, section: &ConnectorSection, name: &str, [a, b]: [u64; 2]) -> DeckTable {
    let behavior = behavior(build, section);
    refuse_rest(build, section, &behavior);
    let axes = axes(build, section);
    let acts = |dof: usize| behavior.stiffness[dof].is_some() || behavior.damping[dof].is_some();
    let is_global = axes == [Vec3::x(), Vec3::y()];
    let turns: Vec<usize> = (3..6).filter(|&dof| if is_global { acts(dof) } else { (3..6).any(acts) }).collect();
    build.turning.extend([a, b].iter().flat_map(|node| turns.iter().map(|dof| (*node, *dof))));
    build.tied.bushed.extend([a, b].iter().filter(|node| **node != 0));
    let six = |of: &[Option<f64>; 6]| of.map(Option::unwrap_or_default);
    DeckTable::new("links", section.line)
        .text("name", name)
        .value("from", build.end(a, b))
        .value("to", build.end(b, a))
        .numbers("bushing", &six(&behavior.stiffness))
        .numbers("bushing_damping", &six(&behavior.damping))
        .value("axes", list(axes.iter().map(|axis| vector(axis.as_slice()))))
}

/// Refuses the changes of a joint with a spring, a stop or a drive that is not there from the first stage on: its coordinate has no origin.
fn refuse_later_coordinate(build: &mut Build, cell: usize) {
    let Some(acts) = build.timeline.acting.get(&cell) else { return };
    let acting: Vec<bool> = build.timeline.stages.iter().map(|stage| acts[stage.step]).collect();
    if acting.is_sorted_by(|before, after| before >= after) && acting.first() == Some(&true) {
        return;
    }
    let changes: Vec<ModelChange> =
        build.im.steps.list.iter().flat_map(|card| card.changes.clone()).filter(|change| !change.is_pair).collect();
    let why = "a joint with a spring, a stop or a drive does not come in a later step: leave it in, with a drive that is zero until then";
    for change in changes {
        if change.targets.iter().any(|target| build.cells(target).contains(&cell)) {
            build.im.refuse(change.line, why);
        }
    }
}
