//! Parts that are rigid: their elements leave the model, a body with their mass takes their place, and their nodes ride on it.
//!
//! Mass and inertia are integrals over the elements: a beam's mass lies on its axis with the rotary inertia of its section, a
//! shell's ρh on its surface with ρh³/12 per area about every axis, as its nodes have it while it deforms. Consistent mass
//! has the same inertia in rigid motion; lumped mass comes to it as elements get smaller.

use super::bodies::{Bodies, part_name};
use super::data::{AnalysisKind, Bar, Beam, Body, MassKind, Part, Rigid, Shell};
use super::nodes::Nodes;
use super::parts::Parts;
use super::place::Place;
use super::report::{Owner, Report};
use crate::deck::Deck;
use crate::diagnostic::Span;
use crate::elements::shell;
use crate::math::{Mat3, Vec3};
use crate::sections::Stiffness;
use crate::solids::element_faces::ElementFaces;
use std::collections::HashMap;
use std::sync::Arc;

/// Principal moments below this part of the largest are round-off.
const ROUND_OFF: f64 = 1e-12;

/// Integrals of density over elements: 1, x, x xᵀ; and the rotary inertia. Also of 1 instead of density, where there is none.
#[derive(Default)]
struct Integrals {
    mass: f64,
    first: Vec3,
    second: Mat3,
    rotary: Mat3,
    size: f64,
    first_of_size: Vec3,
}

impl Integrals {
    /// An element with `parts` of its size at pairs of its nodes, and a density.
    fn add(&mut self, density: f64, x: &[Vec3], part: impl Fn(usize, usize) -> f64) {
        for a in 0..x.len() {
            for b in 0..x.len() {
                let size = part(a, b);
                self.size += size;
                self.first_of_size += size * x[b];
                self.mass += density * size;
                self.first += density * size * x[b];
                self.second += density * size * x[a] * x[b].transpose();
            }
        }
    }

    fn center(&self) -> Vec3 {
        if self.mass > 0.0 { self.first / self.mass } else { self.first_of_size / self.size }
    }

    /// About the centre.
    fn inertia(&self) -> Mat3 {
        let c = self.center();
        let S = self.second - self.mass * c * c.transpose();
        let J = self.rotary + S.trace() * Mat3::identity() - S;
        0.5 * (J + J.transpose())
    }
}

/// ∫ N_a N_b over a segment of length one.
fn along(a: usize, b: usize) -> f64 {
    if a == b { 1.0 / 3.0 } else { 1.0 / 6.0 }
}

/// Gives bodies the mass of their parts, takes the elements of these out of the model and makes their nodes depend on the
/// bodies.
pub(super) fn rigid_bodies<'d>(
    deck: &'d Deck,
    kind: AnalysisKind,
    bodies: Bodies<'d>,
    parts: &mut Parts,
    nodes: &mut Nodes,
    report: &mut Report<'d>,
) -> (Vec<Body>, Vec<Rigid>) {
    let mut made = Vec::new();
    let mut list = bodies.list;
    for (body, of, span) in bodies.of_parts {
        let mut maker = Maker { deck, kind, bodies: &mut list, parts, nodes, report };
        made.extend(maker.rigid_body(body, &of, span));
    }
    (list, made)
}

struct Maker<'a, 'd> {
    deck: &'d Deck,
    kind: AnalysisKind,
    bodies: &'a mut [Body],
    parts: &'a mut Parts,
    nodes: &'a mut Nodes,
    report: &'a mut Report<'d>,
}

