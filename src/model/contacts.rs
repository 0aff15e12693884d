//! `[[contacts]]`: surfaces, the points that touch them, and what acts there.

use super::build::{Builder, Owner, span, vec3};
use super::places::Place;
use super::{AnalysisKind, Bar, Beam, Contact, Held, Model, PartType, Shape as Drawn, Shell, StepLength};
use crate::deck::contacts as deck;
use crate::deck::words::Table;
use crate::diagnostic::{At, Span};
use crate::elements::contact::restitution::{self, Loss};
use crate::elements::contact::{Law, MOST_NODES, Point, Shape, Surface};
use crate::math::{Mat3, Vec3, quadrature};
use crate::names::short;
use std::collections::{HashMap, HashSet};
use std::f64::consts::{PI, TAU};

/// Steps that an impact lasts where the stiffness is left open.
const STEPS: f64 = 20.0;
/// Part of 1/√(k/m) that a step of an impact may reach ahead: nine steps and more an impact.
const RESOLUTION: f64 = 0.5;
/// Points around the rim of a cylinder.
const RIM: usize = 16;
/// More points between two nodes are a slip of the keyboard.
const MOST_POINTS: usize = 100;

/// A point that may touch, as found.
struct Touch {
    nodes: Vec<(usize, f64)>,
    radius: f64,
}

impl Touch {
    fn node(node: usize, radius: f64) -> Touch {
        Touch { nodes: vec![(node, 1.0)], radius }
    }
}

impl<'d> Builder<'d> {
    /// After attachments and supports: what rides on the surface's own body does not touch it, what is held has no mass.
    pub fn contacts(&mut self) {
        let masses = if self.deck.contacts.is_empty() { Vec::new() } else { self.masses_at_nodes() };
        for (index, contact) in self.deck.contacts.iter().enumerate() {
            let name = contact.name.as_ref().map_or_else(|| format!("contacts.{index}"), |name| name.value.clone());
            let owner = Owner { what: format!("contact `{name}`"), span: &contact.span };
            self.need(&owner, "name", &contact.name);
            let surface = self.need(&owner, "surface", &contact.surface).and_then(|s| self.contact_surface(&name, s));
            let carrier = surface.as_ref().map(|(node, _)| *node);
            let points = self.touching(&owner, &name, contact, carrier);
            let is_zone = self.numbers(&owner, contact);
            let (Some((node, surface)), Some(points), Some(is_zone)) = (surface, points, is_zone) else { continue };
            let (law, chosen) = match is_zone {
                true => (None, false),
                false => match self.contact_law(&owner, contact, node, &points, &masses) {
                    Some((law, chosen)) => (Some(law), chosen),
                    None => continue,
                },
            };
            if law.is_some() {
                self.touch(node, true);
                points.iter().flat_map(Point::nodes).for_each(|&node| self.touch(node, false));
            }
            if law.is_some() {
                self.check_start(&owner, node, &surface, &points);
            }
            self.model.add(Contact { name, node, surface, points, law, chosen });
        }
    }

