//! A section of fibres of several materials under normal stress alone, such as concrete with bars of steel.
//!
//! The strain of a fibre is ε = Γ₁ + z κ₂ − y κ₃. Shear and torsion stay elastic, with the stiffness of the section before anything cracks or yields.

use super::fibre_sum::FibreSum;
use super::lane_section::{Linearised, SectionStiffness};
use super::section::{BeamSection, BeamStiffness};
use crate::elements::block::Moduli;
use crate::materials::Dissipation;
use crate::materials::uniaxial::{PointLaw, UniaxialLaw};
use crate::sections::{BeamStresses, Fibre, Stiffness};
use crate::state::Configuration;
use base::math::lanes::LANES;
use base::math::number::{LaneVec3, Number};
use base::math::{Mat3, Vec3};
use std::sync::Arc;

/// Fibres of one material.
#[derive(Debug, Clone)]
pub struct FibreGroup<L = UniaxialLaw> {
    /// Their law.
    pub law: L,
    /// The fibres in section axes. Areas below zero take away what other fibres displace.
    pub fibres: Vec<Fibre>,
}

/// The fibres of a section at an integration point.
pub struct CompositeProfile {
    groups: Vec<FibreGroup<PointLaw>>,
    /// The number of history variables of the section.
    variables: usize,
    /// The section before anything cracks or yields, in section axes.
    whole: BeamStiffness,
    /// Its shear and torsion alone.
    shear: BeamStiffness,
}

/// The strain of a fibre.
#[inline(always)]
fn strain(fibre: &Fibre, [gamma, kappa]: [&Vec3; 2]) -> f64 {
    gamma.x + fibre.z * kappa.y - fibre.y * kappa.z
}

impl CompositeProfile {
    /// The fibres at a point that stands for this length of the beam. `section` gives the stiffness in shear and torsion.
    pub fn new(groups: &[FibreGroup], length: f64, section: &Stiffness) -> Self {
        let mut own = FibreSum::default();
        for group in groups {
            group.fibres.iter().for_each(|fibre| own.add(fibre, &[[group.law.modulus()]]));
        }
        let of_point =
            |group: &FibreGroup| FibreGroup { law: group.law.of_length(length), fibres: group.fibres.clone() };
        let groups: Vec<_> = groups.iter().map(of_point).collect();
        let only =
            |K: &Mat3, keep: fn(usize, usize) -> bool| Mat3::from_fn(|i, j| if keep(i, j) { K[(i, j)] } else { 0.0 });
        let shear = BeamStiffness {
            N: only(&section.N, |i, j| i > 0 && j > 0),
            M: only(&section.M, |i, j| i == 0 && j == 0),
            NM: only(&section.NM, |i, j| i > 0 && j == 0),
            coupled: true,
        };
        let variables = groups.iter().map(|group| group.fibres.len() * group.law.variables()).sum();
        CompositeProfile { groups, variables, whole: shear.plus(&own.section()), shear }
    }

    /// Each fibre with its law and its place in the history of the section.
    #[inline(always)]
    fn each<'a>(&'a self, mut visit: impl FnMut(&'a PointLaw, &'a Fibre, std::ops::Range<usize>)) {
        let mut first = 0;
        for group in &self.groups {
            let variables = group.law.variables();
            for fibre in &group.fibres {
                visit(&group.law, fibre, first..first + variables);
                first += variables;
            }
        }
    }

    /// Stress resultants and the stiffness, in section axes.
    fn linearise(&self, of: [&Vec3; 2], now: &Configuration) -> (Vec3, Vec3, BeamStiffness) {
        let (mut n, mut m) = self.shear.stress(of[0], of[1]);
        let mut sum = FibreSum::default();
        self.each(|law, fibre, at| {
            let [stress, slope] = law.respond(strain(fibre, of), (now.dt, &now.history[at]));
            add(fibre, stress, [&mut n, &mut m]);
            sum.add(fibre, &[[slope]]);
        });
        (n, m, self.shear.plus(&sum.section()))
    }

    /// Stress resultants in section axes.
    fn stress(&self, of: [&Vec3; 2], now: &Configuration) -> (Vec3, Vec3) {
        let (mut n, mut m) = self.shear.stress(of[0], of[1]);
        self.each(|law, fibre, at| {
            let [stress, _] = law.respond(strain(fibre, of), (now.dt, &now.history[at]));
            add(fibre, stress, [&mut n, &mut m]);
        });
        (n, m)
    }
}

