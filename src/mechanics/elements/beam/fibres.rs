//! A section of fibres that yields; each fibre has a stress and separate history variables.
//!
//! The strains of a fibre are ε = Γ₁ + z κ₂ − y κ₃ and, where shear enters the yield condition, γ_a = s_a·(Γ₂, Γ₃, κ₁). The stiffness of
//! the elastic section less that of the elastic fibres acts beside them; with elastic shear it includes all of shear and torsion. It is
//! proportional to the area of intact fibres. An element with a section of failed fibres only is severed and has no force.

use super::fibre_lanes::{FibreLanes, FibresAsk};
use super::fibre_sum::FibreSum;
use super::lane_section::{Linearised, SectionStiffness};
use super::section::{BeamSection, BeamStiffness};
use crate::elements::block::Moduli;
use crate::materials::{Ask, Dissipation, FAILED_STIFFNESS, MaterialLaw, Spent, StressState};
use crate::sections::{BeamStresses, Fibre, Stiffness};
use crate::state::Configuration;
use base::math::lanes::LANES;
use base::math::number::{LaneVec3, Number};
use base::math::{Mat3, Vec3};
use std::sync::Arc;

/// The fibres of a section and their law, shared by all elements of a beam.
pub struct FibreProfile<S, const N: usize> {
    law: MaterialLaw,
    state: S,
    fibres: Vec<Fibre>,
    /// The number of history variables of a fibre.
    variables: usize,
    /// The elastic section, in section axes.
    whole: BeamStiffness,
    /// The elastic section less its elastic fibres, in section axes.
    rest: BeamStiffness,
    /// The fibres side by side.
    lanes: FibreLanes,
}

impl<S: StressState<N>, const N: usize> FibreProfile<S, N> {
    /// `state` says which stresses a fibre has; `section` is the stiffness of the whole elastic section.
    pub fn new(law: &MaterialLaw, state: S, fibres: &[Fibre], section: &Stiffness) -> Self {
        let stiffness = law.stiffness(state);
        let mut own = FibreSum::default();
        fibres.iter().for_each(|fibre| own.add(fibre, &stiffness));
        let own = own.section();
        let whole = BeamStiffness { N: section.N, M: section.M, NM: section.NM, coupled: true };
        let rest = BeamStiffness { N: whole.N - own.N, M: whole.M - own.M, NM: whole.NM - own.NM, coupled: true };
        FibreProfile {
            law: law.clone(),
            state,
            fibres: fibres.to_vec(),
            variables: law.history(state),
            whole,
            rest,
            lanes: FibreLanes::new(fibres),
        }
    }

    /// Strains of a fibre: axial, then shear.
    #[inline(always)]
    fn strain(fibre: &Fibre, gamma: &Vec3, kappa: &Vec3) -> [f64; N] {
        let mut strain = [0.0; N];
        strain[0] = gamma.x + fibre.z * kappa.y - fibre.y * kappa.z;
        for (strain, s) in strain[1..].iter_mut().zip(&fibre.shear) {
            *strain = s[0] * gamma.y + s[1] * gamma.z + s[2] * kappa.x;
        }
        strain
    }

    /// Each fibre with its history variables.
    #[inline(always)]
    fn with_history<'a>(&'a self, old: &'a [f64]) -> impl Iterator<Item = (&'a Fibre, &'a [f64])> {
        self.fibres.iter().zip(old.chunks_exact(self.variables))
    }

    /// The part of the area of the fibres that has not failed.
    #[inline]
    fn intact(&self, history: &[f64]) -> f64 {
        if !self.law.can_fail() {
            return 1.0;
        }
        let (mut intact, mut all) = (0.0, 0.0);
        for (fibre, old) in self.with_history(history) {
            all += fibre.area;
            if !self.law.has_failed(self.state, old) {
                intact += fibre.area;
            }
        }
        intact / all
    }

    /// Stress resultants in section axes where this part of the fibres is intact, and what is asked besides.
    #[inline(always)]
    fn respond(
        &self,
        (gamma, kappa): (&Vec3, &Vec3),
        intact: f64,
        now: &Configuration,
        ask: FibresAsk,
    ) -> (Vec3, Vec3) {
        let (mut n, mut m) = self.rest.stress(gamma, kappa);
        if intact < 1.0 {
            (n, m) = (intact * n, intact * m);
        }
        let (strain, before, sum) = ([gamma, kappa], (now.dt, now.history), [&mut n, &mut m]);
        match self.law.plain() {
            Some(law) => self.lanes.respond((&law, self.state), strain, before, ask, sum),
            None => self.lanes.respond((&self.law, self.state), strain, before, ask, sum),
        }
        (n, m)
    }

    /// Stress resultants and their algorithmic derivative in section axes: the elastic one less what yielding fibres lose.
    fn linearise(&self, strain: (&Vec3, &Vec3), intact: f64, now: &Configuration) -> (Vec3, Vec3, BeamStiffness) {
        if intact == 0.0 {
            return (Vec3::zeros(), Vec3::zeros(), self.whole.scaled(FAILED_STIFFNESS));
        }
        let mut loss = FibreSum::default();
        let (n, m) = self.respond(strain, intact, now, FibresAsk::Tangent(&self.fibres, &mut loss));
        let loss = loss.section();
        if intact < 1.0 {
            let left = self.whole.less(&loss).less(&self.rest.scaled(1.0 - intact));
            return (n, m, left);
        }
        let whole = &self.whole;
        let C = BeamStiffness { N: whole.N - loss.N, M: whole.M - loss.M, NM: whole.NM - loss.NM, coupled: true };
        (n, m, C)
    }
}

