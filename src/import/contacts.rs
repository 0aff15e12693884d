//! `*CONTACT PAIR`: the nodes of one surface touch the faces of another.

use crate::build::Build;
use crate::contact_content::{ContactCard, InteractionCard};
use crate::deck_text::{DeckTable, inline, number, quoted};
use crate::dialect::Dialect;
use crate::file_content::{StepCard, StepProcedure};
use crate::part_piece::PartPiece;
use crate::scopes::NamedTarget;
use crate::surfaces::lines;
use std::collections::BTreeSet;

/// Adds the contacts: a table for each part that is touched.
pub fn contacts(build: &mut Build) {
    for card in build.im.constraints.contacts.pairs.clone() {
        let [slave, master] = &card.surfaces;
        let (Some(touching), Some(touched)) = (names_of(build, slave), pieces_of(build, master)) else { continue };
        if touching.is_empty() || touched.is_empty() {
            let empty = if touching.is_empty() { slave } else { master };
            if !build.im.is_incomplete() {
                build.im.refuse(card.line, &format!("`{}` holds no beams, shells or rigid faces", empty.name));
            }
            continue;
        }
        let laws = &build.im.constraints.contacts.interactions;
        let Some(law) = laws.iter().rfind(|law| law.name == card.interaction).cloned() else {
            let why = format!("no surface interaction is named `{}`", card.interaction);
            build.im.refuse(card.line, &why);
            continue;
        };
        say_thickness(build, &card, (&touching, &touched));
        for piece in touched {
            pair(build, &card, &touching, (&piece, &law));
        }
    }
}

/// Tells where the other program leaves out the thickness of the shells that touch: parts, or those of touching nodes.
fn say_thickness(build: &mut Build, card: &ContactCard, (touching, touched): (&[String], &[PartPiece])) {
    let is_explicit =
        |step: &StepCard| matches!(step.procedure, Some((StepProcedure::Dynamic { is_explicit: true, .. }, _)));
    let of_set = |name: &String| build.groups.by_name.get(name).cloned().unwrap_or_default();
    let single = |name: &String| name.strip_prefix("mesh.")?.parse().ok();
    let nodes: BTreeSet<u64> = touching.iter().flat_map(|name| of_set(name).into_iter().chain(single(name))).collect();
    let acts = |piece: &&PartPiece| {
        let has_node = || piece.elements.iter().flat_map(|element| &element.2).any(|node| nodes.contains(node));
        touching.contains(&piece.name) || touched.iter().any(|other| other.name == piece.name) || has_node()
    };
    let shells = build.pieces.iter().filter(|piece| !piece.is_beam && !piece.is_bar && !piece.is_rigid);
    let thickest = shells.filter(acts).map(|piece| piece.size).fold(0.0, f64::max);
    let has_thickness = build.im.dialect == Some(Dialect::Calculix) || build.im.steps.list.iter().any(is_explicit);
    if card.is_thin && thickest > 0.0 && !has_thickness {
        let how = format!(
            "shells touch with half their thickness, up to {:?}; Abaqus leaves it out without TYPE=SURFACE TO SURFACE: give that, or move the parts",
            0.5 * thickest
        );
        build.im.change(card.line, &how);
    }
}

/// Adds the contact with one part.
fn pair(build: &mut Build, card: &ContactCard, touching: &[String], (piece, law): (&PartPiece, &InteractionCard)) {
    let name = build.deck.unique(&format!("{}_{}", card.surfaces[0].name, piece.name));
    let itself = |name: &String| if *name == piece.name { "itself".to_owned() } else { name.clone() };
    let with: Vec<String> = touching.iter().map(itself).collect();
    let table = DeckTable::new("contacts", card.line)
        .text("name", &name)
        .value("surface", inline(&[("part", quoted(&piece.name))]))
        .names("with", &with);
    let is_moving = build.timeline.stages.iter().all(|stage| stage.is_dynamic);
    let table = match law.friction {
        Some(([first, second, _], line)) if first == second || !is_moving => {
            if first != second {
                build.im.change(line, "friction has the coefficient while it sticks: speeds act in *DYNAMIC alone");
            }
            table.number("friction", first)
        }
        Some(([first, second, decay], _)) => {
            let mut keys = vec![("static", number(first)), ("kinetic", number(second))];
            keys.extend((decay > 0.0).then(|| ("decay", number(decay))));
            table.value("friction", inline(&keys))
        }
        None => table,
    };
    let stages = build.timeline.stages_of_pair(&build.im.steps.list, &card.surfaces);
    build.deck.add_in(table, stages);
}

/// Elements of each surface in contact: parts are cut there, and rigid elements have faces.
pub fn marks(build: &Build) -> Vec<BTreeSet<usize>> {
    let (scopes, mesh) = (&build.im.scopes, &build.mesh);
    let surfaces = build.im.constraints.contacts.pairs.iter().flat_map(|card| &card.surfaces);
    let of = |surface| {
        let sets = scopes.surface(surface)?.into_iter().filter(|(_, side)| side != "NODE");
        Some(sets.filter_map(|(set, _)| mesh.cell_indices(scopes, &set)).flatten().collect())
    };
    surfaces.filter_map(of).collect()
}

/// The parts in a surface.
fn pieces_of(build: &mut Build, surface: &NamedTarget) -> Option<Vec<PartPiece>> {
    let mut cells = BTreeSet::new();
    for (set, side) in lines(build, surface)? {
        match &side[..] {
            "NODE" => build.im.refuse(surface.line, "nodes touch the faces of elements: give a surface of elements"),
            _ if side.starts_with('E') => build.im.refuse(
                surface.line,
                "contact of edges is `surface = { part, edges = true }` in the deck: give the faces, or add it there",
            ),
            _ => cells.extend(build.cells(&set)),
        }
    }
    let found: Vec<PartPiece> = build.pieces.iter().filter(|piece| piece.cells.is_subset(&cells)).cloned().collect();
    let covered: BTreeSet<usize> = found.iter().flat_map(|piece| piece.cells.iter().copied()).collect();
    if let Some(at) = cells.difference(&covered).next().filter(|_| !found.is_empty() && !build.im.is_incomplete()) {
        let why = format!("element {} of `{}` is in no part that touches", build.mesh.cells[*at].id, surface.name);
        build.im.refuse(surface.line, &why);
    }
    Some(found)
}

/// The names of what touches: parts, or sets of nodes.
fn names_of(build: &mut Build, surface: &NamedTarget) -> Option<Vec<String>> {
    let lines = lines(build, surface)?;
    if lines.iter().any(|(_, side)| side != "NODE") {
        return Some(pieces_of(build, surface)?.into_iter().flat_map(|piece| piece.names).collect());
    }
    let sets: Vec<NamedTarget> = lines.into_iter().map(|(set, _)| set).collect();
    let nodes: BTreeSet<u64> = sets.iter().flat_map(|set| build.nodes(set)).collect();
    let used: BTreeSet<u64> = nodes.into_iter().filter(|node| build.mesh.used.contains(node)).collect();
    Some(build.names(&used, &sets, &surface.name))
}
