//! The context of tables acting on the model: names, bodies and parts, all final. Lists of names become nodes here.

use std::collections::{HashMap, HashSet};

use super::data::{Analysis, Body, History};
use super::group_names::GroupChoice;
use super::names::Names;
use super::parts::Parts;
use super::places::place::Place;
use super::places::spot::{Label, Spot};
use super::report::{Owner, Report};
use super::stages::CurrentStage;
use base::diagnostic::At;
use deck::Deck;
use deck::words::Maybe;
use deck::words::Names as List;

/// All named things: the model without connections and loads.
pub(super) struct Scene<'d> {
    /// The deck.
    pub deck: &'d Deck,
    /// The stage of this deck; `None` for a deck without stages.
    pub stage: Option<CurrentStage<'d>>,
    /// The analysis, on whose times loads and outputs depend.
    pub analysis: Analysis,
    /// The names of points, bodies, sets and groups.
    pub names: Names<'d>,
    /// The rigid bodies.
    pub bodies: Vec<Body>,
    /// The deformable parts.
    pub parts: Parts,
    /// Index of the spline for each table of positions or velocities, by the index of the table's amplitude.
    pub motion_curves: HashMap<usize, usize>,
}

/// The kinds of names that a list may hold besides points, bodies and sets.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// A list of points, bodies and sets alone: each node gets the whole load or mass, and a beam would multiply it. (Shells are lists of
    /// nodes like sets: their inner ones have no other name.)
    Nodes,
    /// A list that may hold beams and bars too.
    Parts,
}

impl<'d> Scene<'d> {
    /// The amplitude of a motion by this quantity, for the amplitude named in the deck.
    pub fn amplitude_of_motion(&self, index: usize, history: History) -> usize {
        match history {
            History::Displacement | History::Velocity => self.motion_curves.get(&index).copied().unwrap_or(index),
            History::Acceleration => index,
        }
    }

    /// The nodes that a place covers, some of them perhaps more than once.
    pub fn nodes_of(&self, place: Place) -> Vec<usize> {
        self.names.nodes_of(place, &self.parts)
    }

    /// The place for a name. A set or group of one node means that node.
    pub fn place_or_node(&self, name: &str) -> Option<Place> {
        self.names.place_or_node(name, &self.parts)
    }

    /// All nodes that a list of names covers, each once, in the order of the list.
    pub fn spots(
        &self,
        owner: &Owner,
        key: &str,
        list: &'d Maybe<List>,
        reach: Reach,
        report: &mut Report<'d>,
    ) -> Vec<Spot<'d>> {
        let Some(list) = report.require_nodes(owner, key, list) else { return Vec::new() };
        if list.values.is_empty() {
            report.error::<()>(&list.span, format!("`{key}` is empty"));
        }
        self.spots_of(key, &list.values, reach, report)
    }

    /// All nodes that these names cover, each once, in the order of the names.
    pub fn spots_of(
        &self,
        key: &str,
        names: impl IntoIterator<Item = &'d At<String>>,
        reach: Reach,
        report: &mut Report<'d>,
    ) -> Vec<Spot<'d>> {
        let mut spots = Vec::new();
        let mut seen = HashSet::new();
        for name in names {
            let place = match reach {
                Reach::Nodes => self.names.find_nodes(name, report),
                Reach::Parts => self.names.find_in_parts(name, report),
            };
            let Some(place) = place else { continue };
            if self.names.is_part(place) && (reach == Reach::Nodes || !place.has_nodes()) {
                let taken = if reach == Reach::Nodes { "bodies or sets" } else { "bodies, parts or sets" };
                let message = format!("`{key}` takes points, {taken}, and `{}` is {}", name.value, place.kind());
                let hint = match place.has_nodes() {
                    true => "name the points that are meant, or a set of the part: each of its nodes gets the whole",
                    false => "name the points that are meant",
                };
                report.error_with::<()>(&name.span, message, hint);
                continue;
            }
            let direct = matches!(place, Place::Point(_) | Place::Body(_));
            let nodes = self.nodes_of(place);
            if nodes.is_empty() {
                self.report_empty(place, name, report);
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

    /// Reports a set or group without nodes, unless an error of its members is already reported.
    pub fn report_empty(&self, place: Place, name: &At<String>, report: &mut Report<'d>) {
        let members = match place {
            // This has been said.
            Place::Group(group) if group.nodes == GroupChoice::Many => return,
            Place::Group(_) => {
                let hint = "its elements are of unsupported types, or it has none";
                report.error_with::<()>(&name.span, format!("the group `{}` has no nodes", name.value), hint);
                return;
            }
            Place::Set(set) => &self.deck.sets.0[set].1.values,
            _ => return,
        };
        let has_none = |leaf: &Place| matches!(leaf, Place::Group(_)) || !leaf.has_nodes();
        if members.is_empty() {
            report.error::<()>(&name.span, format!("the set `{}` is empty", name.value));
        } else if report.connections_known() && self.names.leaves(place).iter().all(has_none) {
            report.error::<()>(&name.span, format!("the set `{}` has no nodes", name.value));
        }
    }

    /// The name in the deck of a node from a set or a part.
    pub fn label(&self, node: usize, part: &'d At<String>) -> Label<'d> {
        let point = self.deck.points.0.get(node).map(|(name, _)| name);
        let body = || self.deck.bodies.get(node.checked_sub(self.deck.points.0.len())?)?.name.as_ref();
        if let Some(name) = point.or_else(body) {
            return Label::Name(name);
        }
        self.names.mesh.id(node).map_or(Label::Name(part), Label::Mesh)
    }
}