    /// The node that carries a surface, and the surface in its frame.
    fn contact_surface(&mut self, name: &str, table: &'d At<Table<deck::Surface>>) -> Option<(usize, Surface)> {
        let owner = Owner { what: format!("the surface of contact `{name}`"), span: &table.span };
        let word = self.need(&owner, "shape", &table.shape)?.value;
        let keys = [
            ("point", span(&table.point)),
            ("normal", span(&table.normal)),
            ("center", span(&table.center)),
            ("size", span(&table.size)),
            ("axes", span(&table.axes)),
            ("radius", span(&table.radius)),
            ("axis", span(&table.axis)),
            ("length", span(&table.length)),
            ("ends", span(&table.ends)),
        ];
        let (what, taken): (_, &[&str]) = match word {
            deck::Shape::Plane => ("a plane", &["point", "normal"]),
            deck::Shape::Box => ("a box", &["center", "size", "axes"]),
            deck::Shape::Sphere => ("a sphere", &["center", "radius"]),
            deck::Shape::Cylinder => ("a cylinder", &["center", "radius", "axis", "length"]),
            deck::Shape::Capsule => ("a capsule", &["ends", "radius"]),
        };
        let stray: Vec<(&str, Option<&Span>)> = keys.into_iter().filter(|(key, _)| !taken.contains(key)).collect();
        self.stray(what, &stray);
        let body = match &table.body {
            Some(name) => Some(self.body(name)?),
            None if self.is_spoiled(owner.span, "body") => return None,
            None => None,
        };
        let body = body.map(|body| self.model.bodies[body].node);
        let center = match (word, &table.center, body) {
            (deck::Shape::Plane, ..) => self.need(&owner, "point", &table.point).map(|point| vec3(point)),
            (deck::Shape::Capsule, ..) => None,
            (_, None, Some(body)) if !self.is_spoiled(owner.span, "center") => Some(self.x(body)),
            (_, center, _) => self.need(&owner, "center", center).map(|center| vec3(center)),
        };
        let (center, axes, shape) = match word {
            deck::Shape::Plane => {
                let normal = self.need(&owner, "normal", &table.normal).and_then(|n| self.unit("normal", n));
                (center?, along(&normal?), Shape::Plane)
            }
            deck::Shape::Box => {
                let size = self.need(&owner, "size", &table.size)?;
                if size.value.0.iter().any(|&edge| edge <= 0.0) {
                    return self.error(&size.span, "the edges of a box must be above zero");
                }
                let axes = match &table.axes {
                    Some(axes) => self.axes(axes)?,
                    None if self.is_spoiled(owner.span, "axes") => return None,
                    None => Mat3::identity(),
                };
                (center?, axes, Shape::Box { half: size.value.0.map(|edge| 0.5 * edge) })
            }
            deck::Shape::Sphere => {
                let radius = self.need_positive(&owner, "radius", &table.radius);
                (center?, Mat3::identity(), Shape::Sphere { radius: radius? })
            }
            deck::Shape::Cylinder => {
                let radius = self.need_positive(&owner, "radius", &table.radius);
                let length = self.need_positive(&owner, "length", &table.length);
                let axis = self.need(&owner, "axis", &table.axis).and_then(|axis| self.unit("axis", axis));
                (center?, along(&axis?), Shape::Cylinder { radius: radius?, half: 0.5 * length? })
            }
            deck::Shape::Capsule => {
                let radius = self.need_positive(&owner, "radius", &table.radius);
                let ends = self.need(&owner, "ends", &table.ends)?;
                let [a, b] = ends.value.as_slice() else {
                    return self.error(&ends.span, "`ends` takes two points");
                };
                let (a, b) = (vec3(a), vec3(b));
                let Some(axis) = (b - a).try_normalize(0.0) else {
                    return self.error_with(&ends.span, "the ends of a capsule lie at one place", "that is a sphere");
                };
                (0.5 * (a + b), along(&axis), Shape::Capsule { radius: radius?, half: 0.5 * (b - a).norm() })
            }
        };
        let node = match body {
            Some(node) => node,
            None => {
                let node = self.node(format!("{name}.surface"), false, center);
                // The supports are known, and this node comes after theirs.
                self.model.held.extend((0..6).map(|dof| Held { node, dof, motion: None }));
                node
            }
        };
        Some((node, Surface { center: center - self.x(node), axes, shape }))
    }

    /// Points that the deck names as touching something are connected to it, before supports and loads ask.
    pub fn touch_points(&mut self) {
        for name in self.deck.contacts.iter().filter_map(|contact| contact.with.as_ref()).flat_map(|with| &with.values)
        {
            if let Some(Place::Point(node)) = self.place(name) {
                self.touch(node, false);
            }
        }
    }

