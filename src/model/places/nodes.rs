//! The nodes of a model as the tables add them: positions, connections, dependent nodes and restraints.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::ops::{Deref, DerefMut};

use crate::data::{DependentNode, Node, PrescribedMotion, Restraint};
use crate::places::spot::Spot;
use crate::report::Report;
use base::diagnostic::Span;
use base::math::Vec3;

/// The nodes of a model that is being built.
#[derive(Default)]
pub struct Nodes {
    /// The nodes.
    pub list: Vec<Node>,
    /// The directions of each node with an element, mass, body or link.
    connected: Vec<[bool; 6]>,
    /// Dependent nodes, in the order of attachment.
    pub dependents: Vec<DependentNode>,
    /// The index of each dependent node in `dependents`, and the place in the deck that made it depend.
    attachments: HashMap<usize, (usize, Span)>,
    restraints: Restraints,
    /// Displacements from t = 0 at which motions of restraints end: node, direction and value.
    pub targets: Vec<([usize; 2], f64)>,
}

/// The restraints by node and degree of freedom.
pub type Restraints = BTreeMap<(usize, usize), Restraint>;

impl Nodes {
    /// A new node at rest.
    pub fn add(&mut self, label: String, named: bool, x: Vec3) -> usize {
        self.list.push(Node {
            label,
            named,
            x,
            v: Vec3::zeros(),
            omega: Vec3::zeros(),
            is_number: false,
            given: [None, None],
            place: None,
        });
        self.connected.push([false; 6]);
        self.list.len() - 1
    }

    /// Makes room for so many nodes more.
    pub fn reserve(&mut self, more: usize) {
        self.list.reserve(more);
        self.connected.reserve(more);
    }

    /// A new node that moves with another one in every direction.
    pub fn add_dependent(&mut self, label: String, x: Vec3, master: usize, place: &Span) -> usize {
        let node = self.add(label, false, x);
        self.attach(node, master, [true; 6], place);
        node
    }

    /// Adds a node whose displacement along x is a number rather than a way in space.
    pub fn add_number(&mut self, label: String, near: usize) -> usize {
        let node = self.add(label, false, self.x(near));
        self.list[node].is_number = true;
        node
    }

    /// Makes a node depend on another one in some directions, which it must not do yet on any.
    pub fn attach(&mut self, node: usize, master: usize, dofs: [bool; 6], place: &Span) {
        self.attachments.insert(node, (self.dependents.len(), place.clone()));
        self.dependents.push(DependentNode { node, master, dofs, place: Some([place.start, place.end]) });
    }

    /// Frees the nodes of the attachments that `frees` says; returns these with their places in the deck.
    pub fn detach(&mut self, frees: impl Fn(&DependentNode) -> bool) -> Vec<(DependentNode, Span)> {
        let (freed, kept): (Vec<_>, Vec<_>) = std::mem::take(&mut self.dependents).into_iter().partition(frees);
        let places = &mut self.attachments;
        let mut place = |link: &DependentNode| places.remove(&link.node).map_or(0..0, |(_, place)| place);
        let freed = freed.into_iter().map(|link| (link.clone(), place(&link))).collect();
        for (index, link) in kept.iter().enumerate() {
            if let Some((known, _)) = places.get_mut(&link.node) {
                *known = index;
            }
        }
        self.dependents = kept;
        freed
    }

    /// Notes that something acts on a node, on its translations or also on its rotations.
    pub fn connect(&mut self, node: usize, rotations: bool) {
        self.connected[node][..3].fill(true);
        if rotations {
            self.connected[node][3..].fill(true);
        }
    }

    /// Gives the motion of a node in a direction, or none for rest. It must not be given yet.
    pub fn restrain(&mut self, node: usize, dof: usize, motion: Option<PrescribedMotion>) {
        self.restraints.insert((node, dof), Restraint { node, dof, motion });
    }

    /// Frees a node in a direction again; returns its motion, where it was restrained.
    pub fn release(&mut self, node: usize, dof: usize) -> Option<Restraint> {
        self.restraints.remove(&(node, dof))
    }

    /// The initial position of a node.
    pub fn x(&self, node: usize) -> Vec3 {
        self.list[node].x
    }

    /// The name of a node.
    pub fn label(&self, node: usize) -> &str {
        &self.list[node].label
    }

    /// The restraint of a node in a direction.
    pub fn restraint(&self, node: usize, dof: usize) -> Option<&Restraint> {
        self.restraints.get(&(node, dof))
    }

    /// All restraints, by node and direction.
    pub fn restraints(&self) -> impl Iterator<Item = &Restraint> {
        self.restraints.values()
    }

    /// True where something acts on a degree of freedom of a node.
    pub fn is_connected(&self, node: usize, dof: usize) -> bool {
        self.connected[node][dof]
    }

    /// True where something acts on the rotations of a node.
    pub fn turns(&self, node: usize) -> bool {
        self.connected[node][3..].contains(&true)
    }

