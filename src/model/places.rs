//! What the names of a deck stand for: points, bodies, sets, beams, bars, shells and their edges, links, groups of the mesh.

use super::build::{Builder, Owner, vec3};
use crate::deck::words::{Maybe, Names};
use crate::diagnostic::{At, Diagnostic, Span};
use crate::math::Vec3;

/// What a name stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Place {
    /// By its node.
    Point(usize),
    // The others by their index in the deck, which is that in a sound model.
    Body(usize),
    Set(usize),
    Beam(usize),
    Bar(usize),
    Shell(usize),
    /// Of a shell, counted from 0.
    Edge(usize, usize),
    Link(usize),
    Joint(usize),
    Contact(usize),
    /// Of the mesh.
    Group(usize),
}

/// A node that a list of names covers.
pub(super) struct Spot<'d> {
    pub node: usize,
    pub name: Label<'d>,
    /// Where the name stands that covers it.
    pub span: &'d Span,
    /// Named itself, and not as part of a set, a beam or everything.
    pub direct: bool,
}

/// A node in messages.
#[derive(Debug, Clone, Copy)]
pub(super) enum Label<'d> {
    /// The deck's name of it, or of the part that it belongs to.
    Name(&'d str),
    /// The number of a node of the mesh, as the deck would name it.
    Mesh(u64),
}

impl std::fmt::Display for Label<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Label::Name(name) => f.write_str(name),
            Label::Mesh(id) => write!(f, "mesh.{id}"),
        }
    }
}

/// Which names a list may hold besides points, bodies and sets.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    Nodes,
    /// Beams and bars too. (Shells are lists of nodes like sets: their inner ones have no other name.)
    Parts,
}

impl<'d> Builder<'d> {
    pub fn points(&mut self) {
        for (name, x) in &self.deck.points.0 {
            let node = self.node(name.value.clone(), true, vec3(x));
            self.name(name, Place::Point(node));
        }
    }

    /// Tells nodes where the deck names them, for what is found out about a sound model.
    pub fn place_nodes(&mut self) {
        let deck = self.deck;
        let beams =
            deck.beams.iter().map(|part| part.name.as_ref().or(part.group.as_ref()).map_or(&part.span, |at| &at.span));
        let bars = deck.bars.iter().map(|part| part.name.as_ref().map_or(&part.span, |at| &at.span));
        let shells =
            deck.shells.iter().map(|part| part.name.as_ref().or(part.group.as_ref()).map_or(&part.span, |at| &at.span));
        let of_parts =
            beams.zip(&self.beam_nodes).chain(bars.zip(&self.bar_nodes)).chain(shells.zip(&self.shell_nodes));
        let nodes = &mut self.model.nodes;
        let place = |span: &Span| Some([span.start, span.end]);
        for (span, of_part) in of_parts {
            for &node in of_part {
                nodes[node].place = nodes[node].place.or(place(span));
            }
        }
        for rider in &self.model.riders {
            nodes[rider.node].place = rider.place;
        }
        // Names of their own before all others.
        for (named, span) in self.places.values() {
            match *named {
                Place::Point(node) => nodes[node].place = place(span),
                Place::Body(body) => nodes[self.model.bodies[body].node].place = place(span),
                _ => {}
            }
        }
    }

    /// Takes a name for something; names of points, bodies, sets, beams, bars, shells, links and joints are all different.
    pub fn name(&mut self, name: &'d At<String>, place: Place) {
        if name.is_empty() {
            self.error::<()>(&name.span, "a name must not be empty");
        } else if name.value == "all" || name.value == "energy" {
            self.error::<()>(&name.span, format!("`{}` has a meaning of its own and cannot be a name", name.value));
        } else if self.places.contains_key(name.as_str()) {
            let message = format!("the name `{}` is taken", name.value);
            let diagnostic = Diagnostic::error(message).at(&name.span).hint("given a second time here");
            let rule = "points, bodies, sets, beams, bars, shells, links, joints and contacts share one space of names";
            self.problems.push(diagnostic.hint(rule));
        } else {
            self.places.insert(&name.value, (place, &name.span));
        }
    }

