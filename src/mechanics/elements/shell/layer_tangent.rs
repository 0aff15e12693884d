//! Stress of eight layered sections side by side with its derivative, for schemes that ask for both: sections are gathered as they are
//! needed. Stress has the bits of [`super::layers`].

use super::layer_lanes::{PointLanes, VARIABLES, product};
use super::packed::{InPlaneLanes, LinearisedLanes};
use super::plane_strains::PointStrains;
use super::section::Drilling;
use super::stretch::Stretch;
use crate::materials::{EightPoints, PlaneStress, PointsHistory};
use crate::state::Configuration;
use base::math::lanes::{LANES, Lanes, fma, lanes};
use std::array::from_fn;

/// The sections of eight elements, with the same layers and equally many integration points.
pub(super) struct EightSections<'a, const P: usize, const E: usize> {
    /// The law of a layer.
    pub law: &'a EightPoints<PlaneStress, 3>,
    /// Height above the reference surface, and thickness, of each layer.
    pub at: &'a [[f64; 2]],
    /// Strain of the reference surface is logarithmic; there is no derivative of the stress here then.
    pub logarithmic: bool,
    /// The strains at the integration points.
    pub points: [&'a [PointStrains<P, E>]; LANES],
    /// The stiffness of drilling.
    pub drilling: [&'a Drilling<E>; LANES],
    /// Starts of the ranges in the history of the group.
    pub first: [usize; LANES],
}

/// A matrix by the components of plane stress and strain.
type Plane = [[Lanes; 3]; 3];

impl<const P: usize, const E: usize> EightSections<'_, P, E> {
    /// Stress at a strain, with what yielding takes off the stiffness of `tangent`.
    #[inline(always)]
    pub fn stress(
        &self,
        strain: &InPlaneLanes<P, E>,
        now: &Configuration,
        mut tangent: Option<&mut LinearisedLanes<P, E>>,
    ) -> InPlaneLanes<P, E> {
        let mut stress = InPlaneLanes::ZERO;
        stress.membrane = self.of_drilling(strain);
        for g in 0..self.points[0].len() {
            let point = PointLanes::new(|lane| &self.points[lane][g]);
            let e: [Lanes; 3] = from_fn(|i| product(&point.membrane[i], &strain.membrane));
            let k: [Lanes; 3] = from_fn(|i| product(&point.bending[i], &strain.bending));
            let stretch = self.logarithmic.then(|| Stretch::new(&e));
            let e = stretch.as_ref().map_or(e, |stretch| stretch.strain);
            let ([N, M], loss) = self.through(g, (&e, &k), now, tangent.is_some());
            let N = stretch.as_ref().map_or(N, |stretch| stretch.conjugate(&N));
            let [N, M] = [N, M].map(|part| part.map(|s| point.weight * s));
            (0..E).for_each(|m| stress.membrane[m] += product(&from_fn(|i| point.membrane[i][m]), &N));
            (0..P).for_each(|m| stress.bending[m] += product(&from_fn(|i| point.bending[i][m]), &M));
            if let Some((out, loss)) = tangent.as_deref_mut().zip(loss) {
                out.coupled = true;
                let loss = loss.map(|loss| loss.map(|row| row.map(|lost| point.weight * lost)));
                subtract(&point.membrane, &loss[0], &point.membrane, &mut out.N);
                subtract(&point.membrane, &loss[1], &point.bending, &mut out.NM);
                subtract(&point.bending, &loss[2], &point.bending, &mut out.M);
            }
        }
        stress
    }

    /// The stress of drilling, which stays elastic.
    #[inline(always)]
    fn of_drilling(&self, strain: &InPlaneLanes<P, E>) -> [Lanes; E] {
        let stiffness = lanes(|lane| self.drilling[lane].stiffness);
        let edges = |i: usize| lanes(|lane| self.drilling[lane].stiffness * self.drilling[lane].edges[i]);
        let mut stress = from_fn(|i| edges(i) * strain.membrane[i]);
        for k in 0..2 {
            let row: [Lanes; E] = from_fn(|i| lanes(|lane| self.drilling[lane].rows[k][i]));
            let s = stiffness * product(&row, &strain.membrane);
            (0..E).for_each(|i| stress[i] += s * row[i]);
        }
        stress
    }

    /// The resultants N and M of the section at integration point `g` with the strain and the curvature there, and what N, NM and M lose
    /// by yielding, the moments of the loss with z⁰, z¹ and z²; `None` where nothing yields, or without `linearises`.
    #[inline(always)]
    fn through(
        &self,
        g: usize,
        (e, k): (&[Lanes; 3], &[Lanes; 3]),
        now: &Configuration,
        linearises: bool,
    ) -> ([[Lanes; 3]; 2], Option<[Plane; 3]>) {
        let mut section = [[Lanes::ZERO; 3]; 2];
        let (mut loss, mut yields) = ([[[Lanes::ZERO; 3]; 3]; 3], false);
        for (layer, &[z, w]) in self.at.iter().enumerate() {
            let from = (g * self.at.len() + layer) * VARIABLES;
            let at = self.first.map(|first| first + from);
            let history = PointsHistory { at, count: LANES, old: now.history, new: None };
            let there = from_fn(|i| e[i] + Lanes::splat(z) * k[i]);
            let (sigma, lost) = if linearises {
                self.law.linearise(&there, now.dt, history)
            } else {
                (self.law.advance(&there, now.dt, history).0, None)
            };
            for i in 0..3 {
                section[0][i] += Lanes::splat(w) * sigma[i];
                section[1][i] += Lanes::splat(w * z) * sigma[i];
            }
            let Some(lost) = lost else { continue };
            yields = true;
            for (loss, w) in loss.iter_mut().zip([w, w * z, w * z * z]) {
                for i in 0..3 {
                    (0..3).for_each(|j| loss[i][j] = fma(Lanes::splat(w), lost[i][j], loss[i][j]));
                }
            }
        }
        (section, yields.then_some(loss))
    }
}

/// K ← K − Aᵀ C B.
#[inline(always)]
fn subtract<const R: usize, const Q: usize>(
    A: &[[Lanes; R]; 3],
    C: &Plane,
    B: &[[Lanes; Q]; 3],
    K: &mut [[Lanes; Q]; R],
) {
    let CB: [[Lanes; Q]; 3] = from_fn(|i| from_fn(|n| product(&C[i], &[B[0][n], B[1][n], B[2][n]])));
    for m in 0..R {
        let A: [Lanes; 3] = from_fn(|i| Lanes::ZERO - A[i][m]);
        for n in 0..Q {
            K[m][n] = fma(A[2], CB[2][n], fma(A[1], CB[1][n], fma(A[0], CB[0][n], K[m][n])));
        }
    }
}