    /// All points that may touch, each once.
    fn touching(
        &mut self,
        owner: &Owner<'d>,
        name: &str,
        contact: &'d deck::Contact,
        carrier: Option<usize>,
    ) -> Option<Vec<Point>> {
        let between = match &contact.points {
            Some(at) if at.value > MOST_POINTS as u64 => {
                let message = format!("`points` is {}: at most {MOST_POINTS} are taken to be meant", at.value);
                return self.error(&at.span, message);
            }
            points => points.as_ref().map_or(0, |at| at.value as usize),
        };
        let given = contact.radius.as_ref().map(|_| self.not_negative("radius", &contact.radius, 0.0));
        let names = self.need(owner, "with", &contact.with)?;
        if names.values.is_empty() {
            return self.error(&names.span, "`with` is empty, so nothing touches the surface");
        }
        let (mut touches, mut seen, mut sound, mut parts) = (Vec::new(), HashSet::new(), true, false);
        for at in &names.values {
            let Some(place) = self.lookup(at) else {
                sound = false;
                continue;
            };
            if matches!(place, Place::Link(_) | Place::Contact(_)) {
                sound = false;
                let message =
                    format!("`with` wants points, bodies, sets or parts, and `{}` is {}", at.value, place.kind());
                self.error::<()>(&at.span, message);
                continue;
            }
            let mut found = Vec::new();
            for place in self.leaves(place) {
                parts |= matches!(place, Place::Body(_) | Place::Beam(_) | Place::Bar(_) | Place::Shell(_));
                self.touches_of(place, name, between, at, &mut found);
            }
            if found.is_empty() {
                // A part with errors of its own has no nodes, and these have been said.
                sound = false;
                if self.nodes_of(place).is_empty() {
                    self.report_empty(place, at);
                }
                continue;
            }
            found.retain(|touch| carrier.is_none_or(|body| !touch.nodes.iter().all(|&(n, _)| self.rides_on(n, body))));
            if found.is_empty() {
                sound = false;
                let message = format!("`{}` belongs to the body whose surface it would touch", at.value);
                self.error_with::<()>(&at.span, message, "a body does not touch itself");
            }
            for touch in found {
                let key: Vec<(usize, u64)> = touch.nodes.iter().map(|&(node, w)| (node, w.to_bits())).collect();
                if seen.insert(key) {
                    touches.push(touch);
                }
            }
        }
        if between > 0
            && !parts
            && sound
            && let Some(at) = &contact.points
        {
            return self.error(
                &at.span,
                "`points` lie between the nodes of parts or the corners of bodies, and none is named here",
            );
        }
        if !sound {
            return None;
        }
        let friction = contact.friction.as_ref().is_some_and(|at| at.value > 0.0);
        Some(touches.into_iter().map(|touch| self.contact_point(touch, given, friction)).collect())
    }

    fn contact_point(&self, touch: Touch, given: Option<f64>, friction: bool) -> Point {
        let (mut nodes, mut weights) = ([touch.nodes[0].0; MOST_NODES], [0.0; MOST_NODES]);
        for (k, (node, weight)) in touch.nodes.iter().enumerate() {
            (nodes[k], weights[k]) = (*node, *weight);
        }
        let radius = given.unwrap_or(touch.radius);
        // A point without rotation cannot be turned by friction.
        let turns = touch.nodes.iter().all(|&(node, _)| self.acts[self.root(node)][3..].contains(&true));
        let lever = if friction && turns { radius } else { 0.0 };
        Point { nodes, weights, count: touch.nodes.len(), radius, lever }
    }

    /// What a node moves with in the end.
    fn root(&self, mut node: usize) -> usize {
        let mut steps = 0;
        while let Some((rider, _)) = self.rides.get(&node)
            && steps < self.model.nodes.len()
        {
            node = self.model.riders[*rider].master;
            steps += 1;
        }
        node
    }

    fn rides_on(&self, node: usize, body: usize) -> bool {
        self.root(node) == self.root(body)
    }

