//! The points of `[[contacts]]` that may touch a surface: nodes, places between them, corners of bodies.

use crate::contacts::sight::{MOST_POINTS, Opening, Sight};
use crate::data::{NodeWeights, lattice};
use crate::places::nodes::{Nodes, Topology};
use crate::places::place::Place;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use base::diagnostic::At;
use base::math::convex::{ConvexShape, Spherocylinder};
use base::math::cylinder::RoundCylinder;
use base::math::polyhedron::Polyhedron;
use base::math::{Vec3, curved_faces};
use deck::contacts as words;
use deck::parts::PartIndex;
use deck::words::Names;
use mechanics::elements::contact::{ContactPoint, ConvexBody, MOST_NODES, TouchKind, Toucher};
use mechanics::solids::Touching;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// A point that may touch, as found.
pub(super) struct Touch {
    nodes: NodeWeights,
    radius: f64,
    /// A point, or the line between its two nodes.
    pub(super) extent: TouchKind,
}

impl Touch {
    /// A node.
    pub(super) fn node(node: usize, radius: f64) -> Touch {
        Touch { nodes: vec![(node, 1.0)], radius, extent: TouchKind::Point }
    }

    /// All between two nodes.
    pub(super) fn line(ends: &[usize], radius: f64) -> Touch {
        Touch { nodes: ends.iter().map(|&node| (node, 0.5)).collect(), radius, extent: TouchKind::Line }
    }

    /// An edge between two nodes with separate contact points.
    pub(super) fn edge(ends: &[usize], radius: f64) -> Touch {
        Touch { extent: TouchKind::Edge, ..Touch::line(ends, radius) }
    }
}

/// The lines from node to node of an element.
pub(super) fn lines_of(nodes: &[usize], radius: f64) -> Vec<Touch> {
    nodes.windows(2).map(|ends| Touch::line(ends, radius)).collect()
}

/// Connects the points in `with` lists, so that supports and loads find them connected.
pub fn connect_touching_points(scene: &Scene, nodes: &mut Nodes) {
    let lists = scene.deck.contacts.iter().filter_map(|contact| contact.with.as_ref());
    for name in lists.flat_map(|list| &list.values) {
        if let Some(Place::Point(node)) = scene.names.place(name) {
            nodes.connect(node, false);
        }
    }
}

/// The lines of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceLines {
    /// A surface without lines.
    None,
    /// Beams and bars from node to node. Others touch them with theirs.
    Axes,
    /// The free edges of a shell. Beams and bars touch them with their lines, shells with their free edges.
    FreeEdges,
}

/// A surface that convex solids touch with their full shape.
#[derive(Debug, Clone, Copy)]
pub struct OnConvex {
    /// The node that carries it.
    pub carrier: usize,
    /// True for a plane: boxes and hulls touch it fully by corners, and capsules by ends.
    pub cylinders_alone: bool,
}

/// The names of what `points` do not divide.
#[derive(Default)]
struct Undivided<'n> {
    /// Names with contact by lines.
    lines: Vec<&'n str>,
    /// Bodies that touch with all of their surface.
    solids: Vec<&'n str>,
}

/// Finds the points and the convex solids of one contact.
pub struct Finder<'a, 'd> {
    /// The scene so far.
    pub scene: &'a Scene<'d>,
    /// The nodes; those that points need are added.
    pub topology: &'a mut Topology,
    /// The report for errors.
    pub report: &'a mut Report<'d>,
    /// The surface, if convex solids touch it with their full shape.
    pub on_convex: Option<OnConvex>,
    /// The lines of the surface.
    pub on_lines: SurfaceLines,
    /// The boxes, hulls, cylinders and capsules found.
    pub convex: Vec<ConvexBody>,
    /// Coverage of the touching bodies found.
    pub sight: Sight,
    /// True if further points may lie between the nodes or corners found.
    pub divides: bool,
}