/// The sections of one element, one at each integration point.
pub struct FibreSection<S, const N: usize> {
    profile: Arc<FibreProfile<S, N>>,
    /// Section axes: columns, global components at t = 0.
    frame: Mat3,
    elastic: BeamStiffness,
    /// Start of its range in the history of the group.
    first: usize,
    points: usize,
}

impl<S: StressState<N>, const N: usize> FibreSection<S, N> {
    /// The sections of an element with `points` integration points, whose range in the history of the group starts at `first`.
    pub fn new(
        profile: &Arc<FibreProfile<S, N>>,
        section: &Stiffness,
        frame: &Mat3,
        first: usize,
        points: usize,
    ) -> Self {
        let elastic = BeamStiffness::new(section, frame);
        FibreSection { profile: Arc::clone(profile), frame: *frame, elastic, first, points }
    }

    /// The range of the history of the group that point `g` has.
    #[inline]
    fn history_range(&self, g: usize) -> std::ops::Range<usize> {
        let length = self.profile.variables * self.profile.fibres.len();
        let first = self.first + g * length;
        first..first + length
    }

    /// The intact fraction of the fibres of point `g`; 0 if another section of the element has no fibres left.
    #[inline]
    fn intact(&self, g: usize, history: &[f64]) -> f64 {
        if !self.profile.law.can_fail() {
            return 1.0;
        }
        let of = |g: usize| self.profile.intact(&history[self.history_range(g)]);
        if (0..self.points).any(|g| of(g) == 0.0) { 0.0 } else { of(g) }
    }

    /// Stress resultants at point `g` and their derivative.
    fn linearise_alone(
        &self,
        g: usize,
        (gamma, kappa): (&Vec3, &Vec3),
        now: &Configuration,
        moduli: Moduli,
    ) -> (Vec3, Vec3, BeamStiffness) {
        let intact = self.intact(g, now.history);
        if moduli == Moduli::Elastic && intact > 0.0 {
            let (n, m) = self.stress(g, gamma, kappa, now);
            return (n, m, self.elastic.clone());
        }
        let (gamma, kappa) = (self.frame.tr_mul(gamma), self.frame.tr_mul(kappa));
        let (n, m, C) = self.profile.linearise((&gamma, &kappa), intact, &self.at(g, now));
        (self.frame * n, self.frame * m, C.rotated(&self.frame))
    }

    /// Elastic energy per length at point `g` if the element had not failed, by the history variables of the group.
    fn stored(&self, g: usize, (gamma, kappa): (&Vec3, &Vec3), now: &Configuration) -> f64 {
        let FibreProfile { law, state, rest, .. } = &*self.profile;
        let (gamma, kappa) = (self.frame.tr_mul(gamma), self.frame.tr_mul(kappa));
        let now = self.at(g, now);
        let energy = |(fibre, old): (&Fibre, &[f64])| {
            fibre.area * law.elastic_energy(*state, &FibreProfile::<S, N>::strain(fibre, &gamma, &kappa), old)
        };
        let of_fibres = self.profile.with_history(now.history).map(energy).sum::<f64>();
        self.profile.intact(now.history) * rest.energy(&gamma, &kappa) + of_fibres
    }

    /// Stress at point `g`, and the dissipation per length after `part` of the step, whose history variables are written into `new`.
    fn step(
        &self,
        g: usize,
        (gamma, kappa): (&Vec3, &Vec3),
        now: &Configuration,
        part: f64,
        new: &mut [f64],
    ) -> (Vec3, Vec3, Dissipation) {
        let profile = &*self.profile;
        let (gamma, kappa) = (self.frame.tr_mul(gamma), self.frame.tr_mul(kappa));
        let before = self.intact(g, now.history);
        let now = self.at(g, now);
        let new = &mut new[self.history_range(g)];
        if before == 0.0 {
            new.copy_from_slice(now.history);
            return (Vec3::zeros(), Vec3::zeros(), Dissipation::default());
        }
        let mut spent = Spent::ZERO;
        let (n, m) = profile.respond((&gamma, &kappa), before, &now, FibresAsk::History(part, new, &mut spent));
        let mut spent = spent.lane(0);
        if profile.law.can_fail() {
            spent.eroded += (before - profile.intact(new)) * profile.rest.energy(&gamma, &kappa);
        }
        (self.frame * n, self.frame * m, spent)
    }

