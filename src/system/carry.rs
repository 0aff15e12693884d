//! History variables from one system to another of the same scene, of which some parts have come or gone.

use super::equations::System;
use super::parts::links::{is_shared, turning_links};
use crate::model::{Model, PartKind};
use std::collections::HashMap;
use std::ops::Range;

/// A model and its system.
type Scene<'a> = (&'a Model, &'a System);

/// Copies the history variables of all that both scenes have from `old` to `new`, which holds zeros. Returns the ranges of what is new.
///
/// # Errors
/// A part has other history variables than before.
pub fn carry_history(from: Scene, old: &[f64], to: Scene, new: &mut [f64]) -> Result<Vec<Range<usize>>, String> {
    let known = named_groups(from);
    let mut fresh = Vec::new();
    for (key, range) in named_groups(to) {
        match known.iter().find(|(other, _)| *other == key) {
            Some((_, of)) if of.len() != range.len() => {
                return Err(format!("`{}` remembers other things than in the stage before", key.1));
            }
            Some((_, of)) => new[range].copy_from_slice(&old[of.clone()]),
            None => fresh.push(range),
        }
    }
    // Links share groups, so each is known by its name.
    let turning =
        |(model, system): Scene| -> Vec<(String, usize)> { turning_links(model, &system.links, &system.groups) };
    let turns: HashMap<String, usize> = turning(from).into_iter().collect();
    for (name, slot) in turning(to) {
        if let Some(&of) = turns.get(&name) {
            new[slot] = old[of];
        }
    }
    Ok(fresh)
}

/// A group by the kind and the name of its part, and its number among those of the same part.
type GroupKey<'a> = (PartKind, &'a str, usize);

fn named_groups<'a>((model, system): Scene<'a>) -> Vec<(GroupKey<'a>, Range<usize>)> {
    let mut count: HashMap<(PartKind, &str), usize> = HashMap::new();
    let own = system.groups.iter().filter(|group| !is_shared(group));
    let named = own.map(|group| {
        let name = model.parts[group.part].name();
        let number = count.entry((group.kind, name)).or_default();
        *number += 1;
        ((group.kind, name, *number), group.history.clone())
    });
    named.filter(|(_, range)| !range.is_empty()).collect()
}
