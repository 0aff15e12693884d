//! Parts that are rigid: their elements leave the model, a body with their mass takes their place, and their nodes ride on it.
//!
//! Mass and inertia are integrals over the elements: a beam's mass lies on its axis with the rotary inertia of its section, a
//! shell's ρh on its surface with ρh³/12 per area about every axis, as its nodes have it while it deforms. Consistent mass
//! has the same inertia in rigid motion; lumped mass comes to it as elements get smaller.

use std::collections::HashMap;

use super::build::{Builder, Owner, vec3_or_zero};
use super::places::Place;
use super::{AnalysisKind, Bar, Beam, Body, MassKind, PartType, Rider, Rigid, Shape, Shell};
use crate::deck::bodies as deck;
use crate::diagnostic::{At, Span};
use crate::elements::shell;
use crate::math::{Mat3, Vec3};
use crate::names::nearest;

/// Principal moments below this part of the largest are round-off.
const NONE: f64 = 1e-12;

#[derive(Default)]
pub(super) struct RigidParts<'d> {
    /// The body that a part makes up by itself, by the part.
    pub body_of: HashMap<Place, usize>,
    list: Vec<(usize, Vec<Place>, &'d Span)>,
    /// Nodes of the faces that left the model, by shell of the deck.
    pub faces: HashMap<usize, Vec<Vec<usize>>>,
}

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

impl<'d> Builder<'d> {
    /// A node and a body for each part with `rigid = true`; what they weigh comes later.
    pub fn rigid_parts(&mut self) {
        let deck = self.deck;
        let says = |flag: &crate::deck::words::Maybe<bool>| flag.as_ref().is_some_and(|at| at.value);
        let beams = deck.beams.iter().enumerate().filter(|(_, beam)| says(&beam.rigid));
        let beams = beams.map(|(i, beam)| (Place::Beam(i), "beams", i, &beam.name, &beam.group, &beam.span));
        let shells = deck.shells.iter().enumerate().filter(|(_, shell)| says(&shell.rigid));
        let shells = shells.map(|(i, shell)| (Place::Shell(i), "shells", i, &shell.name, &shell.group, &shell.span));
        for (part, kind, i, name, group, span) in beams.chain(shells) {
            let name = name.as_ref().or(group.as_ref());
            let label = name.map_or_else(|| format!("{kind}.{i}"), |name| name.value.clone());
            let body = self.empty_body(label);
            self.rigid.body_of.insert(part, body);
            self.rigid.list.push((body, vec![part], span));
        }
    }

    /// A body of the deck that parts make up.
    pub fn body_of_parts(&mut self, label: String, body: &'d deck::Body, span: &'d Span) {
        let index = self.empty_body(label);
        let node = self.model.bodies[index].node;
        self.model.nodes[node].v = vec3_or_zero(&body.velocity);
        self.model.nodes[node].omega = vec3_or_zero(&body.angular_velocity);
        let names = body.parts.iter().flat_map(|parts| &parts.values);
        let parts: Vec<Place> = names.filter_map(|name| self.part(name)).collect();
        for (k, part) in parts.iter().enumerate() {
            if parts[..k].contains(part) || self.rigid.list.iter().any(|(_, others, _)| others.contains(part)) {
                let what = self.what(*part);
                self.error::<()>(span, format!("{what} is in two bodies, or twice in one"));
            }
        }
        if body.parts.as_ref().is_some_and(|at| at.values.is_empty()) {
            self.error::<()>(span, "`parts` is empty");
        }
        self.rigid.list.push((index, parts, span));
    }

    /// Weightless, at the origin.
    fn empty_body(&mut self, label: String) -> usize {
        let node = self.node(label.clone(), true, Vec3::zeros());
        self.touch(node, true);
        let shape = Shape::Faces { points: Vec::new(), faces: Vec::new() };
        self.model.bodies.push(Body { name: label, node, mass: 0.0, inertia: Mat3::zeros(), shape });
        self.model.bodies.len() - 1
    }

