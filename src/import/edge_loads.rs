//! Loads along edges of shells: EDNOR, EDSHR, EDTRA and EDLD, as forces at the nodes.

use crate::build::Build;
use crate::deck_text::DeckTable;
use crate::file_content::{SpreadLine, StepCard};
use crate::loads::in_time;
use crate::surfaces::{along_edge, edge, lines};
use crate::timeline::TimeLaw;
use base::math::Vec3;
use base::math::curved_faces::corners;
use std::collections::{BTreeMap, BTreeSet};

/// Forces that differ by less, over the largest one, are the same but for rounding.
const ROUNDING: f64 = 1e-12;

/// Adds the load as forces at the nodes of the edges.
pub fn edges(build: &mut Build, line: &SpreadLine, law: &TimeLaw, of_lines: &[usize]) {
    let given = match direction(line) {
        Ok(given) => given,
        Err(why) => return build.im.refuse(line.line, why),
    };
    let found = edges_of(build, line);
    if found.is_empty() {
        let why = format!("`{}` holds no edges of shells, which {} acts on", line.target.name, line.kind);
        return build.im.refuse(line.line, &why);
    }
    let mut forces: BTreeMap<u64, Vec3> = BTreeMap::new();
    for (cell, of_edge) in found {
        let Some(at) = at_nodes(build, cell, &of_edge, &given) else {
            let why = format!("element {} has no area, and so no direction of this load", build.mesh.cells[cell].id);
            return build.im.refuse(line.line, &why);
        };
        for (node, force) in at {
            *forces.entry(node).or_insert_with(Vec3::zeros) += force * law.scale;
        }
    }
    keeps_direction(build, line);
    let largest = forces.values().map(|force| force.amax()).fold(0.0, f64::max);
    let mut alike: BTreeMap<[i64; 3], (Vec3, BTreeSet<u64>)> = BTreeMap::new();
    for (node, force) in forces.into_iter().filter(|(_, force)| force.amax() > ROUNDING * largest) {
        let key = [0, 1, 2].map(|i| (force[i] / (ROUNDING * largest)).round() as i64 / 2);
        alike.entry(key).or_insert_with(|| (force, BTreeSet::new())).1.insert(node);
    }
    for (force, nodes) in alike.into_values() {
        let force = force.map(|x| if x.abs() < ROUNDING * largest { 0.0 } else { settled(x) });
        let names = build.names(&nodes, &[], "edge");
        let table = DeckTable::new("loads", 0).with_lines(of_lines.iter().copied()).names("at", &names);
        build.deck.add(in_time(table.numbers("force", force.as_slice()), Some(law)));
    }
}

/// A number without the rounding of the quadrature.
fn settled(x: f64) -> f64 {
    format!("{x:.12e}").parse().unwrap_or(x)
}

/// The direction of a load along an edge.
enum Along {
    /// In the face, across the edge and inwards.
    Inwards,
    /// Along the edge, in the order of the nodes.
    Edge,
    /// Against the normal of the face.
    AgainstNormal,
    /// One direction in space.
    Global(Vec3),
}

fn direction(line: &SpreadLine) -> Result<Along, &'static str> {
    let of = |at: usize| line.values.get(at).copied().unwrap_or(0.0);
    match line.kind.trim_end_matches(|c: char| c.is_ascii_digit()) {
        "EDNOR" => Ok(Along::Inwards),
        "EDSHR" => Ok(Along::Edge),
        "EDTRA" => Ok(Along::AgainstNormal),
        "EDLD" => match Vec3::new(of(1), of(2), of(3)).try_normalize(0.0) {
            Some(direction) => Ok(Along::Global(direction)),
            None => Err("EDLD needs a direction behind its magnitude"),
        },
        "EDMOM" => Err("rdsolve has no moments per length along edges: give moments at the nodes"),
        _ => Err("rdsolve knows EDNOR, EDSHR, EDTRA and EDLD along edges: give one of these"),
    }
}

/// Elements and the places of the nodes of their edges, each once: those of the surface, or of the number behind the kind.
fn edges_of(build: &mut Build, line: &SpreadLine) -> BTreeSet<(usize, Vec<usize>)> {
    let number = line.kind.trim_start_matches(|c: char| !c.is_ascii_digit());
    let sets = match line.is_surface {
        true => lines(build, &line.target).unwrap_or_default(),
        false => vec![(line.target.clone(), format!("E{number}"))],
    };
    let shells = build.pieces.iter().filter(|piece| !piece.is_beam && !piece.is_bar);
    let shells: BTreeSet<usize> = shells.flat_map(|piece| piece.cells.iter().copied()).collect();
    let mut edges = BTreeSet::new();
    for (set, side) in sets.into_iter().filter(|(_, side)| side != "NODE") {
        let cells = build.cells(&set).into_iter().filter(|at| shells.contains(at));
        edges.extend(cells.filter_map(|at| Some((at, edge(&side, build.mesh.cells[at].nodes.len())?))));
    }
    edges
}

/// The forces on the nodes of an edge for a load of 1 per length, ∫ N f ds; `None` for an element without a normal.
fn at_nodes(build: &Build, cell: usize, of_edge: &[usize], along: &Along) -> Option<Vec<(u64, Vec3)>> {
    let nodes = &build.mesh.cells[cell].nodes;
    let x = |k: usize| build.mesh.x(nodes[k]);
    let normal = match corners(nodes.len()) {
        3 => (x(1) - x(0)).cross(&(x(2) - x(0))),
        _ => (x(2) - x(0)).cross(&(x(3) - x(1))),
    };
    let normal = normal.try_normalize(0.0)?;
    let mut forces = vec![Vec3::zeros(); of_edge.len()];
    for (weights, slope) in along_edge(&of_edge.iter().map(|k| x(*k)).collect::<Vec<_>>()) {
        // An edge without length has no load.
        let Some(tangent) = slope.try_normalize(0.0) else { continue };
        let force = match along {
            Along::Inwards => normal.cross(&tangent).normalize(),
            Along::Edge => tangent,
            Along::AgainstNormal => -normal,
            Along::Global(direction) => *direction,
        };
        forces.iter_mut().zip(&weights).for_each(|(sum, weight)| *sum += force * (weight * slope.norm()));
    }
    Some(of_edge.iter().map(|k| nodes[*k]).zip(forces).collect())
}

/// Tells that a load keeps its direction where the other program turns it.
pub fn keeps_direction(build: &mut Build, line: &SpreadLine) {
    let is_fixed = line.is_fixed && ["TRVEC", "EDLD"].iter().any(|kind| line.kind.starts_with(kind));
    let is_before = |step: &&StepCard| step.spread.iter().all(|other| other.line != line.line);
    if !is_fixed && build.im.steps.list.iter().skip_while(is_before).any(|step| step.is_nonlinear()) {
        let how = "this load keeps the direction of the undeformed shape, and errs by the angle of rotation; rotations below 0.01 rad change it by 1 %";
        build.im.change(line.line, how);
    }
}
