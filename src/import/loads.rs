//! Forces and moments at nodes, and velocities at the start.

use crate::build::Build;
use crate::deck_text::DeckTable;
use crate::distributing;
use crate::file_content::{ForceLine, StepProcedure};
use crate::importer::Importer;
use crate::pretension;
use crate::scopes::NamedTarget;
use crate::timeline::{GivenValue, InStep, TimeLaw, histories};
use base::math::{Mat3, Vec3};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Node, degree of freedom, whether the force turns with the node, and whether it is an imaginary part.
type ForceKey = (u64, usize, bool, bool);

/// Velocity and angular velocity, their nodes, and their lines.
type MovingNodes = ([f64; 6], BTreeSet<u64>, BTreeSet<usize>);

/// Forces that act alike at several nodes.
#[derive(Default, Clone)]
struct AlikeForces {
    six: [f64; 6],
    nodes: BTreeSet<u64>,
    lines: BTreeSet<usize>,
    law: Option<TimeLaw>,
    is_follower: bool,
}

/// Adds all forces and moments.
pub fn loads(build: &mut Build) {
    let steps = &build.im.steps;
    let lines: Vec<ForceLine> = steps.list.iter().flat_map(|step| step.forces.clone()).collect();
    let given: HashMap<usize, Vec<(ForceKey, GivenValue)>> =
        lines.iter().map(|line| (line.line, given(build, line))).collect();
    for step in build.im.steps.list.clone() {
        let all = step.forces.iter().flat_map(|line| given[&line.line].clone());
        refuse_two_laws(build, all.map(|(key, given)| (format!("{key:?}"), given)));
    }
    let of = |forces: &[ForceLine]| -> Vec<(ForceKey, GivenValue)> {
        let mut sum: BTreeMap<ForceKey, GivenValue> = BTreeMap::new();
        for (key, one) in forces.iter().flat_map(|line| given[&line.line].clone()) {
            match sum.get_mut(&key) {
                Some(other) if other.amplitude == one.amplitude => other.value += one.value,
                _ => drop(sum.insert(key, one)),
            }
        }
        sum.into_iter().collect()
    };
    let steps = &build.im.steps;
    let all = histories(&build.timeline, &steps.list, Vec::new(), |step| of(&step.forces), |step| step.new_forces);
    let mut laws: Vec<(ForceKey, TimeLaw, Vec<usize>)> = Vec::new();
    for (key, history) in all {
        let lines = lines_of(&history);
        let law = build.law(&history, false);
        laws.push((key, law, lines));
    }
    laws.extend(of_own_steps(build, &of));
    let mut groups: BTreeMap<String, AlikeForces> = BTreeMap::new();
    let forces = by_node(laws, &build.tied.axes).into_iter().map(|(node, one)| (node, one.six, one)).collect();
    for (node, six, one) in distributing::spread(build, forces) {
        let one = AlikeForces { six, ..one };
        let key = format!("{:?} {:?} {}", one.six, one.law, one.is_follower);
        let group = groups.entry(key).or_default();
        group.nodes.insert(node);
        group.lines.extend(&one.lines);
        (group.six, group.law, group.is_follower) = (one.six, one.law, one.is_follower);
    }
    let targets = lines.into_iter().map(|line| (line.line, line.target)).collect();
    groups.into_values().for_each(|group| write(build, group, &targets));
}

/// Takes away the loads of steps of natural modes, on which they do not act.
pub fn drop_those_of_modes(im: &mut Importer) {
    for at in 0..im.steps.list.len() {
        let step = &mut im.steps.list[at];
        if !matches!(step.procedure, Some((StepProcedure::Frequency { .. }, _))) {
            continue;
        }
        let forces = step.forces.drain(..).map(|force| force.line);
        let lines: Vec<usize> = forces.chain(step.spread.drain(..).map(|load| load.line)).collect();
        lines.into_iter().for_each(|line| im.ignore(line, "loads of a step do not act on its natural modes"));
    }
}

