//! What a shell asks of its sections; a section that stays elastic. Those that yield stand in [`super::layers`].

use super::packed::{InPlaneLanes, LinearisedLanes, PackedSections};
use crate::elements::block::Moduli;
use crate::elements::results::LayerStress;
use crate::materials::Dissipation;
use crate::state::Configuration;
use base::math::fma;
use base::math::lanes::{self, LANES, Lanes, lanes};
use std::array::from_fn;

/// Strains of an element in its plane, integrated over it, or the stresses conjugate to them: E numbers of the membrane and P of
/// bending, see [`super::plane_strains`].
#[derive(Debug, Clone, Copy)]
pub struct InPlane<const P: usize, const E: usize> {
    /// Numbers of the membrane.
    pub membrane: [f64; E],
    /// Numbers of bending.
    pub bending: [f64; P],
}

impl<const P: usize, const E: usize> InPlane<P, E> {
    /// All zero.
    pub const ZERO: Self = InPlane { membrane: [0.0; E], bending: [0.0; P] };

    /// σ·ε over membrane and bending.
    #[inline]
    pub fn dot(&self, other: &Self) -> f64 {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        sum(&self.membrane, &other.membrane) + sum(&self.bending, &other.bending)
    }
}

impl<const P: usize, const E: usize> InPlaneLanes<P, E> {
    /// Those of one element.
    #[inline(always)]
    fn lane(&self, lane: usize) -> InPlane<P, E> {
        let of = |numbers: &Lanes| numbers.as_array()[lane];
        InPlane { membrane: from_fn(|i| of(&self.membrane[i])), bending: from_fn(|i| of(&self.bending[i])) }
    }
}

/// The stresses of eight elements.
#[inline(always)]
fn stress_side_by_side<const P: usize, const E: usize>(stress: &[InPlane<P, E>; LANES]) -> InPlaneLanes<P, E> {
    InPlaneLanes {
        membrane: from_fn(|i| lanes(|lane| stress[lane].membrane[i])),
        bending: from_fn(|i| lanes(|lane| stress[lane].bending[i])),
    }
}

/// The stiffnesses of eight elements, with their stress.
#[inline(always)]
pub(super) fn stiffness_side_by_side<const P: usize, const E: usize>(
    stress: InPlaneLanes<P, E>,
    C: [SectionTangent<P, E>; LANES],
) -> LinearisedLanes<P, E> {
    let coupled = C.iter().any(|C| C.NM.is_some());
    let NM = |lane: usize, i: usize, j: usize| C[lane].NM.map_or(0.0, |NM| NM[i][j]);
    LinearisedLanes {
        stress,
        N: symmetric(|lane, i, j| C[lane].plane.N[i][j]),
        M: symmetric(|lane, i, j| C[lane].plane.M[i][j]),
        NM: if coupled { from_fn(|i| from_fn(|j| lanes(|lane| NM(lane, i, j)))) } else { [[Lanes::ZERO; P]; E] },
        coupled,
    }
}

/// A symmetric matrix whose lower half need not be read.
#[inline(always)]
fn symmetric<const R: usize>(entry: impl Fn(usize, usize, usize) -> f64) -> [[Lanes; R]; R] {
    let mut K = [[Lanes::ZERO; R]; R];
    for i in 0..R {
        for j in i..R {
            K[i][j] = lanes(|lane| entry(lane, i, j));
            K[j][i] = K[i][j];
        }
    }
    K
}

/// Stress of eight sections, each by itself.
pub(super) fn stress_one_by_one<const P: usize, const E: usize, S: ShellSection<P, E>>(
    sections: [&S; LANES],
    strain: &InPlaneLanes<P, E>,
    now: &Configuration,
) -> InPlaneLanes<P, E> {
    stress_side_by_side(&from_fn(|lane| sections[lane].stress(&strain.lane(lane), now)))
}

