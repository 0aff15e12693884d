//! A section as fibres, each with a stress and a memory of its own: what yields.
//!
//! A fibre feels ε = Γ₁ + z κ₂ − y κ₃ and, where shear yields with it, γ_a = s_a·(Γ₂, Γ₃, κ₁). What the fibres leave of the
//! elastic section (all of shear and torsion where these stay elastic) answers beside them as a spring.

use super::section::{Elastic, Section};
use super::{Configuration, Moduli};
use crate::materials::{Dissipation, Law, StressState};
use crate::math::{Mat3, Mat6, Vec3};
use crate::sections::{Fibre, Stiffness};
use std::array::from_fn;
use std::sync::Arc;

/// The fibres of a section and their law; shared by all elements of a beam.
pub struct Profile<S, const N: usize> {
    law: Law,
    state: S,
    fibres: Vec<Fibre>,
    /// Numbers a fibre remembers.
    memory: usize,
    /// Of a fibre that does not yield.
    stiffness: [[f64; N]; N],
    /// The elastic section, and that less its elastic fibres; section axes.
    whole: Elastic,
    rest: Elastic,
}

impl<S: StressState<N>, const N: usize> Profile<S, N> {
    /// `state` says which stresses a fibre has; `section` is the elastic answer of the whole.
    pub fn new(law: &Law, state: S, fibres: &[Fibre], section: &Stiffness) -> Self {
        let stiffness = law.stiffness(state);
        let mut own = Sum::default();
        fibres.iter().for_each(|fibre| own.add(fibre, &stiffness));
        let own = own.section();
        let whole = Elastic { N: section.N, M: section.M, NM: section.NM, coupled: true };
        let rest = Elastic { N: whole.N - own.N, M: whole.M - own.M, NM: whole.NM - own.NM, coupled: true };
        Profile { law: law.clone(), state, fibres: fibres.to_vec(), memory: law.history(state), stiffness, whole, rest }
    }

    /// Strains of a fibre.
    #[inline(always)]
    fn strain(fibre: &Fibre, gamma: &Vec3, kappa: &Vec3) -> [f64; N] {
        let mut strain = [0.0; N];
        strain[0] = gamma.x + fibre.z * kappa.y - fibre.y * kappa.z;
        for (strain, s) in strain[1..].iter_mut().zip(&fibre.shear) {
            *strain = s[0] * gamma.y + s[1] * gamma.z + s[2] * kappa.x;
        }
        strain
    }

    /// What each fibre remembers.
    #[inline(always)]
    fn memories<'a>(&'a self, past: &'a [f64]) -> impl Iterator<Item = (&'a Fibre, &'a [f64])> {
        self.fibres.iter().zip(past.chunks_exact(self.memory))
    }

    #[inline]
    fn stress(&self, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> (Vec3, Vec3) {
        let (mut n, mut m) = self.rest.stress(gamma, kappa);
        for (fibre, past) in self.memories(now.history) {
            let strain = Self::strain(fibre, gamma, kappa);
            let stress = self.law.stress(self.state, &strain, now.dt, past);
            Self::add(fibre, &stress, &mut n, &mut m);
        }
        (n, m)
    }

    /// Work-conjugate to [`Profile::strain`].
    #[inline(always)]
    fn add(fibre: &Fibre, stress: &[f64; N], n: &mut Vec3, m: &mut Vec3) {
        let force = fibre.area * stress[0];
        n.x += force;
        m.y += fibre.z * force;
        m.z -= fibre.y * force;
        for (tau, s) in stress[1..].iter().zip(&fibre.shear) {
            let force = fibre.area * tau;
            n.y += s[0] * force;
            n.z += s[1] * force;
            m.x += s[2] * force;
        }
    }

    /// Stress and its algorithmic derivative, section axes: the elastic one, less what fibres lose that yield.
    fn linearise(&self, (gamma, kappa): (&Vec3, &Vec3), now: &Configuration) -> (Vec3, Vec3, Elastic) {
        let (mut n, mut m) = self.rest.stress(gamma, kappa);
        let mut loss = Sum::default();
        for (fibre, past) in self.memories(now.history) {
            let strain = Self::strain(fibre, gamma, kappa);
            let (stress, C) = self.law.linearise(self.state, &strain, now.dt, past);
            Self::add(fibre, &stress, &mut n, &mut m);
            if let Some(C) = C {
                loss.add::<N>(fibre, &from_fn(|i| from_fn(|j| self.stiffness[i][j] - C[i][j])));
            }
        }
        let (whole, loss) = (&self.whole, loss.section());
        let C = Elastic { N: whole.N - loss.N, M: whole.M - loss.M, NM: whole.NM - loss.NM, coupled: true };
        (n, m, C)
    }
}

/// Stiffnesses of fibres added up over (Γ₁, κ₂, κ₃), over (Γ₂, Γ₃, κ₁), and between them.
#[derive(Default)]
struct Sum {
    axial: Mat3,
    shear: Mat3,
    mixed: Mat3,
}

impl Sum {
    #[inline(always)]
    fn add<const N: usize>(&mut self, fibre: &Fibre, C: &[[f64; N]; N]) {
        let u = Vec3::new(1.0, fibre.z, -fibre.y);
        let weighted = fibre.area * u;
        self.axial += C[0][0] * weighted * u.transpose();
        for a in 1..N {
            let s_a = Vec3::from(fibre.shear[a - 1]);
            self.mixed += C[0][a] * weighted * s_a.transpose();
            for b in 1..N {
                self.shear += (fibre.area * C[a][b]) * s_a * Vec3::from(fibre.shear[b - 1]).transpose();
            }
        }
    }

