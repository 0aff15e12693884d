//! The names of a deck with their kinds and places: points, bodies, sets, joints, parts and their edges, and groups of the mesh share one
//! name space.

use std::collections::{HashMap, HashSet};

use super::bodies::Bodies;
use super::group_names::{self, GroupChoice, GroupPlace};
use super::mesh_file::MeshNodes;
use super::parts::Parts;
use super::places::place::Place;
use super::report::Report;
use base::diagnostic::{At, Diagnostic, Span};
use deck::Deck;
use deck::loads::Load;
use deck::parts::{DeckPart, PartIndex};

/// Names with a special meaning in lists of nodes and in `[[expect]]`.
const RESERVED: [&str; 2] = ["all", "energy"];

/// The names of a deck.
pub(super) struct Names<'d> {
    /// The deck itself.
    pub deck: &'d Deck,
    /// The mesh, whose groups have names too.
    pub mesh: MeshNodes<'d>,
    /// The meaning of each name, and the place of its declaration.
    places: HashMap<&'d str, (Place, &'d Span)>,
    /// The node of each body.
    body_nodes: Vec<usize>,
    /// The body of each part with `rigid = true`.
    body_of: HashMap<PartIndex, usize>,
}

/// Largest number of self-containing sets reported: each one costs a search through its members.
const CIRCLES: usize = 50;

impl<'d> Names<'d> {
    /// Declares all names of a deck, then checks what sets are made of.
    pub fn declare(deck: &'d Deck, bodies: &Bodies<'d>, mesh: MeshNodes<'d>, report: &mut Report<'d>) -> Self {
        let body_nodes = bodies.list.iter().map(|body| body.node).collect();
        let body_of = bodies.body_of.clone();
        let mut names = Names { deck, mesh, places: HashMap::new(), body_nodes, body_of };
        for (node, (name, _)) in deck.points.0.iter().enumerate() {
            names.add(name, Place::Point(node), report);
        }
        names.add_all(deck.bodies.iter().map(|body| body.name.as_ref()), Place::Body, report);
        names.add_all(deck.sets.0.iter().map(|(name, _)| Some(name)), Place::Set, report);
        names.add_all(deck.joints.iter().map(|joint| joint.name.as_ref()), Place::Joint, report);
        names.add_all(deck.drifts.iter().map(|drift| drift.name.as_ref()), Place::Drift, report);
        deck.parts().for_each(|part| names.add_part(&part, report));
        names.add_groups(report);
        names.check_sets(report);
        names.check_groups(report);
        names
    }

    /// Declares the names of a family of tables, some without a name.
    fn add_all(
        &mut self,
        family: impl Iterator<Item = Option<&'d At<String>>>,
        place: impl Fn(usize) -> Place,
        report: &mut Report<'d>,
    ) {
        for (index, name) in family.enumerate() {
            if let Some(name) = name {
                self.add(name, place(index), report);
            }
        }
    }

    /// Declares the name of a part, if it has one; for a rigid part it means the body.
    fn add_part(&mut self, part: &DeckPart<'d>, report: &mut Report<'d>) {
        if let Some(name) = part.name() {
            let place = self.body_of.get(&part.at).map_or(Place::Part(part.at), |&body| Place::Body(body));
            self.add(name, place, report);
        }
    }

    fn add(&mut self, name: &'d At<String>, place: Place, report: &mut Report<'d>) {
        if name.is_empty() {
            report.error::<()>(&name.span, "a name must not be empty");
        } else if RESERVED.contains(&name.as_str()) {
            report.error_with::<()>(&name.span, format!("`{}` is a reserved name", name.value), "choose another name");
        } else if self.places.contains_key(name.as_str()) {
            let message = format!("the name `{}` is taken", name.value);
            let diagnostic = Diagnostic::error(message).at(&name.span).hint("given a second time here");
            let rule = "points, bodies, sets, beams, bars, shells, links, joints, contacts and drifts share one space of names";
            report.push(diagnostic.hint(rule));
        } else {
            self.places.insert(&name.value, (place, &name.span));
        }
        if name.starts_with(['=', '+', '-', '@']) {
            let message =
                format!("spreadsheets take the name `{}` for a formula when they open a table of results", name.value);
            report.warn(&name.span, message, "let the name begin with a letter or a digit");
        }
    }