/// Adds the stress of a fibre to the resultants n and m.
#[inline(always)]
fn add(fibre: &Fibre, stress: f64, [n, m]: [&mut Vec3; 2]) {
    let force = fibre.area * stress;
    n.x += force;
    m.y += fibre.z * force;
    m.z -= fibre.y * force;
}

/// The sections of one element, one at each integration point.
pub struct CompositeSection {
    /// The fibres of each point.
    profiles: Vec<Arc<CompositeProfile>>,
    /// Section axes: columns, global components at t = 0.
    frame: Mat3,
    elastic: BeamStiffness,
    /// Start of its range in the history of the group.
    first: usize,
}

impl CompositeSection {
    /// The sections of an element, whose range in the history of the group starts at `first`.
    pub fn new(profiles: Vec<Arc<CompositeProfile>>, frame: &Mat3, first: usize) -> Self {
        let elastic = profiles[0].whole.rotated(frame);
        CompositeSection { profiles, frame: *frame, elastic, first }
    }

    /// The range of the history of the group that point `g` has.
    #[inline]
    fn history_range(&self, g: usize) -> std::ops::Range<usize> {
        // All points have the same fibres.
        let length = self.profiles[g].variables;
        let first = self.first + g * length;
        first..first + length
    }

    /// The configuration with the history variables of point `g` alone.
    #[inline]
    fn at<'a>(&self, g: usize, now: &Configuration<'a>) -> Configuration<'a> {
        Configuration { history: &now.history[self.history_range(g)], ..*now }
    }

    /// Strains in section axes.
    #[inline]
    fn own(&self, gamma: &Vec3, kappa: &Vec3) -> [Vec3; 2] {
        [self.frame.tr_mul(gamma), self.frame.tr_mul(kappa)]
    }

    /// Stress resultants at point `g` and their derivative.
    fn linearise_alone(
        &self,
        g: usize,
        [gamma, kappa]: [&Vec3; 2],
        now: &Configuration,
        moduli: Moduli,
    ) -> (Vec3, Vec3, BeamStiffness) {
        if moduli == Moduli::Elastic {
            let (n, m) = self.stress(g, gamma, kappa, now);
            return (n, m, self.elastic.clone());
        }
        let of = self.own(gamma, kappa);
        let (n, m, C) = self.profiles[g].linearise(of.each_ref(), &self.at(g, now));
        (self.frame * n, self.frame * m, C.rotated(&self.frame))
    }
}

impl BeamSection for CompositeSection {
    fn points(_: usize, rule: usize) -> usize {
        rule
    }

    fn elastic(&self, _: usize) -> &BeamStiffness {
        &self.elastic
    }

    fn stress(&self, g: usize, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> (Vec3, Vec3) {
        let of = self.own(gamma, kappa);
        let (n, m) = self.profiles[g].stress(of.each_ref(), &self.at(g, now));
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
            let of = strain.map(|part| part.lane(lane));
            let answer = sections(lane).linearise_alone(g, of.each_ref(), now, moduli);
            (stress[0][lane], stress[1][lane], C[lane]) = answer;
        }
        Linearised {
            stress: stress.map(|part| LaneVec3::gather(|lane| part[lane])),
            C: BeamStiffness::side_by_side(|lane| &C[lane]),
        }
    }

    fn energy(&self, g: usize, gamma: &Vec3, kappa: &Vec3, now: &Configuration) -> f64 {
        let [gamma, kappa] = self.own(gamma, kappa);
        let (profile, now) = (&self.profiles[g], self.at(g, now));
        let mut sum = profile.shear.energy(&gamma, &kappa);
        profile.each(|law, fibre, at| {
            sum += fibre.area * law.energy(strain(fibre, [&gamma, &kappa]), &now.history[at]);
        });
        sum
    }

    fn update_history(
        &self,
        g: usize,
        strain: (&Vec3, &Vec3),
        now: &Configuration,
        part: f64,
        new: &mut [f64],
    ) -> Dissipation {
        let [gamma, kappa] = self.own(strain.0, strain.1);
        let (now, new) = (self.at(g, now), &mut new[self.history_range(g)]);
        let mut spent = Dissipation::default();
        self.profiles[g].each(|law, fibre, at| {
            let strain = self::strain(fibre, [&gamma, &kappa]);
            let more = law.advance(strain, (now.dt, &now.history[at.clone()]), part, &mut new[at]);
            spent += more * fibre.area;
        });
        spent
    }

