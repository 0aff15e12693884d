//! Deck → model, all errors together. This file holds the order of work and what every part of it uses: needed keys,
//! sensible numbers, names. Each part goes on after an error with what is sound, so that one mistake hides no other.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::ops::Range;

use super::meshes::{Input, Meshed};
use super::places::Place;
use super::rigid::RigidParts;
use super::{AnalysisKind, Cadence, Damping, Gyroscopic, Iteration, Method, Model, Node, Output, StepLength, Update};
use crate::deck::Deck;
use crate::deck::read::ROOT;
use crate::deck::words::{Maybe, Named, Vector};
use crate::diagnostic::{At, Diagnostic, Source, Span};
use crate::integrators::{RotationUpdate, Scheme, WilsonTheta};
use crate::materials::Law;
use crate::math::Vec3;
use crate::names::{nearest, quoted};

/// Reads a deck and builds its model; everything there is to say about it, in the order of the deck.
pub fn read(source: &Source) -> (Option<Model>, Vec<Diagnostic>) {
    let (deck, mut problems) = crate::deck::read(source);
    let folder = std::path::Path::new(&source.path).parent().unwrap_or(std::path::Path::new(""));
    let (input, said) = deck.as_ref().map_or((None, Vec::new()), |deck| Input::load(deck, folder));
    let (model, more) = deck.as_ref().map_or((None, Vec::new()), |deck| build(deck, input.as_ref()));
    let model = model.filter(|_| !said.iter().any(Diagnostic::is_error));
    problems.extend(said);
    let model = model.filter(|_| !problems.iter().any(Diagnostic::is_error));
    problems.extend(more);
    problems.sort_by_key(|problem| problem.place.as_ref().map_or(usize::MAX, |place| place.start));
    (model, problems)
}

/// The model the deck describes, with the mesh it names, and everything there is to say about it. `None` if any of that is an
/// error.
pub fn build(deck: &Deck, input: Option<&Input>) -> (Option<Model>, Vec<Diagnostic>) {
    let mut b = Builder::new(deck, input);
    b.analysis();
    b.points();
    b.bodies();
    b.mesh_nodes();
    b.register_names();
    b.amplitudes();
    b.materials();
    b.beams();
    b.bars();
    b.shells();
    b.rigid_bodies();
    b.masses();
    b.links();
    b.joints();
    b.attachments();
    b.touch_points();
    b.environment();
    b.sure = !b.unsure;
    b.supports();
    b.contacts();
    b.loads();
    b.damping();
    b.initial();
    b.control();
    b.expects();
    b.output();
    b.study();
    b.check();
    b.place_nodes();
    b.drop_unused();
    let sound = !b.problems.iter().any(Diagnostic::is_error);
    (sound.then_some(b.model), super::fold::fold(b.problems))
}

/// Elements of all beams, bars and patches together: more, at some kilobytes each, are a slip of the keyboard.
const MOST_ELEMENTS: usize = 2_000_000;