impl<'a, 'd> Finder<'a, 'd> {
    /// A finder for contact by points.
    pub fn new(scene: &'a Scene<'d>, topology: &'a mut Topology, report: &'a mut Report<'d>) -> Self {
        let (convex, sight) = (Vec::new(), Sight::default());
        let (on_convex, on_lines, divides) = (None, SurfaceLines::None, false);
        Finder { scene, topology, report, on_convex, on_lines, convex, sight, divides }
    }

    /// All points that may touch, each once; convex solids are left in `convex`.
    pub fn touching(
        &mut self,
        owner: &Owner<'d>,
        contact: &'d words::Contact,
        carrier: Option<usize>,
    ) -> Option<Vec<ContactPoint>> {
        let between = match &contact.points {
            Some(at) if at.value > MOST_POINTS as u64 => {
                let message = format!("`points` is {}: at most {MOST_POINTS} are allowed", at.value);
                return self.report.error(&at.span, message);
            }
            points => points.as_ref().map_or(0, |at| at.value as usize),
        };
        let given = contact.radius.as_ref().map(|_| self.report.not_negative("radius", &contact.radius, 0.0));
        self.sight.radius = given;
        let names = self.report.require_nodes(owner, "with", &contact.with)?;
        if names.values.is_empty() {
            return self.report.error(&names.span, "`with` is empty, so nothing touches the surface");
        }
        let (mut touches, mut seen, mut sound): (Vec<Touch>, _, _) = (Vec::new(), HashMap::new(), true);
        let mut undivided = Undivided::default();
        for at in &names.values {
            let solids = self.convex.len();
            let Some(found) = self.touches_of_name(at, between, carrier) else {
                sound = false;
                continue;
            };
            if found.iter().any(|touch| touch.extent != TouchKind::Point) {
                undivided.lines.push(at.value.as_str());
            } else if self.convex.len() > solids {
                undivided.solids.push(at.value.as_str());
            }
            for touch in found {
                let mut key: Vec<(usize, u64)> = touch.nodes.iter().map(|&(node, w)| (node, w.to_bits())).collect();
                // A line may be named from either end.
                key.sort_unstable();
                // The contact radius of a shared node or line is that of the thicker part.
                match seen.entry(key) {
                    Entry::Vacant(place) => {
                        place.insert(touches.len());
                        touches.push(touch);
                    }
                    Entry::Occupied(place) => {
                        let known = &mut touches[*place.get()];
                        known.radius = known.radius.max(touch.radius);
                    }
                }
            }
        }
        if between > 0 && sound {
            self.check_points(contact, names, &undivided)?;
        }
        if !sound {
            return None;
        }
        self.inflate(given.unwrap_or(0.0), contact)?;
        let friction = contact.coefficients().sticking > 0.0;
        Some(touches.into_iter().map(|touch| self.contact_point(touch, given, friction)).collect())
    }

    /// Refuses `points` without a part or body to divide, and warns for lines and convex solids, because these touch in full.
    fn check_points(&mut self, contact: &'d words::Contact, names: &Names, undivided: &Undivided) -> Option<()> {
        let at = contact.points.as_ref()?;
        if !names.values.iter().any(|at| self.names_part(at)) {
            let message = "`points` lie between the nodes of parts or the corners of bodies, and none is named here";
            return self.report.error_with(&at.span, message, "leave `points` out");
        }
        let Undivided { lines, solids } = undivided;
        if lines.is_empty() && solids.is_empty() {
            return Some(());
        }
        let all: Vec<String> = lines.iter().chain(solids).map(|name| format!("`{name}`")).collect();
        let (what, verb) = (all.join(", "), if all.len() == 1 { "touches" } else { "touch" });
        let message = format!("`points` does not apply to {what}, which {verb} here in full, not with points");
        match (self.divides, solids.is_empty()) {
            // Nothing is lost where they divide something else, and these need none.
            (true, _) if lines.is_empty() => {}
            (true, _) => {
                self.report.warn(&at.span, message, "add a separate contact for these; it divides the others in `with`")
            }
            (false, false) => self.report.warn(&at.span, message, "leave `points` out"),
            (false, true) => return self.report.error_with(&at.span, message, "leave `points` out"),
        }
        Some(())
    }

