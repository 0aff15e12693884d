//! `[[attachments]]`: points and bodies that move with a body, nodes that move with a beam.

use super::build::{Builder, Owner};
use super::places::{Place, Reach, Spot};
use super::{DIRECTIONS, PartType, Rider};
use crate::deck::attachments::AttachmentMethod;
use crate::deck::beams::Beam;
use crate::diagnostic::{At, Diagnostic};
use crate::math::Vec3;
use crate::names::short;
use std::collections::{HashMap, HashSet};

impl<'d> Builder<'d> {
    pub fn attachments(&mut self) {
        for attachment in &self.deck.attachments {
            let owner = Owner { what: "`[[attachments]]`".to_owned(), span: &attachment.span };
            if let (Some(name), Some(_)) = (&attachment.beam, &attachment.body) {
                self.error::<()>(&name.span, "nodes are attached to a `body` or to a `beam`, not to both");
            }
            // The word that makes a beam rigid is enough: what is attached to it then goes with its body.
            let rigid = attachment.beam.as_ref().and_then(|name| self.rigid_beam(name));
            let beam = attachment.beam.as_ref().filter(|_| rigid.is_none()).map(|name| (name, self.beam_of(name)));
            let body = match beam {
                Some(_) => None,
                None if rigid.is_some() => rigid,
                None if self.is_spoiled(owner.span, "beam") => None,
                None => self.need(&owner, "body", &attachment.body).and_then(|name| self.body(name)),
            };
            let spots = self.spots(&owner, "nodes", &attachment.nodes, Reach::Nodes);
            if self.is_spoiled(owner.span, "dofs") {
                continue;
            }
            let dofs = attachment.dofs.as_ref().map_or([true; 6], |dofs| dofs.0);
            if dofs == [false; 6]
                && let Some(at) = &attachment.dofs
            {
                self.error::<()>(&at.span, "`dofs` is empty, so nothing is attached");
            }
            let method = attachment.method.as_ref().map(|method| method.value);
            if let Some((name, Some(beam))) = beam {
                self.tie(name, beam, &spots, dofs, method);
            }
            let Some(body) = body else { continue };
            let master = self.model.bodies[body].node;
            let body = self.model.bodies[body].name.clone();
            for spot in spots {
                if spot.node == master {
                    let message = format!("body `{body}` is attached to itself");
                    let hint = if spot.direct { "leave it out" } else { "it is a member of this set" };
                    self.error_with::<()>(spot.span, message, hint);
                } else {
                    self.attach(&spot, master, &body, dofs, method);
                }
            }
        }
        self.cycles();
    }

    /// By elimination what rides on nothing yet, by multipliers the rest, unless the deck says which.
    fn attach(&mut self, spot: &Spot, master: usize, to: &str, dofs: [bool; 6], method: Option<AttachmentMethod>) {
        let first = self.rides.get(&spot.node).map(|(rider, _)| self.model.riders[*rider].master);
        if first == Some(master) {
            self.error_with::<()>(spot.span, format!("`{}` is attached to `{to}` twice", spot.name), "once is enough");
        } else if method == Some(AttachmentMethod::Multipliers)
            || first.is_some() && method != Some(AttachmentMethod::Elimination)
        {
            self.join(spot, master, to, dofs);
        } else if let Some(first) = first {
            let first = &self.model.nodes[first].label;
            let message = format!("`{}` is attached to `{first}`, so it cannot be eliminated again", spot.name);
            self.error_with::<()>(spot.span, message, "leave out `method`, or write \"multipliers\"");
        } else {
            self.rides.insert(spot.node, (self.model.riders.len(), spot.span.clone()));
            let place = Some([spot.span.start, spot.span.end]);
            self.model.riders.push(Rider { node: spot.node, master, dofs, place });
        }
    }

    /// Index of the body of a beam with `rigid = true`.
    fn rigid_beam(&self, name: &At<String>) -> Option<usize> {
        let is = |beam: &Beam| beam.name.as_ref().or(beam.group.as_ref()).is_some_and(|own| own.value == name.value);
        match self.place(name) {
            Some(Place::Body(body)) if self.deck.beams.iter().any(|beam| is(beam)) => Some(body),
            _ => None,
        }
    }

    /// Index of a beam by name.
    fn beam_of(&mut self, name: &'d At<String>) -> Option<usize> {
        match self.place(name) {
            Some(Place::Beam(beam)) => Some(beam),
            Some(place) => self.error(&name.span, format!("`{}` is {}, not a beam", name.value, place.kind())),
            None => {
                let names = self.deck.beams.iter().filter_map(|beam| beam.name.as_ref().or(beam.group.as_ref()));
                self.unknown("beam", name, names.map(|name| name.as_str()))
            }
        }
    }