    /// A place without its sets, in the order of the deck.
    pub(super) fn leaves(&self, place: Place) -> Vec<Place> {
        let (mut leaves, mut todo, mut seen) = (Vec::new(), vec![place], HashSet::new());
        while let Some(place) = todo.pop() {
            match place {
                Place::Set(set) => {
                    if seen.insert(set) {
                        let members = self.deck.sets.0[set].1.values.iter().rev();
                        todo.extend(members.filter_map(|name| self.place(name)));
                    }
                }
                place => leaves.push(place),
            }
        }
        leaves
    }

    fn touches_of(&mut self, place: Place, name: &str, between: usize, at: &'d At<String>, found: &mut Vec<Touch>) {
        match place {
            Place::Body(body) => self.touches_of_body(body, name, between, at, found),
            Place::Beam(beam) => {
                let radius = self.half_depth(beam);
                found.extend(self.nodes_of(place).into_iter().map(|node| Touch::node(node, radius)));
                for part in self.model.parts[self.beam_parts[beam].clone()].iter().filter_map(Beam::of) {
                    let (ends, _) = quadrature::lobatto(part.order + 1);
                    for element in &part.elements {
                        let nodes = &element.nodes[..=part.order];
                        for xi in inside(ends, between) {
                            let weights = lagrange(ends, xi);
                            let nodes = nodes.iter().copied().zip(weights).collect();
                            found.push(Touch { nodes, radius });
                        }
                    }
                }
            }
            Place::Bar(bar) => {
                found.extend(self.nodes_of(place).into_iter().map(|node| Touch::node(node, 0.0)));
                for part in self.model.parts[self.bar_parts[bar].clone()].iter().filter_map(Bar::of) {
                    for [a, b] in &part.elements {
                        found.extend((1..=between).map(|k| {
                            let s = k as f64 / (between + 1) as f64;
                            Touch { nodes: vec![(*a, 1.0 - s), (*b, s)], radius: 0.0 }
                        }));
                    }
                }
            }
            Place::Shell(shell) => {
                let radius = 0.5 * self.thickness(shell);
                found.extend(self.nodes_of(place).into_iter().map(|node| Touch::node(node, radius)));
                for part in self.model.parts[self.shell_parts[shell].clone()].iter().filter_map(Shell::of) {
                    let mut edges = HashSet::new();
                    for element in &part.elements {
                        within(&element.nodes[..part.corners], between, radius, &mut edges, found);
                    }
                }
            }
            Place::Edge(shell, _) => {
                let radius = 0.5 * self.thickness(shell);
                found.extend(self.nodes_of(place).into_iter().map(|node| Touch::node(node, radius)));
            }
            _ => found.extend(self.nodes_of(place).into_iter().map(|node| Touch::node(node, 0.0))),
        }
    }

    /// Thickness of a shell of the deck; 0 where it has errors.
    fn thickness(&self, shell: usize) -> f64 {
        let mut parts = self.model.parts[self.shell_parts[shell].clone()].iter().filter_map(Shell::of);
        parts.next().map_or(0.0, |part| part.plate.thickness)
    }

    /// Half the smaller side of a beam's section; 0 where the section does not say.
    fn half_depth(&self, beam: usize) -> f64 {
        let name = self.deck.beams[beam].section.as_ref();
        let section = name.and_then(|name| Some(&self.deck.sections.0[self.deck.sections.position(name)?].1));
        let Some(section) = section else { return 0.0 };
        let value = |key: &crate::deck::words::Maybe<f64>| key.as_ref().map_or(0.0, |at| at.value);
        let wide = value(&section.width).max(value(&section.top_width)).max(value(&section.bottom_width));
        let (low, high) = (wide.min(value(&section.height)), wide.max(value(&section.height)));
        let side = if low > 0.0 { low } else { high };
        (0.5 * side).max(value(&section.radius)).max(0.5 * value(&section.diameter))
    }