    /// Makes convex solids larger by a contact radius, which hulls do not take.
    pub fn inflate(&mut self, radius: f64, contact: &'d words::Contact) -> Option<()> {
        if radius == 0.0 {
            return Some(());
        }
        for one in &mut self.convex {
            one.shape = match (&one.shape, one.shape.half_edges()) {
                (_, Some(half)) => ConvexShape::Polyhedron(Arc::new(Polyhedron::cuboid(half.add_scalar(radius)))),
                (ConvexShape::Spherocylinder(of), _) => {
                    ConvexShape::Spherocylinder(Spherocylinder { radius: of.radius + radius, ..*of })
                }
                (ConvexShape::Cylinder(of), _) => {
                    let (larger, half) = (of.radius() + radius, of.half() + radius);
                    ConvexShape::Cylinder(Arc::new(RoundCylinder::new(larger, half, *of.axes())))
                }
                (ConvexShape::HalfSpace(_), _) => continue,
                (ConvexShape::Polyhedron(_), None) => {
                    let at = contact.radius.as_ref()?;
                    let message = "hulls take no `radius` against boxes, hulls, cylinders, capsules and spheres";
                    return self.report.error_with(&at.span, message, "move their points outward");
                }
            };
        }
        Some(())
    }

    /// True where a name covers bodies or parts.
    fn names_part(&self, name: &str) -> bool {
        let place = self.scene.names.place(name);
        let leaves = place.into_iter().flat_map(|place| self.scene.names.leaves(place));
        let is_part = |place: Place| matches!(place, Place::Body(_) | Place::Part(_)) && place.has_nodes();
        leaves.into_iter().any(is_part)
    }

    /// The points of one name in the list; `None` if unknown or not allowed to touch.
    fn touches_of_name(&mut self, at: &'d At<String>, between: usize, carrier: Option<usize>) -> Option<Vec<Touch>> {
        let place = self.scene.names.find(at, self.report)?;
        if matches!(place, Place::Part(_)) && !place.has_nodes() {
            let message = format!("`with` takes points, bodies, sets or parts, and `{}` is {}", at.value, place.kind());
            return self.report.error(&at.span, message);
        }
        let (mut found, convex) = (Vec::new(), self.convex.len());
        for place in self.scene.names.leaves(place) {
            self.touches_of(place, between, at, &mut found);
        }
        if found.is_empty() && self.convex.len() > convex {
            return Some(found);
        }
        if found.is_empty() {
            // The part has no nodes because of errors already reported.
            if self.scene.nodes_of(place).is_empty() {
                self.scene.report_empty(place, at, self.report);
            }
            return None;
        }
        if let Some(body) = carrier.map(|carrier| self.topology.root(carrier)) {
            found.retain(|touch| touch.nodes.iter().any(|&(node, _)| self.topology.root(node) != body));
        }
        if found.is_empty() && self.convex.len() == convex {
            let message = format!("`{}` belongs to the body whose surface it would touch", at.value);
            return self.report.error_with(&at.span, message, "a body does not touch itself");
        }
        Some(found)
    }

    fn contact_point(&self, touch: Touch, given: Option<f64>, friction: bool) -> ContactPoint {
        let (mut nodes, mut weights) = ([touch.nodes[0].0; MOST_NODES], [0.0; MOST_NODES]);
        for (k, (node, weight)) in touch.nodes.iter().enumerate() {
            (nodes[k], weights[k]) = (*node, *weight);
        }
        let radius = given.unwrap_or(touch.radius);
        // A point without rotation cannot be turned by friction.
        let turns = touch.nodes.iter().all(|&(node, _)| self.topology.turns(self.topology.root(node)));
        let rolling_radius = if friction && turns { radius } else { 0.0 };
        ContactPoint { nodes, weights, count: touch.nodes.len(), radius, rolling_radius, extent: touch.extent }
    }

