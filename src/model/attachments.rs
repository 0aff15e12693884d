//! `[[attachments]]`: points and bodies that move with a body.

use super::build::{Builder, Owner};
use super::places::Reach;
use super::{DIRECTIONS, Rider};
use crate::diagnostic::Diagnostic;

impl<'d> Builder<'d> {
    pub fn attachments(&mut self) {
        for attachment in &self.deck.attachments {
            let owner = Owner { what: "`[[attachments]]`".to_owned(), span: &attachment.span };
            let body = self.need(&owner, "body", &attachment.body).and_then(|name| self.body(name));
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
            let Some(body) = body else { continue };
            let master = self.model.bodies[body].node;
            let body = self.model.bodies[body].name.clone();
            for spot in spots {
                if spot.node == master {
                    let message = format!("body `{body}` is attached to itself");
                    let hint = if spot.direct { "leave it out" } else { "it is a member of this set" };
                    self.error_with::<()>(spot.span, message, hint);
                } else if let Some((rider, _)) = self.rides.get(&spot.node) {
                    let first = self.model.riders[*rider].master;
                    let first = self.model.nodes[first].label.clone();
                    let message = format!("`{}` is attached twice: to `{first}` and to `{body}`", spot.name);
                    let hint = "that would need multipliers, which this version does not have";
                    let way = "a bushing link with a stiff frame can join the two bodies";
                    self.problems.push(Diagnostic::error(message).at(spot.span).hint(hint).hint(way));
                } else {
                    self.rides.insert(spot.node, (self.model.riders.len(), spot.span.clone()));
                    self.model.riders.push(Rider { node: spot.node, master, dofs });
                }
            }
        }
        self.cycles();
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

/// "ux, uy and rz".
pub(super) fn directions(dofs: impl IntoIterator<Item = usize>) -> String {
    let words: Vec<&str> = dofs.into_iter().map(|dof| DIRECTIONS[dof]).collect();
    crate::names::joined(&words)
}