    /// Points of a body's shape, which ride on it.
    fn touches_of_body(&mut self, body: usize, name: &str, between: usize, at: &'d At<String>, found: &mut Vec<Touch>) {
        let (node, shape) = (self.model.bodies[body].node, self.model.bodies[body].shape.clone());
        let is_drawn = self.deck.bodies.get(body).is_some_and(|body| body.shape.is_some());
        let mut corners = Vec::new();
        match &shape {
            Drawn::Faces { .. } => {
                let riders: HashMap<usize, usize> = self.model.riders.iter().map(|r| (r.node, r.master)).collect();
                let mut nodes: Vec<usize> = riders.iter().filter(|(_, m)| **m == node).map(|(n, _)| *n).collect();
                nodes.sort_unstable();
                return found.extend(nodes.into_iter().map(|node| Touch::node(node, 0.0)));
            }
            Drawn::Sphere { radius } => return found.push(Touch::node(node, if is_drawn { *radius } else { 0.0 })),
            _ if !is_drawn => return found.push(Touch::node(node, 0.0)),
            Drawn::Box { size, axes } => {
                // Corners, and as many points as asked for between them, on edges and faces.
                let n = between + 1;
                let side = |i: usize, k: usize| size[i] * (k as f64 / n as f64 - 0.5);
                for k in 0..(n + 1).pow(3) {
                    let at = [k % (n + 1), k / (n + 1) % (n + 1), k / (n + 1).pow(2)];
                    if at.iter().any(|&k| k == 0 || k == n) {
                        corners.push(axes * Vec3::new(side(0, at[0]), side(1, at[1]), side(2, at[2])));
                    }
                }
            }
            Drawn::Cylinder { radius, length, axis, .. } => {
                let axes = along(axis);
                for end in (0..=between + 1).map(|k| length * (k as f64 / (between + 1) as f64 - 0.5)) {
                    let rim = RIM * (between + 1);
                    for k in 0..rim {
                        let (sin, cos) = (TAU * k as f64 / rim as f64).sin_cos();
                        corners.push(axes * Vec3::new(radius * cos, radius * sin, end));
                    }
                }
            }
        }
        let (center, label) = (self.x(node), self.model.bodies[body].name.clone());
        for (k, corner) in corners.into_iter().enumerate() {
            let rider = self.rider(format!("{name}.{label}[{k}]"), center + corner, node, &at.span);
            found.push(Touch::node(rider, 0.0));
        }
    }

    /// What is said of the force; whether there is none.
    fn numbers(&mut self, owner: &Owner<'d>, contact: &'d deck::Contact) -> Option<bool> {
        let before = self.problems.len();
        self.not_negative("stiffness", &contact.stiffness, 1.0);
        self.not_negative("damping", &contact.damping, 0.0);
        self.not_negative("friction", &contact.friction, 0.0);
        let is_zone = contact.stiffness.as_ref().is_some_and(|at| at.value == 0.0);
        if is_zone {
            let keys = [
                ("restitution", span(&contact.restitution)),
                ("damping", span(&contact.damping)),
                ("friction", span(&contact.friction)),
            ];
            self.stray("a zone, a contact of stiffness 0 where nothing acts", &keys);
        }
        if let Some(at) = &contact.restitution {
            if !(restitution::LEAST..=1.0).contains(&at.value) {
                let message = format!("`restitution` lies between {} and 1", restitution::LEAST);
                self.error_with::<()>(&at.span, message, "a landing without a rebound takes `damping`");
            }
            if let Some(damping) = &contact.damping {
                self.error::<()>(&damping.span, format!("{} takes `restitution` or `damping`, not both", owner.what));
            }
        }
        (self.problems.len() == before).then_some(is_zone)
    }

