//! A law for eight points at once with their history variables, where it is plain enough: the numbers are those of
//! [`MaterialLaw::advance`].

use super::law::MaterialLaw;
use super::side_by_side::{PlainPlasticity, PointsAdvanced};
use super::stress_state::StressState;
use base::math::lanes::{LANES, Lanes, lanes};
use std::array::from_fn;

/// A plastic law without viscosity, failure and kinematic hardening and with linear hardening, for eight points at once.
#[derive(Debug, Clone)]
pub struct EightPoints<S, const N: usize> {
    law: MaterialLaw,
    plain: PlainPlasticity<N>,
    state: S,
}

/// The history variables that eight points have and get.
pub struct PointsHistory<'a> {
    /// Where the variables of each point start.
    pub at: [usize; LANES],
    /// The number of points; lanes beyond them have no history to write.
    pub count: usize,
    /// The variables before.
    pub old: &'a [f64],
    /// The variables to be written, where they are.
    pub new: Option<&'a mut [f64]>,
}

impl<S: StressState<N>, const N: usize> EightPoints<S, N> {
    /// `None` for a law that is not so plain.
    pub fn new(law: &MaterialLaw, state: S) -> Option<Self> {
        Some(EightPoints { law: law.clone(), plain: law.plain(state)?, state })
    }

    /// Stress at `strain`, `dt` after the old history, and the energy that yielding dissipates, per volume; writes the new history.
    #[inline(always)]
    pub fn advance(&self, strain: &[Lanes; N], dt: f64, mut history: PointsHistory) -> ([Lanes; N], Lanes) {
        let PointsHistory { at, count, old, new } = &mut history;
        let own: [&[f64]; LANES] = from_fn(|lane| &old[at[lane]..at[lane] + N + 1]);
        let plastic = from_fn(|i| lanes(|lane| own[lane][i]));
        let mut end = self.plain.advance::<S>(strain, &plastic, lanes(|lane| own[lane][N]));
        if let Some(new) = new {
            let plastic = end.plastic.map(Lanes::to_array);
            let accumulated = end.accumulated.to_array();
            for lane in 0..*count {
                let new = &mut new[at[lane]..at[lane] + N + 1];
                (0..N).for_each(|i| new[i] = plastic[i][lane]);
                new[N] = accumulated[lane];
            }
        }
        if end.left != 0 {
            self.one_by_one(strain, dt, history, &mut end);
        }
        (end.stress, end.spent)
    }

    /// Stress at `strain`, and what the derivative of the stress has lost against the elastic stiffness; `None` where no point yields.
    #[inline(always)]
    pub fn linearise(
        &self,
        strain: &[Lanes; N],
        dt: f64,
        history: PointsHistory,
    ) -> ([Lanes; N], Option<[[Lanes; N]; N]>) {
        let own: [&[f64]; LANES] = from_fn(|lane| &history.old[history.at[lane]..history.at[lane] + N + 1]);
        let plastic = from_fn(|i| lanes(|lane| own[lane][i]));
        let (mut stress, tangent) = self.plain.linearise::<S>(strain, &plastic, lanes(|lane| own[lane][N]));
        let Some(tangent) = tangent else { return (stress, None) };
        let elastic = self.law.stiffness(self.state);
        let mut lost = from_fn(|i| {
            from_fn(|j| tangent.yields.select(Lanes::splat(elastic[i][j]) - tangent.stiffness[i][j], Lanes::ZERO))
        });
        if tangent.left != 0 {
            self.linearise_one_by_one(strain, dt, (own, tangent.left), &mut stress, &mut lost);
        }
        (stress, Some(lost))
    }

    /// Linearises the points that are left by themselves.
    #[cold]
    fn linearise_one_by_one(
        &self,
        strain: &[Lanes; N],
        dt: f64,
        (own, left): ([&[f64]; LANES], u32),
        stress: &mut [Lanes; N],
        lost: &mut [[Lanes; N]; N],
    ) {
        let (strain, elastic) = (strain.map(Lanes::to_array), self.law.stiffness(self.state));
        for lane in (0..LANES).filter(|lane| left >> lane & 1 == 1) {
            let (sigma, C) = self.law.stress_and_tangent(self.state, &from_fn(|i| strain[i][lane]), dt, own[lane]);
            let put = |of: &mut Lanes, value: f64| of.as_mut_array()[lane] = value;
            for i in 0..N {
                put(&mut stress[i], sigma[i]);
                (0..N).for_each(|j| put(&mut lost[i][j], elastic[i][j] - C[i][j]));
            }
        }
    }

