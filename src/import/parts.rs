//! Beams, bars and shells: elements with one section, cut where loads or rigid bodies end.

use crate::build::Build;
use crate::contacts;
use crate::deck_text::{DeckTable, UniqueNames, inline, list, number, quoted, vector};
use crate::dialect::Dialect;
use crate::element_types::ElementUse;
use crate::file_content::{SectionCard, SectionOf, SectionValue};
use crate::harmonics;
use crate::material_cards;
use crate::nodal_numbers::by_nodes;
use crate::part_piece::PartPiece;
use crate::pretension;
use crate::scopes::{NamedTarget, PlacedElement};
use crate::temperatures;
use base::math::Vec3;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// How far the middle node of a beam may lie off its straight line, over the length.
const STRAIGHT: f64 = 1e-6;
/// A component of a direction that is zero but for rounding, over its length.
const ROUNDING: f64 = 1e-14;
/// The sine of the least angle between a beam and its first axis.
const PARALLEL: f64 = 1e-6;

/// The names of sections in the deck by the index of their cards, and all of them.
type SectionNames = (HashMap<usize, String>, UniqueNames);

/// The differences that divide elements of one section into parts.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct PieceKey {
    section: usize,
    shape: u8,
    /// The first axis of a beam, or the thickness of a shell, as text.
    axis: String,
    /// Loads and bodies that hold it, in the order of a list of true and false for all of them.
    marks: Vec<Reverse<usize>>,
}

/// Adds beams, bars and shells with their sections and materials.
pub fn parts(build: &mut Build) {
    let section_of = assigned(build);
    let mut marks_of: HashMap<usize, Vec<Reverse<usize>>> = HashMap::new();
    for (mark, cells) in marks(build).into_iter().enumerate() {
        cells.into_iter().for_each(|cell| marks_of.entry(cell).or_default().push(Reverse(mark)));
    }
    let thicknesses = thicknesses(build);
    let mut pieces: BTreeMap<PieceKey, Vec<usize>> = BTreeMap::new();
    let mut bare: Option<(usize, u64)> = None;
    let (all, sections) = (std::mem::take(&mut build.mesh.cells), build.im.sections.clone());
    for (at, cell) in all.iter().enumerate() {
        let becomes = build.im.scopes.types[cell.kind].becomes;
        let is_part =
            matches!(becomes, ElementUse::StraightBeam | ElementUse::CurvedBeam | ElementUse::Truss | ElementUse::Face);
        if becomes == ElementUse::Foreign {
            let kind = &build.im.scopes.types[cell.kind];
            let why = format!("elements of type {}: {}", kind.name, kind.reason());
            build.im.refuse(cell.line, &why);
        }
        if !is_part {
            continue;
        }
        let Some(&section) = section_of.get(&at) else {
            bare = bare.or(Some((cell.line, cell.id)));
            continue;
        };
        let card = &sections[section];
        let Some((shape, axis)) = shape_of(build, cell, card, becomes) else { continue };
        let axis = match &card.what {
            SectionOf::Shell { thickness, .. } => match thickness.or_else(|| at_nodes(&thicknesses, cell)) {
                Some(thickness) => number(thickness),
                None if cell.nodes.iter().all(|node| thicknesses.contains_key(node)) => String::new(),
                None => {
                    build.im.refuse(card.line, &format!("some nodes of element {} have no thickness", cell.id));
                    continue;
                }
            },
            _ => vector(settled(axis).as_slice()),
        };
        let marks = marks_of.remove(&at).unwrap_or_default();
        pieces.entry(PieceKey { section, shape, axis, marks }).or_default().push(at);
    }
    build.mesh.cells = all;
    if let Some((line, id)) = bare.filter(|_| !build.im.is_incomplete()) {
        build.im.refuse(line, &format!("element {id} has no section"));
    }
    write(build, pieces, &thicknesses);
}