    /// A part by name, before names have places.
    fn part(&mut self, name: &At<String>) -> Option<Place> {
        let deck = self.deck;
        let is = |word: Option<&'d At<String>>| word.is_some_and(|word| word.value == name.value);
        let beam = |i: usize| deck.beams[i].name.as_ref().or(deck.beams[i].group.as_ref());
        let shell = |i: usize| deck.shells[i].name.as_ref().or(deck.shells[i].group.as_ref());
        let bar = |i: usize| deck.bars[i].name.as_ref();
        let (beams, bars, shells) = (0..deck.beams.len(), 0..deck.bars.len(), 0..deck.shells.len());
        let own = |rigid: &crate::deck::words::Maybe<bool>| rigid.as_ref().is_some_and(|at| at.value);
        if let Some(i) = beams.clone().find(|&i| is(beam(i))) {
            return if own(&deck.beams[i].rigid) { self.own_body(name) } else { Some(Place::Beam(i)) };
        }
        if let Some(i) = bars.clone().find(|&i| is(bar(i))) {
            return Some(Place::Bar(i));
        }
        if let Some(i) = shells.clone().find(|&i| is(shell(i))) {
            return if own(&deck.shells[i].rigid) { self.own_body(name) } else { Some(Place::Shell(i)) };
        }
        let known: Vec<&str> = beams
            .filter_map(beam)
            .chain(bars.filter_map(bar))
            .chain(shells.filter_map(shell))
            .map(|n| n.as_str())
            .collect();
        let message = format!("no shell, beam or bar is named `{}`", name.value);
        match nearest(name, known) {
            Some(near) => self.error_with(&name.span, message, format!("did you mean `{near}`?")),
            None => self.error(&name.span, message),
        }
    }

    fn own_body<T>(&mut self, name: &At<String>) -> Option<T> {
        let message = format!("`{}` is a body of its own", name.value);
        self.error_with(&name.span, message, "leave out its `rigid`, or attach the body")
    }

    /// "shell `roof`".
    fn what(&self, part: Place) -> String {
        let name = |name: &Option<At<String>>, group: Option<&At<String>>| {
            name.as_ref().or(group).map(|name| name.value.clone()).unwrap_or_default()
        };
        let deck = self.deck;
        let name = match part {
            Place::Beam(i) => name(&deck.beams[i].name, deck.beams[i].group.as_ref()),
            Place::Bar(i) => name(&deck.bars[i].name, None),
            Place::Shell(i) => name(&deck.shells[i].name, deck.shells[i].group.as_ref()),
            _ => String::new(),
        };
        format!("{} `{name}`", part.noun())
    }

    /// Gives bodies the mass of their parts, takes the elements of these out and lets their nodes ride.
    pub fn rigid_bodies(&mut self) {
        for (body, parts, span) in std::mem::take(&mut self.rigid.list) {
            self.rigid_body(body, &parts, span);
        }
    }

    fn rigid_body(&mut self, body: usize, parts: &[Place], span: &'d Span) -> Option<()> {
        let owner = Owner { what: format!("body `{}`", self.model.bodies[body].name), span };
        let (mut nodes, mut cells) = (Vec::new(), Vec::new());
        for &part in parts {
            let (range, of) = match part {
                Place::Beam(i) => (&self.beam_parts[i], &self.beam_nodes[i]),
                Place::Bar(i) => (&self.bar_parts[i], &self.bar_nodes[i]),
                Place::Shell(i) => (&self.shell_parts[i], &self.shell_nodes[i]),
                _ => return None,
            };
            // A part with errors has nothing to weigh.
            if range.is_empty() {
                return None;
            }
            nodes.extend(of.iter().copied());
        }
        let origin = self.x(*nodes.first()?);
        let mut sums = Integrals::default();
        for &part in parts {
            cells.extend(self.take_out(part, origin, &mut sums));
        }
        let (center, inertia) = (sums.center(), sums.inertia());
        if self.model.analysis.kind == AnalysisKind::Dynamic {
            if sums.mass <= 0.0 {
                let message = format!("the parts of {} have no mass", owner.what);
                return self.error_with(
                    span,
                    message,
                    "their materials need a density, and `mass` must not be \"none\"",
                );
            }
            let moments = inertia.symmetric_eigenvalues();
            if moments.min() <= NONE * moments.max() {
                let message = format!("the parts of {} have no inertia about one of its axes", owner.what);
                return self.error_with(
                    span,
                    message,
                    "a straight bar has none about itself: take a beam with a section",
                );
            }
        }
        let master = self.model.bodies[body].node;
        self.model.nodes[master].x = origin + center;
        let elements = cells.len();
        let shape = self.faces(&cells, origin + center);
        let made = &mut self.model.bodies[body];
        (made.mass, made.inertia, made.shape) = (sums.mass, inertia, shape);
        let parts = parts.iter().map(|&part| self.what(part)).collect();
        self.model.rigid.push(Rigid { body, parts, elements });
        for node in nodes {
            self.ride(node, master, &owner)?;
        }
        Some(())
    }

