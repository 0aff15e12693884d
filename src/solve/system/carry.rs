//! Copies history variables between two systems of one model whose parts differ.

use super::equations::System;
use super::parts::links::{RememberingLink, is_shared, remembering_links};
use mechanics::elements::coordinate_law::{IMPACT_POWER, IMPACT_SPEED, RATE};
use model::{Model, PartKind};
use std::collections::HashMap;
use std::ops::Range;

/// A model and its system.
type Scene<'a> = (&'a Model, &'a System);

/// Copies the history variables of all common parts from `old` to `new`, which holds zeros. Returns the ranges of the new parts.
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
    let remembering = |(model, system): Scene| remembering_links(model, &system.links, &system.groups);
    let known: HashMap<String, RememberingLink> =
        remembering(from).into_iter().map(|link| (link.name.clone(), link)).collect();
    let rests = !to.0.analysis.is_dynamic();
    for link in remembering(to) {
        let Some(of) = known.get(&link.name).filter(|of| of.slots.len() == link.slots.len()) else { continue };
        for (k, (&slot, &of)) in link.slots.iter().zip(&of.slots).enumerate() {
            // A static stage has no impacts, and no rates to count turns with.
            let is_rate = link.is_joint && [RATE, IMPACT_SPEED, IMPACT_POWER].contains(&k);
            new[slot] = if rests && is_rate { 0.0 } else { old[of] };
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
