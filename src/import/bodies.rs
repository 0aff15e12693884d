//! Rigid bodies and couplings: a body, and the nodes that are attached to it.

use crate::build::Build;
use crate::contacts;
use crate::deck_text::{DeckTable, list, quoted};
use crate::dialect::Dialect;
use crate::element_types::{ElementUse, SHAPE};
use crate::file_content::{PropertyOf, RigidCard, StepCard, StepProcedure};
use crate::part_piece::PartPiece;
use crate::scopes::NamedTarget;
use crate::surfaces;
use base::math::{Mat3, Vec3};
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// The mass of a body without any, over that of all parts.
const LIGHT: f64 = 1e-9;
/// Degrees of freedom by their words.
pub const DEGREES: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];

/// The inertia at a point: mass, moments of inertia xx, yy, zz, xy, yz, zx, and the line.
#[derive(Debug, Clone, Copy, Default)]
pub struct PointMass {
    /// The mass.
    pub mass: f64,
    /// The moments.
    pub inertia: [f64; 6],
    /// The line of the first of them.
    pub line: usize,
}

/// Masses and inertias by node.
pub fn point_masses(build: &mut Build) -> BTreeMap<u64, PointMass> {
    let mut points: BTreeMap<u64, PointMass> = BTreeMap::new();
    for card in build.im.properties.clone() {
        let wanted = match card.of {
            PropertyOf::Mass => ElementUse::PointMass,
            PropertyOf::Inertia => ElementUse::PointInertia,
            _ => continue,
        };
        let row = card.rows.first().cloned().unwrap_or_default();
        for at in build.cells(&card.target) {
            let cell = build.mesh.cells[at].clone();
            if build.im.scopes.types[cell.kind].becomes != wanted {
                continue;
            }
            let point = points.entry(cell.nodes[0]).or_insert(PointMass { line: card.line, ..PointMass::default() });
            if card.of == PropertyOf::Mass {
                point.mass += row.first().copied().unwrap_or(0.0);
                continue;
            }
            // I11, I22, I33, I12, I13, I23.
            let of = |at: usize| row.get(at).copied().unwrap_or(0.0);
            let read = [of(0), of(1), of(2), of(3), of(5), of(4)];
            point.inertia.iter_mut().zip(read).for_each(|(sum, more)| *sum += more);
        }
        if card.orientation.is_some() {
            build.im.refuse(card.line, "moments of inertia are about the global axes in rdsolve");
        }
    }
    points
}

/// Adds all bodies.
pub fn bodies(build: &mut Build) {
    let cards = build.im.constraints.rigid.clone();
    if cards.is_empty() {
        return;
    }
    let (masses, marks) = (point_masses(build), contacts::marks(build));
    let turning = build.pieces.iter().filter(|piece| !piece.is_bar && !piece.is_rigid);
    let turning = turning.flat_map(|piece| &piece.elements).flat_map(|element| &element.2).copied().collect();
    for card in cards {
        body(build, &card, &masses, &marks, &turning);
    }
}

/// The nodes of a body: those that go with it in all directions, those whose translations do, and those of its own parts.
struct BodyNodes {
    tied: BTreeSet<u64>,
    pinned: BTreeSet<u64>,
    own: BTreeSet<u64>,
    parts: Vec<String>,
}

fn nodes_of(build: &mut Build, card: &RigidCard, marks: &[BTreeSet<usize>]) -> BodyNodes {
    let collect = |build: &mut Build, targets: &[NamedTarget]| -> BTreeSet<u64> {
        targets.iter().flat_map(|target| build.nodes(target)).collect()
    };
    let (mut tied, pinned) = (collect(build, &card.tied), collect(build, &card.pinned));
    if let Some(surface) = &card.surface {
        tied.extend(surfaces::nodes_of(build, surface).unwrap_or_default());
    }
    let cells: BTreeSet<usize> = card.cells.iter().flat_map(|target| build.cells(target)).collect();
    let (mut of_parts, mut parts) = (BTreeSet::new(), Vec::new());
    for piece in build.pieces.iter().filter(|piece| piece.is_rigid && piece.cells.is_subset(&cells)) {
        of_parts.extend(piece.elements.iter().flat_map(|element| element.2.iter().copied()));
        parts.extend(piece.names.iter().cloned());
    }
    let (faces, of_faces) = faces(build, card, &cells, marks);
    parts.extend(faces);
    if !parts.iter().all(|part| build.parts_of_bodies.insert(part.clone())) {
        build.im.refuse(card.line, "some of these elements are in another rigid body");
    }
    for &at in &cells {
        let cell = &build.mesh.cells[at];
        tied.extend(cell.nodes.iter().filter(|node| !of_parts.contains(node) && **node != 0));
    }
    tied.retain(|node| !of_parts.contains(node) && !pinned.contains(node));
    tied.retain(|node| !of_faces.contains(node));
    of_parts.extend(of_faces);
    BodyNodes { tied, pinned, own: of_parts, parts }
}

