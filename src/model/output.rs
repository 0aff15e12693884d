//! `[output]`: tables, nodes and times of output.

use super::data::{BETWEEN_SETS, Cadence, Drift, FieldFiles, FieldFormat, Model, Node, Output};
use super::places::place::Place;
use super::report::{Owner, Report};
use super::scene::{Reach, Scene};
use super::values::flag;
use base::diagnostic::At;
use deck::output as words;
use deck::words::{FlagOrTable, Table};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Files of fields at most, unless the deck says how many.
const MOST_FIELDS: f64 = 200.0;
/// The word for the nodes that the deck names.
const NAMED: &str = "named";
/// Largest number of output times; more are taken for a typing error, and would exhaust memory.
const MOST_ROWS: f64 = 1e7;

/// The format of field files.
fn field_format(table: &Table<words::Output>) -> FieldFormat {
    let word = table.fields.as_ref().and_then(|fields| fields.format.as_ref());
    match word.map(|word| word.value) {
        Some(words::Format::Frd) => FieldFormat::Frd,
        _ => FieldFormat::Vtu,
    }
}

/// The output of a run. For `nodes = "all"` the list of nodes stays empty until unused nodes have been removed.
pub(super) struct Selection {
    /// The output.
    pub output: Output,
    /// True for `nodes = "all"`.
    pub all_nodes: bool,
}

/// Reads `[output]`: the tables, their nodes and their times.
pub(super) fn output<'d>(scene: &Scene<'d>, nodes: &[Node], is_arc_length: bool, report: &mut Report<'d>) -> Selection {
    let units = scene.deck.units.as_ref().map(|units| units.label().to_owned());
    let Some(table) = &scene.deck.output else {
        let nodes = named_nodes(scene, nodes);
        return Selection { output: by_default(scene, nodes, units, report), all_nodes: false };
    };
    let word = table.nodes.as_ref().filter(|nodes| nodes.single).map(|nodes| nodes.values[0].as_str());
    let (nodes, sets) = match word {
        Some("all") => (Vec::new(), Vec::new()),
        Some(NAMED) => (named_nodes(scene, nodes), Vec::new()),
        _ if table.nodes.is_none() => (named_nodes(scene, nodes), Vec::new()),
        _ => listed_nodes(scene, nodes, table, report),
    };
    let end_time = scene.analysis.duration();
    let cadence = cadence(table, end_time, is_arc_length, report);
    let fields = table.fields.as_ref().map(|fields| {
        report.require(&Owner::new("`fields`", &fields.span), "format", &fields.format);
        let cadence = match &fields.every {
            Some(_) => Cadence::Steps(report.count("every", &fields.every, 1)),
            None if is_arc_length => Cadence::Steps(1),
            None => Cadence::at_most(MOST_FIELDS, end_time, &scene.analysis.step_length),
        };
        FieldFiles { cadence, format: field_format(table) }
    });
    let output = Output {
        units,
        nodes,
        sets,
        drifts: drifts(scene, report),
        cadence,
        cadence_is_open: table.every.is_none() && table.interval.is_none(),
        energy: flag(&table.energy, true),
        links: flag(&table.links, false),
        contacts: contacts(table, report),
        reactions: flag(&table.reactions, false),
        sections: sections(table, report),
        failures: may_fail(scene),
        layers: flag(&table.layers, false),
        parts: flag(&table.parts, false),
        joints: flag(&table.joints, false),
        fields,
        checkpoint: report.positive("checkpoint", &table.checkpoint),
    };
    Selection { output, all_nodes: word == Some("all") }
}

/// The output of a deck without `[output]`.
fn by_default<'d>(scene: &Scene<'d>, nodes: Vec<usize>, units: Option<String>, report: &mut Report<'d>) -> Output {
    Output {
        units,
        nodes,
        sets: Vec::new(),
        drifts: drifts(scene, report),
        cadence: Cadence::Steps(1),
        cadence_is_open: true,
        energy: true,
        links: false,
        contacts: None,
        reactions: false,
        sections: None,
        failures: may_fail(scene),
        layers: false,
        parts: false,
        joints: false,
        fields: None,
        checkpoint: None,
    }
}