    /// The index of a node in `dependents`, if it depends on another.
    pub fn attachment(&self, node: usize) -> Option<usize> {
        self.attachments.get(&node).map(|(index, _)| *index)
    }

    /// The place in the deck that makes a node depend on another one.
    pub fn attachment_place(&self, node: usize) -> Option<&Span> {
        self.attachments.get(&node).map(|(_, place)| place)
    }

    /// The node that another one depends on, in whatever directions.
    pub fn master(&self, node: usize) -> Option<usize> {
        self.attachment(node).map(|index| self.dependents[index].master)
    }

    /// The node that another one depends on in a direction.
    pub fn master_in(&self, node: usize, dof: usize) -> Option<usize> {
        let dependent = &self.dependents[self.attachment(node)?];
        dependent.dofs[dof].then_some(dependent.master)
    }

    /// The node that a node moves with in every direction, in the end.
    pub fn carrier(&self, mut node: usize) -> usize {
        while let Some(index) = self.attachment(node)
            && self.dependents[index].dofs == [true; 6]
        {
            node = self.dependents[index].master;
        }
        node
    }

    /// The node that a node depends on, in whatever directions, in the end. A deck may attach nodes in a circle, so the steps
    /// are counted.
    pub fn root(&self, mut node: usize) -> usize {
        for _ in 0..self.list.len() {
            let Some(master) = self.master(node) else { break };
            node = master;
        }
        node
    }
}

/// The nodes after all parts, links, joints and attachments, so that unconnected ones can be detected.
pub struct Topology {
    nodes: Nodes,
    /// True if all connecting tables could be read: an unconnected node then is a separate error.
    complete: bool,
    /// Ends of links and joints of other stages.
    pub ends_elsewhere: HashSet<usize>,
    /// Nodes attached to bodies for contacts, by their labels.
    touching: HashMap<String, usize>,
}

impl Topology {
    /// The nodes once all tables that connect them have been read.
    pub fn new(nodes: Nodes, report: &Report) -> Self {
        let complete = report.connections_known();
        Topology { nodes, complete, ends_elsewhere: HashSet::new(), touching: HashMap::new() }
    }

    /// The node attached to a body for contacts; its label names the body and the place.
    pub fn touching_node(&mut self, label: String, x: Vec3, body: usize, place: &Span) -> usize {
        let known = self.touching.entry(label.clone());
        *known.or_insert_with(|| self.nodes.add_dependent(label, x, body, place))
    }

    /// True if all connecting tables could be read.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// True where a load or a motion of a node in this direction has something to act on.
    pub fn is_taken(&self, node: usize, dof: usize) -> bool {
        self.is_connected(node, dof) || self.master_in(node, dof).is_some()
    }

    /// Reports a point without any connection, under the action `what`.
    pub fn is_loose(&self, spot: &Spot, what: &str, report: &mut Report) -> bool {
        let loose = (0..6).all(|dof| !self.is_taken(spot.node, dof));
        if loose && self.complete {
            let message = format!("nothing is connected to `{}`, so {what} acts on nothing", spot.name);
            let hint = match self.ends_elsewhere.contains(&spot.node) {
                true => "links and joints of other stages end there: `stages` beside it can name theirs",
                false => "connect a beam, bar, shell, link, mass or body to it",
            };
            report.error_with::<()>(spot.span, message, hint);
        }
        loose
    }

    /// The spots without nodes of sets that belong to no part, if the set has others. A group of the mesh may cover faces outside all parts. A
    /// note counts them.
    pub fn without_loose<'d>(&self, spots: Vec<Spot<'d>>, what: &str, report: &mut Report) -> Vec<Spot<'d>> {
        let is_loose = |spot: &Spot| self.complete && (0..6).all(|dof| !self.is_taken(spot.node, dof));
        let mut kept = Vec::with_capacity(spots.len());
        for of in spots.chunk_by(|a, b| a.span == b.span) {
            let loose = of.iter().filter(|spot| is_loose(spot)).count();
            if loose == 0 || loose == of.len() {
                kept.extend(of.iter().copied());
                continue;
            }
            kept.extend(of.iter().filter(|spot| !is_loose(spot)).copied());
            let message = format!("{loose} of the {} nodes here belong to no part, and {what} ignores them", of.len());
            report.note(of[0].span, message, "make a part of their elements, or name a smaller set");
        }
        kept
    }

    /// Node list, attachments and restraints, for the model.
    pub fn into_parts(self) -> (Vec<Node>, Vec<DependentNode>, Vec<Restraint>) {
        let Nodes { list, dependents, restraints, .. } = self.nodes;
        (list, dependents, restraints.into_values().collect())
    }
}

impl Deref for Topology {
    type Target = Nodes;

    fn deref(&self) -> &Nodes {
        &self.nodes
    }
}

impl DerefMut for Topology {
    fn deref_mut(&mut self) -> &mut Nodes {
        &mut self.nodes
    }
}