    /// Declares groups of the mesh, whose names must be different from all others but the parts made of them.
    fn add_groups(&mut self, report: &mut Report<'d>) {
        let deck = self.deck;
        let Some(input) = self.mesh.input else { return };
        let Some(file) = deck.mesh.as_ref().and_then(|mesh| mesh.file.as_ref()) else { return };
        let parts: Vec<&str> = deck.parts().filter_map(|part| part.table.group()).map(|at| at.as_str()).collect();
        // A part may be called like the group it is made of.
        let made: HashSet<u32> = parts.iter().flat_map(|name| input.mesh.named(name)).copied().collect();
        let of_own_group = |part: &DeckPart<'d>| {
            let name = part.name()?.as_str();
            let groups = input.mesh.named(part.table.group()?.as_str());
            input.mesh.named(name).iter().any(|group| groups.contains(group)).then_some(name)
        };
        let own: HashSet<&str> = deck.parts().filter_map(|part| of_own_group(&part)).collect();
        let mut seen = HashSet::new();
        for group in input.mesh.groups.iter().filter(|group| seen.insert(&group.name)) {
            let name = group.name.as_str();
            let is_part = || input.mesh.named(name).iter().any(|group| made.contains(group));
            if RESERVED.contains(&name) {
                if !is_part() {
                    let message = format!("group `{name}` of the mesh has a reserved name");
                    let first = input.mesh.named(name).first().map_or(0, |&first| first as usize);
                    let spelling = group_names::spelling(&input.mesh, first);
                    report.warn(
                        &file.span,
                        message,
                        format!("write `{spelling}` in the deck, or rename it in the mesh"),
                    );
                }
                continue;
            }
            match self.places.get(name) {
                None => {
                    let place = group_names::place(&input.mesh, name).map(Place::Group);
                    self.places.extend(place.map(|place| (name, (place, &file.span))));
                }
                Some(_) if own.contains(name) => {}
                Some((place, span)) => {
                    let message = format!("{} `{name}` has the name of a group of the mesh", place.noun());
                    report.error_with::<()>(span, message, "rename it, here or in the mesh");
                }
            }
        }
    }

    /// Reports unknown members of sets, and sets within themselves.
    fn check_sets(&self, report: &mut Report<'d>) {
        let entangled = self.entangled();
        let mut said = 0;
        for (index, (name, members)) in self.deck.sets.0.iter().enumerate() {
            for member in &members.values {
                self.find(member, report);
            }
            if said < CIRCLES && entangled[index] && self.holds_itself(index) {
                said += 1;
                report.error_with::<()>(
                    &name.span,
                    format!("set `{}` contains itself", name.value),
                    "remove its name from its members",
                );
            }
        }
    }

    /// The sets within a set.
    fn inner_sets(&self, set: usize) -> impl Iterator<Item = usize> {
        self.deck.sets.0[set].1.values.iter().filter_map(|member| match self.places.get(member.as_str()) {
            Some((Place::Set(inner), _)) => Some(*inner),
            _ => None,
        })
    }

    /// For each set, whether it contains itself or a set that does. Sets without inner sets are removed repeatedly; these remain.
    fn entangled(&self) -> Vec<bool> {
        let count = self.deck.sets.0.len();
        let (mut inner, mut outer) = (vec![0_usize; count], vec![Vec::new(); count]);
        for set in 0..count {
            for other in self.inner_sets(set) {
                inner[set] += 1;
                outer[other].push(set);
            }
        }
        let mut free: Vec<usize> = (0..count).filter(|&set| inner[set] == 0).collect();
        while let Some(set) = free.pop() {
            for &holder in &outer[set] {
                inner[holder] -= 1;
                if inner[holder] == 0 {
                    free.push(holder);
                }
            }
        }
        inner.into_iter().map(|left| left > 0).collect()
    }

    fn holds_itself(&self, set: usize) -> bool {
        let (mut todo, mut seen) = (vec![set], HashSet::new());
        while let Some(index) = todo.pop() {
            for inner in self.inner_sets(index) {
                if inner == set {
                    return true;
                }
                if seen.insert(inner) {
                    todo.push(inner);
                }
            }
        }
        false
    }

    /// The meaning of a declared name, without edges of shells and nodes of the mesh.
    pub fn declared(&self, name: &str) -> Option<Place> {
        self.places.get(name).map(|(place, _)| *place)
    }

    /// All declared names with their meaning and place, in no order.
    pub fn declarations(&self) -> impl Iterator<Item = (&'d str, Place, &'d Span)> {
        self.places.iter().map(|(name, (place, span))| (*name, *place, *span))
    }

    /// All declared names of some places, sorted.
    pub fn known(&self, is_meant: impl Fn(Place) -> bool) -> Vec<&'d str> {
        let mut known: Vec<&str> =
            self.declarations().filter(|(_, place, _)| is_meant(*place)).map(|(name, ..)| name).collect();
        known.sort_unstable();
        known
    }

    /// The meaning of a name, also for `mesh.17`, `shell.edge1` to `shell.edge4`, `node-set:root` and `STRIP-1.root`.
    pub fn place(&self, name: &str) -> Option<Place> {
        let node = || self.mesh.node(name).map(Place::Point);
        self.declared(name).or_else(node).or_else(|| self.edge(name)).or_else(|| self.group(name))
    }

    /// The groups of the mesh for a name.
    fn group(&self, name: &str) -> Option<Place> {
        group_names::place(&self.mesh.input?.mesh, name).map(Place::Group)
    }

    /// The meaning of a name in a list of nodes. For a part named after its group, a set of nodes has priority.
    fn node_place(&self, name: &str) -> Option<Place> {
        let place = self.place(name)?;
        let Place::Part(part) = place else { return Some(place) };
        let is_group = self.deck.part(part).is_some_and(|part| part.table.name().is_none());
        let set = || self.mesh.input.and_then(|input| group_names::set_of_nodes(&input.mesh, name));
        Some(if is_group { set().map_or(place, Place::Group) } else { place })
    }

    /// The edge for a name like `shell.edge2`.
    fn edge(&self, name: &str) -> Option<Place> {
        let (surface, edge) = name.rsplit_once(".edge")?;
        let part = match self.declared(surface)? {
            Place::Part(part) => part,
            Place::Body(body) => self.rigid_part(body)?,
            _ => return None,
        };
        let edges = self.deck.part(part)?.table.named_edges();
        (1..=edges).find(|k| edge == k.to_string()).map(|k| Place::Edge(part, k - 1))
    }

    /// The rigid part behind a body, if the body is one.
    pub fn rigid_part(&self, body: usize) -> Option<PartIndex> {
        self.body_of.iter().find(|(_, of)| **of == body).map(|(part, _)| *part)
    }

    /// The meaning of a name. A set or group of one node means that node.
    pub fn place_or_node(&self, name: &str, parts: &Parts) -> Option<Place> {
        self.place(name).map(|place| match place {
            Place::Set(_) | Place::Group(_) => match self.nodes_of(place, parts)[..] {
                [node] => Place::Point(node),
                _ => place,
            },
            place => place,
        })
    }

    /// The meaning of a name; an unknown name is an error.
    pub fn find(&self, name: &At<String>, report: &mut Report<'d>) -> Option<Place> {
        self.place(name).or_else(|| self.unknown_part(name, report))
    }

    /// [`Names::find`] in a list of points, bodies, parts and sets.
    pub fn find_in_parts(&self, name: &At<String>, report: &mut Report<'d>) -> Option<Place> {
        self.node_place(name).or_else(|| self.unknown_part(name, report))
    }

    fn unknown_part(&self, name: &At<String>, report: &mut Report<'d>) -> Option<Place> {
        self.unknown("point, body, set or part", name, || self.known(Place::has_nodes), report)
    }

    /// [`Names::find`] in a list of points, bodies and sets.
    pub fn find_nodes(&self, name: &At<String>, report: &mut Report<'d>) -> Option<Place> {
        self.node_place(name)
            .or_else(|| self.unknown("point, body or set", name, || self.known(|place| !self.is_part(place)), report))
    }

    /// Reports an unknown name in a list of nodes.
    pub fn unknown<'n, T>(
        &self,
        what: &str,
        name: &At<String>,
        known: impl FnOnce() -> Vec<&'n str>,
        report: &mut Report<'d>,
    ) -> Option<T> {
        report.lose_connections();
        // It may be a group of a mesh that could not be read.
        if self.mesh.is_lost {
            return None;
        }
        let known = if report.may_search() { known() } else { Vec::new() };
        report.unknown(what, name, known.into_iter())
    }

    /// Whether a place is no list of nodes.
    pub fn is_part(&self, place: Place) -> bool {
        match place {
            Place::Part(part) => !self.deck.part(part).is_some_and(|part| part.table.is_node_list()),
            Place::Joint(_) | Place::Drift(_) => true,
            _ => false,
        }
    }

    /// The node of a point, where `key` wants nothing else.
    pub fn point(&self, key: &str, name: &At<String>, parts: &Parts, report: &mut Report<'d>) -> Option<usize> {
        match self.node_place(name) {
            Some(Place::Point(node)) => Some(node),
            Some(set @ (Place::Group(_) | Place::Set(_))) => match self.nodes_of(set, parts)[..] {
                [node] => Some(node),
                ref nodes => {
                    let (kind, count) = (set.kind(), nodes.len());
                    let message = format!("`{key}` takes points, and `{}` is {kind} of {count} nodes", name.value);
                    report.error(&name.span, message)
                }
            },
            Some(place) => {
                let message = format!("`{key}` takes points, and `{}` is {}", name.value, place.kind());
                report.error(&name.span, message)
            }
            None => self.unknown("point", name, || self.deck.points.names().collect(), report),
        }
    }

    /// Index of a body by name.
    pub fn body(&self, name: &At<String>, report: &mut Report<'d>) -> Option<usize> {
        match self.declared(name) {
            Some(Place::Body(body)) => Some(body),
            Some(place) => {
                let message = format!("`{}` is {}, not a body", name.value, place.kind());
                report.error_with(&name.span, message, "name an entry of [[bodies]]")
            }
            None => {
                let names = self.deck.bodies.iter().filter_map(|body| body.name.as_ref()).map(|name| name.as_str());
                report.lose_connections();
                report.unknown("body", name, names)
            }
        }
    }

    /// The node of a body, by the index of the body.
    pub fn body_node(&self, body: usize) -> usize {
        self.body_nodes[body]
    }

    /// The surface of a place, also a rigid one or one made of the named group.
    pub fn surface_of(&self, place: Place) -> Option<PartIndex> {
        self.part_of(place, |part| part.kind.is_surface())
    }

    /// The beam or bar of a place, also a rigid one or one made of the named group.
    pub fn line_of(&self, place: Place) -> Option<PartIndex> {
        self.part_of(place, |part| part.kind.is_line())
    }

    fn part_of(&self, place: Place, is_meant: impl Fn(PartIndex) -> bool) -> Option<PartIndex> {
        let part = match place {
            Place::Part(part) => Some(part),
            Place::Body(body) => self.rigid_part(body),
            Place::Group(group) => {
                let mesh = &self.mesh.input?.mesh;
                let pick = |of: &GroupPlace, at: PartIndex| if at.kind.is_surface() { of.faces } else { of.lines };
                let is_made_of_it = |part: &DeckPart| {
                    let own = part.table.group().and_then(|name| group_names::place(mesh, name));
                    own.and_then(|own| pick(&own, part.at).one())
                        .is_some_and(|own| pick(&group, part.at).one() == Some(own))
                };
                let mut meant = self.deck.parts().filter(|part| is_meant(part.at));
                meant.find(is_made_of_it).map(|part| part.at)
            }
            _ => None,
        };
        part.filter(|&part| is_meant(part))
    }

    /// A place without its sets, in the order of the deck.
    pub fn leaves(&self, place: Place) -> Vec<Place> {
        self.leaves_by(place, |name| self.place(name))
    }

    fn leaves_by(&self, place: Place, find: impl Fn(&str) -> Option<Place>) -> Vec<Place> {
        let (mut leaves, mut todo, mut seen) = (Vec::new(), vec![place], HashSet::new());
        while let Some(place) = todo.pop() {
            match place {
                Place::Set(set) if !seen.insert(set) => {}
                Place::Set(set) => {
                    let members = self.deck.sets.0[set].1.values.iter().rev();
                    todo.extend(members.filter_map(|name| find(name)));
                }
                place => leaves.push(place),
            }
        }
        leaves
    }

    /// The nodes that a place covers, some of them perhaps more than once. Parts have those that are made so far.
    pub fn nodes_of(&self, place: Place, parts: &Parts) -> Vec<usize> {
        let mut nodes = Vec::new();
        for place in self.leaves_by(place, |name| self.node_place(name)) {
            match place {
                Place::Point(node) => nodes.push(node),
                Place::Body(body) => nodes.push(self.body_nodes[body]),
                Place::Part(part) => nodes.extend(parts.entry(part).into_iter().flat_map(|entry| &entry.nodes)),
                Place::Edge(part, edge) => {
                    let edges = parts.entry(part).and_then(|entry| entry.edges.get(edge));
                    nodes.extend(edges.into_iter().flatten());
                }
                Place::Group(group) => {
                    nodes.extend(group.nodes.one().into_iter().flat_map(|g| self.mesh.group_nodes(g)))
                }
                Place::Set(_) | Place::Joint(_) | Place::Drift(_) => {}
            }
        }
        nodes
    }

    /// Groups of the mesh that lists of the deck name.
    pub fn groups_in_lists(&self) -> impl Iterator<Item = usize> {
        let loads = self.deck.loads.iter().filter_map(|load| load.at.as_ref()).flat_map(|at| &at.value.values);
        let names = self.node_lists().chain(loads);
        let places = names.flat_map(|name| [self.place(name), self.node_place(name)]).flatten();
        places
            .flat_map(|place| if let Place::Group(group) = place { Some(group) } else { None })
            .flat_map(|g| g.groups())
    }

    /// Names in lists of nodes, and of single nodes.
    fn node_lists(&self) -> impl Iterator<Item = &'d At<String>> {
        let deck = self.deck;
        let points = deck.joints.iter().flat_map(|joint| [&joint.from, &joint.to]).flatten();
        let points = points.filter_map(|end| end.node.as_ref());
        let lists = deck.masses.iter().map(|mass| &mass.at);
        let lists = lists.chain(deck.attachments.iter().map(|attachment| &attachment.nodes));
        let lists = lists.chain(deck.ties.iter().map(|tie| &tie.nodes));
        let lists = lists.chain(deck.supports.iter().map(|support| &support.at));
        let lists = lists.chain(deck.loads.iter().filter(|load| !is_over_surfaces(load)).map(|load| &load.at));
        let lists = lists.chain(deck.initial.iter().map(|initial| &initial.at));
        let lists = lists.chain(deck.damping.iter().flat_map(|damping| &damping.nodal).map(|damper| &damper.at));
        let lists = lists.chain(deck.output.iter().map(|output| &output.nodes)).flatten().map(|at| &at.value);
        let lists = lists.chain(deck.sets.0.iter().map(|(_, members)| &members.value));
        let names = lists.flat_map(|names| &names.values).chain(points);
        names.chain(deck.parts().flat_map(|part| part.table.members()))
    }

    /// Reports names in lists of nodes with several groups in the mesh: the choice, or an error if the deck has to choose.
    pub fn check_groups(&self, report: &mut Report<'d>) {
        let Some(input) = self.mesh.input else { return };
        let mut seen = HashSet::new();
        let nodes = self.node_lists().map(|name| (name, self.node_place(name)));
        // For contacts, a part has priority over a set of nodes.
        let touching = self.deck.contacts.iter().filter_map(|contact| contact.with.as_ref()).flat_map(|at| &at.values);
        let places = nodes.chain(touching.map(|name| (name, self.place(name))));
        for (name, place) in places.filter(|(name, _)| seen.insert(name.as_str())) {
            match place {
                Some(Place::Group(GroupPlace { nodes: GroupChoice::Many, .. })) => {
                    let hint = "write the one that is meant, or several in a list";
                    group_names::ambiguous::<()>(&input.mesh, name, hint, report);
                }
                Some(Place::Group(GroupPlace { nodes: GroupChoice::One(taken), .. })) => {
                    group_names::note_choice(&input.mesh, name, taken as usize, report);
                }
                _ => {}
            }
        }
    }
}

/// True for a load that is spread over faces.
fn is_over_surfaces(load: &Load) -> bool {
    load.pressure.is_some() || load.force_per_area.is_some()
}
