//! Note on an initial velocity of one of several connected parts.

use crate::data::{AnalysisKind, Model, Part};
use crate::report::Report;
use base::names::short;
use std::collections::BTreeSet;

/// Notes a part at rest at t = 0 that shares nodes with a part in translation: the velocity then jumps between neighbouring nodes.
pub fn check_parts_at_rest(model: &Model, report: &mut Report) {
    if model.analysis.kind != AnalysisKind::Dynamic {
        return;
    }
    let speed = |node: usize| model.nodes[node].v.norm();
    let nodes_of = |part: &Part| (0..part.elements()).flat_map(|element| part.nodes(element)).copied().collect();
    let deformable = model.parts.iter().filter(|part| part.kind().is_deformable() && part.elements() > 0);
    let all: Vec<(&str, BTreeSet<usize>)> = deformable.map(|part| (part.name(), nodes_of(part))).collect();
    // Some nodes may move with a body, or stand on supports. A part that turns has nodes at rest on its axis.
    let moves = |nodes: &BTreeSet<usize>| {
        let moving: Vec<usize> = nodes.iter().copied().filter(|&node| speed(node) > 0.0).collect();
        let is_alike = moving.windows(2).all(|pair| model.nodes[pair[0]].v == model.nodes[pair[1]].v);
        2 * moving.len() > nodes.len() && is_alike
    };
    let (movers, others): (Vec<_>, Vec<_>) = all.iter().partition(|(_, nodes)| moves(nodes));
    for (name, nodes) in others {
        let joined = movers
            .iter()
            .find_map(|(mover, of)| Some((mover, *nodes.intersection(of).find(|&&node| speed(node) > 0.0)?)));
        let is_still = |&node: &usize| speed(node) == 0.0 || movers.iter().any(|(_, of)| of.contains(&node));
        if let Some((mover, node)) = joined.filter(|_| nodes.iter().all(is_still)) {
            let [from, to] = model.nodes[node].place.unwrap_or_default();
            let message = format!(
                "`{mover}` starts at {}, and `{name}`, which shares `{}` with it, at rest: the velocity jumps between neighbouring nodes",
                short(speed(node)),
                model.nodes[node].label
            );
            report.note(
                &(from..to),
                message,
                "name both parts in `at` of `[[initial]]`, or \"all\", if they move as one",
            );
            return;
        }
    }
}
