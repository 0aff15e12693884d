//! Loads of single elements: pre-processors write a line for each element, and elements that are loaded alike in all steps become a set.

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
        let Some(cell) = cell(line).filter(|_| exists(im, mesh, line)) else { continue };
        let SpreadLine { kind, values, is_imaginary, is_fixed, amplitude, .. } = line;
        *of_cell.entry(cell).or_default() +=
            &format!("{step} {kind} {values:?} {is_imaginary} {is_fixed} {amplitude:?}\n");
    }
    let mut alike: BTreeMap<&str, Vec<u64>> = BTreeMap::new();
    of_cell.iter().for_each(|(cell, loads)| alike.entry(loads).or_default().push(*cell));
    let sets: BTreeMap<u64, u64> = alike
        .into_values()
        .filter(|cells| cells.len() > 1)
        .flat_map(|cells| cells.clone().into_iter().map(move |cell| (cell, cells[0])))
        .collect();
    for step in 0..im.steps.list.len() {
        let lines = std::mem::take(&mut im.steps.list[step].spread);
        for mut line in lines {
            match cell(&line).and_then(|cell| Some((cell, *sets.get(&cell)?))) {
                Some((cell, first)) if cell == first => {
                    line.target = NamedTarget { name: name(first), is_set: true, ..line.target }
                }
                Some(_) => continue,
                None => {}
            }
            im.steps.list[step].spread.push(line);
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

/// The number of the single element of a line.
fn cell(line: &SpreadLine) -> Option<u64> {
    line.target.name.parse().ok().filter(|_| !line.is_surface && !line.target.is_set)
}

fn exists(im: &Importer, mesh: &FlatMesh, line: &SpreadLine) -> bool {
    line.target.scope == im.scopes.at
        && mesh.cell_indices(&im.scopes, &line.target).is_some_and(|cells| !cells.is_empty())
}
