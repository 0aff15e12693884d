//! Temperatures of nodes as loads on parts: `*TEMPERATURE`, initial temperatures, and the materials that they strain.

use crate::build::Build;
use crate::deck_text::DeckTable;
use crate::file_content::{StepCard, TemperatureLine};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::loads::{in_time, lines_of};
use crate::nodal_numbers::by_nodes;
use crate::part_piece::PartPiece;
use crate::pretension;
use crate::scopes::NamedTarget;
use crate::timeline::{GivenValue, InStep, TimeLaw, histories};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The index of a part and its field: 0 temperature, 1 gradient along the first axis of a beam, 2 along the second axis or the normal of a shell.
type HeatKey = (usize, usize);

/// The changes of temperature of the nodes of a part, where they differ.
struct NodalField {
    changes: BTreeMap<u64, f64>,
    /// The largest by size.
    largest: f64,
}

/// The fields of parts by their index.
type NodalFields = HashMap<usize, NodalField>;

/// `*TEMPERATURE`.
pub fn temperatures(im: &mut Importer, block: &KeywordBlock) {
    if !im.steps.is_open {
        return im.refuse(block.keyword.line, "no *STEP is open at this line");
    }
    let amplitude = block.keyword.value("AMPLITUDE").map(str::to_owned);
    let lines = lines(im, block, amplitude.as_ref());
    let step = im.steps.at_hand();
    step.new_temperatures |= block.keyword.value("OP").is_some_and(|op| op.eq_ignore_ascii_case("NEW"));
    step.temperatures.extend(lines);
}

/// `*INITIAL CONDITIONS, TYPE=TEMPERATURE`.
pub fn initial(im: &mut Importer, block: &KeywordBlock) {
    let lines = lines(im, block, None);
    im.steps.first_temperatures.extend(lines);
}

/// Node or set, temperature, gradients along the second and the first axis.
fn lines(im: &mut Importer, block: &KeywordBlock, amplitude: Option<&String>) -> Vec<TemperatureLine> {
    let mut lines = Vec::new();
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let mut number = |at: usize| im.number_at(data, at).unwrap_or(0.0);
        let values = [number(1), number(3), number(2)];
        if data.filled() > 4 {
            im.refuse(data.line, "temperatures at points of a section are not read: give a value and its gradients");
        }
        let target = im.target(&data.words[0]);
        lines.push(TemperatureLine { line: data.line, target, values, amplitude: amplitude.cloned() });
    }
    lines
}

impl Importer<'_, '_> {
    /// True where a temperature changes in some step.
    pub fn is_heated(&self) -> bool {
        self.steps.list.iter().any(|step| !step.temperatures.is_empty())
    }
}

/// The sets of nodes with temperatures. Parts are cut at their borders.
pub fn targets(im: &Importer) -> Vec<NamedTarget> {
    let steps = im.steps.list.iter().flat_map(|step| &step.temperatures);
    let mut seen = BTreeSet::new();
    let all = steps.chain(&im.steps.first_temperatures).map(|line| line.target.clone());
    all.filter(|target| seen.insert((target.scope, target.name.to_lowercase()))).collect()
}

/// Adds a load for each part whose temperature changes.
pub fn heat(build: &mut Build) {
    if !build.im.is_heated() {
        return;
    }
    let first = build.im.steps.first_temperatures.clone();
    let start = at_nodes(build, &first);
    let steps = build.im.steps.list.clone();
    let mut given: HashMap<usize, Vec<(HeatKey, GivenValue)>> = HashMap::new();
    let mut fields = NodalFields::new();
    for step in &steps {
        let of_step = of_parts(build, &step.temperatures, &start, &mut fields);
        given.insert(step.line, of_step);
    }
    let of = |step: &StepCard| given.get(&step.line).cloned().unwrap_or_default();
    let all = histories(&build.timeline, &steps, Vec::new(), of, |step| step.new_temperatures);
    let mut loads: BTreeMap<usize, Vec<(usize, TimeLaw, Vec<usize>)>> = BTreeMap::new();
    for ((part, component), history) in all {
        let never = history.iter().all(|state| !matches!(state, InStep::Begins(given) if given.value != 0.0));
        if !never {
            let law = build.law(&history, false);
            loads.entry(part).or_default().push((component, law, lines_of(&history)));
        }
    }
    for (part, of_part) in loads {
        write(build, part, of_part, fields.get(&part));
    }
}

/// Temperature and gradients of each node, with the line and amplitude that give them; later lines count.
fn at_nodes(build: &mut Build, lines: &[TemperatureLine]) -> HashMap<u64, TemperatureLine> {
    let mut of_node = HashMap::new();
    for line in lines {
        let nodes = build.nodes(&line.target);
        let nodes = pretension::with_ends(build, nodes);
        of_node.extend(nodes.into_iter().map(|node| (node, line.clone())));
    }
    of_node
}

