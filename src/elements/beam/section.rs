//! How a section answers to strain: elastic here, by fibres in [`super::fibres`].

use super::{Configuration, Moduli};
use crate::materials::Dissipation;
use crate::math::{Mat3, Vec3};
use crate::sections::Stiffness;

/// The sections of one element, one at each integration point, all of the same make. Strains Γ, κ and stresses n, m are in
/// global axes at t = 0.
pub trait Section: Send + Sync {
    /// Integration points of an element of `nodes` nodes whose rule has `rule` points.
    fn points(nodes: usize, rule: usize) -> usize;
    /// The law of the section before it yields.
    fn elastic(&self) -> &Elastic;
    /// Stress at integration point `g`.
    fn stress(&self, g: usize, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> (Vec3, Vec3);
    /// Stress and its derivative, for which there is `room`.
    fn linearise<'a>(
        &'a self,
        g: usize,
        strain: (&Vec3, &Vec3),
        now: &Configuration,
        moduli: Moduli,
        room: &'a mut Elastic,
    ) -> (Vec3, Vec3, &'a Elastic);
    /// Elastic energy per length.
    fn energy(&self, g: usize, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> f64;
    /// Writes its share of the history; what was spent is per length.
    fn update_history(
        &self,
        _g: usize,
        _strain: (&Vec3, &Vec3),
        _now: &Configuration,
        _part: f64,
        _history: &mut [f64],
    ) -> Dissipation {
        Dissipation::default()
    }
    /// Largest accumulated plastic strain.
    fn plastic_strain(&self, _g: usize, _past: &[f64]) -> f64 {
        0.0
    }
    /// Numbers to remember of all points.
    fn history(&self) -> usize {
        0
    }
}

/// σ = C ε with ε = (Γ, κ).
#[derive(Debug, Clone)]
pub struct Elastic {
    pub N: Mat3,
    pub M: Mat3,
    pub NM: Mat3,
    /// NM is not zero.
    pub coupled: bool,
}

impl Elastic {
    pub const ZERO: Elastic = {
        let zero = Mat3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        Elastic { N: zero, M: zero, NM: zero, coupled: false }
    };

    /// Of a section whose axes are the columns of `frame`.
    pub fn new(section: &Stiffness, frame: &Mat3) -> Self {
        let Stiffness { N, M, NM, .. } = section;
        Elastic { N: *N, M: *M, NM: *NM, coupled: *NM != Mat3::zeros() }.turned(frame)
    }

    /// The same in other axes: `frame` has the old ones as columns.
    #[inline]
    pub fn turned(&self, frame: &Mat3) -> Self {
        let turn = |C: &Mat3| frame * C * frame.transpose();
        Elastic { N: turn(&self.N), M: turn(&self.M), NM: turn(&self.NM), coupled: self.coupled }
    }

    #[inline]
    pub fn stress(&self, gamma: &Vec3, kappa: &Vec3) -> (Vec3, Vec3) {
        let (mut n, mut m) = (self.N * gamma, self.M * kappa);
        if self.coupled {
            n += self.NM * kappa;
            m += self.NM.tr_mul(gamma);
        }
        (n, m)
    }

    #[inline]
    pub fn energy(&self, gamma: &Vec3, kappa: &Vec3) -> f64 {
        let (n, m) = self.stress(gamma, kappa);
        0.5 * (n.dot(gamma) + m.dot(kappa))
    }
}

impl Section for Elastic {
    #[inline(always)]
    fn points(nodes: usize, _: usize) -> usize {
        nodes - 1
    }

    #[inline(always)]
    fn elastic(&self) -> &Elastic {
        self
    }

    #[inline(always)]
    fn stress(&self, _: usize, gamma: &Vec3, kappa: &Vec3, _: &Configuration) -> (Vec3, Vec3) {
        Elastic::stress(self, gamma, kappa)
    }

    #[inline(always)]
    fn linearise<'a>(
        &'a self,
        _: usize,
        (gamma, kappa): (&Vec3, &Vec3),
        _: &Configuration,
        _: Moduli,
        _: &'a mut Elastic,
    ) -> (Vec3, Vec3, &'a Elastic) {
        let (n, m) = Elastic::stress(self, gamma, kappa);
        (n, m, self)
    }

    fn energy(&self, _: usize, gamma: &Vec3, kappa: &Vec3, _: &Configuration) -> f64 {
        Elastic::energy(self, gamma, kappa)
    }
}
