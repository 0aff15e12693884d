//! Point masses, springs, dampers and gaps.

use crate::bodies::point_masses;
use crate::build::Build;
use crate::deck_text::{DeckTable, inline, list, quoted, vector};
use crate::element_types::ElementUse;
use crate::file_content::{PropertyCard, PropertyOf};
use base::math::Vec3;

/// How far the curve of a spring goes on beyond its last point, over its range.
const BEYOND: f64 = 1e3;

/// Adds masses at nodes of no body.
pub fn masses(build: &mut Build) {
    for (node, point) in point_masses(build) {
        if build.weighed.contains(&node) {
            continue;
        }
        let has_inertia = point.inertia.iter().any(|x| *x != 0.0);
        if point.mass <= 0.0 {
            if has_inertia {
                build.im.refuse(point.line, "moments of inertia need a mass at the same node in rdsolve");
            }
            continue;
        }
        if has_inertia && point.inertia[..3].iter().filter(|x| **x > 0.0).count() < 2 {
            build.im.refuse(point.line, "moments of inertia about two axes or more are needed in rdsolve");
        }
        let turns = (0..3).filter(|at| point.inertia[*at] != 0.0);
        build.turning.extend(turns.map(|at| (node, 3 + at)));
        build.mesh.used.insert(node);
        let table = DeckTable::new("masses", point.line).text("at", &format!("mesh.{node}")).number("mass", point.mass);
        let kept = if point.inertia[3..].iter().all(|x| *x == 0.0) { &point.inertia[..3] } else { &point.inertia[..] };
        build.deck.add(if has_inertia { table.numbers("inertia", kept) } else { table });
    }
}

/// Adds springs, dampers and gaps.
pub fn links(build: &mut Build) {
    for card in build.im.properties.clone() {
        if matches!(card.of, PropertyOf::Mass | PropertyOf::Inertia) {
            continue;
        }
        for at in build.cells(&card.target) {
            let cell = build.mesh.cells[at].clone();
            let stages = build.timeline.stages_of_cell(at);
            let becomes = build.im.scopes.types[cell.kind].becomes;
            let name = build.deck.unique(&format!("{}_{}", card.target.name, cell.id));
            let table = DeckTable::new("links", card.line).text("name", &name);
            let table = match (card.of, becomes) {
                (PropertyOf::Spring, ElementUse::AxialSpring) | (PropertyOf::Damper, ElementUse::AxialDamper) => {
                    axial(build, &card, &cell.nodes, table)
                }
                (PropertyOf::Spring, ElementUse::GroundSpring | ElementUse::DirectedSpring)
                | (PropertyOf::Damper, ElementUse::GroundDamper | ElementUse::DirectedDamper) => {
                    directed(build, &card, &cell.nodes, table)
                }
                (PropertyOf::Joint, ElementUse::JointC) => joint(build, &card, &cell.nodes, table),
                (PropertyOf::Gap, ElementUse::Gap) => gap(build, &card, &cell.nodes, table),
                _ => {
                    build.im.refuse(card.line, &format!("element {} is none of this property", cell.id));
                    None
                }
            };
            if let Some(table) = table {
                build.mesh.used.extend(cell.nodes.iter().filter(|node| **node != 0));
                build.deck.add_in(table, stages);
            }
        }
    }
}

impl Build<'_, '_, '_> {
    /// A force per length that bends the model little before it: ten times the greatest modulus times the size of the mesh.
    pub fn rigid_stiffness(&self) -> f64 {
        let elastic = self.im.materials.list.iter().filter_map(|material| material.elastic);
        10.0 * elastic.map(|elastic| elastic[0]).fold(0.0, f64::max) * self.mesh.size()
    }

    /// The end of a link or a joint at a node; 0 is the ground beside the other end.
    pub fn end(&self, node: u64, other: u64) -> String {
        match (node, self.body_of.get(&node)) {
            (0, _) => inline(&[("ground", vector(self.mesh.x(other).as_slice()))]),
            (_, Some(body)) => inline(&[("body", quoted(body)), ("point", vector(self.mesh.x(node).as_slice()))]),
            (_, None) => inline(&[("node", format!("\"mesh.{node}\""))]),
        }
    }
}

/// A spring or a damper along the line of two nodes.
fn axial(build: &mut Build, card: &PropertyCard, nodes: &[u64], table: DeckTable) -> Option<DeckTable> {
    let (a, b) = (nodes[0], nodes[1]);
    if build.mesh.x(a) == build.mesh.x(b) {
        build.im.refuse(card.line, "the two nodes of this spring lie in one place, and its line has no direction");
        return None;
    }
    let table = table.value("from", build.end(a, b)).value("to", build.end(b, a));
    let first = card.rows.first().and_then(|row| row.first()).copied().unwrap_or(0.0);
    if card.of == PropertyOf::Damper {
        return Some(table.number("stiffness", 0.0).number("damping", first));
    }
    if !card.is_nonlinear {
        return Some(table.number("stiffness", first));
    }
    let mut points: Vec<[f64; 2]> = card.rows.iter().filter(|row| row.len() > 1).map(|row| [row[1], row[0]]).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (Some(&start), Some(&end)) = (points.first(), points.last()) else {
        build.im.refuse(card.line, "a nonlinear spring needs forces and elongations");
        return None;
    };
    // Beyond its ends the force of such a spring stays.
    let far = BEYOND * (end[0] - start[0]);
    points.insert(0, [start[0] - far, start[1]]);
    points.push([end[0] + far, end[1]]);
    Some(table.text("law", "table").value("points", list(points.iter().map(|point| vector(point)))))
}