    fn contact_law(
        &mut self,
        owner: &Owner<'d>,
        contact: &'d deck::Contact,
        carrier: usize,
        points: &[Point],
        masses: &[f64],
    ) -> Option<(Law, bool)> {
        if self.is_spoiled(owner.span, "stiffness") {
            return None;
        }
        let dynamic = self.model.analysis.kind == AnalysisKind::Dynamic;
        // Riders made since then weigh what they ride on weighs.
        let mass = |node: usize| {
            let root = self.root(node);
            let held = (0..3).all(|dof| self.held.contains_key(&(root, dof)));
            if held { f64::INFINITY } else { masses.get(root).copied().unwrap_or(0.0) }
        };
        let on_ground = !self.model.bodies.iter().any(|body| body.node == carrier);
        let other = if on_ground { f64::INFINITY } else { mass(carrier) };
        let (mut mean, mut least, mut rigid) = (0.0f64, f64::INFINITY, true);
        for point in points {
            let own: f64 = point.nodes().iter().zip(point.weights).map(|(&node, w)| w.abs() * mass(node)).sum();
            let reduced = 1.0 / (1.0 / own + 1.0 / other);
            let is_body = point.nodes().iter().all(|&node| self.is_lump(self.root(node)));
            let heavy = |node: usize| {
                let own: f64 = self.model.masses.iter().filter(|mass| mass.node == node).map(|mass| mass.mass).sum();
                own > 0.5 * masses.get(node).copied().unwrap_or(0.0)
            };
            rigid &= is_body || point.nodes().iter().all(|&node| heavy(self.root(node)));
            // Of a node of something deformable more than its own mass takes part in a blow by a body.
            let taken = if is_body || !other.is_finite() { reduced } else { (own * other).sqrt() };
            mean = mean.max(if taken.is_finite() { taken } else { 0.0 });
            least = if reduced > 0.0 { least.min(1.0 / (1.0 / reduced + self.ease(point))) } else { least };
        }
        let stiffness = match &contact.stiffness {
            Some(at) => at.value,
            None if !dynamic => {
                let message = format!("{} needs `stiffness`", owner.what);
                let hint = "in a static analysis there is neither a mass nor a time step to choose it by";
                return self.error_with(owner.span, message, hint);
            }
            None if mean <= 0.0 => {
                let message = format!("{} needs `stiffness`", owner.what);
                return self.error_with(owner.span, message, "nothing that touches has a mass to choose it by");
            }
            None => {
                let StepLength::Fixed { step } = self.model.analysis.step_length else {
                    let message = format!("{} needs `stiffness`", owner.what);
                    let hint = "with an automatic time step there is no length of step to choose it by";
                    return self.error_with(owner.span, message, hint);
                };
                mean * (PI / (STEPS * step)).powi(2)
            }
        };
        let mass = if least.is_finite() { least } else { mean };
        let frequency = if mass > 0.0 { (stiffness / mass).sqrt() } else { f64::INFINITY };
        let extent = self.model.nodes.iter().map(|node| (node.x - self.x(0)).norm()).fold(0.0, f64::max);
        // An approach that sinks in no deeper than the weight does is no impact. Where there is no weight, a trace of length.
        let floor =
            (self.model.gravity.norm() / frequency).max(if mass > 0.0 { 1e-7 * extent * frequency } else { 0.0 });
        let loss = match (&contact.restitution, &contact.damping) {
            (Some(at), _) if at.value < 1.0 => Loss::Restitution { number: restitution::number(at.value), floor },
            (_, Some(at)) if at.value > 0.0 => Loss::Damping(at.value),
            _ => Loss::None,
        };
        let resolved = dynamic && rigid && frequency.is_finite();
        let law = Law {
            stiffness,
            loss,
            friction: contact.friction.as_ref().map_or(0.0, |at| at.value),
            floor,
            resolution: if resolved { RESOLUTION / frequency } else { f64::INFINITY },
            duration: TAU / frequency,
            near: 0.01 * extent,
            dynamic,
        };
        Some((law, contact.stiffness.is_none()))
    }

    /// By how much a body is easier to move at a point than at its centre, per force: r²/J.
    fn ease(&self, point: &Point) -> f64 {
        let root = self.root(point.nodes[0]);
        let body = self.model.bodies.iter().find(|body| body.node == root);
        body.map_or(0.0, |body| {
            let r = self.x(point.nodes[0]) - self.x(root);
            if body.inertia.trace() > 0.0 { 3.0 * r.norm_squared() / body.inertia.trace() } else { 0.0 }
        })
    }