/// The thickness of shells at nodes.
fn thicknesses(build: &mut Build) -> HashMap<u64, f64> {
    let mut of_node = HashMap::new();
    let wants = |card: &SectionCard| matches!(card.what, SectionOf::Shell { thickness: None, .. });
    if !build.im.sections.iter().any(wants) {
        let lines: Vec<usize> = build.im.thicknesses.iter().map(|(target, _)| target.line).collect();
        lines.into_iter().for_each(|line| build.im.ignore(line, "no section asks for it by NODAL THICKNESS"));
        return of_node;
    }
    for (target, thickness) in build.im.thicknesses.clone() {
        of_node.extend(build.nodes(&target).into_iter().map(|node| (node, thickness)));
    }
    of_node
}

/// The thickness that all nodes of an element have.
fn at_nodes(thicknesses: &HashMap<u64, f64>, cell: &PlacedElement) -> Option<f64> {
    let first = thicknesses.get(&cell.nodes[0]).copied();
    cell.nodes.iter().all(|node| thicknesses.get(node).copied() == first).then_some(first)?
}

/// The thickness of each node of a shell.
fn of_piece(piece: &PartPiece, thicknesses: &HashMap<u64, f64>) -> BTreeMap<u64, f64> {
    let nodes = piece.elements.iter().flat_map(|element| &element.2);
    nodes.filter_map(|node| Some((*node, *thicknesses.get(node)?))).collect()
}

/// A direction without what rotations leave of zeros.
fn settled(x: Vec3) -> Vec3 {
    x.map(|component| if component.abs() < ROUNDING * x.norm() { 0.0 } else { component })
}

/// The section of each element; the last where there are several.
fn assigned(build: &mut Build) -> HashMap<usize, usize> {
    let mut section_of = HashMap::new();
    for (index, card) in build.im.sections.clone().iter().enumerate() {
        let cells = build.cells(&card.target);
        section_of.extend(cells.into_iter().map(|cell| (cell, index)));
    }
    section_of
}

/// Elements of each distributed load and each rigid body.
fn marks(build: &mut Build) -> Vec<BTreeSet<usize>> {
    let steps = build.im.steps.list.iter().chain([&build.im.steps.before]);
    let mut targets: Vec<NamedTarget> = Vec::new();
    for line in steps.flat_map(|step| &step.spread).filter(|line| !line.target.name.is_empty() && !line.is_on_edges()) {
        match build.im.scopes.surface(&line.target) {
            Some(lines) if line.is_surface => targets.extend(lines.into_iter().map(|(set, _)| set)),
            _ => targets.push(line.target.clone()),
        }
    }
    targets.extend(build.im.constraints.rigid.iter().flat_map(|card| card.cells.clone()));
    let mut seen = BTreeSet::new();
    targets.retain(|target| seen.insert((target.scope, target.name.to_lowercase())));
    let found = targets.iter().filter_map(|target| build.mesh.cell_indices(&build.im.scopes, target));
    let mut marks: Vec<BTreeSet<usize>> = found.map(|cells| cells.into_iter().collect()).collect();
    marks.extend(contacts::marks(build));
    let targets = if build.im.is_heated() { temperatures::targets(build.im) } else { Vec::new() };
    let mut by_first: HashMap<u64, Vec<usize>> = HashMap::new();
    for (at, cell) in build.mesh.cells.iter().enumerate().take(if targets.is_empty() { 0 } else { usize::MAX }) {
        if let Some(node) = cell.nodes.first() {
            by_first.entry(*node).or_default().push(at);
        }
    }
    for target in &targets {
        let nodes = build.mesh.node_ids(&build.im.scopes, target).unwrap_or_default();
        let nodes: BTreeSet<u64> = pretension::with_ends(build, nodes).into_iter().collect();
        let cells = nodes.iter().filter_map(|node| by_first.get(node)).flatten().copied();
        marks.push(cells.filter(|at| build.mesh.cells[*at].nodes.iter().all(|node| nodes.contains(node))).collect());
    }
    marks
}

