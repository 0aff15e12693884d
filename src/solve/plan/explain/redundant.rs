//! The redundant constraints of joints in words.

use crate::plan::Plan;
use crate::system::System;
use base::names::joined;
use mechanics::constraints::joint::ConstraintEquation;
use model::{DIRECTIONS, JointOrigin, Model};

/// Number of joints that are listed.
const LISTED: usize = 8;

/// The redundant constraint equations, a line for each of the first joints.
pub fn redundant_constraints(plan: &Plan, model: &Model, system: &System) -> Vec<String> {
    let Some(redundant) = &plan.redundant_constraints else {
        return vec!["too many joints to search for redundant constraints".to_string()];
    };
    let mut lines: Vec<(usize, Vec<&str>)> = Vec::new();
    for (joint, row) in redundant.iter().filter_map(|&number| system.row(number)) {
        let word = word(row, model.constraints.joints[joint].origin);
        match lines.last_mut().filter(|(last, _)| *last == joint) {
            Some((_, words)) => words.push(word),
            None => lines.push((joint, vec![word])),
        }
    }
    let line = |(joint, words): &(usize, Vec<&str>)| {
        let of = &model.constraints.joints[*joint];
        let node = &model.nodes[of.ends[0]].label;
        let (what, all) = match of.origin {
            JointOrigin::Deck => (format!("joint `{}`", of.name), "joints"),
            JointOrigin::Support => (format!("the support of `{node}`"), "supports"),
            JointOrigin::Attachment => (format!("the attachment of `{node}`"), "attachments"),
            JointOrigin::Tie(_) => (format!("the tie of `{node}`"), "ties"),
        };
        let (are, these) = if words.len() == 1 { ("is", "this reaction") } else { ("are", "these reactions") };
        format!(
            "{what}: {} {are} redundant; the {all} share {these} by least norm, weighted by the masses that they move",
            joined(words)
        )
    };
    // Nodes of one tie that share alike are one line.
    let origin = |line: &(usize, Vec<&str>)| model.constraints.joints[line.0].origin;
    let mut groups: Vec<&[(usize, Vec<&str>)]> =
        lines.chunk_by(|a, b| origin(a) == origin(b) && matches!(origin(a), JointOrigin::Tie(_))).collect();
    let more = groups.len().saturating_sub(LISTED);
    groups.truncate(LISTED);
    let more =
        (more > 0).then(|| format!("{more} more joints have redundant equations, and share their reactions alike"));
    let all = groups.into_iter().map(|group| match (group, origin(&group[0])) {
        ([first, _, ..], JointOrigin::Tie(tie)) => of_tie(&model.constraints.ties[tie], group.len(), line(first)),
        _ => line(&group[0]),
    });
    all.chain(more).collect()
}

/// The line of a tie with several such nodes, from that of the first.
fn of_tie(tie: &str, nodes: usize, first: String) -> String {
    format!("tie `{tie}`: {nodes} nodes have redundant equations, the first: {first}")
}

/// The word of an equation; supports and attachments are written about global axes.
fn word(row: &ConstraintEquation, origin: JointOrigin) -> &'static str {
    match row {
        ConstraintEquation::Perpendicular { p, s } if origin != JointOrigin::Deck => DIRECTIONS[3 + p.cross(s).iamax()],
        _ => row.word(),
    }
}
