//! Contact by lines on a surface of lines. The lines are beams and bars, free edges of shells, capsules, and edges of boxes, hulls and
//! cylinders; bodies of such parts have their lines.

use super::points::{Finder, SurfaceLines, Touch, lines_of};
use crate::places::place::Place;
use base::diagnostic::At;
use base::math::convex::{ConvexShape, Spherocylinder};
use base::math::polyhedron::Polyhedron;
use base::math::{Mat3, Vec3, curved_faces};
use deck::parts::PartIndex;
use mechanics::elements::contact::facets::free_edges;
use mechanics::elements::contact::{Facet, TouchKind, Toucher};

impl<'d> Finder<'_, 'd> {
    /// The lines of a place in contact with a surface of lines; `None` for contact by points.
    pub(super) fn lines_of_place(&mut self, place: Place, at: &'d At<String>) -> Option<Vec<Touch>> {
        if self.on_lines == SurfaceLines::None {
            return None;
        }
        let names = &self.scene.names;
        if let (SurfaceLines::FreeEdges, Place::Edge(part, _)) = (self.on_lines, place) {
            self.sight.touchers.insert(Toucher::Ball);
            return Some(lines_of(&self.scene.nodes_of(place), self.contact_radius(part)));
        }
        let line = names.line_of(place);
        let shell = names.surface_of(place).filter(|_| self.on_lines == SurfaceLines::FreeEdges);
        if let Some(part) = line.or(shell) {
            self.sight.touchers.insert(Toucher::Ball);
            return Some(self.lines_of_part(part, |_| true));
        }
        match place {
            Place::Body(body) => self.lines_of_solid(body, at).or_else(|| self.lines_of_parts(body)),
            _ => None,
        }
    }

    /// The elements of a beam or bar, or the free edges of a shell, as far as all of their nodes are `meant`.
    fn lines_of_part(&self, part: PartIndex, meant: impl Fn(usize) -> bool) -> Vec<Touch> {
        let is_meant = |nodes: &Vec<usize>| nodes.iter().all(|&node| meant(node));
        let lines = if part.kind.is_surface() { self.free_edges(part) } else { self.scene.parts.elements(part) };
        lines
            .iter()
            .filter(|nodes| is_meant(nodes))
            .flat_map(|nodes| lines_of(nodes, self.contact_radius(part)))
            .collect()
    }

    /// The lines of a body with a shape. A capsule is the line between its ends. A box or a hull has its corners and, for crossings, its
    /// edges; a cylinder has those of an inscribed prism. All of these are nodes that are rigidly attached to the body.
    fn lines_of_solid(&mut self, body: usize, at: &'d At<String>) -> Option<Vec<Touch>> {
        self.scene.deck.bodies.get(body)?.shape.as_ref()?;
        let shape = self.scene.bodies[body].shape.as_convex()?;
        self.sight.touchers.insert(self.toucher_of_body(body));
        Some(match shape {
            ConvexShape::Spherocylinder(Spherocylinder { half, radius }) => {
                let ends = self.attached(body, &[-half, half], at);
                vec![Touch::line(&ends, radius)]
            }
            ConvexShape::Polyhedron(shape) => self.corners_and_edges(body, &shape, &Mat3::identity(), at),
            ConvexShape::Cylinder(shape) => self.corners_and_edges(body, &shape.prism_within(), shape.axes(), at),
            ConvexShape::HalfSpace(_) => return None,
        })
    }

    /// The corners of a polyhedron in these axes of a body, and its edges for crossings.
    fn corners_and_edges(&mut self, body: usize, shape: &Polyhedron, axes: &Mat3, at: &'d At<String>) -> Vec<Touch> {
        let places: Vec<Vec3> = shape.corners().iter().map(|corner| axes * corner).collect();
        let corners = self.attached(body, &places, at);
        let edges = shape.edges().iter().map(|edge| Touch::edge(&edge.ends.map(|k| corners[k]), 0.0));
        corners.iter().map(|&corner| Touch::node(corner, 0.0)).chain(edges).collect()
    }

    /// Nodes that are rigidly attached to a body, at places from its centre. All contacts share them.
    pub(super) fn attached(&mut self, body: usize, places: &[Vec3], at: &'d At<String>) -> Vec<usize> {
        let of = &self.scene.bodies[body];
        let center = self.topology.x(of.node);
        let label = |place: &Vec3| format!("{}{:?}", of.name, place.as_slice());
        let node = |place: &Vec3| self.topology.touching_node(label(place), center + place, of.node, &at.span);
        places.iter().map(node).collect()
    }

    /// The lines of the rigid parts of a body; for shells against beams, their nodes.
    fn lines_of_parts(&mut self, body: usize) -> Option<Vec<Touch>> {
        let node = self.scene.bodies[body].node;
        let entries = self.scene.parts.entries().filter(|(_, entry)| entry.rigid_elements.is_some());
        let parts: Vec<PartIndex> = entries.map(|(part, _)| part).collect();
        let of_body = |of: usize| self.topology.root(of) == node;
        let mut found = Vec::new();
        for part in parts {
            if self.on_lines == SurfaceLines::Axes && part.kind.is_surface() {
                let nodes = self.scene.nodes_of(Place::Part(part)).into_iter().filter(|&of| of_body(of));
                found.extend(nodes.map(|of| Touch::node(of, self.contact_radius(part))));
                continue;
            }
            found.extend(self.lines_of_part(part, of_body));
        }
        if found.is_empty() {
            return None;
        }
        let is_of_lines = found.iter().all(|touch| touch.extent == TouchKind::Line);
        self.sight.touchers.insert(if is_of_lines { Toucher::Ball } else { Toucher::Nodes });
        Some(found)
    }

    /// The free edges of a shell, by their nodes.
    pub fn free_edges(&self, part: PartIndex) -> Vec<Vec<usize>> {
        let of_element = |nodes: &Vec<usize>| -> Vec<Facet> {
            let corners = curved_faces::facets(nodes.len()).iter();
            corners.map(|of| Facet::new(&of.iter().map(|&k| nodes[k]).collect::<Vec<_>>(), 0.0)).collect()
        };
        let facets: Vec<Facet> = self.scene.parts.elements(part).iter().flat_map(of_element).collect();
        free_edges(&facets).into_iter().map(|ends| ends.to_vec()).collect()
    }
}