/// A model in the making.
pub(super) struct Builder<'d> {
    pub deck: &'d Deck,
    pub model: Model,
    pub problems: Vec<Diagnostic>,
    pub input: Option<&'d Input>,
    /// Parts and sets from the mesh.
    pub meshed: Meshed<'d>,
    /// Parts that are rigid.
    pub rigid: RigidParts<'d>,
    /// The places in `model.parts` of each beam, bar and shell of the deck, none where it has errors.
    pub beam_parts: Vec<Range<usize>>,
    pub bar_parts: Vec<Range<usize>>,
    pub shell_parts: Vec<Range<usize>>,
    /// All nodes that are left go to nodes.csv.
    pub writes_all: bool,
    /// What the names of points, bodies, sets, beams, bars, shells and links stand for.
    pub places: HashMap<&'d str, (Place, &'d Span)>,
    /// Per node: directions in which an element, a mass, a body or a link acts on it.
    pub acts: Vec<[bool; 6]>,
    /// Per node: its entry in `model.riders` and the place in the deck that made it ride.
    pub rides: HashMap<usize, (usize, Span)>,
    /// Nodes of each beam and bar, in order along it.
    pub beam_nodes: Vec<Vec<usize>>,
    pub bar_nodes: Vec<Vec<usize>>,
    /// Nodes of each shell, and of each of its edges in order along it.
    pub shell_nodes: Vec<Vec<usize>>,
    pub shell_edges: Vec<Vec<Vec<usize>>>,
    /// Of all beams, bars and patches so far.
    elements: usize,
    /// Edges of all shells so far, each once.
    pub edges: Vec<super::shells::Edge>,
    /// By material: how it yields.
    pub laws: Vec<Option<Law>>,
    /// Section, material and whether it needs a mass → `model.stiffnesses`.
    pub stiffnesses: HashMap<(usize, Option<usize>, bool), Option<usize>>,
    /// Directions held, by node and direction; who holds them, and whether they move.
    pub held: BTreeMap<(usize, usize), (super::Held, Span)>,
    /// Per node that rides and is supported: the point that holds it.
    pub ghosts: HashMap<usize, usize>,
    /// A part names something unknown, so what is connected to what is not known either.
    pub unsure: bool,
    /// Not so when all parts were read: a point that nothing touches is an error of its own.
    pub sure: bool,
    /// Materials, sections and amplitudes that something names.
    pub used: HashSet<(&'static str, usize)>,
}

/// A table of the deck, for messages: "beam `portal`".
pub(super) struct Owner<'d> {
    pub what: String,
    pub span: &'d Span,
}

impl<'d> Builder<'d> {
    fn new(deck: &'d Deck, input: Option<&'d Input>) -> Self {
        let model = Model {
            title: deck.title.as_ref().map(|title| title.value.clone()).unwrap_or_default(),
            units: deck.units.as_ref().map(|units| units.label().to_owned()),
            analysis: super::Analysis {
                kind: AnalysisKind::Dynamic,
                end_time: 0.0,
                step_length: StepLength::Fixed { step: 0.0 },
                least_step: 0.0,
                plane: true,
            },
            scheme: Scheme::WilsonTheta(WilsonTheta { theta: 1.4, rotation: RotationUpdate::Exponential }),
            iteration: Iteration {
                method: Method::Auto,
                update: Update::Auto,
                gyroscopic: Gyroscopic::Auto,
                tolerance: 1e-8,
                limit: 20,
            },
            nodes: Vec::new(),
            bodies: Vec::new(),
            masses: Vec::new(),
            stiffnesses: Vec::new(),
            parts: Vec::new(),
            riders: Vec::new(),
            joints: Vec::new(),
            held: Vec::new(),
            amplitudes: Vec::new(),
            loads: Vec::new(),
            pressures: Vec::new(),
            gravity: Vec3::zeros(),
            base_accelerations: Vec::new(),
            damping: Damping::default(),
            expects: Vec::new(),
            rigid: Vec::new(),
            mesh: None,
            output: Output {
                nodes: Vec::new(),
                cadence: Cadence::Steps(1),
                energy: true,
                links: false,
                contacts: false,
                reactions: false,
                sections: false,
                layers: false,
                parts: false,
                fields: None,
            },
            study: None,
        };
        Builder {
            deck,
            model,
            input,
            meshed: Meshed::new(deck, input),
            rigid: RigidParts::default(),
            beam_parts: Vec::new(),
            bar_parts: Vec::new(),
            shell_parts: Vec::new(),
            writes_all: false,
            problems: Vec::new(),
            places: HashMap::new(),
            acts: Vec::new(),
            rides: HashMap::new(),
            beam_nodes: Vec::new(),
            bar_nodes: Vec::new(),
            shell_nodes: Vec::new(),
            shell_edges: Vec::new(),
            elements: 0,
            edges: Vec::new(),
            laws: Vec::new(),
            stiffnesses: HashMap::new(),
            held: BTreeMap::new(),
            ghosts: HashMap::new(),
            unsure: deck.spoiled.iter().any(|entry| entry.table.as_ref().is_none_or(|table| *table == ROOT)),
            sure: true,
            used: HashSet::new(),
        }
    }

