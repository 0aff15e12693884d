//! Convex solids on bodies against one on another body or on the ground.

use super::memory::Memory;
use super::pair::{CarriedConvex, ConvexBody, ConvexPair, law_of_faces, width};
use crate::elements::contact::history::PointHistory;
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::surface::Surface;

/// Convex solids against one.
pub struct ConvexPairs {
    /// The law, for the whole of a face.
    pub(in crate::elements::contact) law: ContactLaw,
    /// The one that is touched.
    pub(super) other: CarriedConvex,
    /// Those that touch it.
    pub(super) touching: Vec<ConvexBody>,
    /// The node of each of these, then the carrier of the other.
    pub(super) nodes: Vec<[usize; 2]>,
}

impl ConvexPairs {
    /// `None` where the surface is no convex solid of these kinds. The stiffness and damping of `law` are those of a corner.
    pub fn new(law: ContactLaw, surface: &Surface, carrier: usize, touching: Vec<ConvexBody>) -> Option<Self> {
        let nodes = touching.iter().map(|one| [one.node, carrier]).collect();
        let reach = touching.iter().map(|one| one.shape.reach()).fold(0.0, f64::max);
        let other = CarriedConvex::of_surface(surface, carrier, reach)?;
        Some(ConvexPairs { law: law_of_faces(law), other, touching, nodes })
    }

    /// The number of pairs.
    pub(in crate::elements::contact) fn count(&self) -> usize {
        self.touching.len()
    }

    /// One of the pairs.
    pub(in crate::elements::contact) fn pair(&self, e: usize) -> ConvexPair<'_> {
        ConvexPair { law: &self.law, one: &self.touching[e], other: &self.other }
    }

    /// The history of a pair, as a part of that of the block.
    pub(in crate::elements::contact) fn history<'a>(&self, e: usize, history: &'a [f64]) -> PointHistory<'a> {
        let width = width(&self.law);
        PointHistory::new(&history[e * width..(e + 1) * width])
    }

    /// What a pair remembers, with the memory of its friction.
    pub(in crate::elements::contact) fn friction_of<'a>(
        &self,
        e: usize,
        history: &'a [f64],
    ) -> (PointHistory<'a>, Memory) {
        let old = self.history(e, history);
        (old, Memory::read(old))
    }
}
