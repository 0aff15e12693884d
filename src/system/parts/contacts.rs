//! Contacts in the equation of motion: their blocks.

use super::assembled::{Assembled, NumberedBlock, Setting, pieces};
use crate::elements::contact::{BoxPairs, ContactPoint, Contacts, MOST_NODES};
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
        for piece in pieces(self.boxes.len()) {
            let boxes = self.boxes[piece.clone()].to_vec();
            let pairs = BoxPairs::new(law, &self.surface, self.node, boxes);
            blocks.extend(pairs.map(|pairs| (Box::new(pairs) as _, self.points.len() + piece.start)));
        }
        blocks
    }

    fn stays_in(&self, plane: &MotionPlane, _: &[Stiffness]) -> bool {
        let center = self.surface.center[plane.normal].abs();
        // Two boxes of which each is the same on both sides of the plane push each other along it.
        let keeps = !self.points.is_empty() || self.boxes.is_empty();
        let along = self.surface.axes.row(plane.normal).iter().any(|x| x.abs() > 1.0 - 1e-12);
        center <= SMALL * plane.size && (!keeps || self.surface.keeps(plane.normal)) && (self.boxes.is_empty() || along)
    }
}
