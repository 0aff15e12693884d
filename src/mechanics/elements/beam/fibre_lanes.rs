//! Fibres of a section eight at a time, with the bits that each has by itself.

use crate::materials::{EightPoints, MaterialLaw, PointsHistory, StressState};
use crate::sections::Fibre;
use base::math::Vec3;
use base::math::lanes::{LANES, Lanes, lanes};
use std::array::from_fn;

/// The fibres of a section side by side, under a law that is plain enough.
pub struct FibreLanes<S, const N: usize> {
    law: EightPoints<S, N>,
    packs: Vec<FibrePack>,
}

/// Up to eight fibres; lanes beyond the last repeat it.
struct FibrePack {
    count: usize,
    y: Lanes,
    z: Lanes,
    shear: [[Lanes; 3]; 2],
}

impl<S: StressState<N>, const N: usize> FibreLanes<S, N> {
    /// `None` where fibres must be computed one by one.
    pub fn new(law: &MaterialLaw, state: S, fibres: &[Fibre]) -> Option<Self> {
        let pack = |fibres: &[Fibre]| {
            let at = |lane: usize| &fibres[lane.min(fibres.len() - 1)];
            FibrePack {
                count: fibres.len(),
                y: lanes(|lane| at(lane).y),
                z: lanes(|lane| at(lane).z),
                shear: from_fn(|i| from_fn(|j| lanes(|lane| at(lane).shear[i][j]))),
            }
        };
        Some(FibreLanes { law: EightPoints::new(law, state)?, packs: fibres.chunks(LANES).map(pack).collect() })
    }

    /// Writes the history variables `dt` after `old` into `new` and calls `of` for each fibre, by number, with its stress and what its
    /// yielding dissipates, per volume.
    #[inline]
    pub fn advance(
        &self,
        (gamma, kappa): (&Vec3, &Vec3),
        dt: f64,
        (old, new): (&[f64], &mut [f64]),
        mut of: impl FnMut(usize, &[f64; N], f64),
    ) {
        let [g, k] = [gamma, kappa].map(|v| [v.x, v.y, v.z].map(Lanes::splat));
        for (place, FibrePack { count, y, z, shear }) in self.packs.iter().enumerate() {
            let strain = from_fn(|i| match i {
                0 => g[0] + *z * k[1] - *y * k[2],
                _ => shear[i - 1][0] * g[1] + shear[i - 1][1] * g[2] + shear[i - 1][2] * k[0],
            });
            let first = place * LANES;
            let at = from_fn(|lane| (first + lane.min(count - 1)) * (N + 1));
            let history = PointsHistory { at, count: *count, old, new: Some(&mut *new) };
            let (stress, spent) = self.law.advance(&strain, dt, history);
            let (stress, spent) = (stress.map(Lanes::to_array), spent.to_array());
            for lane in 0..*count {
                of(first + lane, &from_fn(|i| stress[i][lane]), spent[lane]);
            }
        }
    }
}
