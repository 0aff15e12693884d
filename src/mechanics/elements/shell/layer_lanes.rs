//! The layers of eight shell elements side by side, with the bits of [`super::layers`].

use super::packed::InPlaneLanes;
use super::plane_strains::PointStrains;
use super::stretch::Stretch;
use crate::materials::{Dissipation, EightPoints, PlaneStress, PointsHistory};
use crate::state::Configuration;
use base::math::lanes::{LANES, Lanes, lanes};
use std::array::from_fn;

/// The number of history variables of a layer: plastic strains and their accumulated value.
pub(super) const VARIABLES: usize = 4;

/// The layered sections of eight elements.
pub struct LayerLanes<const P: usize, const E: usize> {
    /// The law of a layer.
    pub law: EightPoints<PlaneStress, 3>,
    /// Strain of the reference surface is logarithmic.
    pub logarithmic: bool,
    /// Height above the reference surface, and thickness, of each layer.
    pub at: Vec<[f64; 2]>,
    /// What the stiffness of drilling is multiplied by for each edge, and for its rows.
    pub edges: [Lanes; E],
    pub stiffness: Lanes,
    pub rows: [[Lanes; E]; 2],
    /// Integration points.
    pub points: Vec<PointLanes<P, E>>,
    /// Starts of the ranges in the history of the group.
    pub first: [usize; LANES],
}

/// An integration point of eight elements.
pub struct PointLanes<const P: usize, const E: usize> {
    /// Rows of the strain of the reference surface by the numbers of the membrane.
    pub membrane: [[Lanes; E]; 3],
    /// Rows of curvature by the numbers of bending.
    pub bending: [[Lanes; P]; 3],
    /// Area.
    pub weight: Lanes,
}

impl<const P: usize, const E: usize> PointLanes<P, E> {
    /// Of a point of each of eight elements.
    #[inline(always)]
    pub fn new<'a>(point: impl Fn(usize) -> &'a PointStrains<P, E>) -> Self {
        PointLanes {
            membrane: from_fn(|i| from_fn(|m| lanes(|lane| point(lane).membrane[(i, m)]))),
            bending: from_fn(|i| from_fn(|m| lanes(|lane| point(lane).bending[(i, m)]))),
            weight: lanes(|lane| point(lane).weight),
        }
    }
}

/// Σ aᵢ bᵢ.
#[inline(always)]
pub(super) fn product<const N: usize>(a: &[Lanes; N], b: &[Lanes; N]) -> Lanes {
    let mut sum = a[0] * b[0];
    (1..N).for_each(|i| sum += a[i] * b[i]);
    sum
}

impl<const P: usize, const E: usize> LayerLanes<P, E> {
    /// Stress at a strain, as [`super::packed::PackedSections::advance`] has it.
    #[inline(always)]
    pub fn advance(
        &self,
        strain: &InPlaneLanes<P, E>,
        now: &Configuration,
        new: Option<(&mut [f64], &mut Dissipation)>,
        count: usize,
    ) -> InPlaneLanes<P, E> {
        let (mut new, spent) = new.unzip();
        let mut sum = Lanes::ZERO;
        let mut stress = InPlaneLanes::ZERO;
        stress.membrane = from_fn(|i| self.edges[i] * strain.membrane[i]);
        for row in &self.rows {
            let s = self.stiffness * product(row, &strain.membrane);
            (0..E).for_each(|i| stress.membrane[i] += s * row[i]);
        }
        let mut at = 0;
        for point in &self.points {
            let e: [Lanes; 3] = from_fn(|i| product(&point.membrane[i], &strain.membrane));
            let k: [Lanes; 3] = from_fn(|i| product(&point.bending[i], &strain.bending));
            let stretch = self.logarithmic.then(|| Stretch::new(&e));
            let e = stretch.as_ref().map_or(e, |stretch| stretch.strain);
            let mut section = [[Lanes::ZERO; 3]; 2];
            for &[z, w] in &self.at {
                let there = from_fn(|i| e[i] + Lanes::splat(z) * k[i]);
                let at_layer = self.first.map(|first| first + at);
                let history = PointsHistory { at: at_layer, count, old: now.history, new: new.as_deref_mut() };
                let (sigma, more) = self.law.advance(&there, now.dt, history);
                for i in 0..3 {
                    section[0][i] += Lanes::splat(w) * sigma[i];
                    section[1][i] += Lanes::splat(w * z) * sigma[i];
                }
                sum += more * (Lanes::splat(w) * point.weight);
                at += VARIABLES;
            }
            let N = stretch.as_ref().map_or(section[0], |stretch| stretch.conjugate(&section[0]));
            let [N, M] = [N, section[1]].map(|part| part.map(|s| point.weight * s));
            let by = |rows: [Lanes; 3], s: &[Lanes; 3]| product(&rows, s);
            (0..E).for_each(|m| stress.membrane[m] += by(from_fn(|i| point.membrane[i][m]), &N));
            (0..P).for_each(|m| stress.bending[m] += by(from_fn(|i| point.bending[i][m]), &M));
        }
        if let Some(spent) = spent {
            sum.to_array()[..count].iter().for_each(|plastic| spent.plastic += plastic);
        }
        stress
    }
}
