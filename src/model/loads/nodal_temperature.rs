//! Temperatures by node: the mean over each element, relative to the largest of the part.

use crate::parts::Parts;
use crate::places::nodes::Topology;
use crate::places::place::Place;
use crate::report::Report;
use crate::scene::Scene;
use deck::loads as words;
use deck::parts::PartIndex;
use std::collections::{HashMap, HashSet};

/// The temperatures of the elements of a part of the deck.
pub struct NodalTemperatures {
    /// The largest by size.
    pub largest: f64,
    /// Those of all elements over the largest, model part by model part.
    factors: Vec<Vec<f64>>,
}

impl NodalTemperatures {
    /// Gives the factors to the parts.
    pub fn give(self, parts: &mut Parts, part: PartIndex) {
        let range = parts.entry(part).map_or(0..0, |entry| entry.range.clone());
        let heats = parts.list[range].iter_mut().map(|part| part.heat_mut());
        for (heat, factors) in heats.zip(self.factors) {
            if let Some(heat) = heat {
                heat.factors = factors;
            }
        }
    }
}

/// Reads `nodal_temperature` for a part; `None` where the load has none.
pub fn nodal_temperatures<'d>(
    scene: &Scene<'d>,
    load: &'d words::Load,
    part: PartIndex,
    topology: &Topology,
    report: &mut Report<'d>,
) -> Option<NodalTemperatures> {
    let mut given = HashMap::new();
    for (name, temperature) in &load.nodal_temperature.0 {
        let Some(place) = scene.names.find_nodes(name, report) else { continue };
        given.extend(scene.names.nodes_of(place, &scene.parts).into_iter().map(|node| (node, temperature.value)));
    }
    if given.is_empty() {
        return None;
    }
    let entry = scene.parts.entry(part)?;
    let elsewhere = load.temperature.as_ref().map_or(0.0, |at| at.value);
    let field = Field {
        inner: inner_nodes(scene, part, topology, (&given, elsewhere)),
        places: given.iter().map(|(node, value)| (topology.x(*node).map(f64::to_bits).into(), *value)).collect(),
        carried: &entry.carried,
        given,
        elsewhere,
    };
    let of_part = |index: usize| {
        let part = &scene.parts.list[index];
        let mean = |element: usize| {
            let nodes = part.corners(element);
            nodes.iter().map(|&node| field.at(node, topology)).sum::<f64>() / nodes.len() as f64
        };
        (0..part.elements()).map(mean).collect::<Vec<f64>>()
    };
    let mut factors: Vec<Vec<f64>> = entry.range.clone().map(of_part).collect();
    let larger = |a: f64, b: &f64| if b.abs() > a.abs() { *b } else { a };
    let largest = factors.iter().flatten().fold(0.0, larger);
    if largest != 0.0 {
        factors.iter_mut().flatten().for_each(|factor| *factor /= largest);
    }
    Some(NodalTemperatures { largest, factors })
}

/// Reports entries of `nodal_temperature` that name no node of these parts.
pub fn check_nodes<'d>(
    scene: &Scene<'d>,
    load: &'d words::Load,
    parts: &[PartIndex],
    topology: &Topology,
    report: &mut Report<'d>,
) {
    let entries = || parts.iter().filter_map(|part| scene.parts.entry(*part));
    let nodes = entries().flat_map(|entry| entry.nodes.iter().chain(entry.carried.values()));
    let all: HashSet<usize> = nodes.flat_map(|&node| [Some(node), topology.master(node)]).flatten().collect();
    let place = |node: usize| <[u64; 3]>::from(topology.x(node).map(f64::to_bits));
    let places: HashSet<[u64; 3]> = all.iter().map(|&node| place(node)).collect();
    for (name, _) in load.nodal_temperature.0.iter().filter(|_| !all.is_empty()) {
        let named = scene.names.place(name).map_or_else(Vec::new, |place| scene.names.nodes_of(place, &scene.parts));
        if !named.is_empty() && !named.iter().any(|node| all.contains(node) || places.contains(&place(*node))) {
            let message =
                format!("`{}` has no node of the heated parts, so this temperature is of nothing", name.value);
            report.error_with::<()>(&name.span, message, "name nodes of the parts in `part`, or remove the entry");
        }
    }
}

/// The temperatures at the nodes of a part.
struct Field<'a> {
    given: HashMap<usize, f64>,
    /// The same by place, for the ends of released beams.
    places: HashMap<[u64; 3], f64>,
    /// The temperatures of the nodes between the points of a path.
    inner: HashMap<usize, f64>,
    carried: &'a HashMap<usize, usize>,
    /// The temperature of all other nodes.
    elsewhere: f64,
}

impl Field<'_> {
    fn at(&self, node: usize, topology: &Topology) -> f64 {
        let node = self.carried.get(&node).copied().unwrap_or(node);
        let of = |node: usize| self.given.get(&node).or_else(|| self.inner.get(&node));
        let by_place = || self.places.get(&<[u64; 3]>::from(topology.x(node).map(f64::to_bits)));
        // The ends of beams with offsets depend on their points.
        let by_master = || topology.master(node).and_then(of);
        of(node).or_else(by_place).or_else(by_master).copied().unwrap_or(self.elsewhere)
    }
}

/// The temperatures of the nodes between the points of the path of a part, which are linear along it.
fn inner_nodes(
    scene: &Scene,
    part: PartIndex,
    topology: &Topology,
    (given, elsewhere): (&HashMap<usize, f64>, f64),
) -> HashMap<usize, f64> {
    let mut inner = HashMap::new();
    let Some(table) = scene.deck.part(part).filter(|part| part.at.kind.is_line() && part.table.group().is_none())
    else {
        return inner;
    };
    let points = table.table.members().into_iter().filter_map(|name| match scene.names.place(name) {
        Some(Place::Point(node)) => Some(node),
        _ => None,
    });
    let ends: HashSet<usize> = points.collect();
    let nodes = scene.parts.entry(part).map_or(&[][..], |entry| &entry.nodes);
    // The ends of the beam may lie beside its points.
    let is_end = |node: &usize| {
        let place = topology.x(*node);
        ends.contains(node) || topology.master(*node).is_some() || ends.iter().any(|end| topology.x(*end) == place)
    };
    let value = |node: usize| {
        let at = |node: usize| given.get(&node).copied();
        let beside = || ends.iter().find(|end| topology.x(**end) == topology.x(node)).and_then(|end| at(*end));
        at(node).or_else(|| topology.master(node).and_then(at)).or_else(beside).unwrap_or(elsewhere)
    };
    let marks: Vec<usize> = (0..nodes.len()).filter(|&k| is_end(&nodes[k])).collect();
    for pair in marks.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|k| nodes[k]);
        let (from, to) = (value(a), value(b));
        let (start, way) = (topology.x(a), topology.x(b) - topology.x(a));
        for &node in &nodes[pair[0] + 1..pair[1]] {
            let part = (topology.x(node) - start).dot(&way) / way.norm_squared();
            inner.insert(node, from + part * (to - from));
        }
    }
    inner
}