/// Stress and its derivative of eight sections, each by itself.
pub(super) fn linearise_one_by_one<const P: usize, const E: usize, S: ShellSection<P, E>>(
    sections: [&S; LANES],
    strain: &InPlaneLanes<P, E>,
    now: &Configuration,
    moduli: Moduli,
) -> LinearisedLanes<P, E> {
    let mut places = [CoupledStiffness::ZERO; LANES];
    let mut stress = [InPlane::ZERO; LANES];
    let mut lane = 0;
    let C = places.each_mut().map(|place| {
        let (s, C) = sections[lane].linearise(&strain.lane(lane), now, moduli, place);
        stress[lane] = s;
        lane += 1;
        C
    });
    stiffness_side_by_side(stress_side_by_side(&stress), C)
}

/// The sections of one element.
pub trait ShellSection<const P: usize, const E: usize>: Send + Sync + Sized {
    /// The sections of eight elements side by side.
    type Packed: PackedSections<Self, P, E>;
    /// The stiffness before the material yields.
    fn elastic(&self) -> &ShellStiffness<P, E>;
    /// Stress at a strain.
    fn stress(&self, strain: &InPlane<P, E>, now: &Configuration) -> InPlane<P, E>;
    /// Stress and its derivative, which `tangent` holds where it is not the elastic one.
    fn linearise<'a>(
        &'a self,
        strain: &InPlane<P, E>,
        now: &Configuration,
        moduli: Moduli,
        tangent: &'a mut CoupledStiffness<P, E>,
    ) -> (InPlane<P, E>, SectionTangent<'a, P, E>);
    /// True where forces of eight elements that are gathered as they are needed cost less than those of one after the other.
    const FORCES_SIDE_BY_SIDE: bool = false;
    /// Stress of eight elements side by side, with the bits of [`ShellSection::stress`].
    #[inline(always)]
    fn stress_eight(sections: [&Self; LANES], strain: &InPlaneLanes<P, E>, now: &Configuration) -> InPlaneLanes<P, E> {
        stress_one_by_one(sections, strain, now)
    }
    /// Stress and its derivative of eight elements side by side.
    fn linearise_eight(
        sections: [&Self; LANES],
        strain: &InPlaneLanes<P, E>,
        now: &Configuration,
        moduli: Moduli,
    ) -> LinearisedLanes<P, E>;
    /// Elastic energy.
    fn energy(&self, strain: &InPlane<P, E>, now: &Configuration) -> f64;
    /// Writes the history variables of the element at `part` of the way to `now` into its range of `new`, the history of the
    /// group, and returns the dissipation.
    fn update_history(
        &self,
        _strain: &InPlane<P, E>,
        _now: &Configuration,
        _part: f64,
        _new: &mut [f64],
    ) -> Dissipation {
        Dissipation::default()
    }
    /// Stress at a strain, with the history variables there written as [`ShellSection::update_history`] does and its dissipation.
    fn advance(&self, strain: &InPlane<P, E>, now: &Configuration, new: &mut [f64]) -> (InPlane<P, E>, Dissipation) {
        (self.stress(strain, now), self.update_history(strain, now, 1.0, new))
    }
    /// Writes the mean stress and the largest plastic strain of each layer, in axes of the element, and returns the number of layers.
    fn layers(&self, _strain: &InPlane<P, E>, _now: &Configuration, _layers: &mut [LayerStress]) -> usize {
        0
    }
    /// Largest accumulated plastic strain, by the history variables of the group.
    fn plastic_strain(&self, _history: &[f64]) -> f64 {
        0.0
    }
    /// True for sections that may fail.
    fn can_fail(&self) -> bool {
        false
    }
    /// The membrane strain of largest size, of Green, where the material yields, and whether it does so by logarithmic strain.
    fn surface_strain(&self, _strain: &InPlane<P, E>) -> (f64, bool) {
        (0.0, false)
    }
    /// True where the element has failed as a whole, by the history variables of the group: there is no stress then, nor damping.
    fn has_failed(&self, _history: &[f64]) -> bool {
        false
    }
    /// The number of history variables of the element.
    fn history(&self) -> usize {
        0
    }
}