/// The shape of an element and the first axis of its section. Shapes: 0 beam of two nodes, 1 straight beam of three, 2 curved beam, 3 bar, 4 shell,
/// 5 beam beside its nodes.
fn shape_of(build: &mut Build, cell: &PlacedElement, card: &SectionCard, becomes: ElementUse) -> Option<(u8, Vec3)> {
    let x = |at: usize| build.mesh.x(cell.nodes[at]);
    let count = build.im.scopes.types[cell.kind].nodes;
    let fits = matches!(
        (&card.what, becomes),
        (SectionOf::Beam { .. }, ElementUse::StraightBeam | ElementUse::CurvedBeam)
            | (SectionOf::Shell { .. }, ElementUse::Face)
            | (SectionOf::Bar(_), ElementUse::Truss)
    );
    if !fits {
        let name = &build.im.scopes.types[cell.kind].name;
        let why = format!("this section is not one of elements of type {name}, such as element {}", cell.id);
        build.im.refuse(card.line, &why);
        return None;
    }
    let SectionOf::Beam { n1, offset, keys } = &card.what else {
        return Some((if becomes == ElementUse::Face { 4 } else { 3 }, Vec3::zeros()));
    };
    let yields = build.im.materials.find(&card.material).is_some_and(|material| !material.plastic.is_empty());
    if yields && keys.contains(&("shape", SectionValue::Word("general"))) {
        let why = "this section is known by its integrals alone, and stays elastic: leave *PLASTIC out, or give RECT, CIRC, PIPE, BOX of like walls, I or L";
        build.im.refuse(card.line, why);
        return None;
    }
    let turned =
        cell.instance.and_then(|at| build.im.scopes.instances[at].turn.as_ref()).map_or(*n1, |(_, turn)| turn * n1);
    let last = count - 1;
    let along = (x(last) - x(0)).normalize();
    let axis = if cell.nodes.len() > count { x(count) - x(0) } else { turned };
    let across = axis - along * axis.dot(&along);
    let is_across = across.norm() > PARALLEL * axis.norm();
    if !is_across {
        let about =
            format!("the first axis of the section, {}, is parallel to element {}", vector(axis.as_slice()), cell.id);
        build.im.refuse(card.line, &about);
        return None;
    }
    if *offset != [0.0; 2] {
        if becomes == ElementUse::CurvedBeam {
            build.im.change(card.line, "a beam of three nodes beside its nodes is two straight ones");
        }
        return Some((5, axis));
    }
    if becomes == ElementUse::StraightBeam {
        return Some((0, axis));
    }
    let off = (x(1) - 0.5 * (x(0) + x(2))).norm() / (x(2) - x(0)).norm();
    if off <= STRAIGHT {
        return Some((1, axis));
    }
    build.im.change(cell.line, "a beam whose middle node lies off the middle is two straight ones");
    Some((2, axis))
}