impl<'d> Maker<'_, 'd> {
    fn rigid_body(&mut self, body: usize, parts: &[Place], span: &'d Span) -> Option<Rigid> {
        let owner = Owner::new(format!("body `{}`", self.bodies[body].name), span);
        let (mut nodes, mut cells) = (Vec::new(), Vec::new());
        for &part in parts {
            let entry = self.parts.entry(part)?;
            // A part with errors has nothing to weigh.
            if entry.range.is_empty() {
                return None;
            }
            nodes.extend(entry.nodes.iter().copied());
        }
        let origin = self.nodes.x(*nodes.first()?);
        let mut sums = Integrals::default();
        for &part in parts {
            cells.extend(self.take_out(part, origin, &mut sums));
        }
        let (center, inertia) = (sums.center(), sums.inertia());
        if self.kind == AnalysisKind::Dynamic {
            if sums.mass <= 0.0 {
                let message = format!("the parts of {} have no mass", owner.what);
                return self.report.error_with(
                    span,
                    message,
                    "their materials need a density, and `mass` must not be \"none\"",
                );
            }
            let moments = inertia.symmetric_eigenvalues();
            if moments.min() <= ROUND_OFF * moments.max() {
                let message = format!("the parts of {} have no inertia about one of its axes", owner.what);
                return self.report.error_with(
                    span,
                    message,
                    "a straight bar has none about itself: take a beam with a section",
                );
            }
        }
        let master = self.bodies[body].node;
        self.nodes.list[master].x = origin + center;
        let elements = cells.len();
        let shape = self.faces(&cells, origin + center);
        let made = &mut self.bodies[body];
        (made.mass, made.inertia, made.shape) = (sums.mass, inertia, Arc::new(shape));
        let parts = parts.iter().map(|&part| part_name(self.deck, part)).collect();
        for node in nodes {
            self.attach(node, master, &owner)?;
        }
        Some(Rigid { body, parts, elements })
    }

    /// Moves the elements of a part from the model into integrals, x from `origin`; returns the nodes of each.
    fn take_out(&mut self, place: Place, origin: Vec3, sums: &mut Integrals) -> Vec<Vec<usize>> {
        let Some(range) = self.parts.entry(place).map(|entry| entry.range.clone()) else { return Vec::new() };
        let mut cells = Vec::new();
        for part in range {
            let x = |node: usize| self.nodes.x(node) - origin;
            match &mut self.parts.list[part] {
                Part::Beam(beam) => take_out_beam(beam, &self.parts.stiffnesses, x, sums, &mut cells),
                Part::Bar(bar) => take_out_bar(bar, x, sums, &mut cells),
                Part::Shell(shell) => take_out_shell(shell, x, sums, &mut cells),
                Part::Link(_) | Part::Contact(_) => {}
            }
        }
        if let Place::Shell(shell) = place {
            self.parts.shells[shell].rigid_faces = Some(cells.clone());
        }
        cells
    }

    /// The shape of the elements as they are drawn, about the centre.
    fn faces(&self, cells: &[Vec<usize>], center: Vec3) -> ElementFaces {
        let (mut points, mut places) = (Vec::new(), HashMap::new());
        let mut place = |&node: &usize| {
            *places.entry(node).or_insert_with(|| {
                points.push(self.nodes.x(node) - center);
                points.len() - 1
            })
        };
        let faces = cells.iter().map(|cell| cell.iter().map(&mut place).collect()).collect();
        ElementFaces { points, faces }
    }

    /// A node goes with a body; one at the end of a rigid offset already goes with the point it hangs on.
    fn attach(&mut self, node: usize, master: usize, owner: &Owner) -> Option<()> {
        let mut node = node;
        while let Some(on) = self.nodes.master(node) {
            if on == master {
                return Some(());
            }
            node = on;
        }
        if let Some(other) = self.bodies.iter().find(|body| body.node == node) {
            let message = format!("{} and body `{}` share nodes", owner.what, other.name);
            return self.report.error_with(owner.span, message, "make one body of them: list both in its `parts`");
        }
        self.nodes.attach(node, master, [true; 6], owner.span);
        Some(())
    }
}

fn take_out_beam(
    beam: &mut Beam,
    stiffnesses: &[Stiffness],
    x: impl Fn(usize) -> Vec3,
    sums: &mut Integrals,
    cells: &mut Vec<Vec<usize>>,
) {
    for e in std::mem::take(&mut beam.elements) {
        let ends = [e.nodes[0], e.nodes[beam.order]];
        let x = ends.map(&x);
        let (length, section) = ((x[1] - x[0]).norm(), &stiffnesses[e.section]);
        let density = if beam.mass == MassKind::None { 0.0 } else { section.mass_per_length };
        sums.add(density, &x, |a, b| length * along(a, b));
        if beam.rotary_inertia && beam.mass != MassKind::None {
            sums.rotary += length * e.frame * section.inertia_per_length * e.frame.transpose();
        }
        cells.push(ends.to_vec());
    }
}

fn take_out_bar(bar: &mut Bar, x: impl Fn(usize) -> Vec3, sums: &mut Integrals, cells: &mut Vec<Vec<usize>>) {
    for ends in std::mem::take(&mut bar.elements) {
        let x = ends.map(&x);
        let density = if bar.mass == MassKind::None { 0.0 } else { bar.mass_per_length };
        sums.add(density, &x, |a, b| (x[1] - x[0]).norm() * along(a, b));
        cells.push(ends.to_vec());
    }
}

fn take_out_shell(shell: &mut Shell, x: impl Fn(usize) -> Vec3, sums: &mut Integrals, cells: &mut Vec<Vec<usize>>) {
    let h = shell.plate.thickness;
    let density = if shell.mass == MassKind::None { 0.0 } else { shell.density };
    for e in std::mem::take(&mut shell.elements) {
        let nodes = e.nodes[..shell.corners].to_vec();
        let x: Vec<Vec3> = nodes.iter().map(|&node| x(node)).collect();
        let products = shell::products(&x);
        sums.add(density * h, &x, |a, b| products[a][b]);
        let area: f64 = products.iter().flatten().sum();
        sums.rotary += density * h.powi(3) / 12.0 * area * Mat3::identity();
        cells.push(nodes);
    }
}