    /// Moves the elements of a part from the model into integrals, x from `origin`; returns the nodes of each.
    fn take_out(&mut self, part: Place, origin: Vec3, sums: &mut Integrals) -> Vec<Vec<usize>> {
        let model = &mut self.model;
        let mut cells = Vec::new();
        match part {
            Place::Beam(i) => {
                for beam in model.parts[self.beam_parts[i].clone()].iter_mut().filter_map(Beam::of_mut) {
                    for e in std::mem::take(&mut beam.elements) {
                        let ends = [e.nodes[0], e.nodes[beam.order]];
                        let x = ends.map(|node| model.nodes[node].x - origin);
                        let (length, section) = ((x[1] - x[0]).norm(), &model.stiffnesses[e.section]);
                        let density = if beam.mass == MassKind::None { 0.0 } else { section.mass_per_length };
                        sums.add(density, &x, |a, b| length * along(a, b));
                        if beam.rotary_inertia && beam.mass != MassKind::None {
                            sums.rotary += length * e.frame * section.inertia_per_length * e.frame.transpose();
                        }
                        cells.push(ends.to_vec());
                    }
                }
            }
            Place::Bar(i) => {
                for bar in model.parts[self.bar_parts[i].clone()].iter_mut().filter_map(Bar::of_mut) {
                    for ends in std::mem::take(&mut bar.elements) {
                        let x = ends.map(|node| model.nodes[node].x - origin);
                        let density = if bar.mass == MassKind::None { 0.0 } else { bar.mass_per_length };
                        sums.add(density, &x, |a, b| (x[1] - x[0]).norm() * along(a, b));
                        cells.push(ends.to_vec());
                    }
                }
            }
            Place::Shell(i) => {
                for shell in model.parts[self.shell_parts[i].clone()].iter_mut().filter_map(Shell::of_mut) {
                    let h = shell.plate.thickness;
                    let density = if shell.mass == MassKind::None { 0.0 } else { shell.density };
                    for e in std::mem::take(&mut shell.elements) {
                        let nodes = e.nodes[..shell.corners].to_vec();
                        let x: Vec<Vec3> = nodes.iter().map(|&node| model.nodes[node].x - origin).collect();
                        let products = shell::products(&x);
                        sums.add(density * h, &x, |a, b| products[a][b]);
                        let area: f64 = products.iter().flatten().sum();
                        sums.rotary += density * h.powi(3) / 12.0 * area * Mat3::identity();
                        cells.push(nodes);
                    }
                }
                self.rigid.faces.insert(i, cells.clone());
            }
            _ => {}
        }
        cells
    }

    /// Elements as they are drawn.
    fn faces(&self, cells: &[Vec<usize>], center: Vec3) -> Shape {
        let (mut points, mut places) = (Vec::new(), HashMap::new());
        let mut place = |&node: &usize| {
            *places.entry(node).or_insert_with(|| {
                points.push(self.x(node) - center);
                points.len() - 1
            })
        };
        let faces = cells.iter().map(|cell| cell.iter().map(&mut place).collect()).collect();
        Shape::Faces { points, faces }
    }

    /// A node goes with a body; one at the end of a rigid offset already goes with the point it hangs on.
    fn ride(&mut self, node: usize, master: usize, owner: &Owner) -> Option<()> {
        let mut node = node;
        while let Some((rider, _)) = self.rides.get(&node) {
            let on = self.model.riders[*rider].master;
            if on == master {
                return Some(());
            }
            node = on;
        }
        if let Some(other) = self.model.bodies.iter().find(|body| body.node == node) {
            let message = format!("{} and body `{}` share nodes", owner.what, other.name);
            return self.error_with(owner.span, message, "make one body of them: list both in its `parts`");
        }
        self.rides.insert(node, (self.model.riders.len(), owner.span.clone()));
        let place = Some([owner.span.start, owner.span.end]);
        self.model.riders.push(Rider { node, master, dofs: [true; 6], place });
        Some(())
    }
}
