//! Contacts: points against a surface.

use super::part_answers::PartAnswers;
use crate::elements::contact::{ContactLaw, ContactPoint, Surface};
use crate::quantities::{CONTACT, CONTACT_FORCE, Column};

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
    /// The contact law; `None` for a clearance monitor, which exerts no force.
    pub law: Option<ContactLaw>,
    /// True where the deck leaves the stiffness to the program.
    pub chosen: bool,
}

impl PartAnswers for Contact {
    const QUANTITIES: &'static [&'static [Column]] = &[&CONTACT, &[CONTACT_FORCE]];

    fn name(&self) -> &str {
        &self.name
    }

    fn elements(&self) -> usize {
        self.points.len()
    }

    fn nodes(&self, element: usize) -> &[usize] {
        self.points[element].nodes()
    }

    fn visit_nodes(&mut self, visit: &mut impl FnMut(&mut usize)) {
        visit(&mut self.node);
        self.points.iter_mut().flat_map(|point| &mut point.nodes[..point.count]).for_each(visit);
    }

    fn may_stiffen(&self) -> bool {
        true
    }
}