    /// Names of parts whose nodes come later, so that lists may mention them.
    pub fn register_names(&mut self) {
        let deck = self.deck;
        let rigid = std::mem::take(&mut self.rigid.body_of);
        let part = |part: Place| rigid.get(&part).map_or(part, |&body| Place::Body(body));
        for (index, (name, _)) in deck.sets.0.iter().enumerate() {
            self.name(name, Place::Set(index));
        }
        for (index, beam) in deck.beams.iter().enumerate() {
            if let Some(name) = beam.name.as_ref().or(beam.group.as_ref()) {
                self.name(name, part(Place::Beam(index)));
            }
        }
        for (index, bar) in deck.bars.iter().enumerate() {
            if let Some(name) = &bar.name {
                self.name(name, Place::Bar(index));
            }
        }
        for (index, shell) in deck.shells.iter().enumerate() {
            if let Some(name) = shell.name.as_ref().or(shell.group.as_ref()) {
                self.name(name, part(Place::Shell(index)));
            }
        }
        for (index, link) in deck.links.iter().enumerate() {
            if let Some(name) = &link.name {
                self.name(name, Place::Link(index));
            }
        }
        for (index, joint) in deck.joints.iter().enumerate() {
            if let Some(name) = &joint.name {
                self.name(name, Place::Joint(index));
            }
        }
        for (index, contact) in deck.contacts.iter().enumerate() {
            if let Some(name) = &contact.name {
                self.name(name, Place::Contact(index));
            }
        }
        self.rigid.body_of = rigid;
        self.register_groups();
        for (index, (_, members)) in deck.sets.0.iter().enumerate() {
            for member in &members.values {
                self.lookup(member);
            }
            if self.holds_itself(index) {
                let name = &deck.sets.0[index].0;
                self.error::<()>(&name.span, format!("set `{}` holds itself", name.value));
            }
        }
    }

    fn holds_itself(&self, set: usize) -> bool {
        let (mut todo, mut seen) = (vec![set], vec![false; self.deck.sets.0.len()]);
        while let Some(index) = todo.pop() {
            for member in &self.deck.sets.0[index].1.values {
                match self.places.get(member.as_str()) {
                    Some((Place::Set(inner), _)) if *inner == set => return true,
                    Some((Place::Set(inner), _)) if !seen[*inner] => {
                        seen[*inner] = true;
                        todo.push(*inner);
                    }
                    _ => {}
                }
            }
        }
        false
    }

    /// What a name stands for, `shell.edge1` to `shell.edge4` among them.
    pub fn place(&self, name: &str) -> Option<Place> {
        if let Some((place, _)) = self.places.get(name) {
            return Some(*place);
        }
        if let Some(node) = self.mesh_node(name) {
            return Some(Place::Point(node));
        }
        let (shell, edge) = name.rsplit_once(".edge")?;
        let index = match self.places.get(shell)?.0 {
            Place::Shell(index) => index,
            // A rigid one.
            Place::Body(_) => {
                self.deck.shells.iter().position(|s| s.name.as_ref().is_some_and(|n| n.value == shell))?
            }
            _ => return None,
        };
        // A group has no corners.
        if self.deck.shells[index].group.is_some() {
            return None;
        }
        // Where the corners are wrong, that is said there.
        let three = self.deck.shells[index].corners.as_ref().is_some_and(|corners| corners.values.len() == 3);
        let corners = if three { 3 } else { 4 };
        (1..=corners).find(|k| edge == k.to_string()).map(|k| Place::Edge(index, k - 1))
    }

    /// What a name stands for; a set or group of one node stands for that node.
    pub fn place_or_node(&self, name: &str) -> Option<Place> {
        self.place(name).map(|place| match place {
            Place::Set(_) | Place::Group(_) => match self.nodes_of(place)[..] {
                [node] => Place::Point(node),
                _ => place,
            },
            place => place,
        })
    }