/// Writes the pieces.
fn write(build: &mut Build, pieces: BTreeMap<PieceKey, Vec<usize>>, thicknesses: &HashMap<u64, f64>) {
    let (mut materials, mut sections) = (HashMap::new(), SectionNames::default());
    let mut names: HashMap<usize, String> = HashMap::new();
    let mut next = build.mesh.last_cell() + 1;
    let rigid = rigid_cells(build);
    for (key, cells) in pieces {
        let card = build.im.sections[key.section].clone();
        let Some((material, density)) = material(build, &card, &mut materials) else { continue };
        let is_rigid = cells.iter().all(|cell| rigid.contains(cell));
        let mut piece = PartPiece {
            name: card.target.name.clone(),
            names: Vec::new(),
            is_beam: key.shape < 3 || key.shape == 5,
            is_bar: key.shape == 3 || key.shape == 5,
            elements: Vec::new(),
            cells: cells.iter().copied().collect(),
            size: 0.0,
            density,
            is_rigid,
            sides: None,
        };
        if !piece.is_bar {
            piece.name = match names.get(&key.section) {
                Some(first) => build.deck.unique(first),
                None => build.deck.unique_or(&card.target.name, "elements"),
            };
            names.entry(key.section).or_insert_with(|| piece.name.clone());
            piece.names.push(piece.name.clone());
        }
        let set = piece.name.clone();
        for &at in &cells {
            let cell = &build.mesh.cells[at];
            let kind = &build.im.scopes.types[cell.kind];
            elements(&mut piece.elements, cell, (key.shape, kind.nodes), &mut next);
            let corners = &cell.nodes[..kind.nodes];
            build.mesh.used.extend(corners);
            if key.shape != 3 {
                build.rotating.extend(corners);
            }
        }
        match &card.what {
            SectionOf::Beam { .. } if key.shape == 5 => {
                piece.name = set;
                beams_beside(build, &card, (&mut piece, &key), &material, &mut sections);
            }
            SectionOf::Beam { .. } => beam(build, &card, (&mut piece, &key), &material, &mut sections),
            SectionOf::Shell { points, offset, .. } => {
                let varying = if key.axis.is_empty() { of_piece(&piece, thicknesses) } else { BTreeMap::new() };
                piece.size = key.axis.parse().unwrap_or_else(|_| middle(&varying));
                shell(build, &card, &piece, (&material, *points, *offset), &varying);
            }
            SectionOf::Bar(area) => {
                piece.size = *area;
                piece.name = set;
                bars(build, &card, &mut piece, &material);
            }
        }
        build.add_piece(piece);
    }
}

/// The middle between the least and the largest thickness.
fn middle(varying: &BTreeMap<u64, f64>) -> f64 {
    let largest = varying.values().copied().fold(0.0, f64::max);
    0.5 * (largest + varying.values().copied().fold(largest, f64::min))
}

/// Elements of rigid bodies.
fn rigid_cells(build: &mut Build) -> BTreeSet<usize> {
    let targets: Vec<NamedTarget> = build.im.constraints.rigid.iter().flat_map(|card| card.cells.clone()).collect();
    targets.iter().flat_map(|target| build.cells(target)).collect()
}