    fn touches_of(&mut self, place: Place, between: usize, at: &'d At<String>, found: &mut Vec<Touch>) {
        if let Some(lines) = self.lines_of_place(place, at) {
            return found.extend(lines);
        }
        self.sight.touchers.insert(match place {
            Place::Body(body) => self.toucher_of_body(body),
            Place::Part(_) | Place::Edge(..) => Toucher::Nodes,
            _ => Toucher::Ball,
        });
        match place {
            Place::Body(body) => self.touches_of_body(body, between, at, found),
            Place::Part(part) => {
                let radius = self.contact_radius(part);
                self.divides = true;
                self.open(&self.scene.parts.elements(part), part.kind.is_surface(), radius, Some(between));
                found.extend(self.scene.nodes_of(place).into_iter().map(|node| Touch::node(node, radius)));
                let between = self.scene.parts.of(part).iter().flat_map(|part| part.places_between(between));
                found.extend(between.map(|nodes| Touch { nodes, radius, extent: TouchKind::Point }));
            }
            Place::Edge(part, _) => {
                let radius = self.contact_radius(part);
                self.open(&[self.scene.nodes_of(place)], false, radius, None);
                found.extend(self.scene.nodes_of(place).into_iter().map(|node| Touch::node(node, radius)));
            }
            _ => found.extend(self.scene.nodes_of(place).into_iter().map(|node| Touch::node(node, 0.0))),
        }
    }

    pub(super) fn toucher_of_body(&self, body: usize) -> Toucher {
        let shape = &self.scene.bodies[body].shape;
        let is_drawn = self.scene.deck.bodies.get(body).is_some_and(|body| body.shape.is_some());
        match shape.touching(0) {
            Touching::Nodes => Toucher::Nodes,
            Touching::Points { .. } if is_drawn => match shape.as_convex() {
                Some(shape) if shape.half_edges().is_some() => Toucher::Box,
                Some(ConvexShape::Polyhedron(_)) => Toucher::Hull,
                Some(ConvexShape::Spherocylinder(_)) => Toucher::Capsule,
                Some(ConvexShape::Cylinder(_)) if shape.has_hole() => Toucher::Tube,
                Some(ConvexShape::Cylinder(_)) => Toucher::Cylinder,
                Some(ConvexShape::HalfSpace(_)) | None => Toucher::Nodes,
            },
            Touching::Points { .. } | Touching::Ball(_) => Toucher::Ball,
        }
    }

    /// Notes the widest opening between the nodes of elements, with so many points `between` where there may be some.
    fn open(&mut self, elements: &[Vec<usize>], is_surface: bool, radius: f64, between: Option<usize>) {
        let x = |node: usize| self.topology.x(node);
        let width = |nodes: &Vec<usize>| match is_surface {
            // A body passing through a mesh of a surface is at most as wide as its diagonal.
            true => {
                let facets = curved_faces::facets(nodes.len()).iter();
                let pairs =
                    facets.flat_map(|of| of.iter().flat_map(|&a| of.iter().map(move |&b| (nodes[a], nodes[b]))));
                pairs.fold(0.0, widest(&x))
            }
            false => nodes.windows(2).map(|pair| (pair[0], pair[1])).fold(0.0, widest(&x)),
        };
        let width = elements.iter().map(width).fold(0.0, f64::max) / (between.unwrap_or(0) + 1) as f64;
        self.sight.openings.push(Opening { width, radius, divides: between.is_some() });
    }

    /// Nodes as points of this radius.
    pub fn points_at(&self, nodes: &[usize], radius: f64, contact: &words::Contact) -> Vec<ContactPoint> {
        let friction = contact.coefficients().sticking > 0.0;
        nodes.iter().map(|&node| self.contact_point(Touch::node(node, radius), Some(radius), friction)).collect()
    }

