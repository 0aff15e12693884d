//! The sections of a beam: the interface, and a section that stays elastic. Sections that yield are in [`super::fibres`].

use super::lane_section::{Linearised, SectionStiffness};
use crate::elements::block::Moduli;
use crate::materials::Dissipation;
use crate::sections::{BeamStresses, Stiffness};
use crate::state::Configuration;
use base::math::number::{LaneVec3, Number};
use base::math::{Mat3, Vec3};

/// The sections of one element, one at each integration point. Strains Γ, κ and stress resultants n, m (force and moment) have
/// global components at t = 0.
pub trait BeamSection: Send + Sync {
    /// True for a section that never yields, with the stress of [`BeamSection::elastic`].
    const IS_ELASTIC: bool = false;
    /// True for sections that differ from point to point of an element.
    const VARIES: bool = false;
    /// The number of integration points of an element of `nodes` nodes whose rule has `rule` points.
    fn points(nodes: usize, rule: usize) -> usize;
    /// The stiffness of the section at integration point `g` before it yields.
    fn elastic(&self, g: usize) -> &BeamStiffness;
    /// Stress at integration point `g`.
    fn stress(&self, g: usize, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> (Vec3, Vec3);
    /// Stress at the strains Γ, κ of point `g` of some elements side by side, and its derivative; `elastic` is their stiffness before they
    /// yield.
    fn linearise<'a, T: Number>(
        sections: impl Fn(usize) -> &'a Self,
        g: usize,
        strain: &[LaneVec3<T>; 2],
        now: (&Configuration, Moduli),
        elastic: &SectionStiffness<T>,
    ) -> Linearised<T>
    where
        Self: 'a;
    /// Elastic energy per length.
    fn energy(&self, g: usize, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> f64;
    /// Writes the history variables of point `g` at `part` of the way to `now` into its range of `new`, the history of the group. Returns
    /// the dissipation per length.
    fn update_history(
        &self,
        _g: usize,
        _strain: (&Vec3, &Vec3),
        _now: &Configuration,
        _part: f64,
        _new: &mut [f64],
    ) -> Dissipation {
        Dissipation::default()
    }
    /// Stress at point `g`, with the history variables there written as [`BeamSection::update_history`] does and its dissipation.
    fn advance(
        &self,
        g: usize,
        (gamma, kappa): (&Vec3, &Vec3),
        now: &Configuration,
        new: &mut [f64],
    ) -> (Vec3, Vec3, Dissipation) {
        let (n, m) = self.stress(g, gamma, kappa, now);
        (n, m, self.update_history(g, (gamma, kappa), now, 1.0, new))
    }
    /// Largest accumulated plastic strain at point `g`, by the history variables of the group.
    fn plastic_strain(&self, _g: usize, _history: &[f64]) -> f64 {
        0.0
    }
    /// Extreme stresses of the fibres at point `g`, of shear stress where it enters the yield condition; `None` of a section without fibres.
    fn stresses(&self, _g: usize, _strain: (&Vec3, &Vec3), _now: &Configuration) -> Option<BeamStresses> {
        None
    }
    /// True for sections that may fail.
    fn can_fail(&self) -> bool {
        false
    }
    /// True where the element has failed, by the history variables of the group: there is no stress then, nor damping.
    fn has_failed(&self, _history: &[f64]) -> bool {
        false
    }
    /// Energy per length in the intact fibres at point `g` of a failing element: elastic energy, and energy of kinematic hardening.
    fn lost(&self, _g: usize, _strain: (&Vec3, &Vec3), _now: &Configuration) -> Dissipation {
        Dissipation::default()
    }
    /// The number of history variables of all points.
    fn history(&self) -> usize {
        0
    }
}

/// The stiffness C of a section: σ = C ε with σ = (n, m) and ε = (Γ, κ). As a [`BeamSection`] it is one that stays elastic.
#[derive(Debug, Clone)]
pub struct BeamStiffness {
    /// ∂n/∂Γ.
    pub N: Mat3,
    /// ∂m/∂κ.
    pub M: Mat3,
    /// ∂n/∂κ, and transposed ∂m/∂Γ.
    pub NM: Mat3,
    /// `NM` is not zero.
    pub coupled: bool,
}

impl BeamStiffness {
    /// No stiffness.
    pub const ZERO: BeamStiffness = {
        let zero = Mat3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        BeamStiffness { N: zero, M: zero, NM: zero, coupled: false }
    };