/// The stiffness of drilling that strains do not feel, which stays elastic.
#[derive(Debug, Clone)]
pub struct Drilling<const E: usize> {
    /// What the following are multiplied by.
    pub stiffness: f64,
    /// Rows r of r rᵀ by the numbers of the membrane.
    pub rows: [[f64; E]; 2],
    /// Further entries of the diagonal, of the edges that are held straight.
    pub edges: [f64; E],
}

impl<const E: usize> Drilling<E> {
    /// The stress of the numbers of the membrane.
    #[inline(always)]
    pub fn stress(&self, membrane: &[f64; E]) -> [f64; E] {
        let mut stress = from_fn(|i| self.stiffness * self.edges[i] * membrane[i]);
        for row in &self.rows {
            let s = self.stiffness * row.iter().zip(membrane).map(|(r, e)| r * e).sum::<f64>();
            (0..E).for_each(|i| stress[i] += s * row[i]);
        }
        stress
    }

    /// Adds the stiffness.
    pub fn add_to(&self, K: &mut [[f64; E]; E]) {
        for i in 0..E {
            K[i][i] += self.stiffness * self.edges[i];
            for j in 0..E {
                K[i][j] += self.stiffness * self.rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
            }
        }
    }
}

/// The stiffness C of an element in its plane, σ = C ε. As a [`ShellSection`] it is one that stays elastic.
#[derive(Debug, Clone)]
pub struct ShellStiffness<const P: usize, const E: usize> {
    /// Membrane.
    pub N: [[f64; E]; E],
    /// Bending.
    pub M: [[f64; P]; P],
}

/// The derivative of the stress where layers yield on one side more than on the other.
pub struct CoupledStiffness<const P: usize, const E: usize> {
    /// Membrane and bending, each by itself.
    pub plane: ShellStiffness<P, E>,
    /// Rows of the membrane, columns of bending.
    pub NM: [[f64; P]; E],
    /// `NM` is not zero.
    pub coupled: bool,
}

/// The derivative of the stress of a section, elastic or not.
#[derive(Clone, Copy)]
pub struct SectionTangent<'a, const P: usize, const E: usize> {
    /// Membrane and bending, each by itself.
    pub plane: &'a ShellStiffness<P, E>,
    /// Rows of the membrane, columns of bending; `None` where they are zero.
    pub NM: Option<&'a [[f64; P]; E]>,
}

impl<const P: usize, const E: usize> CoupledStiffness<P, E> {
    /// No stiffness.
    pub const ZERO: Self = CoupledStiffness { plane: ShellStiffness::ZERO, NM: [[0.0; P]; E], coupled: false };

    /// The same to be read.
    #[inline(always)]
    pub fn tangent(&self) -> SectionTangent<'_, P, E> {
        SectionTangent { plane: &self.plane, NM: self.coupled.then_some(&self.NM) }
    }
}

impl<const P: usize, const E: usize> ShellStiffness<P, E> {
    /// No stiffness.
    pub const ZERO: Self = ShellStiffness { N: [[0.0; E]; E], M: [[0.0; P]; P] };

    /// The derivative of the stress, which is this stiffness.
    #[inline(always)]
    pub fn tangent(&self) -> SectionTangent<'_, P, E> {
        SectionTangent { plane: self, NM: None }
    }

    /// σ = C ε, membrane and bending.
    #[inline(always)]
    pub fn stress(&self, strain: &InPlane<P, E>) -> InPlane<P, E> {
        let mut stress = InPlane::ZERO;
        // By columns of symmetric matrices: no sum waits for the one before.
        for i in 0..E {
            for j in 0..E {
                stress.membrane[j] = fma(self.N[i][j], strain.membrane[i], stress.membrane[j]);
            }
        }
        for i in 0..P {
            for j in 0..P {
                stress.bending[j] = fma(self.M[i][j], strain.bending[i], stress.bending[j]);
            }
        }
        stress
    }
}

/// The stiffnesses of eight elements by the rows of their upper halves.
pub struct StiffnessLanes<const P: usize, const E: usize> {
    N: Box<[Lanes]>,
    M: Box<[Lanes]>,
}