/// Lists all nodes of a model but bodies, for output.
pub(super) fn write_all_nodes(model: &mut Model) {
    let mut is_other = vec![false; model.nodes.len()];
    model.bodies.iter().for_each(|body| is_other[body.node] = true);
    let heats = model.parts.iter().filter_map(|part| part.heat());
    heats.flat_map(|heat| heat.numbers).flatten().for_each(|node| is_other[node] = true);
    // Arms of ties are no nodes of the deck.
    for tie in model.constraints.joints.iter().filter(|joint| joint.is_tie()) {
        tie.all_ends().for_each(|node| is_other[node] |= model.nodes[node].label.starts_with(&tie.name));
    }
    let amplitudes = model.parts.iter_mut().filter(|part| part.kind().is_floating());
    amplitudes.for_each(|part| part.visit_nodes(&mut |&mut node| is_other[node] |= model.nodes[node].is_number));
    let reduced = model.reductions.iter().flat_map(|reduction| &reduction.amplitudes);
    reduced.for_each(|&node| is_other[node] = true);
    model.output.nodes = (0..model.nodes.len()).filter(|&node| !is_other[node]).collect();
}

fn is_body(scene: &Scene, node: usize) -> bool {
    scene.bodies.binary_search_by_key(&node, |body| body.node).is_ok()
}

/// Nodes that the deck names, without bodies.
fn named_nodes(scene: &Scene, nodes: &[Node]) -> Vec<usize> {
    (0..nodes.len()).filter(|&node| nodes[node].named && !is_body(scene, node)).collect()
}

/// Nodes that the table lists, sorted. Their names come with them if one of these is no point. Among names, "named" means all points of
/// the deck.
fn listed_nodes<'d>(
    scene: &Scene<'d>,
    nodes: &[Node],
    table: &'d At<Table<words::Output>>,
    report: &mut Report<'d>,
) -> (Vec<usize>, Vec<String>) {
    let list = table.nodes.iter().flat_map(|list| &list.values);
    let (word, names): (Vec<_>, Vec<_>) = list.partition(|name| name.value == NAMED);
    let spots = scene.spots_of("nodes", names.iter().copied(), Reach::Parts, report);
    for spot in spots.iter().filter(|spot| spot.direct && is_body(scene, spot.node)) {
        let message = format!("`{}` is a body, and not written with the nodes", spot.name);
        report.error_with::<()>(spot.span, message, "remove it: bodies are always written to bodies.csv");
    }
    let named = if word.is_empty() { Vec::new() } else { named_nodes(scene, nodes) };
    let listed = spots.iter().filter(|spot| !is_body(scene, spot.node));
    let nodes: BTreeSet<usize> = listed.clone().map(|spot| spot.node).chain(named.iter().copied()).collect();
    if listed.clone().all(|spot| spot.direct) {
        return (nodes.into_iter().collect(), Vec::new());
    }
    let mut of_nodes = names_of(scene, names.into_iter());
    named.into_iter().for_each(|node| add_name(of_nodes.entry(node).or_default(), NAMED));
    let sets = nodes.iter().map(|node| of_nodes.get(node).cloned().unwrap_or_default()).collect();
    (nodes.into_iter().collect(), sets)
}

/// Adds a name to those that cover a node.
fn add_name(names: &mut String, name: &str) {
    *names += if names.is_empty() { "" } else { BETWEEN_SETS };
    *names += name;
}

/// The names that cover each node, in their order and each once.
fn names_of<'n>(scene: &Scene, names: impl Iterator<Item = &'n At<String>>) -> BTreeMap<usize, String> {
    let (mut seen, mut covered) = (HashSet::new(), BTreeMap::<usize, String>::new());
    for name in names.filter(|name| seen.insert(name.as_str())) {
        let place = scene.place_or_node(name);
        let nodes: BTreeSet<usize> = place.into_iter().flat_map(|place| scene.nodes_of(place)).collect();
        for node in nodes {
            add_name(covered.entry(node).or_default(), name);
        }
    }
    covered
}

/// The sets, groups and parts that supports of any stage name, by the labels of their nodes; none without a table of reactions.
pub(super) fn supported_sets(asked: &Selection, scene: &Scene, nodes: &[Node]) -> HashMap<String, String> {
    if !asked.output.reactions {
        return HashMap::new();
    }
    let deck = scene.stage.map_or(scene.deck, |stage| stage.sequence.whole);
    let names = deck.supports.iter().flat_map(|support| &support.at).flat_map(|at| &at.values);
    let of_several = names.filter(|name| !matches!(scene.names.place(name), Some(Place::Point(_) | Place::Body(_))));
    names_of(scene, of_several).into_iter().map(|(node, names)| (nodes[node].label.clone(), names)).collect()
}