    fn plastic_strain(&self, g: usize, history: &[f64]) -> f64 {
        let history = &history[self.history_range(g)];
        let mut most = 0.0f64;
        self.profiles[g].each(|law, _, at| most = most.max(law.plastic_strain(&history[at])));
        most
    }

    fn stresses(&self, g: usize, (gamma, kappa): (&Vec3, &Vec3), now: &Configuration) -> Option<BeamStresses> {
        let (of, now) = (self.own(gamma, kappa), self.at(g, now));
        let mut found = BeamStresses::default();
        self.profiles[g].each(|law, fibre, at| {
            if fibre.area > 0.0 {
                found.include(law.respond(strain(fibre, of.each_ref()), (now.dt, &now.history[at]))[0], &[]);
            }
        });
        Some(found)
    }

    fn history(&self) -> usize {
        self.profiles.iter().map(|profile| profile.variables).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::uniaxial::{ConcreteModel, MenegottoPinto, Softening};
    use crate::sections::SectionShape;
    use crate::sections::rectangle::Rectangle;
    use base::math::Vec6;
    use rand::{RngExt, SeedableRng, rngs::SmallRng};

    /// A rectangle of 0.4 x 0.5 with a core and three bars, the bars on one side.
    fn groups() -> (Vec<FibreGroup>, Stiffness) {
        let shape = Rectangle { width: 0.4, height: 0.5 };
        let [cover, mut core] = shape.cover_and_core(0.04, [4, 6]).unwrap();
        let bars = [-0.1, 0.0, 0.1].map(|y| Fibre { area: 3e-4, y, z: 0.19, shear: [[0.0; 3]; 2] });
        core.extend(bars.map(|bar| Fibre { area: -bar.area, ..bar }));
        let concrete = |strength: f64, crushing: f64| {
            UniaxialLaw::Concrete(ConcreteModel {
                modulus: 30e9,
                strength,
                residual: 0.2 * strength,
                crushing: Softening::Strain(crushing),
                tensile_strength: 2.5e6,
                cracking: Softening::Energy(100.0),
                unloading_ratio: 0.1,
            })
        };
        let steel = UniaxialLaw::MenegottoPinto(MenegottoPinto {
            modulus: 200e9,
            yield_stress: 500e6,
            hardening_ratio: 0.01,
            curvature: [20.0, 0.925, 0.15],
            isotropic: [0.0, 1.0, 0.0, 1.0],
        });
        let groups = vec![
            FibreGroup { law: concrete(30e6, 0.006), fibres: cover },
            FibreGroup { law: concrete(39e6, 0.02), fibres: core },
            FibreGroup { law: steel, fibres: bars.to_vec() },
        ];
        (groups, shape.section(0.2).unwrap().stiffness(30e9, 0.2, 0.0))
    }

    /// Areas and moments of the elastic section by hand: the concrete, and 170 GPa more at each bar.
    #[test]
    fn the_elastic_section_is_that_of_concrete_and_bars() {
        let (groups, section) = groups();
        let whole = CompositeProfile::new(&groups, 0.2, &section).whole;
        let (concrete, bar) = (30e9 * 0.4 * 0.5, 170e9 * 3e-4);
        let close =
            |value: f64, exact: f64| assert!((value - exact).abs() < 1e-12 * exact.abs(), "{value} for {exact}");
        close(whole.N[(0, 0)], concrete + 3.0 * bar);
        close(whole.M[(1, 1)], concrete * 0.25 / 12.0 + 3.0 * bar * 0.19f64.powi(2));
        close(whole.M[(2, 2)], concrete * 0.16 / 12.0 + 2.0 * bar * 0.01);
        close(whole.NM[(0, 1)], 3.0 * bar * 0.19);
        close(whole.N[(1, 1)], section.N[(1, 1)]);
        close(whole.M[(0, 0)], section.M[(0, 0)]);
    }

    /// The tangent of random states against differences of the resultants. Where a fibre bends within the difference, one side agrees.
    #[test]
    fn the_tangent_is_the_derivative_of_the_resultants() {
        let (groups, section) = groups();
        let profile = Arc::new(CompositeProfile::new(&groups, 0.2, &section));
        let section = CompositeSection::new(vec![profile], &Mat3::identity(), 0);
        let mut random = SmallRng::seed_from_u64(8);
        let mut history = vec![0.0; section.history()];
        let scale = [2e-3, 1e-3, 1e-3, 2e-3, 8e-3, 8e-3];
        for _ in 0..200 {
            let mut any = || Vec6::from_fn(|i, _| scale[i] * random.random_range(-1.0..1.0));
            let (to, at) = (any(), any());
            let parts = |e: &Vec6| (Vec3::new(e[0], e[1], e[2]), Vec3::new(e[3], e[4], e[5]));
            let old = history.clone();
            let (gamma, kappa) = parts(&to);
            let now = |history| Configuration { history, ..Configuration::of(&[]) };
            section.update_history(0, (&gamma, &kappa), &now(&old), 1.0, &mut history);
            let now = now(&history);
            let (gamma, kappa) = parts(&at);
            let (_, _, C) = section.linearise_alone(0, [&gamma, &kappa], &now, Moduli::Algorithmic);
            for j in 0..6 {
                let h = 1e-6 * scale[j];
                let side = |h: f64| {
                    let mut e = at;
                    e[j] += h;
                    let (gamma, kappa) = parts(&e);
                    section.stress(0, &gamma, &kappa, &now)
                };
                let (n0, m0) = side(0.0);
                let (k, whole) = (j % 3, &section.elastic);
                let [cn, cm, sizes] = match j {
                    0..3 => [C.N.column(k).into_owned(), C.NM.row(k).transpose(), Vec3::new(whole.N[(k, k)], 0.0, 0.0)],
                    _ => {
                        [C.NM.column(k).into_owned(), C.M.column(k).into_owned(), Vec3::new(whole.M[(k, k)], 0.0, 0.0)]
                    }
                };
                let error = [h, -h].map(|h| {
                    let (n, m) = side(h);
                    ((n - n0) / h - cn).amax().max(((m - m0) / h - cm).amax()) / sizes.x
                });
                // The second derivative over h: 20 h over the yield strain in the knee of a bar.
                assert!(error[0].min(error[1]) < 2e-5, "{j}: {error:?}");
            }
        }
    }

    /// The work of the resultants on a random path is the energy that unloading returns and the dissipation. The trapezoidal rule of 2000 pieces
    /// errs by their square.
    #[test]
    fn work_is_energy_and_dissipation() {
        let (groups, section) = groups();
        let profile = Arc::new(CompositeProfile::new(&groups, 0.2, &section));
        let section = CompositeSection::new(vec![profile], &Mat3::identity(), 0);
        let mut random = SmallRng::seed_from_u64(11);
        let mut history = vec![0.0; section.history()];
        let scale = [2e-3, 1e-3, 1e-3, 2e-3, 8e-3, 8e-3];
        let (mut at, mut old, mut work, mut spent) = (Vec6::zeros(), Vec6::zeros(), 0.0, 0.0);
        for _ in 0..6 {
            let to = Vec6::from_fn(|i, _| scale[i] * random.random_range(-1.0..1.0));
            let step = (to - at) / 2000.0;
            for _ in 0..2000 {
                at += step;
                let before = history.clone();
                let now = Configuration { history: &before, ..Configuration::of(&[]) };
                let (gamma, kappa) = (at.fixed_rows::<3>(0).into_owned(), at.fixed_rows::<3>(3).into_owned());
                let (n, m, more) = section.advance(0, (&gamma, &kappa), &now, &mut history);
                let new = Vec6::new(n.x, n.y, n.z, m.x, m.y, m.z);
                work += 0.5 * (old + new).dot(&step);
                (old, spent) = (new, spent + more.plastic);
            }
        }
        let now = Configuration { history: &history, ..Configuration::of(&[]) };
        let (gamma, kappa) = (at.fixed_rows::<3>(0).into_owned(), at.fixed_rows::<3>(3).into_owned());
        let energy = section.energy(0, &gamma, &kappa, &now);
        assert!((work - energy - spent).abs() < 1e-5 * work, "{work} for {energy} and {spent}");
        assert!(spent > 0.3 * work, "{spent} of {work}");
    }
}
