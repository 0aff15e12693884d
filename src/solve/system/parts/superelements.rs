//! Superelements in the equation of motion: one block each.

use super::assembled::{Assembled, NumberedBlock, Setting};
use crate::system::plane::MotionPlane;
use base::math::Vec3;
use mechanics::elements::superelement::{FloatingElement, SuperelementBlock};
use mechanics::sections::Stiffness;
use model::Superelement;

impl Assembled for Superelement {
    fn floating(&self, x: &[Vec3], beta: f64) -> Option<FloatingElement> {
        Some(FloatingElement::new(self.matrices.clone(), x, beta))
    }

    fn blocks(&self, setting: &Setting) -> Vec<NumberedBlock> {
        let beta = setting.model.damping.beta(&self.damping);
        vec![(Box::new(SuperelementBlock(FloatingElement::new(self.matrices.clone(), setting.x, beta))), 0)]
    }

    /// Matrices may couple all directions.
    fn stays_in(&self, _: &MotionPlane, _: &[Stiffness]) -> bool {
        false
    }
}