    /// The lines of elements, by the nodes of each, as touching lines.
    pub fn lines_at(&self, elements: &[Vec<usize>], radius: f64, contact: &words::Contact) -> Vec<ContactPoint> {
        let friction = contact.coefficients().sticking > 0.0;
        let lines = elements.iter().flat_map(|nodes| lines_of(nodes, radius));
        lines.map(|line| self.contact_point(line, Some(radius), friction)).collect()
    }

    /// The contact radius of a part: half its thickness unless given.
    pub fn contact_radius(&self, part: PartIndex) -> f64 {
        self.scene.parts.entry(part).map_or(0.0, |entry| entry.contact_radius)
    }

    /// Finds points of a body's shape, as nodes that are rigidly attached to the body.
    fn touches_of_body(&mut self, body: usize, between: usize, at: &'d At<String>, found: &mut Vec<Touch>) {
        let (node, shape) = (self.scene.bodies[body].node, self.scene.bodies[body].shape.clone());
        let is_drawn = self.scene.deck.bodies.get(body).is_some_and(|body| body.shape.is_some());
        if let (Some(on), Some(shape), true) = (self.on_convex, shape.as_convex(), is_drawn)
            && (shape.is_cylinder() || !on.cylinders_alone)
            && self.topology.root(on.carrier) != self.topology.root(node)
        {
            if self.convex.iter().all(|one| one.node != node) {
                self.convex.push(ConvexBody { node, shape });
            }
            return;
        }
        let width = shape.opening(between).filter(|_| is_drawn);
        let (points, radius) = match shape.touching(between) {
            Touching::Nodes => {
                return self.touches_of_parts(node, between, found);
            }
            Touching::Ball(radius) if is_drawn => return found.push(Touch::node(node, radius)),
            Touching::Points { points, radius } if is_drawn => (points, radius),
            Touching::Ball(_) | Touching::Points { .. } => return found.push(Touch::node(node, 0.0)),
        };
        self.divides = true;
        self.sight.openings.extend(width.map(|width| Opening { width, radius, divides: true }));
        found.extend(self.attached(body, &points, at).into_iter().map(|node| Touch::node(node, radius)));
    }
}

impl Finder<'_, '_> {
    /// The nodes of a body's parts with their contact radius, and the places `between` them.
    fn touches_of_parts(&mut self, body: usize, between: usize, found: &mut Vec<Touch>) {
        let scene = self.scene;
        let mut radii: HashMap<usize, f64> = HashMap::new();
        for (part, _) in scene.parts.entries().filter(|(_, entry)| entry.rigid_elements.is_some()) {
            let mut elements = scene.parts.elements(part);
            elements.retain(|nodes| nodes.iter().all(|&of| self.topology.root(of) == body));
            if elements.is_empty() {
                continue;
            }
            let radius = self.contact_radius(part);
            self.divides = true;
            self.open(&elements, part.kind.is_surface(), radius, Some(between));
            for &node in elements.iter().flatten() {
                let at = radii.entry(node).or_insert(radius);
                *at = at.max(radius);
            }
            let nodes = elements.iter().map(Vec::as_slice);
            let places = match part.kind.is_surface() {
                true => lattice::over_faces(nodes, between),
                false => lattice::along_lines(nodes, between),
            };
            found.extend(places.into_iter().map(|nodes| Touch { nodes, radius, extent: TouchKind::Point }));
        }
        let mut nodes: Vec<usize> =
            self.topology.dependents.iter().filter(|of| of.master == body).map(|of| of.node).collect();
        nodes.sort_unstable();
        nodes.dedup();
        found.extend(nodes.into_iter().map(|node| Touch::node(node, radii.get(&node).copied().unwrap_or(0.0))));
    }
}

/// The longest of distances so far and of one more pair of nodes.
fn widest(x: &impl Fn(usize) -> Vec3) -> impl Fn(f64, (usize, usize)) -> f64 + '_ {
    |most, (a, b)| most.max((x(a) - x(b)).norm())
}