    fn section(&self) -> Elastic {
        const AXIAL: [usize; 3] = [0, 4, 5];
        const SHEAR: [usize; 3] = [1, 2, 3];
        let mut C = Mat6::zeros();
        for i in 0..3 {
            for j in 0..3 {
                C[(AXIAL[i], AXIAL[j])] = self.axial[(i, j)];
                C[(SHEAR[i], SHEAR[j])] = self.shear[(i, j)];
                C[(AXIAL[i], SHEAR[j])] = self.mixed[(i, j)];
                C[(SHEAR[j], AXIAL[i])] = self.mixed[(i, j)];
            }
        }
        let part = |i, j| C.fixed_view::<3, 3>(i, j).into_owned();
        Elastic { N: part(0, 0), M: part(3, 3), NM: part(0, 3), coupled: true }
    }
}

/// The sections of one element.
pub struct Fibred<S, const N: usize> {
    profile: Arc<Profile<S, N>>,
    /// Section axes as columns, global at t = 0.
    frame: Mat3,
    elastic: Elastic,
    /// Where its share of the group's history begins.
    first: usize,
    points: usize,
}

impl<S: StressState<N>, const N: usize> Fibred<S, N> {
    /// With `points` integration points; its share of the group's history begins at `first`.
    pub fn new(profile: &Arc<Profile<S, N>>, section: &Stiffness, frame: &Mat3, first: usize, points: usize) -> Self {
        let elastic = Elastic::new(section, frame);
        Fibred { profile: Arc::clone(profile), frame: *frame, elastic, first, points }
    }

    /// What the fibres of point `g` remember, as a range of the group's history.
    #[inline]
    fn share(&self, g: usize) -> std::ops::Range<usize> {
        let length = self.profile.memory * self.profile.fibres.len();
        let first = self.first + g * length;
        first..first + length
    }

    #[inline]
    fn at<'a>(&self, g: usize, now: &Configuration<'a>) -> Configuration<'a> {
        Configuration { history: &now.history[self.share(g)], ..*now }
    }
}

impl<S: StressState<N>, const N: usize> Section for Fibred<S, N> {
    fn points(_: usize, rule: usize) -> usize {
        rule
    }

    fn elastic(&self) -> &Elastic {
        &self.elastic
    }

    fn stress(&self, g: usize, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> (Vec3, Vec3) {
        let (gamma, kappa) = (self.frame.tr_mul(gamma), self.frame.tr_mul(kappa));
        let (n, m) = self.profile.stress(&gamma, &kappa, &self.at(g, now));
        (self.frame * n, self.frame * m)
    }

    fn linearise<'a>(
        &'a self,
        g: usize,
        (gamma, kappa): (&Vec3, &Vec3),
        now: &Configuration,
        moduli: Moduli,
        room: &'a mut Elastic,
    ) -> (Vec3, Vec3, &'a Elastic) {
        if moduli == Moduli::Elastic {
            let (n, m) = self.stress(g, gamma, kappa, now);
            return (n, m, &self.elastic);
        }
        let (gamma, kappa) = (self.frame.tr_mul(gamma), self.frame.tr_mul(kappa));
        let (n, m, C) = self.profile.linearise((&gamma, &kappa), &self.at(g, now));
        *room = C.turned(&self.frame);
        (self.frame * n, self.frame * m, room)
    }

    fn energy(&self, g: usize, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> f64 {
        let Profile { law, state, rest, .. } = &*self.profile;
        let (gamma, kappa) = (self.frame.tr_mul(gamma), self.frame.tr_mul(kappa));
        let now = self.at(g, now);
        let of = |(fibre, past): (&Fibre, &[f64])| {
            fibre.area * law.elastic_energy(*state, &Profile::<S, N>::strain(fibre, &gamma, &kappa), past)
        };
        rest.energy(&gamma, &kappa) + self.profile.memories(now.history).map(of).sum::<f64>()
    }

    fn update_history(
        &self,
        g: usize,
        (gamma, kappa): (&Vec3, &Vec3),
        now: &Configuration,
        part: f64,
        history: &mut [f64],
    ) -> Dissipation {
        let Profile { law, state, memory, .. } = &*self.profile;
        let (gamma, kappa) = (self.frame.tr_mul(gamma), self.frame.tr_mul(kappa));
        let now = self.at(g, now);
        let mut sum = Dissipation::default();
        let history = history[self.share(g)].chunks_exact_mut(*memory);
        for ((fibre, past), new) in self.profile.memories(now.history).zip(history) {
            let strain = Profile::<S, N>::strain(fibre, &gamma, &kappa);
            let spent = law.advance(*state, &strain, (now.dt, part), past, new).1;
            sum += spent * fibre.area;
        }
        sum
    }

    fn plastic_strain(&self, g: usize, past: &[f64]) -> f64 {
        let Profile { law, state, .. } = &*self.profile;
        let past = &past[self.share(g)];
        self.profile.memories(past).map(|(_, past)| law.accumulated(*state, past)).fold(0.0, f64::max)
    }

    fn history(&self) -> usize {
        self.points * self.profile.memory * self.profile.fibres.len()
    }
}
