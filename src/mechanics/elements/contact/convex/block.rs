//! Convex solids on bodies against one on another body or on the ground, as a block of pairs.

use super::memory::Memory;
use super::pair::{CarriedConvex, ConvexBody, ConvexPair, law_of_faces, width};
use super::steps::is_missed;
use super::tangent::tangent;
use super::update::update_pair;
use crate::elements::block::{Branches, Elements, Force, Mechanics, Moduli, Results};
use crate::elements::contact::history::PairMemory;
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::pair_block::{PairAction, PairBlock, energy, subtract_forces};
use crate::elements::contact::surface::Surface;
use crate::elements::slip::Sliding;
use crate::materials::Dissipation;
use crate::state::{Configuration, Node};

/// Convex solids against one.
pub struct ConvexPairs {
    /// The law, for the whole of a face.
    pub(in crate::elements::contact) law: ContactLaw,
    /// The one that is touched.
    other: CarriedConvex,
    /// The touching solids.
    touching: Vec<ConvexBody>,
    /// The node of each of these, then the carrier of the other.
    nodes: Vec<[usize; 2]>,
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
    fn count(&self) -> usize {
        self.touching.len()
    }

    /// One of the pairs.
    fn pair(&self, e: usize) -> ConvexPair<'_> {
        ConvexPair { law: &self.law, one: &self.touching[e], other: &self.other }
    }

    /// The history of a pair, as a part of that of the block.
    fn history<'a>(&self, e: usize, history: &'a [f64]) -> PairMemory<'a> {
        let width = width(&self.law);
        PairMemory(&history[e * width..(e + 1) * width])
    }

    /// The memory of a pair, with that of its friction.
    pub(in crate::elements::contact) fn friction_of<'a>(
        &self,
        e: usize,
        history: &'a [f64],
    ) -> (PairMemory<'a>, Memory) {
        let old = self.history(e, history);
        (old, Memory::read(old))
    }
}

impl Elements for ConvexPairs {
    fn len(&self) -> usize {
        self.count()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.nodes[e]
    }

    fn dofs(&self) -> usize {
        6
    }

    fn sliding(&self) -> Option<&dyn Sliding> {
        Some(self)
    }
}

impl Mechanics for ConvexPairs {
    fn history(&self) -> usize {
        width(&self.law) * self.count()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        subtract_forces(self, now, F);
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        K.fill(0.0);
        if !now.history.is_empty() {
            tangent(&self.pair(e), self.history(e, now.history), now, rate_weight, K);
        }
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        let mut spent = Dissipation::default();
        for (e, new) in history.chunks_exact_mut(width(&self.law)).enumerate() {
            let pair = self.pair(e);
            spent += update_pair(&pair, &pair.kinematics(now.nodes), self.history(e, now.history), now, part, new);
        }
        spent
    }
}

impl Results for ConvexPairs {
    fn energy(&self, now: &Configuration) -> f64 {
        energy(self, now)
    }
}

impl Branches for ConvexPairs {
    fn is_inactive(&self, e: usize, now: &Configuration) -> bool {
        now.history.is_empty()
            || now.dt < self.history(e, now.history).safe_time()
            || self.pair(e).kinematics(now.nodes).pose.least_axis_within(self.law.touching).gap > self.law.touching
    }
}

impl PairBlock for ConvexPairs {
    fn law(&self) -> &ContactLaw {
        &self.law
    }

    fn carrier(&self) -> Option<usize> {
        Some(self.other.node)
    }

    fn each_action(&self, now: &Configuration, act: &mut dyn FnMut(&PairAction)) {
        if now.history.is_empty() {
            return;
        }
        for e in 0..self.count() {
            let pair = self.pair(e);
            if let Some((at, acting)) = pair.touch(self.history(e, now.history), now) {
                act(&pair.action(&at, &acting));
            }
        }
    }

    fn any_memory(&self, history: &[f64], is: &mut dyn FnMut(PairMemory) -> bool) -> bool {
        (0..self.count()).map(|e| self.history(e, history)).any(|old| old.is_known() && is(old))
    }

    fn misses(&self, start: &[Node], now: &Configuration) -> bool {
        (0..self.count()).any(|e| is_missed(&self.pair(e), self.history(e, now.history), start, now))
    }
}