/// Refuses loads of one step on one thing whose amplitudes differ, for they do not add up to one load.
pub fn refuse_two_laws(build: &mut Build, all: impl Iterator<Item = (String, GivenValue)>) {
    let mut first: HashMap<String, GivenValue> = HashMap::new();
    for (key, given) in all {
        let of_key = first.entry(key).or_insert_with(|| given.clone());
        if of_key.amplitude != given.amplitude {
            build.im.refuse(given.line, "a load in the same place and direction has another amplitude in this step");
        }
    }
}

/// What each line names.
pub type LineTargets = BTreeMap<usize, NamedTarget>;

/// What these lines name.
pub fn of_lines(lines: &BTreeSet<usize>, targets: &LineTargets) -> Vec<NamedTarget> {
    lines.iter().filter_map(|line| targets.get(line).cloned()).collect()
}

/// Lines that give values.
pub fn lines_of(history: &[InStep]) -> Vec<usize> {
    history.iter().filter_map(|state| if let InStep::Begins(given) = state { Some(given.line) } else { None }).collect()
}

/// Forces of buckling factors and of steady motions act in their own stages alone.
fn of_own_steps(
    build: &mut Build,
    of: &impl Fn(&[ForceLine]) -> Vec<(ForceKey, GivenValue)>,
) -> Vec<(ForceKey, TimeLaw, Vec<usize>)> {
    let mut laws = Vec::new();
    for (stage, step) in build.stages_with_own_loads() {
        for (key, given) in of(&build.im.steps.list[step].forces) {
            let law = build.law_in(&stage, &given);
            laws.push((key, law, vec![given.line]));
        }
    }
    laws
}

/// Forces of each node with one law in time.
fn by_node(laws: Vec<(ForceKey, TimeLaw, Vec<usize>)>, axes: &HashMap<u64, Mat3>) -> Vec<(u64, AlikeForces)> {
    let mut nodes: BTreeMap<(u64, bool, String), AlikeForces> = BTreeMap::new();
    for ((node, dof, is_follower, _), law, lines) in laws.into_iter().filter(|(_, law, _)| law.scale != 0.0) {
        let key = (node, is_follower, format!("{:?} {:?}", law.amplitude, law.stages));
        let alike = nodes.entry(key).or_default();
        let axis = axes.get(&node).map_or(Mat3::identity(), |axes| *axes).column(dof % 3) * law.scale;
        let first = dof - dof % 3;
        (0..3).filter(|i| axis[*i] != 0.0).for_each(|i| alike.six[first + i] += axis[i]);
        alike.lines.extend(lines);
        alike.is_follower = is_follower;
        alike.law = Some(TimeLaw { scale: 1.0, ..law });
    }
    nodes.into_iter().map(|((node, _, _), alike)| (node, alike)).collect()
}

/// Nodes and degrees of freedom of a line; those of a node that turns a body are moments on the body.
fn given(build: &mut Build, line: &ForceLine) -> Vec<(ForceKey, GivenValue)> {
    let mut nodes = build.nodes(&line.target);
    let of_sections = pretension::nodes(build);
    nodes.retain(|node| !of_sections.contains(node));
    let mut given = Vec::new();
    for node in nodes {
        let (node, shift) = match build.turned.get(&node) {
            Some(&reference) => (reference, 3),
            None => (node, 0),
        };
        if !build.mesh.used.contains(&node) && !build.tied.distributed.contains_key(&node) {
            if !build.im.is_incomplete() {
                build.im.refuse(line.line, &format!("node {node} has no element that this force could act on"));
            }
            continue;
        }
        let dof = line.degree + shift;
        if dof > 5 {
            continue;
        }
        let value = GivenValue { value: line.value, amplitude: line.amplitude.clone(), line: line.line };
        given.push(((node, dof, line.is_follower, line.is_imaginary), value));
    }
    given
}

fn write(build: &mut Build, group: AlikeForces, targets: &LineTargets) {
    let names = build.names(&group.nodes, &of_lines(&group.lines, targets), "loaded");
    let mut table = DeckTable::new("loads", 0).with_lines(group.lines.iter().copied()).names("at", &names);
    for (key, part) in [("force", &group.six[..3]), ("moment", &group.six[3..])] {
        if part.iter().any(|x| *x != 0.0) {
            table = table.numbers(key, part);
        }
    }
    if group.is_follower {
        table = table.value("follower", "true");
    }
    let table = in_time(table, group.law.as_ref());
    build.deck.add(table);
}

