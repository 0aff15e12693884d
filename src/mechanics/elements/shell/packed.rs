//! What the sections of eight shell elements say side by side.

use crate::materials::Dissipation;
use crate::state::Configuration;
use base::math::lanes::Lanes;

/// Strains in the plane of eight elements, or the stresses conjugate to them.
#[derive(Clone, Copy)]
pub struct InPlaneLanes<const P: usize, const E: usize> {
    /// Numbers of the membrane.
    pub membrane: [Lanes; E],
    /// Numbers of bending.
    pub bending: [Lanes; P],
}

impl<const P: usize, const E: usize> InPlaneLanes<P, E> {
    /// All zero.
    pub const ZERO: Self = InPlaneLanes { membrane: [Lanes::ZERO; E], bending: [Lanes::ZERO; P] };
}

/// Stress of eight elements in their planes, and the stiffness C.
pub struct LinearisedLanes<const P: usize, const E: usize> {
    /// Stress.
    pub stress: InPlaneLanes<P, E>,
    /// Membrane.
    pub N: [[Lanes; E]; E],
    /// Bending.
    pub M: [[Lanes; P]; P],
    /// Rows of the membrane, columns of bending; nothing unless `coupled`.
    pub NM: [[Lanes; P]; E],
    /// `NM` is not zero.
    pub coupled: bool,
}

/// Sections of eight elements side by side.
pub trait PackedSections<S, const P: usize, const E: usize>: Send + Sync + Sized {
    /// Those of up to eight elements; `None` where they must be computed one by one.
    fn pack(sections: &[&S]) -> Option<Self>;
    /// Stress at a strain in the plane of the first `count` lanes. Where `new` is given the history variables there are written and their
    /// dissipation is added, element by element.
    fn advance(
        &self,
        strain: &InPlaneLanes<P, E>,
        now: &Configuration,
        new: Option<(&mut [f64], &mut Dissipation)>,
        count: usize,
    ) -> InPlaneLanes<P, E>;
}
