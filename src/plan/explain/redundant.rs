//! The redundant constraints of joints in words.

use crate::model::Model;
use crate::names::joined;
use crate::plan::Plan;
use crate::system::System;

/// The redundant constraint equations, a line for each joint.
pub fn redundant_constraints(plan: &Plan, model: &Model, system: &System) -> Vec<String> {
    let Some(redundant) = &plan.redundant_constraints else {
        return vec!["too many joints to search for redundant constraints".to_string()];
    };
    let mut lines: Vec<(usize, Vec<&str>)> = Vec::new();
    for (joint, row) in redundant.iter().filter_map(|&number| system.row(number)) {
        match lines.last_mut().filter(|(last, _)| *last == joint) {
            Some((_, words)) => words.push(row.word()),
            None => lines.push((joint, vec![row.word()])),
        }
    }
    let line = |(joint, words): (usize, Vec<&str>)| {
        let name = &model.constraints.joints[joint].name;
        let (are, these) = if words.len() == 1 { ("is", "this reaction") } else { ("are", "these reactions") };
        format!(
            "joint `{name}`: {} {are} redundant; the joints share {these} by least norm, weighted by the masses that they move",
            joined(&words)
        )
    };
    lines.into_iter().map(line).collect()
}