    /// What a name stands for; reports a name that stands for nothing.
    pub fn lookup(&mut self, name: &At<String>) -> Option<Place> {
        self.lookup_among(name, Reach::Parts)
    }

    /// [`Builder::lookup`] where a list reaches so far.
    fn lookup_among(&mut self, name: &At<String>, reach: Reach) -> Option<Place> {
        if let Some(place) = self.place(name) {
            if let Place::Group(group) = place {
                self.meshed.named[group] = true;
            }
            return Some(place);
        }
        let is_link = |place: &Place| matches!(place, Place::Link(_) | Place::Joint(_) | Place::Contact(_));
        let known = self.places.iter().filter(|(_, (place, _))| !is_link(place));
        let (what, known): (_, Vec<_>) = match reach {
            Reach::Nodes => ("point, body or set", known.filter(|(_, (place, _))| !self.is_part(*place)).collect()),
            Reach::Parts => ("point, body, set or part", known.collect()),
        };
        let mut known: Vec<&str> = known.into_iter().map(|(name, _)| *name).collect();
        known.sort_unstable();
        self.unknown(what, name, known.into_iter())
    }

    /// Not a list of nodes.
    fn is_part(&self, place: Place) -> bool {
        match place {
            Place::Beam(beam) => self.deck.beams[beam].group.is_none(),
            place => matches!(place, Place::Bar(_) | Place::Link(_) | Place::Joint(_) | Place::Contact(_)),
        }
    }

    /// The node of a point; `key` wants nothing else.
    pub fn point(&mut self, key: &str, name: &At<String>) -> Option<usize> {
        let place = self.place(name);
        if let Some(set @ (Place::Group(_) | Place::Set(_))) = place {
            return match self.nodes_of(set)[..] {
                [node] => self.lookup(name).map(|_| node),
                ref nodes => {
                    let (kind, count) = (set.kind(), nodes.len());
                    let message = format!("`{key}` wants points, and `{}` is {kind} of {count} nodes", name.value);
                    self.error(&name.span, message)
                }
            };
        }
        match place {
            Some(Place::Point(node)) => Some(node),
            Some(place) => {
                let message = format!("`{key}` wants points, and `{}` is {}", name.value, place.kind());
                self.error(&name.span, message)
            }
            None => self.unknown("point", name, self.deck.points.names()),
        }
    }

    /// Index of a body by name.
    pub fn body(&mut self, name: &At<String>) -> Option<usize> {
        match self.places.get(name.as_str()) {
            Some((Place::Body(body), _)) => Some(*body),
            Some((place, _)) => self.error(&name.span, format!("`{}` is {}, not a body", name.value, place.kind())),
            None => {
                let names = self.deck.bodies.iter().filter_map(|body| body.name.as_ref()).map(|name| name.as_str());
                self.unknown("body", name, names)
            }
        }
    }

