//! Loads of single elements: pre-processors write a line for each element, and elements that are loaded alike in all steps become a set.

use crate::element_types::ElementUse;
use crate::file_content::SpreadLine;
use crate::flat_mesh::FlatMesh;
use crate::importer::Importer;
use crate::scopes::{Members, NamedTarget};
use std::collections::BTreeMap;

/// Joins the loads of single elements that have the same ones in each step.
pub fn join(im: &mut Importer, mesh: &FlatMesh) {
    let mut of_cell: BTreeMap<u64, String> = BTreeMap::new();
    for (step, line) in
        im.steps.list.iter().enumerate().flat_map(|(step, of)| of.spread.iter().map(move |line| (step, line)))
    {
        let Some(cell) = cell(line).filter(|_| is_of_part(im, mesh, line)) else { continue };
        *of_cell.entry(cell).or_default() += &format!("{step} {}\n", load(line));
    }
    let mut alike: BTreeMap<&str, Vec<u64>> = BTreeMap::new();
    of_cell.iter().for_each(|(cell, loads)| alike.entry(loads).or_default().push(*cell));
    let sets: BTreeMap<u64, u64> = alike
        .into_values()
        .filter(|cells| cells.len() > 1)
        .flat_map(|cells| cells.clone().into_iter().map(move |cell| (cell, cells[0])))
        .collect();
    let (mut firsts, mut joined) = (BTreeMap::new(), Vec::new());
    for step in 0..im.steps.list.len() {
        let lines = std::mem::take(&mut im.steps.list[step].spread);
        for mut line in lines {
            match cell(&line).and_then(|cell| Some((cell, *sets.get(&cell)?))) {
                Some((cell, first)) if cell == first => {
                    line.target = NamedTarget { name: name(first), is_set: true, ..line.target };
                    firsts.insert((step, first, load(&line)), line.line);
                }
                Some((_, first)) => {
                    joined.push(((step, first, load(&line)), line.line));
                    continue;
                }
                None => {}
            }
            im.steps.list[step].spread.push(line);
        }
    }
    for (of, line) in joined {
        if let Some(first) = firsts.get(&of) {
            im.verdicts.join(*first, line);
        }
    }
    for (cell, first) in &sets {
        let target = NamedTarget { scope: im.scopes.at, name: cell.to_string(), is_set: false, line: 0 };
        let ids = im.scopes.members(&target, Members::Cells).unwrap_or_default();
        im.scopes.here().cell_sets.place(&name(*first)).extend(ids);
    }
}

/// The internal name of a set by its first element.
fn name(first: u64) -> String {
    format!("_elements_as_{first}")
}

/// What acts, without its element.
fn load(line: &SpreadLine) -> String {
    let SpreadLine { kind, values, is_imaginary, is_fixed, amplitude, .. } = line;
    format!("{kind} {values:?} {is_imaginary} {is_fixed} {amplitude:?}")
}

/// The number of the single element of a line.
fn cell(line: &SpreadLine) -> Option<u64> {
    line.target.name.parse().ok().filter(|_| !line.is_surface && !line.target.is_set)
}

/// True for elements that become parts: loads of others are refused at their own lines.
fn is_of_part(im: &Importer, mesh: &FlatMesh, line: &SpreadLine) -> bool {
    use ElementUse::{CurvedBeam, Face, StraightBeam, Truss};
    let becomes = |at: usize| im.scopes.types[mesh.cells[at].kind].becomes;
    let is_part = |at: usize| matches!(becomes(at), StraightBeam | CurvedBeam | Truss | Face);
    line.target.scope == im.scopes.at
        && mesh.cell_indices(&im.scopes, &line.target).is_some_and(|cells| cells.first().is_some_and(|at| is_part(*at)))
}