/// The elements of a cell as the mesh has them.
fn elements(
    list: &mut Vec<(&'static str, u64, Vec<u64>)>,
    cell: &PlacedElement,
    (shape, count): (u8, usize),
    next: &mut u64,
) {
    let nodes = cell.nodes[..count].to_vec();
    match shape {
        0 => list.push(("B31", cell.id, nodes)),
        1 => list.push(("B32", cell.id, nodes)),
        5 if count == 2 => list.push(("B31", cell.id, nodes)),
        2 | 5 => {
            list.push(("B31", cell.id, vec![nodes[0], nodes[1]]));
            list.push(("B31", *next, vec![nodes[1], nodes[2]]));
            *next += 1;
        }
        3 => list.push(("T3D2", cell.id, vec![nodes[0], nodes[count - 1]])),
        _ => {
            let kind = match count {
                3 => "S3",
                4 => "S4",
                6 => "STRI65",
                8 => "S8R",
                _ => "S9R5",
            };
            list.push((kind, cell.id, nodes));
        }
    }
}

/// The name of the material of a section in the deck, and its density.
fn material(build: &mut Build, card: &SectionCard, names: &mut HashMap<String, String>) -> Option<(String, f64)> {
    let Some(material) = build.im.materials.find(&card.material).cloned() else {
        let about = format!("no material is named `{}`", card.material);
        build.im.refuse(card.line, &about);
        return None;
    };
    if material.elastic.is_none() {
        build.im.refuse(material.line, "a material of beams and shells needs *ELASTIC");
        return None;
    }
    if let Some(line) = material.no_compression.filter(|_| !matches!(card.what, SectionOf::Bar(_))) {
        build.im.refuse(line, "bars alone take tension alone in rdsolve");
    }
    let is_heated = build.im.is_heated();
    let name = names.entry(material.name.to_lowercase()).or_insert_with(|| {
        build.deck.add(material_cards::table(&material, &material.name, is_heated));
        material.name.clone()
    });
    Some((name.clone(), material.density.unwrap_or(0.0)))
}

/// Adds a beam and its section.
fn beam(
    build: &mut Build,
    card: &SectionCard,
    (piece, key): (&mut PartPiece, &PieceKey),
    material: &str,
    sections: &mut SectionNames,
) {
    let SectionOf::Beam { keys, .. } = &card.what else { return };
    let name = section(build, card, key.section, sections);
    sizes(piece, keys);
    let table = DeckTable::new("beams", card.line)
        .text("group", &piece.name)
        .text("section", &name)
        .text("material", material)
        .value("order", if key.shape == 1 { "2" } else { "1" })
        .value("orientation", &*key.axis);
    let table = damped(build, card, table);
    build.deck.add(table);
}

/// Adds a beam of two points for each element, with rigid arms from its nodes.
fn beams_beside(
    build: &mut Build,
    card: &SectionCard,
    (piece, key): (&mut PartPiece, &PieceKey),
    material: &str,
    sections: &mut SectionNames,
) {
    let SectionOf::Beam { keys, offset, .. } = &card.what else { return };
    let section = section(build, card, key.section, sections);
    sizes(piece, keys);
    let n1 = axis_of(&key.axis);
    if build.im.dialect == Some(Dialect::Calculix) {
        let how = "rigid arms join nodes and axis; CalculiX has arms at bends and at rotations alone";
        build.im.change(card.line, how);
    }
    for (_, id, nodes) in &piece.elements.clone() {
        let [start, end] = [build.mesh.x(nodes[0]), build.mesh.x(nodes[1])];
        let along = (end - start).normalize();
        let first = (n1 - along * n1.dot(&along)).normalize();
        let arm = settled(first * offset[0] + along.cross(&first) * offset[1]);
        let name = build.deck.unique(&format!("{}_{id}", piece.name));
        let table = DeckTable::new("beams", card.line)
            .text("name", &name)
            .value("path", list(nodes.iter().map(|node| quoted(&format!("mesh.{node}")))))
            .value("elements", "1")
            .text("section", &section)
            .text("material", material)
            .value("orientation", &*key.axis)
            .numbers("offset_start", arm.as_slice())
            .numbers("offset_end", arm.as_slice());
        piece.names.push(name);
        let table = damped(build, card, table);
        build.deck.add(table);
    }
}

/// Adds the damping of the material, unless modes have their own.
fn damped(build: &Build, card: &SectionCard, table: DeckTable) -> DeckTable {
    let of = build.im.materials.find(&card.material).and_then(|material| material.damping);
    match of.filter(|_| !harmonics::replaces_damping(build.im)) {
        Some([alpha, beta]) => table.value("damping", inline(&[("alpha", number(alpha)), ("beta", number(beta))])),
        None => table,
    }
}

/// The vector of a text such as `[0.0, 1.0, 0.0]`.
fn axis_of(text: &str) -> Vec3 {
    let mut numbers = text.trim_matches(['[', ']']).split(", ").filter_map(|word| word.parse().ok());
    Vec3::from_fn(|_, _| numbers.next().unwrap_or(0.0))
}

/// Area and sides of the section of a part.
fn sizes(piece: &mut PartPiece, keys: &[(&'static str, SectionValue)]) {
    piece.size = area(keys);
    piece.sides = match keys {
        [(_, SectionValue::Word("rectangle")), (_, SectionValue::Number(a)), (_, SectionValue::Number(b))] => {
            Some([*a, *b])
        }
        _ => None,
    };
}

/// The name of the section of a card in the deck, which is added.
fn section(build: &mut Build, card: &SectionCard, index: usize, sections: &mut SectionNames) -> String {
    let SectionOf::Beam { keys, .. } = &card.what else { return String::new() };
    if card.orientation.is_some() {
        build.im.refuse(card.line, "ORIENTATION of a beam section is not read; give the first axis on the second line");
    }
    let (of_card, names) = sections;
    let name = of_card.entry(index).or_insert_with(|| {
        let name = names.unique(&card.target.name);
        let mut table = DeckTable::named("sections", &name, card.line);
        for (key, value) in keys {
            table = match value {
                SectionValue::Word(word) => table.text(key, word),
                SectionValue::Number(x) => table.number(key, *x),
                SectionValue::Numbers(xs) => table.numbers(key, xs),
            };
        }
        build.deck.add(table);
        name
    });
    name.clone()
}

/// The area of a section, for its mass.
fn area(keys: &[(&'static str, SectionValue)]) -> f64 {
    let get = |name: &str| match keys.iter().find(|(key, _)| *key == name) {
        Some((_, SectionValue::Number(x))) => *x,
        Some((_, SectionValue::Numbers(xs))) => xs.iter().sum(),
        _ => 0.0,
    };
    match keys.first() {
        Some((_, SectionValue::Word("rectangle"))) => get("width") * get("height"),
        Some((_, SectionValue::Word("circle"))) => std::f64::consts::PI * get("radius").powi(2),
        Some((_, SectionValue::Word("tube"))) => {
            let (r, t) = (get("radius"), get("thickness"));
            std::f64::consts::PI * t * (2.0 * r - t)
        }
        _ => get("area"),
    }
}

/// Adds a shell.
fn shell(
    build: &mut Build,
    card: &SectionCard,
    piece: &PartPiece,
    (material, points, offset): (&str, Option<u64>, f64),
    varying: &BTreeMap<u64, f64>,
) {
    let mut table = DeckTable::new("shells", card.line)
        .text("group", &piece.name)
        .value("thickness", number(piece.size))
        .text("material", material);
    if offset != 0.0 {
        if build.im.dialect != Some(Dialect::Abaqus) {
            let how = "rigid arms join nodes and mid-surface; CalculiX has arms at folds and at rotations alone";
            build.im.change(card.line, how);
        }
        // The file has the place of the nodes over the middle surface, the deck that of the middle surface over the nodes.
        table = table.number("offset", -offset * piece.size);
    }
    if !varying.is_empty() {
        build.im.change(card.line, "each element has the mean of the thicknesses of its corners");
        table = table.value("nodal_thickness", by_nodes(build, varying, "thick"));
        if offset != 0.0 {
            build.im.refuse(card.line, "an offset of a shell whose thickness varies is not translated");
        }
    }
    let yields = build.im.materials.find(&card.material).is_some_and(|material| !material.plastic.is_empty());
    if yields {
        if let Some(points) = points.filter(|points| (2..=10).contains(points)) {
            table = table.value("layers", points.to_string());
        }
        if build.im.steps.list.iter().any(|step| step.is_nonlinear()) {
            table = table.text("strain", "logarithmic");
        }
    }
    if let Some(name) = &card.orientation {
        match build.im.axes.get(&name.to_lowercase()) {
            Some(Some([first, _])) => table = table.numbers("axis", first.as_slice()),
            Some(None) => {}
            None => build.im.refuse(card.line, &format!("no orientation is named `{name}`")),
        }
    }
    let table = damped(build, card, table);
    build.deck.add(table);
}

/// Adds a bar for each element.
fn bars(build: &mut Build, card: &SectionCard, piece: &mut PartPiece, material: &str) {
    let is_slack = build.im.materials.find(&card.material).is_some_and(|of| of.no_compression.is_some());
    for (_, id, nodes) in &piece.elements.clone() {
        let name = build.deck.unique(&format!("{}_{id}", piece.name));
        let path = list(nodes.iter().map(|node| format!("\"mesh.{node}\"")));
        let table = DeckTable::new("bars", card.line)
            .text("name", &name)
            .value("path", path)
            .text("material", material)
            .number("area", piece.size);
        let table = if is_slack { table.value("tension_only", "true") } else { table };
        let table = damped(build, card, table);
        piece.names.push(name);
        build.deck.add(table);
    }
}