    /// All nodes that a list of names covers, each once, in the order of the list.
    pub fn spots(&mut self, owner: &Owner, key: &str, names: &'d Maybe<Names>, reach: Reach) -> Vec<Spot<'d>> {
        let Some(names) = self.need(owner, key, names) else { return Vec::new() };
        if names.values.is_empty() {
            self.error::<()>(&names.span, format!("`{key}` is empty"));
        }
        let mut spots = Vec::new();
        let mut seen = std::collections::HashSet::new();
        for name in &names.values {
            let Some(place) = self.lookup_among(name, reach) else { continue };
            if reach == Reach::Nodes && self.is_part(place) {
                let message = format!("`{key}` wants points, bodies or sets, and `{}` is {}", name.value, place.kind());
                self.error_with::<()>(&name.span, message, "name its points");
                continue;
            }
            let direct = matches!(place, Place::Point(_) | Place::Body(_));
            let nodes = self.nodes_of(place);
            if nodes.is_empty() {
                self.report_empty(place, name);
            }
            for node in nodes {
                if seen.insert(node) {
                    let label = if direct { Label::Name(name) } else { self.label(node, name) };
                    spots.push(Spot { node, name: label, span: &name.span, direct });
                }
            }
        }
        spots
    }

    /// Says of a set or group that it covers no node, unless an error of what is in it has been said.
    pub fn report_empty(&mut self, place: Place, name: &At<String>) {
        let members = match place {
            Place::Group(_) => {
                let hint = "its elements are of kinds that are skipped, or there are none";
                self.error_with::<()>(&name.span, format!("the group `{}` has no nodes", name.value), hint);
                return;
            }
            Place::Set(set) => &self.deck.sets.0[set].1.values,
            _ => return,
        };
        let bare =
            |leaf: &Place| matches!(leaf, Place::Link(_) | Place::Joint(_) | Place::Contact(_) | Place::Group(_));
        if members.is_empty() {
            self.error::<()>(&name.span, format!("the set `{}` is empty", name.value));
        } else if !self.unsure && self.leaves(place).iter().all(bare) {
            self.error::<()>(&name.span, format!("the set `{}` has no nodes", name.value));
        }
    }

    /// The name under which the deck knows a node that a set or a part brought in.
    pub fn label(&self, node: usize, part: &'d At<String>) -> Label<'d> {
        let point = self.deck.points.0.get(node).map(|(name, _)| name);
        let body = || self.deck.bodies.get(node.checked_sub(self.deck.points.0.len())?)?.name.as_ref();
        if let Some(name) = point.or_else(body) {
            return Label::Name(name);
        }
        self.mesh_id(node).map_or(Label::Name(part), Label::Mesh)
    }

    pub fn nodes_of(&self, place: Place) -> Vec<usize> {
        let (mut nodes, mut todo, mut seen) = (Vec::new(), vec![place], vec![false; self.deck.sets.0.len()]);
        while let Some(place) = todo.pop() {
            match place {
                Place::Point(node) => nodes.push(node),
                Place::Body(body) => nodes.push(self.model.bodies[body].node),
                Place::Beam(beam) => nodes.extend(self.beam_nodes.get(beam).into_iter().flatten()),
                Place::Bar(bar) => nodes.extend(self.bar_nodes.get(bar).into_iter().flatten()),
                Place::Shell(shell) => nodes.extend(self.shell_nodes.get(shell).into_iter().flatten()),
                Place::Edge(shell, edge) => {
                    nodes.extend(self.shell_edges.get(shell).and_then(|edges| edges.get(edge)).into_iter().flatten());
                }
                Place::Link(_) | Place::Joint(_) | Place::Contact(_) => {}
                Place::Group(group) => nodes.extend(self.group_nodes(group)),
                Place::Set(set) if std::mem::replace(&mut seen[set], true) => {}
                Place::Set(set) => {
                    let members = self.deck.sets.0[set].1.values.iter().rev();
                    todo.extend(members.filter_map(|name| self.place(name)));
                }
            }
        }
        nodes
    }

    pub fn x(&self, node: usize) -> Vec3 {
        self.model.nodes[node].x
    }
}

impl Place {
    /// "a shell", "an edge of a shell".
    pub fn kind(self) -> String {
        let noun = self.noun();
        format!("{} {noun}", if noun.starts_with('e') { "an" } else { "a" })
    }

    pub fn noun(self) -> &'static str {
        match self {
            Place::Point(_) => "point",
            Place::Body(_) => "body",
            Place::Set(_) => "set",
            Place::Beam(_) => "beam",
            Place::Bar(_) => "bar",
            Place::Shell(_) => "shell",
            Place::Edge(..) => "edge of a shell",
            Place::Link(_) => "link",
            Place::Joint(_) => "joint",
            Place::Contact(_) => "contact",
            Place::Group(_) => "group of the mesh",
        }
    }
}