    /// Reports an error; the answer is `None`, so that `return self.error(…)` leaves a part that cannot go on.
    pub fn error<T>(&mut self, place: &Span, message: impl Into<String>) -> Option<T> {
        self.problems.push(Diagnostic::error(message).at(place));
        None
    }

    /// [`Builder::error`] with a hint at the caret.
    pub fn error_with<T>(&mut self, place: &Span, message: impl Into<String>, hint: impl Into<String>) -> Option<T> {
        self.problems.push(Diagnostic::error(message).at(place).hint(hint));
        None
    }

    pub fn warn(&mut self, place: &Span, message: impl Into<String>, hint: impl Into<String>) {
        self.problems.push(Diagnostic::warning(message).at(place).hint(hint));
    }

    /// The value of a key that must be there.
    pub fn need<T>(&mut self, owner: &Owner, key: &str, value: &'d Maybe<T>) -> Option<&'d At<T>> {
        self.unsure |=
            value.is_none() && ["path", "corners", "group", "at", "nodes", "from", "to", "with"].contains(&key);
        if value.is_none() && !self.is_spoiled(owner.span, key) {
            self.error::<()>(owner.span, format!("{} needs `{key}`", owner.what));
        }
        value.as_ref()
    }

    /// Whether a key is written, but so that it could not be read: that has been reported.
    pub fn is_spoiled(&self, table: &Span, key: &str) -> bool {
        let here = |entry: &Option<Span>| entry.as_ref().is_none_or(|span| span == table);
        self.deck.spoiled.iter().any(|entry| entry.key == key && here(&entry.table))
    }

    /// A number above zero, if it is there.
    pub fn positive(&mut self, key: &str, value: &Maybe<f64>) -> Option<f64> {
        let value = value.as_ref()?;
        if value.value > 0.0 {
            Some(value.value)
        } else {
            self.error(&value.span, format!("`{key}` must be above zero"))
        }
    }

    pub fn need_positive(&mut self, owner: &Owner, key: &str, value: &'d Maybe<f64>) -> Option<f64> {
        self.need(owner, key, value)?;
        self.positive(key, value)
    }

    /// A number of zero or more; `default` if it is not there.
    pub fn not_negative(&mut self, key: &str, value: &Maybe<f64>, default: f64) -> f64 {
        match value {
            Some(value) if value.value < 0.0 => {
                self.error::<()>(&value.span, format!("`{key}` must not be negative"));
                default
            }
            Some(value) => value.value,
            None => default,
        }
    }

    /// A whole number of at least one.
    pub fn count(&mut self, key: &str, value: &Maybe<u64>, default: usize) -> usize {
        match value {
            Some(value) if value.value == 0 => {
                self.error::<()>(&value.span, format!("`{key}` must be at least 1"));
                default
            }
            Some(value) => usize::try_from(value.value).unwrap_or(usize::MAX),
            None => default,
        }
    }

    /// The unit vector along a direction, which must not be zero.
    pub fn unit(&mut self, key: &str, value: &At<Vector>) -> Option<Vec3> {
        // Scaled first: the square of a large component may overflow, that of a small one vanish.
        let v = vec3(value);
        let unit = v.try_normalize(0.0).or_else(|| (v / v.amax()).try_normalize(0.0)).filter(|u| u.amax().is_finite());
        unit.or_else(|| self.error(&value.span, format!("`{key}` must not be zero")))
    }

    /// Keys that mean nothing here, of those given by name and place.
    pub fn stray(&mut self, what: &str, keys: &[(&str, Option<&Span>)]) {
        for (key, place) in keys {
            if let Some(place) = place {
                self.error::<()>(place, format!("`{key}` means nothing for {what}"));
            }
        }
    }

    /// The entry of a named table, by name; `what` is one of them, in singular.
    pub fn find<T>(
        &mut self,
        what: &'static str,
        table: &'d Named<T>,
        name: &At<String>,
    ) -> Option<(usize, &'d At<T>)> {
        if let Some(index) = table.position(name) {
            self.used.insert((what, index));
            return Some((index, &table.0[index].1));
        }
        self.unknown(what, name, table.names())
    }

    /// Reports a name that stands for nothing.
    pub fn unknown<'n, T>(
        &mut self,
        what: &str,
        name: &At<String>,
        known: impl Iterator<Item = &'n str> + Clone,
    ) -> Option<T> {
        self.unsure |= what.starts_with("point") || what == "body";
        // It may be a group of a mesh that could not be read.
        if self.meshed.lost && what.starts_with("point") {
            return None;
        }
        // It may be there, but too wrong to be read.
        if self.deck.spoiled.iter().any(|entry| entry.key == name.value) {
            return None;
        }
        let message = format!("no {what} is named `{}`", name.value);
        match nearest(name, known.clone()) {
            Some(near) => self.error_with(&name.span, message, format!("did you mean `{near}`?")),
            None if known.clone().next().is_none() => self.error_with(&name.span, message, "the deck has none"),
            None if known.clone().count() <= 8 => {
                self.error_with(&name.span, message, format!("known: {}", quoted(known)))
            }
            None => self.error(&name.span, message),
        }
    }

