//! Contacts: points against a surface.

use super::part_answers::PartAnswers;
use crate::elements::contact::{ContactLaw, ContactPoint, Surface, Toucher, TouchingBox};
use crate::quantities::{CONTACT, CONTACT_FORCE, Column};
use std::collections::BTreeSet;

/// Points against a surface.
#[derive(Debug, Clone)]
pub struct Contact {
    /// The deck's name.
    pub name: String,
    /// The node that carries the surface: a body's, or a restrained one for the ground.
    pub node: usize,
    /// The surface, in the frame of that node.
    pub surface: Surface,
    /// The points.
    pub points: Vec<ContactPoint>,
    /// Boxes that touch the surface, which is a box then, with their corners, edges and faces.
    pub boxes: Vec<TouchingBox>,
    /// The shapes of all that touches, by which `check` says what is not seen.
    pub touchers: BTreeSet<Toucher>,
    /// The contact law; `None` for a clearance monitor, which exerts no force.
    pub law: Option<ContactLaw>,
    /// The smallest dimension of bodies that touch and of what is touched, by which depths are judged.
    pub size: f64,
    /// By what the stiffness was chosen, where the deck leaves it to the program.
    pub chosen: Option<String>,
}

impl Contact {
    /// The node that carries the surface with each node of the points, one pair after the other.
    pub fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        self.points.iter().flat_map(|point| point.nodes()).map(|&node| [self.node, node])
    }
}

impl PartAnswers for Contact {
    const QUANTITIES: &'static [&'static [Column]] = &[&CONTACT, &[CONTACT_FORCE]];

    fn name(&self) -> &str {
        &self.name
    }

    fn elements(&self) -> usize {
        self.points.len() + self.boxes.len()
    }

    fn nodes(&self, element: usize) -> &[usize] {
        match element.checked_sub(self.points.len()) {
            Some(of_boxes) => std::slice::from_ref(&self.boxes[of_boxes].node),
            None => self.points[element].nodes(),
        }
    }

    fn visit_nodes(&mut self, visit: &mut impl FnMut(&mut usize)) {
        visit(&mut self.node);
        self.points.iter_mut().flat_map(|point| &mut point.nodes[..point.count]).for_each(&mut *visit);
        self.boxes.iter_mut().for_each(|one| visit(&mut one.node));
    }

    fn may_stiffen(&self) -> bool {
        true
    }
}