/// Adds rigid elements in contact as a shell next to nothing thick and heavy; returns its name and nodes.
fn faces(
    build: &mut Build,
    card: &RigidCard,
    cells: &BTreeSet<usize>,
    marks: &[BTreeSet<usize>],
) -> (Option<String>, BTreeSet<u64>) {
    let is_rigid = |at: &usize| build.im.scopes.types[build.mesh.cells[*at].kind].becomes == ElementUse::RigidFace;
    let rigid: BTreeSet<usize> = cells.iter().copied().filter(is_rigid).collect();
    let touched: BTreeSet<usize> = marks.iter().flatten().copied().collect();
    let of: BTreeSet<usize> =
        rigid.intersection(&touched).copied().filter(|at| build.mesh.cells[*at].nodes.len() > 2).collect();
    if let Some(&first) = rigid.difference(&of).next() {
        let line = build.mesh.cells[first].line;
        build.im.change(line, SHAPE);
    }
    if of.is_empty() {
        return (None, BTreeSet::new());
    }
    let kind = |nodes: &[u64]| if nodes.len() == 3 { "S3" } else { "S4" };
    let cell = |at: &usize| &build.mesh.cells[*at];
    let elements: Vec<_> = of.iter().map(|at| (kind(&cell(at).nodes), cell(at).id, cell(at).nodes.clone())).collect();
    let nodes = elements.iter().flat_map(|element| element.2.iter().copied()).collect();
    let name = build.deck.unique(&format!("{}_faces", card.name));
    let (size, material) = (LIGHT * build.mesh.size(), build.deck.unique(&format!("{}_rigid", card.name)));
    let heaviest = build.pieces.iter().map(|piece| piece.density).fold(0.0, f64::max);
    let table = DeckTable::named("materials", &material, card.line)
        .text("model", "elastic")
        .number("youngs_modulus", 1.0)
        .number("poisson_ratio", 0.0);
    build.deck.add(if heaviest > 0.0 { table.number("density", heaviest) } else { table });
    let table = DeckTable::new("shells", card.line).text("group", &name).number("thickness", size);
    build.deck.add(table.text("material", &material));
    build.add_piece(PartPiece {
        name: name.clone(),
        names: vec![name.clone()],
        is_beam: false,
        is_bar: false,
        elements,
        cells: of,
        size,
        density: 0.0,
        is_rigid: true,
        sides: None,
    });
    (Some(name), nodes)
}

fn body(
    build: &mut Build,
    card: &RigidCard,
    masses: &BTreeMap<u64, PointMass>,
    marks: &[BTreeSet<usize>],
    turning: &HashSet<u64>,
) {
    let Some(reference) = build.node(&card.reference) else { return };
    let BodyNodes { mut tied, pinned, own, parts } = nodes_of(build, card, marks);
    if let Some(target) = &card.rotations
        && let Some(node) = build.node(target)
    {
        build.turned.insert(node, reference);
        tied.remove(&node);
    }
    let name = build.deck.unique_or(&card.name, "body");
    tied.remove(&reference);
    let all: BTreeSet<u64> = tied.iter().chain(&pinned).copied().chain([reference]).collect();
    let table = DeckTable::new("bodies", card.line).text("name", &name);
    let table = match parts.is_empty() {
        true => inertia(build, card, table, &all, (masses, reference)),
        false => table.names("parts", &parts),
    };
    build.deck.add(table);
    say_rotations(build, card, tied.iter().any(|node| turning.contains(node)));
    let is_all = card.degrees.is_empty();
    let whole: BTreeSet<u64> =
        if is_all { tied.iter().copied().chain([reference]).collect() } else { [reference].into() };
    let degrees = list(card.degrees.iter().map(|dof| quoted(DEGREES[*dof])));
    let some = if is_all { BTreeSet::new() } else { tied.clone() };
    let of_reference = own.contains(&reference);
    for (nodes, dofs) in [(&whole, None), (&some, Some(degrees)), (&pinned, Some(quoted("translations")))] {
        let nodes: BTreeSet<u64> = nodes.iter().copied().filter(|node| !(of_reference && *node == reference)).collect();
        if nodes.is_empty() {
            continue;
        }
        let of_surface = card.surface.iter().flat_map(|surface| surfaces::node_sets(build, surface));
        let targets: Vec<NamedTarget> = card.tied.iter().chain(&card.pinned).cloned().chain(of_surface).collect();
        let names = build.names(&nodes, &targets, &format!("{name}_nodes"));
        let table = DeckTable::new("attachments", card.line).text("body", &name).names("nodes", &names);
        build.deck.add(match dofs {
            Some(dofs) => table.value("dofs", dofs),
            None => table,
        });
    }
    build.rotating.extend(whole.iter().copied());
    for node in all.iter().chain(&own) {
        build.mesh.used.insert(*node);
        build.body_of.entry(*node).or_insert_with(|| name.clone());
    }
}

