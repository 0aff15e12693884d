//! Fibres of a section eight at a time; a fibre has bitwise the same result alone.

use crate::materials::{Ask, Dissipation, MaterialLaw, Spent, StressState};
use crate::sections::Fibre;
use base::math::Vec3;
use base::math::lanes::{LANES, Lanes, lanes};
use std::array::from_fn;

/// The fibres of a section side by side.
pub struct FibreLanes(Vec<FibrePack>);

/// Up to eight fibres; lanes beyond the last repeat it.
struct FibrePack {
    count: usize,
    y: Lanes,
    z: Lanes,
    shear: [[Lanes; 3]; 2],
}

impl FibreLanes {
    /// Packs the fibres of a section.
    pub fn new(fibres: &[Fibre]) -> Self {
        let pack = |fibres: &[Fibre]| {
            let at = |lane: usize| &fibres[lane.min(fibres.len() - 1)];
            FibrePack {
                count: fibres.len(),
                y: lanes(|lane| at(lane).y),
                z: lanes(|lane| at(lane).z),
                shear: from_fn(|i| from_fn(|j| lanes(|lane| at(lane).shear[i][j]))),
            }
        };
        FibreLanes(fibres.chunks(LANES).map(pack).collect())
    }

    /// Writes the history variables `dt` after `old` into `new` and calls `of` for each fibre, by number, with its stress and what its
    /// yielding dissipates, per volume.
    #[inline]
    pub fn advance<S: StressState<N>, const N: usize>(
        &self,
        (law, state): (&MaterialLaw, S),
        [gamma, kappa]: [&Vec3; 2],
        dt: f64,
        (old, new): (&[f64], &mut [f64]),
        mut of: impl FnMut(usize, &[f64; N], Dissipation),
    ) {
        let [g, k] = [gamma, kappa].map(|v| [v.x, v.y, v.z].map(Lanes::splat));
        let variables = law.history(state);
        for (place, FibrePack { count, y, z, shear }) in self.0.iter().enumerate() {
            let strain: [Lanes; N] = from_fn(|i| match i {
                0 => g[0] + *z * k[1] - *y * k[2],
                _ => shear[i - 1][0] * g[1] + shear[i - 1][1] * g[2] + shear[i - 1][2] * k[0],
            });
            let first = place * LANES;
            let at = |lane: usize| (first + lane.min(count - 1)) * variables;
            let history = law.recall(state, old, at);
            let answer = law.respond(state, &strain, (dt, &history), Ask::History(1.0));
            law.remember(state, &answer.new, (&mut *new, |lane| (lane < *count).then(|| at(lane))));
            let stress = answer.stress.map(Lanes::to_array);
            let spent = answer.dissipation.unwrap_or(Spent::ZERO);
            for lane in 0..*count {
                of(first + lane, &from_fn(|i| stress[i][lane]), spent.lane(lane));
            }
        }
    }
}
