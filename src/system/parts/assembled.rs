//! What every kind of part brings into the equation of motion, each in the file of its kind.

use super::masses::NodalMasses;
use crate::elements::ElementBlock;
use crate::math::Vec3;
use crate::model::Model;
use crate::sections::Stiffness;
use crate::system::plane::Plane;
use crate::system::thread_partition::MOST_IN_GROUP;
use std::ops::Range;

/// What the blocks of a scene are made with.
pub struct Setting<'s> {
    pub model: &'s Model,
    /// Initial positions of all nodes.
    pub x: &'s [Vec3],
    /// Stiffness-proportional damping.
    pub beta: f64,
    /// The normal of a plane motion.
    pub plane: Option<usize>,
}

/// A block of like elements, and the number of its first element within its part.
pub type NumberedBlock = (Box<dyn ElementBlock>, usize);

/// The answers of a kind of part while a system is built.
pub trait Assembled {
    /// Adds the mass of the part at its nodes or over its elements; a part may have none.
    fn add_masses(&self, _stiffnesses: &[Stiffness], _masses: &mut NodalMasses) {}

    /// The blocks of the part; some may be empty.
    fn blocks(&self, setting: &Setting) -> Vec<NumberedBlock>;

    /// True where a motion in the plane drives nothing of the part out of it.
    fn stays_in(&self, plane: &Plane, stiffnesses: &[Stiffness]) -> bool;
}

/// Divides elements into ranges for a group each, as equal as possible.
pub fn pieces(elements: usize) -> impl Iterator<Item = Range<usize>> {
    let count = elements.div_ceil(MOST_IN_GROUP);
    (0..count).map(move |k| k * elements / count..(k + 1) * elements / count)
}
