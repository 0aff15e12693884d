//! Ends of beams that release rotations: each is a node of its own, which a joint holds to its point.

use crate::data::{BeamElement, PartIndex};
use crate::part_context::PartContext;
use crate::parts::ReleasedEnd;
use crate::report::Report;
use base::diagnostic::At;
use base::math::Mat3;
use deck::beams::Release;
use deck::words::{Directions, Maybe, Table};
use std::collections::BTreeMap;

/// The rotations that an end holds; `None` where it releases nothing, or translations, which is reported.
pub fn held(released: &Maybe<Directions>, report: &mut Report) -> Option<[bool; 3]> {
    let at = released.as_ref()?;
    let Directions(dofs) = at.value;
    if dofs[..3].contains(&true) {
        let hint = "name rotations: \"rx\" is torsion, \"ry\" and \"rz\" bending about the local axes";
        return report.error_with(&at.span, "the end of a beam releases no translations", hint);
    }
    Some([3, 4, 5].map(|dof| !dofs[dof]))
}

/// Adds the node at the end of a beam, which is held to `point` in all but the released rotations; returns it. Its name begins with `prefix`.
pub fn release(
    prefix: &str,
    which: &str,
    point: usize,
    (held, axes): ([bool; 3], Mat3),
    cx: &mut PartContext,
) -> usize {
    let x = cx.nodes.x(point);
    let node = cx.nodes.add(format!("{prefix}released_{which}"), false, x);
    cx.nodes.connect(node, true);
    cx.parts.releases.push(ReleasedEnd { name: format!("{prefix}{which}"), ends: [point, node], held, axes });
    node
}

/// Releases both ends of each chain of segments of a group. A chain starts where its first segment does.
pub fn release_chains<'d>(
    name: &str,
    group: &'d At<String>,
    (words, order): (&'d At<Table<Release>>, usize),
    elements: &mut [BeamElement],
    (at, cx): (PartIndex, &mut PartContext<'_, 'd>),
) -> Option<()> {
    let both = [held(&words.start, cx.report), held(&words.end, cx.report)];
    let chains = match chains(elements, order) {
        Ok(chains) => chains,
        Err(node) => {
            let message =
                format!("segments of group `{}` branch or close a ring at `{}`", group.value, cx.nodes.label(node));
            let hint =
                "an end is released where segments form lines with two ends: put each member into a group of its own";
            return cx.report.error_with(&words.span, message, hint);
        }
    };
    let directed = chains.iter().all(|ends| ends.map(|(_, last)| last) == [false, true]);
    if !directed && both[0] != both[1] {
        let message = format!("segments of group `{}` run against each other, so a line has no start", group.value);
        return cx.report.error_with(
            &words.span,
            message,
            "release both ends alike, or mesh the lines in one direction",
        );
    }
    let single = chains.len() == 1;
    for (number, ends) in chains.into_iter().enumerate() {
        let prefix = if single { format!("{name}.") } else { format!("{name}[{}].", number + 1) };
        for (((element, last), which), held) in ends.into_iter().zip(["start", "end"]).zip(both) {
            let Some(held) = held else { continue };
            let element = &mut elements[element];
            let place = if last { order } else { 0 };
            let point = element.nodes[place];
            let node = release(&prefix, which, point, (held, element.frame), cx);
            element.nodes[place] = node;
            if last {
                // Places beyond the order repeat the end.
                element.nodes[place..].fill(node);
            }
            let listed = cx.parts.entry_mut(at).nodes.iter_mut().find(|listed| **listed == point);
            listed.into_iter().for_each(|listed| *listed = node);
        }
    }
    Some(())
}

/// An end of a chain: its element, and whether it is the last node of that element.
type ChainEnd = (usize, bool);

/// The two ends of each chain, start first, in the order of the elements. Errors: a node where elements branch, or one of a ring.
fn chains(elements: &[BeamElement], order: usize) -> Result<Vec<[ChainEnd; 2]>, usize> {
    let mut at_node: BTreeMap<usize, Vec<ChainEnd>> = BTreeMap::new();
    for (index, element) in elements.iter().enumerate() {
        at_node.entry(element.nodes[0]).or_default().push((index, false));
        at_node.entry(element.nodes[order]).or_default().push((index, true));
    }
    if let Some((node, _)) = at_node.iter().find(|(_, ends)| ends.len() > 2) {
        return Err(*node);
    }
    let node_of = |(element, last): ChainEnd| elements[element].nodes[if last { order } else { 0 }];
    let (mut found, mut used) = (Vec::new(), vec![false; elements.len()]);
    let free = |end: ChainEnd| at_node[&node_of(end)].len() == 1;
    // Starts first, so that a chain in one direction begins there.
    for last in [false, true] {
        for index in 0..elements.len() {
            let begin = (index, last);
            if used[index] || !free(begin) {
                continue;
            }
            let mut end = begin;
            let finish = loop {
                used[end.0] = true;
                let across = (end.0, !end.1);
                match at_node[&node_of(across)].iter().find(|next| next.0 != across.0) {
                    Some(next) => end = *next,
                    None => break across,
                }
            };
            found.push([begin, finish]);
        }
    }
    match used.iter().position(|used| !used) {
        Some(index) => Err(elements[index].nodes[0]),
        None => Ok(found),
    }
}