/// The rows of the upper half of a matrix of `R` rows.
fn upper<const R: usize>(entry: impl Fn(usize, usize) -> Lanes) -> Box<[Lanes]> {
    let entry = &entry;
    (0..R).flat_map(|i| (i..R).map(move |j| entry(i, j))).collect()
}

/// The place of an entry of the upper half among its rows.
#[inline(always)]
const fn place_in_upper<const R: usize>(i: usize, j: usize) -> usize {
    i * (2 * R - i - 1) / 2 + j
}

impl<const P: usize, const E: usize> PackedSections<ShellStiffness<P, E>, P, E> for StiffnessLanes<P, E> {
    fn pack(sections: &[&ShellStiffness<P, E>]) -> Option<Self> {
        let at = |lane: usize| sections[lane.min(sections.len() - 1)];
        Some(StiffnessLanes {
            N: upper::<E>(|i, j| lanes(|lane| at(lane).N[i][j])),
            M: upper::<P>(|i, j| lanes(|lane| at(lane).M[i][j])),
        })
    }

    #[inline(always)]
    fn advance(
        &self,
        strain: &InPlaneLanes<P, E>,
        _: &Configuration,
        _: Option<(&mut [f64], &mut Dissipation)>,
        _: usize,
    ) -> InPlaneLanes<P, E> {
        let (N, M) = (&self.N[..E * (E + 1) / 2], &self.M[..P * (P + 1) / 2]);
        elastic_side_by_side(|i, j| N[place_in_upper::<E>(i, j)], |i, j| M[place_in_upper::<P>(i, j)], strain)
    }
}

/// σ = C ε of eight elements without coupling, as [`ShellStiffness::stress`] has it. `N` and `M` give entries of upper halves: the
/// matrices are symmetric to the last bit.
#[inline(always)]
fn elastic_side_by_side<const P: usize, const E: usize>(
    N: impl Fn(usize, usize) -> Lanes,
    M: impl Fn(usize, usize) -> Lanes,
    strain: &InPlaneLanes<P, E>,
) -> InPlaneLanes<P, E> {
    let mut stress = InPlaneLanes::ZERO;
    for i in 0..E {
        for j in 0..E {
            stress.membrane[j] = lanes::fma(N(i.min(j), i.max(j)), strain.membrane[i], stress.membrane[j]);
        }
    }
    for i in 0..P {
        for j in 0..P {
            stress.bending[j] = lanes::fma(M(i.min(j), i.max(j)), strain.bending[i], stress.bending[j]);
        }
    }
    stress
}

impl<const P: usize, const E: usize> ShellSection<P, E> for ShellStiffness<P, E> {
    type Packed = StiffnessLanes<P, E>;

    #[inline(always)]
    fn elastic(&self) -> &ShellStiffness<P, E> {
        self
    }

    #[inline(always)]
    fn stress(&self, strain: &InPlane<P, E>, _: &Configuration) -> InPlane<P, E> {
        ShellStiffness::stress(self, strain)
    }

    #[inline(always)]
    fn linearise<'a>(
        &'a self,
        strain: &InPlane<P, E>,
        _: &Configuration,
        _: Moduli,
        _: &'a mut CoupledStiffness<P, E>,
    ) -> (InPlane<P, E>, SectionTangent<'a, P, E>) {
        (ShellStiffness::stress(self, strain), self.tangent())
    }

    #[inline(always)]
    fn linearise_eight(
        sections: [&Self; LANES],
        strain: &InPlaneLanes<P, E>,
        _: &Configuration,
        _: Moduli,
    ) -> LinearisedLanes<P, E> {
        let mut out = stiffness_side_by_side(InPlaneLanes::ZERO, sections.map(Self::tangent));
        out.stress = elastic_side_by_side(|i, j| out.N[i][j], |i, j| out.M[i][j], strain);
        out
    }

    fn energy(&self, strain: &InPlane<P, E>, _: &Configuration) -> f64 {
        0.5 * strain.dot(&ShellStiffness::stress(self, strain))
    }
}
