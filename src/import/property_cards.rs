//! Properties of single elements: masses, springs, dampers, gaps.

use crate::file_content::{PropertyCard, PropertyOf};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;

fn property(im: &mut Importer, block: &KeywordBlock, of: PropertyOf) {
    let line = block.keyword.line;
    let Some(set) = block.keyword.value("ELSET") else {
        return im.refuse(line, &format!("*{} needs ELSET=", block.keyword.name));
    };
    let rows: Vec<Vec<f64>> = block.data.iter().map(|data| im.numbers(data)).collect();
    let has_degrees = block.data.first().is_some_and(|data| {
        let words = &data.words[..data.filled()];
        words.len() <= 2 && words.iter().all(|word| word.whole().is_some_and(|dof| (1..=6).contains(&dof)))
    }) && block.data.len() > 1;
    im.properties.push(PropertyCard {
        of,
        line,
        target: im.set_target(set, line),
        is_nonlinear: block.keyword.has("NONLINEAR"),
        orientation: block.keyword.value("ORIENTATION").map(str::to_owned),
        rows,
        has_degrees,
    });
}

/// `*MASS`.
pub fn mass(im: &mut Importer, block: &KeywordBlock) {
    property(im, block, PropertyOf::Mass);
}

/// `*ROTARY INERTIA`.
pub fn inertia(im: &mut Importer, block: &KeywordBlock) {
    property(im, block, PropertyOf::Inertia);
}

/// `*SPRING`.
pub fn spring(im: &mut Importer, block: &KeywordBlock) {
    property(im, block, PropertyOf::Spring);
}

/// `*DASHPOT`.
pub fn dashpot(im: &mut Importer, block: &KeywordBlock) {
    property(im, block, PropertyOf::Damper);
}

/// `*GAP`.
pub fn gap(im: &mut Importer, block: &KeywordBlock) {
    property(im, block, PropertyOf::Gap);
}

/// `*ORIENTATION`.
pub fn orientation(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let name = block.keyword.value("NAME").unwrap_or_default().to_lowercase();
    let system = block.keyword.value("SYSTEM").unwrap_or("RECTANGULAR").to_ascii_uppercase();
    let values = block.data.first().map(|data| im.numbers(data)).unwrap_or_default();
    let is_rectangular = "RECTANGULAR".starts_with(&system)
        && block.keyword.value("DEFINITION").is_none_or(|by| by.eq_ignore_ascii_case("COORDINATES"));
    let axes = (is_rectangular && values.len() >= 6)
        .then(|| [0, 3].map(|at| base::math::Vec3::new(values[at], values[at + 1], values[at + 2])));
    if axes.is_none() {
        im.refuse(line, "of systems of axes those with SYSTEM=RECTANGULAR and two points are read");
    }
    if let Some(rows) = block.data.get(1)
        && im.number_at(rows, 1).is_some_and(|angle| angle != 0.0)
    {
        im.refuse(line, "a further rotation of the axes is not read; give the turned axes by their points");
    }
    im.axes.insert(name, axes);
}