/// Changes of temperature of parts in a step. Where the nodes of a part differ, their changes go into `fields`.
fn of_parts(
    build: &mut Build,
    lines: &[TemperatureLine],
    start: &HashMap<u64, TemperatureLine>,
    fields: &mut NodalFields,
) -> Vec<(HeatKey, GivenValue)> {
    let (of_node, mut given) = (at_nodes(build, lines), Vec::new());
    for (index, piece) in build.pieces.clone().iter().enumerate().filter(|(_, piece)| !piece.is_rigid) {
        let nodes: BTreeSet<u64> = piece.elements.iter().flat_map(|element| element.2.iter().copied()).collect();
        let Some(line) = nodes.iter().find_map(|node| of_node.get(node)) else { continue };
        let values = |of: &HashMap<u64, TemperatureLine>, node: &u64| of.get(node).map_or([0.0; 3], |line| line.values);
        let alike = |of: &HashMap<u64, TemperatureLine>| {
            nodes.iter().all(|node| values(of, node) == values(of, &nodes.first().copied().unwrap_or(0)))
        };
        if !alike(&of_node) || !alike(start) || !nodes.iter().all(|node| of_node.contains_key(node)) {
            match field(&nodes, &of_node, start) {
                Ok(field) if fields.get(&index).is_none_or(|known| known.changes == field.changes) => {
                    let value = GivenValue { value: field.largest, amplitude: line.amplitude.clone(), line: line.line };
                    given.push(((index, 0), value));
                    fields.insert(index, field);
                }
                Ok(_) => {
                    let about =
                        format!("the field of temperature over `{}` has another shape in a step before", piece.name);
                    build.im.refuse(line.line, &about);
                }
                Err(reason) => build.im.refuse(line.line, &format!("over the nodes of `{}` {reason}", piece.name)),
            }
            continue;
        }
        let Some(node) = nodes.first() else { continue };
        let before = values(start, node);
        if line.amplitude.is_some() && before != [0.0; 3] {
            build
                .im
                .refuse(line.line, "an amplitude multiplies the temperature, and the deck has its change: begin at 0");
            continue;
        }
        for component in 0..3 {
            let value = line.values[component] - before[component];
            given.push(((index, component), GivenValue { value, amplitude: line.amplitude.clone(), line: line.line }));
        }
    }
    given
}

/// The changes of temperature of nodes that differ. Errors: what else differs.
fn field(
    nodes: &BTreeSet<u64>,
    of_node: &HashMap<u64, TemperatureLine>,
    start: &HashMap<u64, TemperatureLine>,
) -> Result<NodalField, &'static str> {
    let before = |node: &u64| start.get(node).map_or([0.0; 3], |line| line.values);
    let lines = || nodes.iter().filter_map(|node| of_node.get(node));
    if lines().any(|line| line.values[1..] != [0.0; 2]) || nodes.iter().any(|node| before(node)[1..] != [0.0; 2]) {
        return Err("gradients of temperature do not go with temperatures that differ: cut it into parts");
    }
    let mut amplitudes = lines().map(|line| &line.amplitude);
    let first = amplitudes.next().cloned().flatten();
    if amplitudes.any(|amplitude| *amplitude != first) {
        return Err("temperatures have different amplitudes: cut it into parts");
    }
    if first.is_some() && nodes.iter().any(|node| before(node) != [0.0; 3]) {
        return Err("an amplitude multiplies the temperature, and the deck has its change: begin at 0");
    }
    // A node without a temperature keeps that of the start.
    let change = |node: &u64| of_node.get(node).map_or(0.0, |line| line.values[0] - before(node)[0]);
    let changes: BTreeMap<u64, f64> = nodes.iter().map(|node| (*node, change(node))).collect();
    let largest = changes.values().fold(0.0, |a: f64, b| if b.abs() > a.abs() { *b } else { a });
    Ok(NodalField { changes, largest })
}

/// Adds the loads of a part: one for each law in time.
fn write(build: &mut Build, part: usize, laws: Vec<(usize, TimeLaw, Vec<usize>)>, field: Option<&NodalField>) {
    let piece: PartPiece = build.pieces[part].clone();
    let mut done: BTreeMap<String, (TimeLaw, [f64; 3], BTreeSet<usize>)> = BTreeMap::new();
    for (component, law, lines) in laws {
        let key = format!("{:?} {:?}", law.amplitude, law.stages);
        let entry = done.entry(key).or_insert_with(|| (law.clone(), [0.0; 3], BTreeSet::new()));
        entry.1[component] = law.scale;
        entry.2.extend(lines);
    }
    for (law, [change, first, second], lines) in done.into_values() {
        let mut table = DeckTable::new("loads", 0).with_lines(lines).names("part", &piece.names);
        match field {
            Some(field) if change != 0.0 => {
                let factor = change / field.largest;
                let changed = field.changes.iter().filter(|(_, value)| **value != 0.0);
                let changes = changed.map(|(node, value)| (*node, factor * value)).collect();
                table = table.value("nodal_temperature", by_nodes(build, &changes, "warm"));
            }
            None if change != 0.0 => table = table.number("temperature", change),
            _ => {}
        }
        if [first, second] != [0.0; 2] {
            table = match piece.is_beam {
                true => table.numbers("temperature_gradient", &[first, second]),
                false => table.number("temperature_gradient", second),
            };
        }
        build.deck.add(in_time(table, Some(&law)));
    }
}