/// Reads `[[drifts]]`. One with an error is left out, so that places in the list are those of the deck only in a sound one.
fn drifts<'d>(scene: &Scene<'d>, report: &mut Report<'d>) -> Vec<Drift> {
    let mut drifts = Vec::new();
    for table in &scene.deck.drifts {
        let owner = Owner::new("`[[drifts]]`", &table.span);
        let name = report.require(&owner, "name", &table.name);
        let from = report.require(&owner, "from", &table.from).and_then(|name| drift_end(scene, name, report));
        let to = report.require(&owner, "to", &table.to).and_then(|at| Some((at, drift_end(scene, at, report)?)));
        let (Some(name), Some(from), Some((at, to))) = (name, from, to) else { continue };
        if from == to {
            report.error_with::<()>(&at.span, "a drift needs two different points", "`from` is the same");
        }
        drifts.push(Drift { name: name.value.clone(), ends: [from, to] });
    }
    drifts
}

/// The node of a point or body.
fn drift_end<'d>(scene: &Scene<'d>, name: &'d At<String>, report: &mut Report<'d>) -> Option<usize> {
    match scene.place_or_node(name) {
        Some(Place::Point(node)) => Some(node),
        Some(Place::Body(body)) => Some(scene.names.body_node(body)),
        Some(place) => {
            let message = format!("a drift goes from point to point, and `{}` is {}", name.value, place.kind());
            report.error_with(&name.span, message, "name a point or a body")
        }
        None => {
            let known = || scene.names.known(|place| matches!(place, Place::Point(_) | Place::Body(_)));
            scene.names.unknown("point or body", name, known, report)
        }
    }
}

/// True where a part of the deck may fail in any stage.
fn may_fail(scene: &Scene) -> bool {
    scene.deck.links.iter().any(|link| link.failure.is_some())
        || scene.deck.materials.0.iter().any(|(_, material)| material.value.values.place("failure_strain").is_some())
}

/// Whether stress resultants are written, and where in beams.
fn sections<'d>(table: &'d words::Output, report: &mut Report<'d>) -> Option<words::SectionPlaces> {
    let sections = table.sections.as_ref()?;
    match &sections.value {
        FlagOrTable::Flag(flag) => flag.then_some(words::SectionPlaces::Points),
        FlagOrTable::Table(places) => {
            let owner = Owner::new("`sections`", &sections.span);
            let places = report.require(&owner, "at", &places.at);
            Some(places.map_or(words::SectionPlaces::Points, |places| places.value))
        }
    }
}

/// Which tables of contacts are written.
fn contacts<'d>(table: &'d words::Output, report: &mut Report<'d>) -> Option<words::ContactRows> {
    let contacts = table.contacts.as_ref()?;
    match &contacts.value {
        FlagOrTable::Flag(flag) => flag.then_some(words::ContactRows::Contacts),
        FlagOrTable::Table(rows) => {
            let owner = Owner::new("`contacts`", &contacts.span);
            let rows = report.require(&owner, "by", &rows.by);
            Some(rows.map_or(words::ContactRows::Contacts, |rows| rows.value))
        }
    }
}

fn cadence(table: &words::Output, end_time: f64, is_arc_length: bool, report: &mut Report) -> Cadence {
    let Some(at) = &table.interval else { return Cadence::Steps(report.count("every", &table.every, 1)) };
    if table.every.is_some() {
        report.error::<()>(&at.span, "`[output]` takes `every` or `interval`, not both");
        return Cadence::Steps(1);
    }
    let Some(interval) = report.positive("interval", &table.interval) else { return Cadence::Steps(1) };
    // A missing end time has been reported.
    if end_time < f64::MAX && end_time / interval > MOST_ROWS {
        let message = format!("`interval` asks for {:.1e} rows", end_time / interval);
        report.error_with::<()>(&at.span, message, format!("at most {MOST_ROWS:.0e} are allowed"));
    }
    if is_arc_length {
        let hint = "give `every`, which counts steps";
        report.error_with::<()>(&at.span, "with arc-length control no output times can be given", hint);
    }
    Cadence::Interval(interval)
}
