//! The contributions of a part to the equation of motion: the interface of every kind, each in the file of its kind.

use super::masses::{LumpedElement, NodalMasses};
use crate::system::plane::MotionPlane;
use crate::system::thread_partition::MOST_IN_GROUP;
use base::math::{Mat3, Vec3};
use mechanics::elements::ElementBlock;
use mechanics::elements::contact::PairBlock;
use mechanics::elements::superelement::FloatingElement;
use mechanics::sections::Stiffness;
use model::Model;
use std::ops::Range;

/// The data for the blocks of a model.
pub struct Setting<'s> {
    /// The model.
    pub model: &'s Model,
    /// Initial positions of all nodes.
    pub x: &'s [Vec3],
    /// Normal of a plane motion; `None` for a motion in space.
    pub plane: Option<usize>,
}

/// A block of like elements, and the number of its first element within its part.
pub type NumberedBlock = (Box<dyn ElementBlock>, usize);

/// A block of pairs, and the number of its first element within its part.
pub type NumberedPairs = (Box<dyn PairBlock>, usize);

/// Squared distances of neighbouring nodes of an element as tensors, global components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeSpacing {
    /// For turns that bend the element.
    pub bending: Mat3,
    /// For turns about the normal of a shell, which waves of bending do not have.
    pub drilling: Mat3,
}

impl Default for NodeSpacing {
    fn default() -> NodeSpacing {
        NodeSpacing { bending: Mat3::zeros(), drilling: Mat3::zeros() }
    }
}

/// The contributions of a part while a system is built.
pub trait Assembled {
    /// Adds the mass of the part at its nodes or over its elements; a part may have none.
    fn add_masses(&self, _stiffnesses: &[Stiffness], _masses: &mut NodalMasses) {}

    /// The lumped mass of an element; `None` for elements without mass and for rigid ones.
    fn lumped(&self, _element: usize, _stiffnesses: &[Stiffness], _masses: &NodalMasses) -> Option<LumpedElement> {
        None
    }

    /// The squared distances of neighbouring nodes of a deformable element at t = 0, as tensors S. `aᵀ S a` belongs to
    /// waves that turn the element about the unit vector a, and is zero if there are none.
    fn spacing(&self, _element: usize, _masses: &NodalMasses) -> NodeSpacing {
        NodeSpacing::default()
    }

    /// The part as a superelement, on nodes that lie at `x`, with Rayleigh's β; `None` for other parts.
    fn floating(&self, _x: &[Vec3], _beta: f64) -> Option<FloatingElement> {
        None
    }

    /// The blocks of elements of the part; some may be empty.
    fn blocks(&self, _setting: &Setting) -> Vec<NumberedBlock> {
        Vec::new()
    }

    /// The blocks of pairs that may touch, likewise.
    fn pairs(&self, _setting: &Setting) -> Vec<NumberedPairs> {
        Vec::new()
    }

    /// True where a motion in the plane drives nothing of the part out of it.
    fn stays_in(&self, plane: &MotionPlane, stiffnesses: &[Stiffness]) -> bool;
}

/// Divides elements into ranges for a group each, as equal as possible.
pub fn pieces(elements: usize) -> impl Iterator<Item = Range<usize>> {
    let count = elements.div_ceil(MOST_IN_GROUP);
    (0..count).map(move |k| k * elements / count..(k + 1) * elements / count)
}