    /// A body or a point mass, and no part of something deformable.
    fn is_lump(&self, node: usize) -> bool {
        let model = &self.model;
        model.bodies.iter().any(|body| body.node == node)
            || model.masses.iter().any(|mass| mass.node == node)
                && !self.beam_nodes.iter().chain(&self.bar_nodes).chain(&self.shell_nodes).any(|of| of.contains(&node))
    }

    /// What rests at each node, and at what it rides on.
    fn masses_at_nodes(&self) -> Vec<f64> {
        let Model { nodes, bodies, masses, parts, stiffnesses, .. } = &self.model;
        let mut at = vec![0.0; nodes.len()];
        bodies.iter().for_each(|body| at[body.node] += body.mass);
        masses.iter().for_each(|mass| at[mass.node] += mass.mass);
        for part in parts.iter().filter(|part| part.kind().is_deformable()) {
            for element in 0..part.elements() {
                let (of, mass) = (part.nodes(element), part.element_mass(element, nodes, stiffnesses));
                of.iter().for_each(|&node| at[node] += mass / of.len() as f64);
            }
        }
        for node in 0..at.len() {
            let root = self.root(node);
            if root != node {
                at[root] += at[node];
            }
        }
        at
    }

    /// What begins inside is pushed out by a blow.
    fn check_start(&mut self, owner: &Owner<'d>, node: usize, surface: &Surface, points: &[Point]) {
        let center = self.x(node);
        let gap = |point: &Point| {
            let x: Vec3 = point.nodes().iter().zip(point.weights).map(|(&node, w)| w * self.x(node)).sum();
            surface.distance(&(x - center)) - point.radius
        };
        let least = points.iter().map(gap).fold(f64::INFINITY, f64::min);
        let size = points.iter().map(|point| self.x(point.nodes[0]).norm()).fold(center.norm(), f64::max);
        // Decks have some digits only.
        if least < -1e-6 * size {
            let message = format!("{} begins closed: something lies {} inside the surface", owner.what, short(-least));
            self.warn(owner.span, message, "it is pushed out at t = 0");
        }
    }
}

/// Axes whose third is given.
fn along(axis: &Vec3) -> Mat3 {
    let x = axis.cross(&Vec3::ith(axis.iamin(), 1.0)).normalize();
    Mat3::from_columns(&[x, axis.cross(&x), *axis])
}

/// As many places between each pair of neighbours.
fn inside(nodes: &[f64], between: usize) -> Vec<f64> {
    let pairs = nodes.windows(2);
    pairs
        .flat_map(|pair| (1..=between).map(move |k| pair[0] + (pair[1] - pair[0]) * k as f64 / (between + 1) as f64))
        .collect()
}

/// The polynomials of nodes at ξ.
fn lagrange(nodes: &[f64], xi: f64) -> Vec<f64> {
    let others = |a: usize| (0..nodes.len()).filter(move |&b| b != a);
    (0..nodes.len()).map(|a| others(a).map(|b| (xi - nodes[b]) / (nodes[a] - nodes[b])).product()).collect()
}

/// A lattice within an element and on those of its edges that are not in `edges` yet.
fn within(nodes: &[usize], between: usize, radius: f64, edges: &mut HashSet<[usize; 2]>, found: &mut Vec<Touch>) {
    let (count, parts) = (nodes.len(), between + 1);
    let at = |k: usize| k as f64 / parts as f64;
    for i in 0..count {
        let pair = [nodes[i], nodes[(i + 1) % count]];
        if edges.insert([pair[0].min(pair[1]), pair[0].max(pair[1])]) {
            found.extend((1..parts).map(|k| Touch { nodes: vec![(pair[0], 1.0 - at(k)), (pair[1], at(k))], radius }));
        }
    }
    for i in 1..parts {
        for j in 1..parts {
            let (s, t) = (at(i), at(j));
            let weights = match count {
                3 if i + j < parts => vec![1.0 - s - t, s, t],
                3 => continue,
                _ => vec![(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t],
            };
            found.push(Touch { nodes: nodes.iter().copied().zip(weights).collect(), radius });
        }
    }
}
