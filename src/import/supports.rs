//! Supports: fixed and moved degrees of freedom, with their stages.

use crate::bodies::DEGREES;
use crate::build::Build;
use crate::deck_text::{DeckTable, inline, list, number, quoted, vector};
use crate::file_content::SupportLine;
use crate::loads::{LineTargets, of_lines};
use crate::pretension;
use crate::timeline::{GivenValue, InStep, histories};
use base::math::Mat3;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The support of a degree of freedom.
#[derive(Debug, Clone, PartialEq)]
enum HeldAs {
    /// Held where it is.
    Fixed,
    /// Moved: scale, amplitude, and the quantity of the amplitude.
    Moved(f64, Option<String>, &'static str),
    /// Led from where it is to a displacement, over its first stage.
    Led(f64),
}

/// A degree of freedom and the stages of its support.
type Held = (HeldAs, Option<Vec<String>>);

/// Nodes with the same supports, and their lines.
#[derive(Default)]
struct Alike {
    held: [Option<Held>; 6],
    axes: Option<Mat3>,
    nodes: BTreeSet<u64>,
    lines: BTreeSet<usize>,
}

/// A node, its degree of freedom, and the entry of a line.
type GivenFreedom = ((u64, usize), GivenValue);

/// Adds all supports.
pub fn supports(build: &mut Build) {
    let steps = &build.im.steps;
    let lines: Vec<SupportLine> =
        steps.list.iter().chain([&steps.before]).flat_map(|step| step.supports.clone()).collect();
    let by_line: HashMap<usize, SupportLine> = lines.iter().map(|line| (line.line, line.clone())).collect();
    let given: HashMap<usize, Vec<GivenFreedom>> = lines.iter().map(|line| (line.line, given(build, line))).collect();
    let of = |supports: &[SupportLine]| -> Vec<GivenFreedom> {
        supports.iter().flat_map(|line| given[&line.line].clone()).collect()
    };
    let steps = &build.im.steps;
    let all = histories(
        &build.timeline,
        &steps.list,
        of(&steps.before.supports),
        |step| of(&step.supports),
        |step| step.new_supports,
    );
    let mut of_node: BTreeMap<u64, Alike> = BTreeMap::new();
    for ((node, dof), history) in all {
        let lines: Vec<usize> = history
            .iter()
            .filter_map(|state| if let InStep::Begins(given) = state { Some(given.line) } else { None })
            .collect();
        let held = held(build, history, dof, &by_line);
        let entry = of_node.entry(node).or_default();
        entry.held[dof] = held;
        entry.lines.extend(lines);
    }
    add_rotations(build, &mut of_node);
    let mut groups: BTreeMap<String, Alike> = BTreeMap::new();
    for (node, alike) in of_node {
        let axes = build.tied.axes.get(&node).copied();
        let group = groups.entry(format!("{:?} {axes:?}", alike.held)).or_default();
        (group.held, group.axes) = (alike.held, axes);
        group.nodes.insert(node);
        group.lines.extend(alike.lines);
    }
    let targets = lines.into_iter().map(|line| (line.line, line.target)).collect();
    for group in groups.into_values() {
        write(build, group, &targets);
    }
}

/// Nodes and degrees of freedom of a line; those of a node that turns a body are rotations of the body.
fn given(build: &mut Build, line: &SupportLine) -> Vec<GivenFreedom> {
    let mut nodes = build.nodes(&line.target);
    let of_sections = pretension::nodes(build);
    nodes.retain(|node| !of_sections.contains(node));
    let mut given = Vec::new();
    let mut unused = false;
    for node in nodes {
        let (node, shift) = match build.turned.get(&node) {
            Some(&reference) => (reference, 3),
            None => (node, 0),
        };
        if !build.mesh.used.contains(&node) {
            unused = true;
            continue;
        }
        for dof in line.degrees.iter().map(|dof| dof + shift).filter(|dof| *dof < 6) {
            let value = GivenValue { value: line.value, amplitude: line.amplitude.clone(), line: line.line };
            given.push(((node, dof), value));
        }
    }
    if unused {
        build.im.ignore(line.line, "nodes without elements are not in the model");
    }
    given
}

/// The support of one degree of freedom.
fn held(build: &mut Build, mut history: Vec<InStep>, dof: usize, lines: &HashMap<usize, SupportLine>) -> Option<Held> {
    let is_fixed = |given: &GivenValue| lines.get(&given.line).is_some_and(|line| line.is_fixed);
    for at in 1..history.len() {
        if let InStep::Begins(given) = &history[at]
            && is_fixed(given)
            && history[at - 1] != InStep::Absent
        {
            history[at] = InStep::Holds;
        }
    }
    let first = history.iter().position(|state| *state != InStep::Absent)?;
    let InStep::Begins(start) = history[first].clone() else { return None };
    let is_zero = history.iter().all(|state| match state {
        InStep::Begins(given) => given.value == 0.0,
        _ => true,
    });
    if first > 0 && !is_fixed(&start) {
        let stage = |at: &usize| &build.timeline.stages[*at];
        let is_still = build.timeline.general[first..].iter().all(|at| !stage(at).is_dynamic);
        let goes_on = history[first + 1..].iter().all(|state| *state == InStep::Holds);
        let is_plain =
            start.amplitude.is_none() && lines.get(&start.line).is_some_and(|line| line.history == "displacement");
        if dof < 3 && is_still && goes_on && is_plain && build.timeline.is_staged() {
            return Some((HeldAs::Led(start.value), build.timeline.from(first)));
        }
        build.im.refuse(
            start.line,
            "a rotation, or a displacement before motion in time, that was free before is held where it is found, not at a value: say FIXED",
        );
        return None;
    }
    let end = history.iter().rposition(|state| *state != InStep::Absent).unwrap_or(first);
    if history[first..=end].contains(&InStep::Absent) {
        build.im.refuse(start.line, "a support that ends and comes again is not translated");
        return None;
    }
    if is_zero {
        let stages = match (first, end + 1 == history.len()) {
            (0, true) => None,
            (_, true) => build.timeline.from(first),
            _ => {
                let general = &build.timeline.general[first..=end];
                Some(general.iter().map(|&at| build.timeline.stages[at].name.clone()).collect())
            }
        };
        return Some((HeldAs::Fixed, stages));
    }
    let kind = lines.get(&start.line).map_or("displacement", |line| line.history);
    moved(build, &history, (first, &start), kind)
}

/// The motion of a degree of freedom from a step on; refuses one that no deck says.
fn moved(
    build: &mut Build,
    history: &[InStep],
    (first, start): (usize, &GivenValue),
    kind: &'static str,
) -> Option<Held> {
    let stage = &build.timeline.stages[build.timeline.general[first]];
    let is_still = |at: &usize| !build.timeline.stages[*at].is_dynamic;
    let why = if history.last() == Some(&InStep::Absent) {
        "a moved support that is freed later is not translated"
    } else if kind != "displacement" && build.timeline.general[first..].iter().any(is_still) {
        "a velocity or an acceleration in a static step is not translated: give the displacement"
    } else if stage.is_dynamic && kind == "displacement" && start.amplitude.is_none() {
        "a displacement that jumps at the start of a dynamic step needs an AMPLITUDE"
    } else {
        let law = build.law(history, true);
        return Some((HeldAs::Moved(law.scale, law.amplitude, kind), law.stages));
    };
    build.im.refuse(start.line, why);
    None
}

/// Fixes motions without stiffness: rotations of nodes joined only by bushings, and motion out of the plane of plane elements.
fn add_rotations(build: &mut Build, of_node: &mut BTreeMap<u64, Alike>) {
    let mut add = |node: u64, degrees: &[usize]| {
        let alike = of_node.entry(node).or_default();
        for &dof in degrees {
            alike.held[dof].get_or_insert((HeldAs::Fixed, None));
        }
    };
    for node in
        build.tied.bushed.iter().filter(|node| !build.rotating.contains(node) && !build.body_of.contains_key(node))
    {
        let still: Vec<usize> = (3..6).filter(|dof| !build.turning.contains(&(*node, *dof))).collect();
        add(*node, &still);
    }
    let is_plane = |name: &str| ["B2", "T2", "PIPE2", "R2D", "RB2"].iter().any(|begin| name.starts_with(begin));
    for cell in build.mesh.cells.iter().filter(|cell| is_plane(&build.im.scopes.types[cell.kind].name)) {
        let turns = cell.nodes.iter().filter(|node| build.mesh.used.contains(node));
        for node in turns {
            add(*node, if build.rotating.contains(node) { &[2, 3, 4] } else { &[2] });
        }
    }
}

/// Writes the supports of nodes that are held alike: a table for each choice of stages.
fn write(build: &mut Build, group: Alike, targets: &LineTargets) {
    let mut seen: Vec<Option<Vec<String>>> = Vec::new();
    for (_, stages) in group.held.iter().flatten() {
        if !seen.contains(stages) {
            seen.push(stages.clone());
        }
    }
    if seen.is_empty() {
        return;
    }
    let names = build.names(&group.nodes, &of_lines(&group.lines, targets), "held");
    for stages in seen {
        let mut table = DeckTable::new("supports", 0).with_lines(group.lines.iter().copied()).names("at", &names);
        let here = |dof: &usize| group.held[*dof].as_ref().filter(|(_, at)| *at == stages).map(|(held, _)| held);
        let fixed: Vec<usize> = (0..6).filter(|dof| here(dof) == Some(&HeldAs::Fixed)).collect();
        if !fixed.is_empty() {
            table = table.value("fix", words(&fixed));
        }
        let moved: Vec<(&str, String)> = (0..6)
            .filter_map(|dof| match here(&dof) {
                Some(HeldAs::Moved(scale, amplitude, kind)) => {
                    Some((DEGREES[dof], motion(*scale, amplitude.as_ref(), kind)))
                }
                Some(HeldAs::Led(value)) => Some((DEGREES[dof], inline(&[("to", number(*value))]))),
                _ => None,
            })
            .collect();
        if let Some(axes) = group.axes.filter(|_| !is_alike_along_any_axes(&fixed, moved.len())) {
            let [first, second] = [axes.column(0), axes.column(1)].map(|axis| vector(axis.as_slice()));
            table = table.value("axes", list([first, second].into_iter()));
            if moved.iter().any(|(dof, _)| dof.starts_with('r')) {
                let line = group.lines.first().copied().unwrap_or(0);
                build.im.refuse(line, "rotations along axes of *TRANSFORM are held, not moved: give global ones");
            }
        }
        if !moved.is_empty() {
            table = table.value("motion", inline(&moved));
        }
        build.deck.add(table.in_stages(stages.as_deref()));
    }
}

/// True where the axes make no difference: all translations or none are held, and all rotations or none.
fn is_alike_along_any_axes(fixed: &[usize], moved: usize) -> bool {
    moved == 0 && matches!(fixed, [] | [0, 1, 2] | [3, 4, 5] | [0, 1, 2, 3, 4, 5])
}

/// Degrees of freedom as the deck writes them.
fn words(degrees: &[usize]) -> String {
    match degrees {
        [0, 1, 2, 3, 4, 5] => quoted("all"),
        [0, 1, 2] => quoted("translations"),
        [3, 4, 5] => quoted("rotations"),
        some => list(some.iter().map(|dof| quoted(DEGREES[*dof]))),
    }
}

fn motion(scale: f64, amplitude: Option<&String>, kind: &str) -> String {
    let mut keys = vec![("scale", number(scale))];
    keys.extend(amplitude.map(|name| ("amplitude", quoted(name))));
    if kind != "displacement" {
        keys.push(("history", quoted(kind)));
    }
    inline(&keys)
}
