//! The names in the file of a sweep that its deck must know, checked before the first case runs.

use super::file::SweepFile;
use base::diagnostic::{Diagnostic, Source};
use base::names::{nearest, quoted};
use deck::Deck;
use results::collected::Collected;

/// Subjects of rows that stand in no deck.
const OF_PROGRAM: [&str; 3] = ["analysis", "energy", "scene"];

/// The faults of the overrides of a case: keys that the deck lacks, and values of another type.
pub fn check_keys(case: &Source) -> Vec<Diagnostic> {
    let is_of_set = |problem: &Diagnostic| problem.place.as_ref().is_some_and(|place| place.start > case.text.len());
    deck::read(case).1.into_iter().filter(|problem| problem.is_error() && is_of_set(problem)).collect()
}

/// The stages and subjects of `[collect]` that the deck of a case does not know. A subject is refused only where the deck has a similar
/// name, because rdsolve and mesh files add further names.
pub fn check_collected(file: &SweepFile, case: &Source) -> Vec<Diagnostic> {
    let Some(deck) = deck::read(case).0 else { return Vec::new() };
    let is_letter = |c: char| c.is_alphanumeric() || "_-".contains(c);
    let in_deck = || case.text.lines().flat_map(names_in);
    let subject = |one: &Collected| {
        let name = one.at.split(|c| !is_letter(c)).next().unwrap_or_default();
        let stands = case.text.contains(name) || case.sets.iter().any(|(_, set)| set.contains(name));
        let is_known = stands || deck.mesh.is_some() || OF_PROGRAM.contains(&name) || name.parse::<u64>().is_ok();
        let near = if is_known { None } else { nearest(name, in_deck()) }?;
        let message = format!("`{}` of [collect]: the deck has no `{name}`", one.name);
        Some(Diagnostic::error(message).hint(format!("did you mean `{near}`?")))
    };
    let stage = |one: &Collected| stage_problem(one, &deck);
    file.collect.iter().flat_map(|one| [stage(one), subject(one)]).flatten().collect()
}

/// The names in a line of a deck: texts in quotes, and the key.
fn names_in(line: &str) -> impl Iterator<Item = &str> {
    let line = if line.trim_start().starts_with('#') { "" } else { line };
    let key = line.split_once('=').map(|(key, _)| key.trim());
    key.into_iter().chain(line.split('"').skip(1).step_by(2))
}

/// The fault of a number whose stage is none of the deck.
fn stage_problem(one: &Collected, deck: &Deck) -> Option<Diagnostic> {
    let stage = one.stage.as_deref()?;
    let names = || deck.stages.iter().filter_map(|stage| stage.name.as_ref()).map(|name| name.as_str());
    if names().any(|name| name == stage) {
        return None;
    }
    let hint = match nearest(stage, names()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if deck.stages.is_empty() => "the deck has no stages: remove `stage`".to_owned(),
        None => format!("it has {}", quoted(names())),
    };
    Some(Diagnostic::error(format!("`{}` of [collect]: the deck has no stage `{stage}`", one.name)).hint(hint))
}