    /// Each node onto the nearest node of a beam; the beam's own stay.
    fn tie(
        &mut self,
        name: &At<String>,
        beam: usize,
        spots: &[Spot<'d>],
        dofs: [bool; 6],
        method: Option<AttachmentMethod>,
    ) {
        let own: HashSet<usize> = self.beam_nodes[beam].iter().copied().collect();
        // Along the axis in which the beam is longest, so that a search may stop where nothing nearer can come.
        let (low, high) = own.iter().fold((Vec3::repeat(f64::MAX), Vec3::repeat(f64::MIN)), |(low, high), &node| {
            (low.inf(&self.x(node)), high.sup(&self.x(node)))
        });
        let axis = (high - low).imax();
        let mut line: Vec<(f64, usize)> = own.iter().map(|&node| (self.x(node)[axis], node)).collect();
        line.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        // Direction and length of an element at each node.
        let mut spans: HashMap<usize, Vec3> = HashMap::new();
        for part in self.model.parts[self.beam_parts[beam].clone()].iter().filter_map(super::Beam::of) {
            for e in &part.elements {
                let span = self.x(e.nodes[part.order]) - self.x(e.nodes[0]);
                e.nodes[..=part.order].iter().for_each(|&node| {
                    spans.insert(node, span);
                });
            }
        }
        let (mut far, mut farthest, mut between) = (0, 0.0f64, Vec::new());
        for spot in spots.iter().filter(|spot| !own.contains(&spot.node)) {
            let x = self.x(spot.node);
            let Some((master, second)) = nearest_two(&line, axis, &x, |node| (self.x(node) - x).norm()) else {
                continue;
            };
            let distance = (self.x(master) - x).norm();
            if let Some(other) = second.filter(|&other| (self.x(other) - x).norm() <= distance * (1.0 + SAME)) {
                between.push((spot, [spot.node, master, other]));
                continue;
            }
            if let Some(span) = spans.get(&master) {
                let along = (x - self.x(master)).dot(span).abs() / span.norm_squared();
                far += usize::from(along > 0.5 + SAME);
                farthest = farthest.max(along);
            }
            self.attach(spot, master, &self.model.nodes[master].label.clone(), dofs, method);
        }
        // Of each name in the list the first node, and how many others.
        for of in between.chunk_by(|a, b| a.0.span == b.0.span) {
            let (spot, nodes) = &of[0];
            let [node, a, b] = nodes.map(|node| self.model.nodes[node].label.clone());
            let message = format!("`{node}` is as near to `{a}` as to `{b}` of beam `{}`", name.value);
            let error = Diagnostic::error(message).at(spot.span);
            let error = error.hint("the meshes must match: each node needs its own on the beam");
            self.problems.push(match of.len() {
                1 => error,
                count => error.hint(format!("the same goes for {} more nodes", count - 1)),
            });
        }
        if far > 0 {
            let message = format!("nodes reach beyond beam `{}` by more than half an element: {far}", name.value);
            self.warn(&name.span, message, format!("the farthest by {} elements", short(farthest)));
        }
    }

    /// Reports riders that, from master to master, ride on themselves.
    fn cycles(&mut self) {
        let mut known = vec![false; self.model.nodes.len()];
        for start in 0..self.model.riders.len() {
            let (mut chain, mut node) = (Vec::new(), self.model.riders[start].node);
            while let Some((rider, place)) = self.rides.get(&node)
                && !known[node]
            {
                known[node] = true;
                chain.push(node);
                node = self.model.riders[*rider].master;
                let Some(begin) = chain.iter().position(|&earlier| earlier == node) else { continue };
                let names: Vec<String> =
                    chain[begin..].iter().chain([&node]).map(|&n| format!("`{}`", self.model.nodes[n].label)).collect();
                let message = format!("these attachments go round in a circle: {}", names.join(" on "));
                let diagnostic = Diagnostic::error(message).at(place);
                self.problems.push(diagnostic.hint("one of them must not be attached"));
                break;
            }
        }
    }

    /// The node that another one rides on in a direction.
    pub fn master(&self, node: usize, dof: usize) -> Option<usize> {
        let (rider, _) = self.rides.get(&node)?;
        let rider = &self.model.riders[*rider];
        rider.dofs[dof].then_some(rider.master)
    }

    /// Whether anything takes a load or a motion of a node in a direction.
    pub fn is_taken(&self, node: usize, dof: usize) -> bool {
        self.acts[node][dof] || self.master(node, dof).is_some()
    }

    /// Reports a point on which nothing acts at all, `what` being done to it.
    pub fn is_loose(&mut self, spot: &super::places::Spot, what: &str) -> bool {
        let loose = (0..6).all(|dof| !self.is_taken(spot.node, dof));
        if loose && self.sure {
            let message = format!("nothing is connected to `{}`, so {what} acts on nothing", spot.name);
            self.error_with::<()>(spot.span, message, "no beam, bar, link, mass or body");
        }
        loose
    }
}

/// Distances that agree to this part are the same but for rounding.
const SAME: f64 = 1e-9;

/// The two nodes nearest to x of a line sorted along an axis, by their distance; the first of equals.
fn nearest_two(
    line: &[(f64, usize)],
    axis: usize,
    x: &Vec3,
    distance: impl Fn(usize) -> f64,
) -> Option<(usize, Option<usize>)> {
    let start = line.partition_point(|entry| entry.0 < x[axis]);
    let (mut below, mut above) = (line[..start].iter().rev().peekable(), line[start..].iter().peekable());
    let mut best: Vec<(f64, usize)> = Vec::with_capacity(3);
    loop {
        let gap = |entry: Option<&&(f64, usize)>| entry.map_or(f64::INFINITY, |entry| (entry.0 - x[axis]).abs());
        let (down, up) = (gap(below.peek()), gap(above.peek()));
        // Equal distances count, so a node just as near along the axis is still looked at.
        if best.len() == 2 && down.min(up) > best[1].0 {
            break;
        }
        let Some(&(_, node)) = (if down <= up { below.next() } else { above.next() }) else { break };
        best.push((distance(node), node));
        best.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        best.truncate(2);
    }
    best.first().map(|first| (first.1, best.get(1).map(|second| second.1)))
}

/// "ux, uy and rz".
pub(super) fn directions(dofs: impl IntoIterator<Item = usize>) -> String {
    let words: Vec<&str> = dofs.into_iter().map(|dof| DIRECTIONS[dof]).collect();
    crate::names::joined(&words)
}
