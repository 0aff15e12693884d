//! Rigid parts: a body with their mass replaces their elements, and their nodes depend on it.
//!
//! Mass and inertia are integrals over the elements. A beam has its mass on the axis with the rotary inertia of its section. A shell has ρh
//! on its surface with ρh³/12 per area about every axis, as its nodes have in deformable shells. Consistent mass has the same inertia in
//! rigid motion; lumped mass converges to it with smaller elements.

use super::bodies::{Bodies, title};
use super::data::{Body, MassIntegrals, Rigid};
use super::parts::Parts;
use super::places::nodes::Nodes;
use super::report::{Owner, Report};
use base::diagnostic::Span;
use base::math::Vec3;
use deck::Deck;
use deck::parts::PartIndex;
use mechanics::solids::element_faces::ElementFaces;
use std::collections::HashMap;
use std::sync::Arc;

/// Principal moments below this part of the largest are round-off.
const ROUND_OFF: f64 = 1e-12;

/// Gives bodies the mass of their parts, removes the parts' elements from the model and makes their nodes depend on the bodies.
pub(super) fn rigid_bodies<'d>(
    deck: &'d Deck,
    has_inertia: bool,
    bodies: Bodies<'d>,
    parts: &mut Parts,
    nodes: &mut Nodes,
    report: &mut Report<'d>,
) -> (Vec<Body>, Vec<Rigid>) {
    let mut made = Vec::new();
    let mut list = bodies.list;
    for (body, of, span) in bodies.of_parts {
        let mut maker = Maker { deck, has_inertia, bodies: &mut list, parts, nodes, report };
        made.extend(maker.rigid_body(body, &of, span));
    }
    (list, made)
}

struct Maker<'a, 'd> {
    deck: &'d Deck,
    has_inertia: bool,
    bodies: &'a mut [Body],
    parts: &'a mut Parts,
    nodes: &'a mut Nodes,
    report: &'a mut Report<'d>,
}

impl<'d> Maker<'_, 'd> {
    fn rigid_body(&mut self, body: usize, parts: &[PartIndex], span: &'d Span) -> Option<Rigid> {
        let owner = Owner::new(format!("body `{}`", self.bodies[body].name), span);
        let (mut nodes, mut cells) = (Vec::new(), Vec::new());
        for &part in parts {
            let entry = self.parts.entry(part)?;
            // A part with errors has no mass to add.
            if entry.range.is_empty() {
                return None;
            }
            nodes.extend(entry.nodes.iter().copied());
        }
        let origin = self.nodes.x(*nodes.first()?);
        let mut sums = MassIntegrals::default();
        for &part in parts {
            self.reject_damping(part);
            cells.extend(self.take_out(part, origin, &mut sums));
        }
        let (center, inertia) = (sums.center(), sums.inertia());
        if self.has_inertia {
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
        let parts = parts.iter().map(|&part| title(self.deck, part)).collect();
        for node in nodes {
            self.attach(node, master, &owner)?;
        }
        Some(Rigid { body, parts, elements })
    }

    /// A rigid part has no damping: its mass is that of a body.
    fn reject_damping(&mut self, part: PartIndex) {
        let given = self.deck.part(part).and_then(|part| part.table.damping());
        if let Some(given) = given {
            let message = "`damping` does not apply to a rigid part";
            let hint = "`alpha` of [damping] acts on the mass of bodies";
            self.report.error_with::<()>(&given.span, message, hint);
        }
    }

    /// Moves the elements of a part from the model into integrals, x from `origin`; returns the nodes of each.
    fn take_out(&mut self, at: PartIndex, origin: Vec3, sums: &mut MassIntegrals) -> Vec<Vec<usize>> {
        let Some(range) = self.parts.entry(at).map(|entry| entry.range.clone()) else { return Vec::new() };
        let mut cells = Vec::new();
        let x = |node: usize| self.nodes.x(node) - origin;
        let Parts { list, stiffnesses, .. } = &mut *self.parts;
        for part in &mut list[range] {
            cells.extend(part.take_out(stiffnesses, &x, sums));
        }
        self.parts.entry_mut(at).rigid_elements = Some(cells.clone());
        cells
    }

    /// The shape of the elements for drawing, about the centre.
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

    /// Attaches a node to a body; a node at the end of a rigid offset is attached by the point it depends on.
    fn attach(&mut self, node: usize, master: usize, owner: &Owner) -> Option<()> {
        let mut node = node;
        while let Some(on) = self.nodes.master(node) {
            if on == master {
                return Some(());
            }
            node = on;
        }
        if let Some(other) = Body::at(self.bodies, node).map(|at| &self.bodies[at]) {
            let message = format!("{} and body `{}` share nodes", owner.what, other.name);
            return self.report.error_with(owner.span, message, "make one body of them: list both in its `parts`");
        }
        self.nodes.attach(node, master, [true; 6], owner.span);
        Some(())
    }
}