/// Tells where CalculiX lets nodes of shells and beams turn in the body.
fn say_rotations(build: &mut Build, card: &RigidCard, turns: bool) {
    if turns && !card.is_coupling && build.im.dialect == Some(Dialect::Calculix) {
        let how = "nodes of shells and beams turn with the body. CalculiX leaves their rotations free, as `dofs = \"translations\"` in \
                   [[attachments]] does";
        build.im.change(card.line, how);
    }
}

/// Adds centre, mass and inertia from the masses at its nodes, or next to nothing where there are none.
fn inertia(
    build: &mut Build,
    card: &RigidCard,
    table: DeckTable,
    nodes: &BTreeSet<u64>,
    (masses, reference): (&BTreeMap<u64, PointMass>, u64),
) -> DeckTable {
    let free = |node: &&u64| !build.body_of.contains_key(*node) && !card.is_coupling;
    let heavy: Vec<(u64, PointMass)> =
        nodes.iter().filter(free).filter_map(|node| Some((*node, *masses.get(node)?))).collect();
    let points: Vec<(Vec3, PointMass)> = heavy.iter().map(|(node, point)| (build.mesh.x(*node), *point)).collect();
    let mass: f64 = points.iter().map(|(_, point)| point.mass).sum();
    if mass > 0.0 {
        build.weighed.extend(heavy.iter().map(|(node, _)| *node));
    }
    let size = build.mesh.size();
    if mass <= 0.0 {
        let x = build.mesh.x(reference);
        let is_still = |step: &StepCard| {
            matches!(step.procedure, Some((StepProcedure::Static { .. } | StepProcedure::Buckle { .. }, _)))
        };
        if build.im.steps.list.iter().all(is_still) {
            return table.numbers("center", x.as_slice());
        }
        let all: f64 = build.pieces.iter().map(|piece| piece.mass(|id| build.mesh.x(id))).sum();
        let light = if all > 0.0 { LIGHT * all } else { LIGHT };
        build.im.change(card.line, "the body has no mass; the deck gives it a billionth of that of all parts");
        return table
            .numbers("center", x.as_slice())
            .number("mass", light)
            .numbers("inertia", &[light * size * size; 3]);
    }
    let center = points.iter().map(|(x, point)| x * point.mass).sum::<Vec3>() / mass;
    let mut total = Mat3::zeros();
    for (x, point) in &points {
        let (r, [xx, yy, zz, xy, yz, zx]) = (x - center, point.inertia);
        total += Mat3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz);
        total += (Mat3::identity() * r.norm_squared() - r * r.transpose()) * point.mass;
    }
    let least = LIGHT * mass * size * size;
    if (0..3).any(|i| total[(i, i)] < least) {
        build.im.change(card.line, "the body has no moment of inertia about some axis; the deck gives it next to none");
        (0..3).for_each(|i| total[(i, i)] = total[(i, i)].max(least));
    }
    let six = [total[(0, 0)], total[(1, 1)], total[(2, 2)], total[(0, 1)], total[(1, 2)], total[(2, 0)]];
    let kept = if six[3..].iter().all(|x| *x == 0.0) { &six[..3] } else { &six[..] };
    table.numbers("center", center.as_slice()).number("mass", mass).numbers("inertia", kept)
}
