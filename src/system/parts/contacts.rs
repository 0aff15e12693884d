//! Contacts in the equation of motion: their blocks.

use super::assembled::{Assembled, NumberedBlock, Setting, pieces};
use crate::elements::contact::{ContactPoint, Contacts, MOST_NODES};
use crate::model::Contact;
use crate::sections::Stiffness;
use crate::system::plane::{MotionPlane, SMALL};

impl Assembled for Contact {
    /// The blocks of points with equally many nodes, with the number of the first point among those; none for a clearance
    /// monitor.
    fn blocks(&self, _: &Setting) -> Vec<NumberedBlock> {
        let Some(law) = self.law else { return Vec::new() };
        let mut blocks: Vec<NumberedBlock> = Vec::new();
        for count in 1..=MOST_NODES {
            let points: Vec<ContactPoint> = self.points.iter().filter(|point| point.count == count).cloned().collect();
            for piece in pieces(points.len()) {
                let block = Contacts::new(law, self.surface.clone(), self.node, points[piece.clone()].to_vec());
                blocks.push((Box::new(block), piece.start));
            }
        }
        blocks
    }

    fn stays_in(&self, plane: &MotionPlane, _: &[Stiffness]) -> bool {
        let center = self.surface.center[plane.normal].abs();
        center <= SMALL * plane.size && self.surface.keeps(plane.normal)
    }
}