    /// Computes the points that are left by themselves.
    #[cold]
    fn one_by_one(&self, strain: &[Lanes; N], dt: f64, mut history: PointsHistory, end: &mut PointsAdvanced<N>) {
        let strain = strain.map(Lanes::to_array);
        let (mut stress, mut spent) = (end.stress.map(Lanes::to_array), end.spent.to_array());
        for lane in (0..history.count).filter(|lane| end.left >> lane & 1 == 1) {
            let at = history.at[lane]..history.at[lane] + N + 1;
            let (strain, old) = (from_fn(|i| strain[i][lane]), &history.old[at.clone()]);
            // A point that is not to be remembered writes over what no one reads.
            let mut nowhere = [0.0; 8];
            let new = match &mut history.new {
                Some(new) => &mut new[at],
                None => &mut nowhere[..N + 1],
            };
            let (sigma, dissipation) = self.law.advance(self.state, &strain, (dt, 1.0), old, new);
            (0..N).for_each(|i| stress[i][lane] = sigma[i]);
            spent[lane] = dissipation.plastic;
        }
        (end.stress, end.spent) = (stress.map(Lanes::new), Lanes::new(spent));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{FailureCriterion, FibreStress, Hardening, PlaneStress, Uniaxial};
    use rand::{RngExt, SeedableRng};

    /// Strains from far below yield to far beyond, from histories of earlier steps, with hardening and without: the same bits.
    fn agrees<S: StressState<N>, const N: usize>(state: S) {
        let mut rng = rand::rngs::StdRng::seed_from_u64(3);
        for modulus in [0.0, 2e9, 150e9] {
            let law = MaterialLaw::new(210e9, 0.3, Hardening::Linear { yield_stress: 250e6, modulus }, 0.0, None);
            let eight = EightPoints::new(&law, state).unwrap();
            let size = N + 1;
            let mut old = vec![0.0; LANES * size];
            for step in 0..200 {
                let scale = [1e-5, 1e-3, 1e-2, 1.0, 1e160][step % if step < 100 { 4 } else { 5 }];
                let strain: [[f64; LANES]; N] = from_fn(|_| from_fn(|_| scale * rng.random_range(-1.0..1.0)));
                let (mut new, mut alone) = (old.clone(), old.clone());
                let history =
                    PointsHistory { at: from_fn(|lane| lane * size), count: LANES, old: &old, new: Some(&mut new) };
                let before = PointsHistory { at: from_fn(|lane| lane * size), count: LANES, old: &old, new: None };
                let (linear, lost) = eight.linearise(&strain.map(Lanes::new), 1e-6, before);
                let (stress, spent) = eight.advance(&strain.map(Lanes::new), 1e-6, history);
                let (stress, spent) = (stress.map(Lanes::to_array), spent.to_array());
                for lane in 0..LANES {
                    let at = lane * size..(lane + 1) * size;
                    let one = from_fn(|i| strain[i][lane]);
                    let (tau, C) = law.stress_and_tangent(state, &one, 1e-6, &old[at.clone()]);
                    let elastic = law.stiffness(state);
                    for i in 0..N {
                        assert_eq!(linear[i].to_array()[lane], tau[i], "{scale:e}, lane {lane}");
                        for j in 0..N {
                            let lost = lost.map_or(0.0, |lost| lost[i][j].to_array()[lane]);
                            // Rounding of a few products of the size of the stiffness.
                            let error = (lost - (elastic[i][j] - C[i][j])).abs();
                            assert!(error < 1e-14 * elastic[0][0], "{scale:e}, lane {lane}: {error:e}");
                        }
                    }
                    let (sigma, own) = law.advance(state, &one, (1e-6, 1.0), &old[at.clone()], &mut alone[at]);
                    assert_eq!(from_fn::<f64, N, _>(|i| stress[i][lane]), sigma, "{scale:e}, lane {lane}");
                    assert_eq!(spent[lane], own.plastic, "{scale:e}, lane {lane}");
                }
                assert_eq!(new, alone);
                if scale < 1.0 {
                    old = new;
                }
            }
        }
    }

    #[test]
    fn eight_points_are_one_eight_times() {
        agrees(PlaneStress);
        agrees(FibreStress);
        agrees(Uniaxial);
    }

    #[test]
    fn other_laws_are_left_to_themselves() {
        let linear = Hardening::Linear { yield_stress: 1.0, modulus: 0.1 };
        let law = |share| MaterialLaw::new(1.0, 0.3, linear.clone(), share, None);
        assert!(EightPoints::new(&law(0.0), Uniaxial).is_some());
        assert!(EightPoints::new(&law(0.5), Uniaxial).is_none());
        assert!(EightPoints::new(&law(0.0).failing_at(FailureCriterion::at(0.1)), Uniaxial).is_none());
        let table = Hardening::table(vec![[0.0, 1.0], [1.0, 2.0]]).unwrap();
        assert!(EightPoints::new(&MaterialLaw::new(1.0, 0.3, table, 0.0, None), Uniaxial).is_none());
    }
}
