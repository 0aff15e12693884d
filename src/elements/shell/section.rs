//! How the plane of a shell answers to strain: elastic here, by layers in [`super::layers`].

use super::{Configuration, Moduli};
use crate::elements::Layer;
use crate::materials::Dissipation;

/// The sections of one element. Strains and stresses are the M numbers of the membrane and the M of bending.
pub trait Section<const M: usize>: Send + Sync {
    /// The law before anything yields.
    fn elastic(&self) -> &Plane<M>;
    fn stress(&self, strain: &[[f64; M]; 2], now: &Configuration) -> [[f64; M]; 2];
    /// Stress and its derivative, for which there is `room`.
    fn linearise<'a>(
        &'a self,
        strain: &[[f64; M]; 2],
        now: &Configuration,
        moduli: Moduli,
        room: &'a mut Plane<M>,
    ) -> ([[f64; M]; 2], &'a Plane<M>);
    /// Elastic energy.
    fn energy(&self, strain: &[[f64; M]; 2], now: &Configuration) -> f64;
    /// Writes its share of the history.
    fn update_history(
        &self,
        _strain: &[[f64; M]; 2],
        _now: &Configuration,
        _part: f64,
        _history: &mut [f64],
    ) -> Dissipation {
        Dissipation::default()
    }
    /// Writes each layer's mean stress and largest plastic strain, in axes of the element, and returns how many there are.
    fn layers(&self, _strain: &[[f64; M]; 2], _now: &Configuration, _layers: &mut [Layer]) -> usize {
        0
    }
    /// Largest accumulated plastic strain.
    fn plastic_strain(&self, _past: &[f64]) -> f64 {
        0.0
    }
    /// Numbers to remember.
    fn history(&self) -> usize {
        0
    }
}

/// σ = C ε by membrane and bending.
#[derive(Debug, Clone)]
pub struct Plane<const M: usize> {
    pub N: [[f64; M]; M],
    pub M: [[f64; M]; M],
    /// Rows of the membrane, columns of bending.
    pub NM: [[f64; M]; M],
    /// NM is not zero.
    pub coupled: bool,
}

impl<const M: usize> Plane<M> {
    pub const ZERO: Self = Plane { N: [[0.0; M]; M], M: [[0.0; M]; M], NM: [[0.0; M]; M], coupled: false };

    /// Of a homogeneous section; `ratio` of bending to membrane: h²/12.
    pub fn new(N: [[f64; M]; M], ratio: f64) -> Self {
        Plane { N, M: N.map(|row| row.map(|c| ratio * c)), ..Self::ZERO }
    }

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

/// Σ σ ε over membrane and bending.
#[inline]
pub(super) fn product<const M: usize>(a: &[[f64; M]; 2], b: &[[f64; M]; 2]) -> f64 {
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| a * b).sum()
}

impl<const M: usize> Section<M> for Plane<M> {
    #[inline(always)]
    fn elastic(&self) -> &Plane<M> {
        self
    }

    #[inline(always)]
    fn stress(&self, strain: &[[f64; M]; 2], _: &Configuration) -> [[f64; M]; 2] {
        Plane::stress(self, strain)
    }

    #[inline(always)]
    fn linearise<'a>(
        &'a self,
        strain: &[[f64; M]; 2],
        _: &Configuration,
        _: Moduli,
        _: &'a mut Plane<M>,
    ) -> ([[f64; M]; 2], &'a Plane<M>) {
        (Plane::stress(self, strain), self)
    }

    fn energy(&self, strain: &[[f64; M]; 2], _: &Configuration) -> f64 {
        0.5 * product(strain, &Plane::stress(self, strain))
    }
}
