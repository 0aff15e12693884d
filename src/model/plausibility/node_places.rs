//! The place in the deck of each node, for warnings about valid models.

use crate::names::Names;
use crate::parts::Parts;
use crate::places::nodes::Topology;
use crate::places::place::Place;
use base::diagnostic::Span;

/// Sets the deck place of nodes: their names, the attachments of dependent nodes, or their parts.
pub fn place_nodes(names: &Names, parts: &Parts, topology: &mut Topology) {
    let place = |span: &Span| Some([span.start, span.end]);
    for part in names.deck.parts() {
        for &node in parts.entry(part.at).into_iter().flat_map(|entry| &entry.nodes) {
            let node = &mut topology.list[node];
            node.place = node.place.or(place(part.place()));
        }
    }
    for index in 0..topology.dependents.len() {
        let dependent = &topology.dependents[index];
        let (node, place) = (dependent.node, dependent.place);
        topology.list[node].place = place;
    }
    // The names of nodes have priority.
    for (_, named, span) in names.declarations() {
        match named {
            Place::Point(node) => topology.list[node].place = place(span),
            Place::Body(body) => topology.list[names.body_node(body)].place = place(span),
            _ => {}
        }
    }
}
