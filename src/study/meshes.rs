//! The meshes of a study, as overrides of the deck: all numbers of elements times a factor, and the degree of all beams.

use crate::deck::Deck;
use crate::deck::words::OneOrMany;
use crate::diagnostic::Diagnostic;

/// The overrides that multiply all numbers of elements.
pub fn refine(deck: &Deck, factor: f64, problems: &mut Vec<Diagnostic>) -> Vec<String> {
    if factor == 1.0 {
        return Vec::new();
    }
    let mut sets = Vec::new();
    for part in deck.parts() {
        if part.table.group().is_some() {
            let message = format!("`meshes` cannot refine `{}`: its elements are those of the mesh file", part.label());
            problems.push(Diagnostic::error(message));
        } else if let Some(elements) = part.table.elements() {
            match multiplied(elements, factor) {
                Some(numbers) => sets.push(format!("{}.elements={numbers}", part.table_path())),
                None => {
                    let count: Vec<String> = elements.values.iter().map(|count| count.value.to_string()).collect();
                    let (count, label) = (count.join(", "), part.label());
                    let message = format!("{factor} times the {count} elements of `{label}` is no whole number");
                    problems.push(Diagnostic::error(message));
                }
            }
        }
    }
    if sets.is_empty() && problems.is_empty() {
        problems.push(Diagnostic::error("`meshes` has nothing to refine: the deck has no elements"));
    }
    sets
}

/// The numbers of elements times a factor, as a deck writes them; `None` where one is not whole.
fn multiplied(elements: &OneOrMany<u64>, factor: f64) -> Option<String> {
    let whole = elements.values.iter().map(|count| {
        let scaled = count.value as f64 * factor;
        let whole = scaled.round();
        ((scaled - whole).abs() < 1e-9 && whole >= 1.0).then(|| (whole as u64).to_string())
    });
    let numbers = whole.collect::<Option<Vec<String>>>()?;
    Some(if elements.single { numbers.concat() } else { format!("[{}]", numbers.join(", ")) })
}

/// The overrides that give the elements of all beams this degree.
pub fn reorder(deck: &Deck, order: u64) -> Vec<String> {
    let beams = deck.parts().filter(|part| part.table.has_order() && !part.is_rigid());
    beams.map(|part| format!("{}.order={order}", part.table_path())).collect()
}
