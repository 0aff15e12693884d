//! Elastic sections that differ from point to point of an element: tapered and twisted beams.

use super::lane_section::{Linearised, SectionStiffness};
use super::section::{BeamSection, BeamStiffness};
use crate::elements::block::Moduli;
use crate::state::Configuration;
use base::math::Vec3;
use base::math::number::{LaneVec3, Number};

/// The stiffness at each integration point; an element of N nodes uses the first N − 1.
pub(super) struct VariedSection(pub Box<[BeamStiffness; 4]>);

impl BeamSection for VariedSection {
    const IS_ELASTIC: bool = true;
    const VARIES: bool = true;

    #[inline(always)]
    fn points(nodes: usize, _: usize) -> usize {
        nodes - 1
    }

    #[inline(always)]
    fn elastic(&self, g: usize) -> &BeamStiffness {
        &self.0[g]
    }

    #[inline(always)]
    fn stress(&self, g: usize, gamma: &Vec3, kappa: &Vec3, _: &Configuration) -> (Vec3, Vec3) {
        self.0[g].stress(gamma, kappa)
    }

    /// `elastic` is the stiffness at the point.
    #[inline(always)]
    fn linearise<'a, T: Number>(
        _: impl Fn(usize) -> &'a Self,
        _: usize,
        strain: &[LaneVec3<T>; 2],
        _: (&Configuration, Moduli),
        elastic: &SectionStiffness<T>,
    ) -> Linearised<T> {
        Linearised { stress: elastic.stress(strain), C: *elastic }
    }

    fn energy(&self, g: usize, gamma: &Vec3, kappa: &Vec3, _: &Configuration) -> f64 {
        self.0[g].energy(gamma, kappa)
    }
}
