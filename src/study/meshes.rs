//! The meshes of a study, as overrides of the deck: all numbers of elements times a factor, and the degree of all beams.

use base::diagnostic::Diagnostic;
use deck::Deck;
use deck::words::OneOrMany;
use model::Model;

/// The overrides that multiply all numbers of elements.
pub fn refine(deck: &Deck, factor: f64, problems: &mut Vec<Diagnostic>) -> Vec<String> {
    if factor == 1.0 {
        return Vec::new();
    }
    let mut sets = Vec::new();
    for part in deck.parts() {
        if part.table.group().is_some() {
            let message = format!("`meshes` cannot refine `{}`: its elements are those of the mesh file", part.label());
            problems.push(Diagnostic::error(message).hint("remove `meshes`, and run decks with finer mesh files"));
        } else if let Some(elements) = part.table.elements() {
            match multiplied(elements, factor) {
                Some(numbers) => sets.push(format!("{}.elements={numbers}", part.table_path())),
                None => {
                    let count: Vec<String> = elements.values.iter().map(|count| count.value.to_string()).collect();
                    let (count, label) = (count.join(", "), part.label());
                    let message = format!("{factor} times the {count} elements of `{label}` is no whole number");
                    problems.push(Diagnostic::error(message).hint("give a factor that divides them, or 2"));
                }
            }
        }
    }
    if sets.is_empty() && problems.is_empty() {
        problems.push(
            Diagnostic::error("`meshes` has nothing to refine: the deck has no elements").hint("remove `meshes`"),
        );
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

/// A coarser mesh of a deck, for the error of its mesh.
#[derive(Debug, Clone)]
pub struct CoarserMesh {
    /// The overrides for the coarser mesh; none if no part can be coarser.
    pub sets: Vec<String>,
    /// The factor by which its errors are larger.
    pub apart: f64,
    /// The names of deformable parts with unchanged mesh.
    pub unchanged: Vec<String>,
    /// The overrides for a mesh of still a degree less, which measures the factor; none if elements are halved, or degrees are too low.
    pub coarsest: Vec<String>,
}

/// Half as many elements in each part, or a degree less of a beam of one element.
pub fn coarser(deck: &Deck, model: &Model) -> CoarserMesh {
    /// The part of the order of convergence that is reached; of 300 columns of 17 runs 94 % were then within the bound.
    const SLOPE: f64 = 0.8;
    /// The least factor between the errors of degrees p and p - 1.
    const OF_A_DEGREE: f64 = 4.0;
    let (sets, unchanged, coarsest) = (Vec::new(), Vec::new(), Vec::new());
    let mut mesh = CoarserMesh { sets, apart: f64::INFINITY, unchanged, coarsest };
    for part in deck.parts().filter(|part| !part.is_rigid()) {
        let (path, label) = (part.table_path(), part.label());
        let order = part.table.order();
        // Displacements converge with twice the degree, in few elements less; where material yields, its hinges keep them at two.
        let slope = if model.yields() { 2.0 } else { SLOPE * 2.0 * order.unwrap_or(1) as f64 };
        let elements = part.table.elements().filter(|_| part.table.group().is_none());
        let halves = elements.map(|at| at.values.iter().map(|count| count.value.div_ceil(2)).collect::<Vec<_>>());
        match (elements, halves) {
            (Some(at), Some(halves)) if at.values.iter().any(|count| count.value > 1) => {
                let counts = at.values.iter().map(|count| count.value).zip(&halves).filter(|(count, _)| *count > 1);
                let ratio = counts.map(|(count, half)| count as f64 / *half as f64).fold(f64::INFINITY, f64::min);
                mesh.apart = mesh.apart.min(ratio.powf(slope.max(2.0)));
                let words: Vec<String> = halves.iter().map(u64::to_string).collect();
                let value = if at.single { words.concat() } else { format!("[{}]", words.join(", ")) };
                mesh.sets.push(format!("{path}.elements={value}"));
                if order.is_none() && at.values.iter().any(|count| count.value == 1) {
                    mesh.unchanged.push(label);
                }
            }
            _ => match order.filter(|order| *order > 1) {
                Some(order) => {
                    mesh.apart = mesh.apart.min(OF_A_DEGREE);
                    mesh.sets.push(format!("{path}.order={}", order - 1));
                    mesh.coarsest.extend((order > 2).then(|| format!("{path}.order={}", order - 2)));
                }
                None if part.table.group().is_some() || elements.is_some() => mesh.unchanged.push(label),
                None => {}
            },
        }
    }
    if mesh.coarsest.len() < mesh.sets.len() {
        mesh.coarsest.clear();
    }
    mesh
}

/// The overrides that give the elements of all beams this degree.
pub fn reorder(deck: &Deck, order: u64) -> Vec<String> {
    let beams = deck.parts().filter(|part| part.table.order().is_some() && !part.is_rigid());
    beams.map(|part| format!("{}.order={order}", part.table_path())).collect()
}