    /// Counts elements that paths and patches are to be cut into, before they take memory: together more than
    /// [`MOST_ELEMENTS`] are an error.
    pub fn made(&mut self, elements: usize, place: &Span) -> Option<()> {
        let before = self.elements;
        self.elements = before.saturating_add(elements);
        if self.elements <= MOST_ELEMENTS {
            return Some(());
        }
        // Once: what comes after is too many as well.
        if before <= MOST_ELEMENTS {
            let message = format!("with this the deck has {} elements", self.elements);
            let hint = format!("at most {MOST_ELEMENTS} of all beams, bars and patches are taken to be meant");
            self.error_with::<()>(place, message, hint);
        }
        None
    }

    pub fn amplitude(&mut self, name: &At<String>) -> Option<usize> {
        self.find("amplitude", &self.deck.amplitudes, name).map(|(index, _)| index)
    }

    /// A new node at rest.
    pub fn node(&mut self, label: String, named: bool, x: Vec3) -> usize {
        self.model.nodes.push(Node { label, named, x, v: Vec3::zeros(), omega: Vec3::zeros(), place: None });
        self.acts.push([false; 6]);
        self.model.nodes.len() - 1
    }

    /// Something acts on a node, on its translations or also on its rotations.
    pub fn touch(&mut self, node: usize, rotations: bool) {
        self.acts[node][..3].fill(true);
        if rotations {
            self.acts[node][3..].fill(true);
        }
    }

    /// A new node that moves with another one in every way.
    pub fn rider(&mut self, label: String, x: Vec3, master: usize, place: &Span) -> usize {
        let node = self.node(label, false, x);
        self.rides.insert(node, (self.model.riders.len(), place.clone()));
        self.model.riders.push(super::Rider { node, master, dofs: [true; 6], place: Some([place.start, place.end]) });
        node
    }
}

pub(super) fn vec3(value: &Vector) -> Vec3 {
    Vec3::from(value.0)
}

pub(super) fn vec3_or_zero(value: &Maybe<Vector>) -> Vec3 {
    value.as_ref().map_or_else(Vec3::zeros, |value| vec3(value))
}

/// The word of a key that takes one of a few, or its default.
pub(super) fn chosen<T: Copy + Default>(value: &Maybe<T>) -> T {
    value.as_ref().map_or_else(T::default, |value| value.value)
}

pub(super) fn span<T>(value: &Maybe<T>) -> Option<&Span> {
    value.as_ref().map(|value| &value.span)
}
