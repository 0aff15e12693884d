//! Properties of single elements: masses, springs, dampers, gaps.

use crate::file_content::{PropertyCard, PropertyOf};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::scopes::ScopeIndex;
use base::math::Vec3;
use base::text_file::cards::Data;

fn property(im: &mut Importer, block: &KeywordBlock, of: PropertyOf) {
    let line = block.keyword.line;
    let joint = im.properties.last().is_some_and(|card| card.of == PropertyOf::Joint);
    if block.keyword.value("ELSET").is_none() && joint && matches!(of, PropertyOf::Spring | PropertyOf::Damper) {
        return law_of_joint(im, block, usize::from(of == PropertyOf::Damper));
    }
    let Some(set) = block.keyword.value("ELSET") else {
        return im.refuse(line, &format!("*{} needs ELSET=", block.keyword.name));
    };
    if block.keyword.has("ALPHA") {
        im.refuse(line, "ALPHA of single masses is not translated: rdsolve damps the whole model by [damping]");
    }
    let lines: Vec<&Data> = block.data.iter().filter(|data| data.filled() > 0).collect();
    if lines.is_empty() {
        return im.refuse(line, &format!("*{} needs values on the line below", block.keyword.name));
    }
    let rows: Vec<Vec<f64>> = lines.iter().map(|data| im.numbers(data)).collect();
    let has_degrees = lines.first().is_some_and(|data| {
        let words = &data.words[..data.filled()];
        words.len() <= 2 && words.iter().all(|word| word.whole().is_some_and(|dof| (1..=6).contains(&dof)))
    }) && lines.len() > 1;
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

/// `*JOINT`: the springs and dampers on the following lines act along local axes of its elements.
pub fn joint(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    let Some(set) = block.keyword.value("ELSET") else { return im.refuse(line, "*JOINT needs ELSET=") };
    im.properties.push(PropertyCard {
        of: PropertyOf::Joint,
        line,
        target: im.set_target(set, line),
        is_nonlinear: false,
        orientation: block.keyword.value("ORIENTATION").map(str::to_owned),
        rows: vec![vec![0.0; 6]; 2],
        has_degrees: true,
    });
}

/// A spring or a damper of a joint: its axis, then its value.
fn law_of_joint(im: &mut Importer, block: &KeywordBlock, row: usize) {
    let line = block.keyword.line;
    let lines: Vec<&Data> = block.data.iter().filter(|data| data.filled() > 0).collect();
    let [first, second] = lines[..] else {
        return im.refuse(line, "in a *JOINT its axis, from 1 to 6, and its stiffness or damping are needed");
    };
    if block.keyword.has("NONLINEAR") {
        return im.refuse(line, "springs and dampers of a *JOINT are linear in rdsolve");
    }
    let axis = im.id(first, 0).filter(|axis| (1..=6).contains(axis));
    let (Some(axis), Some(value)) = (axis, im.number_at(second, 0)) else {
        return im.refuse(line, "in a *JOINT its axis, from 1 to 6, and its stiffness or damping are needed");
    };
    if let Some(card) = im.properties.last_mut() {
        card.rows[row][axis as usize - 1] += value;
    }
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
    let point = |at: usize| Vec3::from_fn(|i, _| values.get(at + i).copied().unwrap_or(0.0));
    // Points a and b, seen from c.
    let axes = (is_rectangular && values.len() >= 6).then(|| [point(0) - point(6), point(3) - point(6)]);
    if axes.is_none() {
        im.refuse(line, "of systems of axes those with SYSTEM=RECTANGULAR and two points are read");
    }
    if let Some(rows) = block.data.get(1)
        && im.number_at(rows, 1).is_some_and(|angle| angle != 0.0)
    {
        im.refuse(line, "a further rotation of the axes is not read; give the turned axes by their points");
    }
    if let ScopeIndex::Part(part) = im.scopes.at {
        im.axes_of_parts.push((line, part));
    }
    if im.axes.insert(name, axes).is_some_and(|known| known != axes) {
        im.refuse(line, "another system of axes has this name: give each a name of its own");
    }
}

/// Refuses systems of axes of parts whose instances are turned, for the axes would turn with them.
pub fn refuse_turned_axes(im: &mut Importer) {
    let is_turned = |part: usize| im.scopes.instances.iter().any(|at| at.part == part && at.turn.is_some());
    let lines: Vec<usize> = im.axes_of_parts.iter().filter(|of| is_turned(of.1)).map(|of| of.0).collect();
    for line in lines {
        im.refuse(line, "the axes of a part do not turn with its instance: write the part as it stands");
    }
}