    /// The stiffness of a section whose axes are the columns of `frame`.
    pub fn new(section: &Stiffness, frame: &Mat3) -> Self {
        let Stiffness { N, M, NM, .. } = section;
        BeamStiffness { N: *N, M: *M, NM: *NM, coupled: *NM != Mat3::zeros() }.rotated(frame)
    }

    /// The stiffnesses of several elements side by side.
    #[inline(always)]
    pub fn side_by_side<'a, T: Number>(of: impl Fn(usize) -> &'a BeamStiffness) -> SectionStiffness<T> {
        let (zero, coupled) = ([[T::ZERO; 3]; 3], (0..T::COUNT).any(|lane| of(lane).coupled));
        let mut C = SectionStiffness { N: zero, M: zero, NM: zero, coupled };
        for i in 0..3 {
            for j in 0..3 {
                C.N[i][j] = T::gather(|lane| of(lane).N[(i, j)]);
                C.M[i][j] = T::gather(|lane| of(lane).M[(i, j)]);
                if coupled {
                    C.NM[i][j] = T::gather(|lane| of(lane).NM[(i, j)]);
                }
            }
        }
        C
    }

    /// The stiffness times `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        BeamStiffness { N: factor * self.N, M: factor * self.M, NM: factor * self.NM, coupled: self.coupled }
    }

    /// The stiffness and another.
    pub fn plus(&self, other: &Self) -> Self {
        BeamStiffness { N: self.N + other.N, M: self.M + other.M, NM: self.NM + other.NM, coupled: true }
    }

    /// The stiffness less another.
    pub fn less(&self, other: &Self) -> Self {
        BeamStiffness { N: self.N - other.N, M: self.M - other.M, NM: self.NM - other.NM, coupled: true }
    }

    /// The stiffness by other axes: the columns of `frame` are the present axes in the components of the new ones.
    #[inline]
    pub fn rotated(&self, frame: &Mat3) -> Self {
        let turn = |C: &Mat3| frame * C * frame.transpose();
        BeamStiffness { N: turn(&self.N), M: turn(&self.M), NM: turn(&self.NM), coupled: self.coupled }
    }

    /// n and m at the strains Γ, κ.
    #[inline]
    pub fn stress(&self, gamma: &Vec3, kappa: &Vec3) -> (Vec3, Vec3) {
        let (mut n, mut m) = (self.N * gamma, self.M * kappa);
        if self.coupled {
            n += self.NM * kappa;
            m += self.NM.tr_mul(gamma);
        }
        (n, m)
    }

    /// Energy per length at the strains Γ, κ.
    #[inline]
    pub fn energy(&self, gamma: &Vec3, kappa: &Vec3) -> f64 {
        let (n, m) = self.stress(gamma, kappa);
        0.5 * (n.dot(gamma) + m.dot(kappa))
    }
}

impl BeamSection for BeamStiffness {
    const IS_ELASTIC: bool = true;

    #[inline(always)]
    fn points(nodes: usize, _: usize) -> usize {
        nodes - 1
    }

    #[inline(always)]
    fn elastic(&self, _: usize) -> &BeamStiffness {
        self
    }

    #[inline(always)]
    fn stress(&self, _: usize, gamma: &Vec3, kappa: &Vec3, _: &Configuration) -> (Vec3, Vec3) {
        BeamStiffness::stress(self, gamma, kappa)
    }

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

    fn energy(&self, _: usize, gamma: &Vec3, kappa: &Vec3, _: &Configuration) -> f64 {
        BeamStiffness::energy(self, gamma, kappa)
    }
}