/// Adds amplitude and stages of a load.
pub fn in_time(table: DeckTable, law: Option<&TimeLaw>) -> DeckTable {
    let Some(law) = law else { return table };
    let table = match &law.amplitude {
        Some(name) => table.text("amplitude", name),
        None => table,
    };
    table.in_stages(law.stages.as_deref())
}

/// Adds rigid motions at the start. Returns their nodes; refuses lines that share some.
fn rotations(build: &mut Build) -> BTreeSet<u64> {
    let mut moving = BTreeSet::new();
    for card in build.im.steps.rotations.clone() {
        if card.velocity == Vec3::zeros() && card.spin == Vec3::zeros() {
            build.im.ignore(card.line, "all begins at rest");
            continue;
        }
        let nodes = build.nodes(&card.nodes);
        let nodes = pretension::with_ends(build, nodes);
        let nodes: BTreeSet<u64> = nodes.into_iter().filter(|node| build.mesh.used.contains(node)).collect();
        if nodes.is_empty() {
            if !build.im.is_incomplete() {
                build.im.refuse(card.line, &format!("no node of `{}` has an element that could move", card.nodes.name));
            }
            continue;
        }
        refuse_moved_twice(build, card.line, nodes.intersection(&moving).next().copied());
        let names = build.names(&nodes, std::slice::from_ref(&card.nodes), "moving");
        moving.extend(nodes);
        let mut table = DeckTable::new("initial", 0).with_lines([card.line]).names("at", &names);
        if card.velocity != Vec3::zeros() {
            table = table.numbers("velocity", card.velocity.as_slice());
        }
        if card.spin != Vec3::zeros() {
            table = table.numbers("angular_velocity", card.spin.as_slice()).numbers("about", card.about.as_slice());
        }
        build.deck.add(table);
    }
    moving
}

/// Refuses a velocity at the start of a node that has one by another line.
fn refuse_moved_twice(build: &mut Build, line: usize, node: Option<u64>) {
    if let Some(node) = node {
        build.im.refuse(line, &format!("node {node} has a rotating velocity by another line: give it one of them"));
    }
}

/// Adds velocities at the start.
pub fn velocities(build: &mut Build) {
    let moving = rotations(build);
    let mut of_node: BTreeMap<u64, ([f64; 6], BTreeSet<usize>)> = BTreeMap::new();
    let all = build.im.steps.velocities.clone();
    for (line, target, dof, value) in &all {
        if *value == 0.0 {
            build.im.ignore(*line, "all begins at rest");
        }
        let nodes = build.nodes(target);
        let nodes = pretension::with_ends(build, nodes);
        refuse_moved_twice(build, *line, nodes.iter().find(|node| moving.contains(node)).copied());
        for node in nodes {
            if build.mesh.used.contains(&node) {
                let entry = of_node.entry(node).or_default();
                entry.0[*dof] = *value;
                entry.1.insert(*line);
            }
        }
    }
    let mut groups: BTreeMap<String, MovingNodes> = BTreeMap::new();
    for (node, (six, lines)) in of_node {
        let group = groups.entry(format!("{six:?}")).or_insert((six, BTreeSet::new(), BTreeSet::new()));
        group.1.insert(node);
        group.2.extend(lines);
    }
    let targets = all.into_iter().map(|(line, target, _, _)| (line, target)).collect();
    for (six, nodes, lines) in groups.into_values().filter(|(six, ..)| *six != [0.0; 6]) {
        let names = build.names(&nodes, &of_lines(&lines, &targets), "moving");
        let mut table = DeckTable::new("initial", 0).with_lines(lines).names("at", &names);
        for (key, part) in [("velocity", &six[..3]), ("angular_velocity", &six[3..])] {
            if part.iter().any(|x| *x != 0.0) {
                table = table.numbers(key, part);
            }
        }
        build.deck.add(table);
    }
}