    /// The configuration with the history variables of point `g` alone.
    #[inline]
    fn at<'a>(&self, g: usize, now: &Configuration<'a>) -> Configuration<'a> {
        Configuration { history: &now.history[self.history_range(g)], ..*now }
    }
}

impl<S: StressState<N>, const N: usize> BeamSection for FibreSection<S, N> {
    fn points(_: usize, rule: usize) -> usize {
        rule
    }

    fn elastic(&self, _: usize) -> &BeamStiffness {
        &self.elastic
    }

    fn stress(&self, g: usize, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> (Vec3, Vec3) {
        let (gamma, kappa) = (self.frame.tr_mul(gamma), self.frame.tr_mul(kappa));
        let intact = self.intact(g, now.history);
        if intact == 0.0 {
            return (Vec3::zeros(), Vec3::zeros());
        }
        let (n, m) = self.profile.respond((&gamma, &kappa), intact, &self.at(g, now), FibresAsk::Stress);
        (self.frame * n, self.frame * m)
    }

    #[inline(always)]
    fn linearise<'a, T: Number>(
        sections: impl Fn(usize) -> &'a Self,
        g: usize,
        strain: &[LaneVec3<T>; 2],
        (now, moduli): (&Configuration, Moduli),
        _: &SectionStiffness<T>,
    ) -> Linearised<T>
    where
        Self: 'a,
    {
        let mut stress = [[Vec3::zeros(); LANES]; 2];
        let mut C = [const { BeamStiffness::ZERO }; LANES];
        for lane in 0..T::COUNT {
            let [gamma, kappa] = strain.map(|part| part.lane(lane));
            let of = sections(lane).linearise_alone(g, (&gamma, &kappa), now, moduli);
            (stress[0][lane], stress[1][lane], C[lane]) = of;
        }
        Linearised {
            stress: stress.map(|part| LaneVec3::gather(|lane| part[lane])),
            C: BeamStiffness::side_by_side(|lane| &C[lane]),
        }
    }

    fn energy(&self, g: usize, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> f64 {
        if self.has_failed(now.history) { 0.0 } else { self.stored(g, (gamma, kappa), now) }
    }

    fn update_history(
        &self,
        g: usize,
        strain: (&Vec3, &Vec3),
        now: &Configuration,
        part: f64,
        new: &mut [f64],
    ) -> Dissipation {
        self.step(g, strain, now, part, new).2
    }

    fn advance(
        &self,
        g: usize,
        strain: (&Vec3, &Vec3),
        now: &Configuration,
        new: &mut [f64],
    ) -> (Vec3, Vec3, Dissipation) {
        self.step(g, strain, now, 1.0, new)
    }

    fn can_fail(&self) -> bool {
        self.profile.law.can_fail()
    }

    fn has_failed(&self, history: &[f64]) -> bool {
        self.intact(0, history) == 0.0
    }

    fn lost(&self, g: usize, strain: (&Vec3, &Vec3), now: &Configuration) -> Dissipation {
        let FibreProfile { law, state, .. } = &*self.profile;
        let history = self.profile.with_history(&now.history[self.history_range(g)]);
        let kept = history.map(|(fibre, old)| fibre.area * law.lost(*state, old)).sum::<f64>();
        Dissipation { stored: -kept, eroded: kept + self.stored(g, strain, now), ..Dissipation::default() }
    }

    fn stresses(&self, g: usize, (gamma, kappa): (&Vec3, &Vec3), now: &Configuration) -> Option<BeamStresses> {
        let (gamma, kappa) = (self.frame.tr_mul(gamma), self.frame.tr_mul(kappa));
        let severed = self.intact(g, now.history) == 0.0;
        let (law, state, now) = (&self.profile.law, self.profile.state, self.at(g, now));
        let mut found = BeamStresses::default();
        for (fibre, old) in self.profile.with_history(now.history) {
            let strain = FibreProfile::<S, N>::strain(fibre, &gamma, &kappa);
            let stress =
                if severed { [0.0; N] } else { law.at_point(state, &strain, (now.dt, old), Ask::Stress).stress };
            found.include(stress[0], &stress[1..]);
        }
        Some(found)
    }

    fn plastic_strain(&self, g: usize, history: &[f64]) -> f64 {
        let FibreProfile { law, state, .. } = &*self.profile;
        let history = &history[self.history_range(g)];
        self.profile.with_history(history).map(|(_, old)| law.accumulated(*state, old)).fold(0.0, f64::max)
    }

    fn history(&self) -> usize {
        self.points * self.profile.variables * self.profile.fibres.len()
    }
}
