//! Fibres of a section eight at a time; a fibre has bitwise the same result alone.

use super::fibre_sum::FibreSum;
use crate::materials::{Ask, MaterialLaw, Spent, StressState};
use crate::sections::Fibre;
use base::math::Vec3;
use base::math::lanes::{LANES, Lanes, lanes};
use std::array::from_fn;

/// The fibres of a section side by side.
pub struct FibreLanes(Vec<FibrePack>);

/// Up to eight fibres; lanes beyond the last repeat it.
struct FibrePack {
    count: usize,
    area: Lanes,
    y: Lanes,
    z: Lanes,
    shear: [[Lanes; 3]; 2],
}

/// What fibres are asked besides their stress.
pub enum FibresAsk<'a> {
    /// Nothing more.
    Stress,
    /// What the stiffness of these fibres loses by yielding.
    Tangent(&'a [Fibre], &'a mut FibreSum),
    /// The history variables after this part of the step, and what is dissipated until then, per length.
    History(f64, &'a mut [f64], &'a mut Spent<f64>),
}

impl FibrePack {
    /// Strains: axial, then shear.
    #[inline(always)]
    fn strain<const N: usize>(&self, [gamma, kappa]: [&Vec3; 2]) -> [Lanes; N] {
        let [g, k] = [gamma, kappa].map(|v| [v.x, v.y, v.z].map(Lanes::splat));
        let mut strain = [g[0] + self.z * k[1] - self.y * k[2]; N];
        for i in 1..N {
            let s = &self.shear[i - 1];
            strain[i] = s[0] * g[1] + s[1] * g[2] + s[2] * k[0];
        }
        strain
    }

    /// Adds stresses to the resultants n and m, fibre by fibre: work-conjugate to [`FibrePack::strain`].
    #[inline(always)]
    fn add<const N: usize>(&self, stress: &[Lanes; N], [n, m]: [&mut Vec3; 2]) {
        let force = self.area * stress[0];
        let [y, z, force] = [self.y * force, self.z * force, force].map(Lanes::to_array);
        let mut shear = [[[0.0; LANES]; 3]; 2];
        for i in 1..N {
            let force = self.area * stress[i];
            shear[i - 1] = self.shear[i - 1].map(|s| (s * force).to_array());
        }
        for lane in 0..self.count {
            n.x += force[lane];
            m.y += z[lane];
            m.z -= y[lane];
            for of in &shear[..N - 1] {
                n.y += of[0][lane];
                n.z += of[1][lane];
                m.x += of[2][lane];
            }
        }
    }

    /// Adds what the stiffness of `fibres` loses against the `elastic` one.
    #[inline(always)]
    fn lose<const N: usize>(
        &self,
        fibres: &[Fibre],
        C: &[[Lanes; N]; N],
        elastic: &[[f64; N]; N],
        loss: &mut FibreSum,
    ) {
        let C = C.map(|row| row.map(Lanes::to_array));
        for (lane, fibre) in fibres[..self.count].iter().enumerate() {
            let lost = from_fn(|i| from_fn(|j| elastic[i][j] - C[i][j][lane]));
            if lost != [[0.0; N]; N] {
                loss.add::<N>(fibre, &lost);
            }
        }
    }
}

impl FibreLanes {
    /// Packs the fibres of a section.
    pub fn new(fibres: &[Fibre]) -> Self {
        let pack = |fibres: &[Fibre]| {
            let at = |lane: usize| &fibres[lane.min(fibres.len() - 1)];
            FibrePack {
                count: fibres.len(),
                area: lanes(|lane| at(lane).area),
                y: lanes(|lane| at(lane).y),
                z: lanes(|lane| at(lane).z),
                shear: from_fn(|i| from_fn(|j| lanes(|lane| at(lane).shear[i][j]))),
            }
        };
        FibreLanes(fibres.chunks(LANES).map(pack).collect())
    }

    /// Adds the stresses `dt` after the history variables `old` to the resultants n and m, and answers what is asked besides.
    #[inline(always)]
    pub fn respond<S: StressState<N>, const N: usize>(
        &self,
        (law, state): (&MaterialLaw, S),
        strain: [&Vec3; 2],
        (dt, old): (f64, &[f64]),
        mut ask: FibresAsk,
        [n, m]: [&mut Vec3; 2],
    ) {
        let asked = match &ask {
            FibresAsk::Stress => Ask::Stress,
            FibresAsk::Tangent(..) => Ask::Tangent,
            FibresAsk::History(part, ..) => Ask::History(*part),
        };
        let (variables, elastic) = (law.history(state), law.stiffness(state));
        for (first, pack) in (0..).step_by(LANES).zip(&self.0) {
            let at = |lane: usize| (first + lane.min(pack.count - 1)) * variables;
            let history = law.recall(state, old, at);
            let answer = law.respond(state, &pack.strain(strain), (dt, &history), asked);
            pack.add(&answer.stress, [n, m]);
            match &mut ask {
                FibresAsk::Stress => {}
                FibresAsk::Tangent(fibres, loss) => {
                    if let Some(C) = &answer.tangent {
                        pack.lose(&fibres[first..], C, &elastic, loss);
                    }
                }
                FibresAsk::History(_, new, spent) => {
                    law.remember(state, &answer.new, (old, &mut **new), at);
                    if let Some(more) = &answer.dissipation {
                        spent.add_each(more, pack.area, pack.count);
                    }
                }
            }
        }
    }
}