/// A spring or a damper along a degree of freedom, to the ground or between two nodes.
fn directed(build: &mut Build, card: &PropertyCard, nodes: &[u64], table: DeckTable) -> Option<DeckTable> {
    if card.is_nonlinear || !card.has_degrees {
        let about = if card.is_nonlinear {
            "a nonlinear spring acts along the line between two nodes in rdsolve: type SPRINGA"
        } else {
            "this spring needs its degree of freedom on the first line and its stiffness on the second"
        };
        build.im.refuse(card.line, about);
        return None;
    }
    let degrees: Vec<usize> = card.rows[0].iter().map(|dof| *dof as usize - 1).collect();
    if degrees.iter().any(|dof| *dof != degrees[0]) {
        build.im.refuse(card.line, "a spring between two different degrees of freedom is not translated");
        return None;
    }
    let mut six = [0.0; 6];
    six[degrees[0]] = card.rows[1].first().copied().unwrap_or(0.0);
    let (a, b) = (nodes[0], nodes.get(1).copied());
    let (from, to) = match b {
        Some(b) => (build.end(a, b), build.end(b, a)),
        None => (build.end(0, a), build.end(a, a)),
    };
    build.tied.bushed.extend(nodes);
    if degrees[0] > 2 {
        let about = if card.orientation.is_some() { 3..6 } else { degrees[0]..degrees[0] + 1 };
        build.turning.extend(nodes.iter().flat_map(|node| about.clone().map(|dof| (*node, dof))));
    }
    let table = table.value("from", from).value("to", to);
    let table = match card.of {
        PropertyOf::Damper => table.numbers("bushing", &[0.0; 6]).numbers("bushing_damping", &six),
        _ => table.numbers("bushing", &six),
    };
    Some(along(build, card, table))
}

/// Springs and dampers between two nodes along axes that turn with the first.
fn joint(build: &mut Build, card: &PropertyCard, nodes: &[u64], table: DeckTable) -> Option<DeckTable> {
    let (a, b) = (nodes[0], nodes[1]);
    if card.rows.iter().flatten().all(|x| *x == 0.0) {
        build.im.refuse(card.line, "this *JOINT has no *SPRING and no *DASHPOT, and joins nothing");
        return None;
    }
    let turns = (3..6).filter(|dof| card.rows.iter().any(|row| row[*dof] != 0.0)).collect::<Vec<usize>>();
    let turns = if card.orientation.is_some() && !turns.is_empty() { vec![3, 4, 5] } else { turns };
    build.tied.bushed.extend(nodes);
    build.turning.extend(nodes.iter().flat_map(|node| turns.iter().map(|dof| (*node, *dof))));
    let table = table.value("from", build.end(a, b)).value("to", build.end(b, a)).numbers("bushing", &card.rows[0]);
    let is_damped = card.rows[1].iter().any(|x| *x != 0.0);
    let table = if is_damped { table.numbers("bushing_damping", &card.rows[1]) } else { table };
    Some(along(build, card, table))
}

/// Adds the local axes of a property.
fn along(build: &mut Build, card: &PropertyCard, table: DeckTable) -> DeckTable {
    let Some(name) = &card.orientation else { return table };
    let axes = build.im.axes.get(&name.to_lowercase()).copied();
    if axes.is_none() {
        build.im.refuse(card.line, &format!("no system of axes is named `{name}`"));
    }
    match axes.flatten() {
        Some(axes) => table.value("axes", list(axes.iter().map(|axis| vector(axis.as_slice())))),
        None => table,
    }
}

/// A gap.
fn gap(build: &mut Build, card: &PropertyCard, nodes: &[u64], table: DeckTable) -> Option<DeckTable> {
    let row = card.rows.first().cloned().unwrap_or_default();
    let of = |at: usize| row.get(at).copied().unwrap_or(0.0);
    let direction = Vec3::new(of(1), of(2), of(3));
    let given = row.get(5).copied().filter(|stiffness| *stiffness > 0.0);
    let stiffness = given.unwrap_or(build.rigid_stiffness());
    if stiffness <= 0.0 || of(0) < 0.0 {
        build.im.refuse(card.line, "a gap needs a stiffness and a clearance of 0 or more in rdsolve");
        return None;
    }
    if given.is_none() {
        build.im.change(card.line, &format!("a closed gap is a spring of stiffness {stiffness:e}, not rigid"));
    }
    let (a, b) = (nodes[0], nodes[1]);
    let table = table
        .value("from", build.end(a, b))
        .value("to", build.end(b, a))
        .text("law", "compression-only")
        .number("stiffness", stiffness)
        .number("gap", of(0));
    Some(if direction.norm() > 0.0 { table.numbers("direction", direction.as_slice()) } else { table })
}
