//! What a shell asks of its sections; a section that stays elastic. Those that yield stand in [`super::layers`].

use crate::elements::block::Moduli;
use crate::elements::results::LayerStress;
use crate::materials::Dissipation;
use crate::state::Configuration;
use nalgebra::SMatrix;

/// The sections of one element. Strains and stresses are the M numbers of the membrane and the M of bending, integrated over the
/// element.
pub trait ShellSection<const M: usize>: Send + Sync {
    /// The stiffness before the material yields.
    fn elastic(&self) -> &ShellStiffness<M>;
    /// Stress at a strain.
    fn stress(&self, strain: &[[f64; M]; 2], now: &Configuration) -> [[f64; M]; 2];
    /// Stress and its derivative, which `tangent` holds where it is not the elastic one.
    fn linearise<'a>(
        &'a self,
        strain: &[[f64; M]; 2],
        now: &Configuration,
        moduli: Moduli,
        tangent: &'a mut ShellStiffness<M>,
    ) -> ([[f64; M]; 2], &'a ShellStiffness<M>);
    /// Elastic energy.
    fn energy(&self, strain: &[[f64; M]; 2], now: &Configuration) -> f64;
    /// Writes the history variables of the element at `part` of the way to `now` into its range of `new`, the history of the
    /// group, and returns the dissipation.
    fn update_history(
        &self,
        _strain: &[[f64; M]; 2],
        _now: &Configuration,
        _part: f64,
        _new: &mut [f64],
    ) -> Dissipation {
        Dissipation::default()
    }
    /// Writes the mean stress and the largest plastic strain of each layer, in axes of the element, and returns the number of layers.
    fn layers(&self, _strain: &[[f64; M]; 2], _now: &Configuration, _layers: &mut [LayerStress]) -> usize {
        0
    }
    /// Largest accumulated plastic strain, by the history variables of the group.
    fn plastic_strain(&self, _history: &[f64]) -> f64 {
        0.0
    }
    /// The number of history variables of the element.
    fn history(&self) -> usize {
        0
    }
}

/// The stiffness C of an element in its plane, σ = C ε. As a [`ShellSection`] it is one that stays elastic.
#[derive(Debug, Clone)]
pub struct ShellStiffness<const M: usize> {
    /// Membrane.
    pub N: [[f64; M]; M],
    /// Bending.
    pub M: [[f64; M]; M],
    /// Rows of the membrane, columns of bending.
    pub NM: [[f64; M]; M],
    /// `NM` is not zero.
    pub coupled: bool,
}

impl<const M: usize> ShellStiffness<M> {
    /// No stiffness.
    pub const ZERO: Self = ShellStiffness { N: [[0.0; M]; M], M: [[0.0; M]; M], NM: [[0.0; M]; M], coupled: false };

    /// The stiffness of a homogeneous section from that of its membrane; `ratio` of bending to membrane: h²/12.
    pub fn new(N: [[f64; M]; M], ratio: f64) -> Self {
        ShellStiffness { N, M: N.map(|row| row.map(|c| ratio * c)), ..Self::ZERO }
    }

    /// σ = C ε, membrane and bending.
    #[inline(always)]
    pub fn stress(&self, [e, k]: &[[f64; M]; 2]) -> [[f64; M]; 2] {
        let mut stress = [[0.0; M]; 2];
        for i in 0..M {
            for j in 0..M {
                stress[0][i] += self.N[i][j] * e[j];
                stress[1][i] += self.M[i][j] * k[j];
                if self.coupled {
                    stress[0][i] += self.NM[i][j] * k[j];
                    stress[1][i] += self.NM[j][i] * e[j];
                }
            }
        }
        stress
    }
}

/// σ·ε over membrane and bending.
#[inline]
pub(super) fn product<const M: usize>(a: &[[f64; M]; 2], b: &[[f64; M]; 2]) -> f64 {
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| a * b).sum()
}

impl<const M: usize> ShellSection<M> for ShellStiffness<M> {
    #[inline(always)]
    fn elastic(&self) -> &ShellStiffness<M> {
        self
    }

    #[inline(always)]
    fn stress(&self, strain: &[[f64; M]; 2], _: &Configuration) -> [[f64; M]; 2] {
        ShellStiffness::stress(self, strain)
    }

    #[inline(always)]
    fn linearise<'a>(
        &'a self,
        strain: &[[f64; M]; 2],
        _: &Configuration,
        _: Moduli,
        _: &'a mut ShellStiffness<M>,
    ) -> ([[f64; M]; 2], &'a ShellStiffness<M>) {
        (ShellStiffness::stress(self, strain), self)
    }

    fn energy(&self, strain: &[[f64; M]; 2], _: &Configuration) -> f64 {
        0.5 * product(strain, &ShellStiffness::stress(self, strain))
    }
}

/// The strains ε₁, ε₂, γ₁₂ at an integration point from those of the element.
pub(super) struct StrainOperator<const M: usize> {
    /// The matrix of the operator.
    pub A: SMatrix<f64, 3, M>,
    /// Area that belongs to the point.
    pub weight: f64,
}
