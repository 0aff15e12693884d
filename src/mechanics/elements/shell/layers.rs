//! A shell of layers in plane stress, each with history variables of its own, that yields. Strain of the reference surface is Green's, or
//! logarithmic, see [`super::stretch`], and curvature adds to it. Transverse shear stays elastic until all layers have failed.

use super::layer_lanes::{LayerLanes, PointLanes};
use super::layer_tangent::EightSections;
use super::packed::{InPlaneLanes, LinearisedLanes, PackedSections};
use super::plane_strains::PointStrains;
use super::section::{
    CoupledStiffness, Drilling, InPlane, SectionTangent, ShellSection, ShellStiffness, linearise_one_by_one,
    stiffness_side_by_side, stress_one_by_one,
};
use super::stretch::Stretch;
use crate::elements::block::Moduli;
use crate::elements::results::LayerStress;
use crate::materials::{Dissipation, EightPoints, MaterialLaw, PlaneStress};
use crate::state::Configuration;
use base::math::lanes::{LANES, lanes};
use base::math::quadrature;
use nalgebra::SMatrix;
use std::array::from_fn;
use std::ops::Range;
use std::sync::Arc;

/// The layers of a shell whose material yields.
#[derive(Debug, Clone)]
pub struct LayerModel {
    /// The law of the layers.
    pub law: MaterialLaw,
    /// The number of points through the thickness, at most [`super::MOST_LAYERS`]: up to five of Gauss, beyond that those of
    /// [`quadrature::kinked`].
    pub layers: usize,
    /// Strain of the reference surface is logarithmic, not Green's: see the file `stretch.rs`.
    pub logarithmic: bool,
}

impl LayerModel {
    /// The layers of a given thickness.
    pub(super) fn layers(&self, thickness: f64) -> Arc<Layers> {
        let points: Vec<(f64, f64)> = match self.layers {
            n @ ..=5 => {
                let (points, weights) = quadrature::gauss(n);
                points.iter().copied().zip(weights.iter().copied()).collect()
            }
            n => quadrature::kinked(n),
        };
        let half = 0.5 * thickness;
        Arc::new(Layers {
            law: self.law.clone(),
            eight: EightPoints::new(&self.law, PlaneStress),
            at: points.iter().map(|(z, w)| [half * z, half * w]).collect(),
            variables: self.law.history(PlaneStress),
            stiffness: self.law.stiffness(PlaneStress),
            thickness,
            logarithmic: self.logarithmic,
        })
    }
}

/// The layers and their law, shared by all elements of a part.
pub struct Layers {
    law: MaterialLaw,
    /// The law for eight points at once, where there is one.
    eight: Option<EightPoints<PlaneStress, 3>>,
    /// Height above the reference surface, and thickness, of each layer.
    at: Vec<[f64; 2]>,
    /// The number of history variables of a layer.
    variables: usize,
    /// ∂stress/∂strain of a layer that does not yield.
    stiffness: [[f64; 3]; 3],
    /// Of all layers.
    thickness: f64,
    /// Strain of the reference surface is logarithmic, see [`Stretch`].
    logarithmic: bool,
}

/// The stiffness of an element in its plane, and what it is made of.
pub(super) struct InPlaneStiffness<const P: usize, const E: usize> {
    /// The stiffness before the material yields.
    pub elastic: ShellStiffness<P, E>,
    /// The stiffness of drilling, a part of it.
    pub drilling: Drilling<E>,
    /// The strains at its integration points.
    pub points: Vec<PointStrains<P, E>>,
}

/// The sections of one element.
pub struct LayeredSection<const P: usize, const E: usize> {
    layers: Arc<Layers>,
    elastic: ShellStiffness<P, E>,
    drilling: Drilling<E>,
    points: Vec<PointStrains<P, E>>,
    /// Start of its range in the history of the group.
    first: usize,
}

impl<const P: usize, const E: usize> LayeredSection<P, E> {
    /// `first`: the start of its range in the history of the group.
    pub(super) fn new(
        layers: &Arc<Layers>,
        InPlaneStiffness { elastic, drilling, points }: InPlaneStiffness<P, E>,
        first: usize,
    ) -> Self {
        LayeredSection { layers: Arc::clone(layers), elastic, drilling, points, first }
    }

    /// Eight of them side by side; `None` where they must be computed one by one.
    #[inline(always)]
    fn side_by_side<'a>(sections: &[&'a Self; LANES]) -> Option<EightSections<'a, P, E>> {
        let Layers { eight, at, logarithmic, .. } = &*sections[0].layers;
        let points = sections.map(|section| &section.points[..]);
        // The flat elements of a part have more points than the others.
        let alike = points.iter().all(|own| own.len() == points[0].len());
        Some(EightSections {
            law: eight.as_ref().filter(|_| alike)?,
            at,
            logarithmic: *logarithmic,
            points,
            drilling: sections.map(|section| &section.drilling),
            first: sections.map(|section| section.first),
        })
    }

    /// The range of the history of the group that the element has.
    fn history_range(&self) -> Range<usize> {
        self.first..self.first + ShellSection::<P, E>::history(self)
    }

    /// The stress of drilling, which stays elastic.
    #[inline(always)]
    fn drilling(&self, strain: &InPlane<P, E>) -> InPlane<P, E> {
        InPlane { membrane: self.drilling.stress(&strain.membrane), ..InPlane::ZERO }
    }

    /// Membrane strain and curvature at an integration point.
    #[inline(always)]
    fn strain(point: &PointStrains<P, E>, strain: &InPlane<P, E>) -> [[f64; 3]; 2] {
        let membrane = from_fn(|i| (0..E).map(|m| point.membrane[(i, m)] * strain.membrane[m]).sum());
        [membrane, from_fn(|i| (0..P).map(|m| point.bending[(i, m)] * strain.bending[m]).sum())]
    }

    /// Calls `of` for each layer of each integration point with the point, [z, volume], strain and history variables.
    #[inline(always)]
    fn each(
        &self,
        strain: &InPlane<P, E>,
        old: &[f64],
        mut of: impl FnMut(&PointStrains<P, E>, [f64; 2], &[f64; 3], &[f64]),
    ) {
        let all = self.layers.at.len() * self.layers.variables;
        for (point, old) in self.points.iter().zip(old[self.history_range()].chunks_exact(all)) {
            self.through(point, strain, old, |[z, w], strain, old| of(point, [z, w * point.weight], strain, old));
        }
    }

    /// Calls `of` for each layer of an integration point with [z, thickness], strain and history variables; answers with the strain of the
    /// reference surface if that is logarithmic.
    #[inline(always)]
    fn through(
        &self,
        point: &PointStrains<P, E>,
        strain: &InPlane<P, E>,
        old: &[f64],
        mut of: impl FnMut([f64; 2], &[f64; 3], &[f64]),
    ) -> Option<Stretch<f64>> {
        let [e, k] = Self::strain(point, strain);
        let stretch = self.layers.logarithmic.then(|| Stretch::new(&e));
        let e = stretch.as_ref().map_or(e, |stretch| stretch.strain);
        for (&[z, w], old) in self.layers.at.iter().zip(old.chunks_exact(self.layers.variables)) {
            of([z, w], &from_fn(|i| e[i] + z * k[i]), old);
        }
        stretch
    }

    /// The losses of N and NM by logarithmic strain as those by Green's: C − (∂H/∂E)ᵀ (C − loss) ∂H/∂E − N:∂²H/∂E², (∂H/∂E)ᵀ loss.
    fn stretched(&self, stretch: &Stretch<f64>, N: &[f64; 3], loss: &mut [[[f64; 3]; 3]; 3]) {
        let Layers { stiffness, thickness, .. } = &*self.layers;
        let (slopes, curvature) = (stretch.slopes(), stretch.curvature(N));
        let whole = |i: usize, j: usize| thickness * stiffness[i][j];
        let right: [[f64; 3]; 3] =
            from_fn(|j| from_fn(|i| (0..3).map(|k| (whole(i, k) - loss[0][i][k]) * slopes[j][k]).sum()));
        let kept = |i: usize, j: usize| (0..3).map(|k| slopes[i][k] * right[j][k]).sum::<f64>() + curvature[j][i];
        loss[0] = from_fn(|i| from_fn(|j| whole(i, j) - 0.5 * (kept(i, j) + kept(j, i))));
        loss[1] = from_fn(|i| from_fn(|j| (0..3).map(|k| slopes[i][k] * loss[1][k][j]).sum()));
    }

    /// Adds to the stress of the element that of a point, where the section has the resultants N and M.
    #[inline(always)]
    fn add(
        point: &PointStrains<P, E>,
        stretch: &Option<Stretch<f64>>,
        [N, M]: &[[f64; 3]; 2],
        stress: &mut InPlane<P, E>,
    ) {
        let N = stretch.as_ref().map_or(*N, |stretch| stretch.conjugate(N));
        let [N, M] = [N, *M].map(|part| part.map(|s| point.weight * s));
        for m in 0..E {
            stress.membrane[m] += (0..3).map(|i| point.membrane[(i, m)] * N[i]).sum::<f64>();
        }
        for m in 0..P {
            stress.bending[m] += (0..3).map(|i| point.bending[(i, m)] * M[i]).sum::<f64>();
        }
    }
}

/// Adds the stress of a layer to N and M.
#[inline(always)]
fn accumulate(section: &mut [[f64; 3]; 2], [z, w]: [f64; 2], sigma: &[f64; 3]) {
    for i in 0..3 {
        section[0][i] += w * sigma[i];
        section[1][i] += w * z * sigma[i];
    }
}

/// K ← K − w Aᵀ C B.
#[inline(always)]
fn subtract<const R: usize, const Q: usize>(
    w: f64,
    (A, C, B): (&SMatrix<f64, 3, R>, &[[f64; 3]; 3], &SMatrix<f64, 3, Q>),
    K: &mut [[f64; Q]; R],
) {
    for n in 0..Q {
        let column: [f64; 3] = from_fn(|i| w * (0..3).map(|j| C[i][j] * B[(j, n)]).sum::<f64>());
        for m in 0..R {
            K[m][n] -= (0..3).map(|i| A[(i, m)] * column[i]).sum::<f64>();
        }
    }
}

impl<const P: usize, const E: usize> PackedSections<LayeredSection<P, E>, P, E> for LayerLanes<P, E> {
    fn pack(sections: &[&LayeredSection<P, E>]) -> Option<Self> {
        let first = sections.first()?;
        let law = first.layers.eight.clone()?;
        let at = |lane: usize| sections[lane.min(sections.len() - 1)];
        // The flat elements of a part have more points than the others.
        if sections.iter().any(|section| section.points.len() != first.points.len()) {
            return None;
        }
        let point = |g: usize| PointLanes::new(|lane| &at(lane).points[g]);
        Some(LayerLanes {
            law,
            logarithmic: first.layers.logarithmic,
            at: first.layers.at.clone(),
            edges: from_fn(|i| lanes(|lane| at(lane).drilling.stiffness * at(lane).drilling.edges[i])),
            stiffness: lanes(|lane| at(lane).drilling.stiffness),
            rows: from_fn(|k| from_fn(|i| lanes(|lane| at(lane).drilling.rows[k][i]))),
            points: (0..first.points.len()).map(point).collect(),
            first: from_fn(|lane| at(lane).first),
        })
    }

    #[inline(always)]
    fn advance(
        &self,
        strain: &InPlaneLanes<P, E>,
        now: &Configuration,
        new: Option<(&mut [f64], &mut Dissipation)>,
        count: usize,
    ) -> InPlaneLanes<P, E> {
        LayerLanes::advance(self, strain, now, new, count)
    }
}

impl<const P: usize, const E: usize> ShellSection<P, E> for LayeredSection<P, E> {
    type Packed = LayerLanes<P, E>;

    fn elastic(&self) -> &ShellStiffness<P, E> {
        &self.elastic
    }

    fn stress(&self, strain: &InPlane<P, E>, now: &Configuration) -> InPlane<P, E> {
        let mut stress = self.drilling(strain);
        let all = self.layers.at.len() * self.layers.variables;
        for (point, old) in self.points.iter().zip(now.history[self.history_range()].chunks_exact(all)) {
            let mut section = [[0.0; 3]; 2];
            let stretch = self.through(point, strain, old, |at, strain, old| {
                accumulate(&mut section, at, &self.layers.law.stress(PlaneStress, strain, now.dt, old));
            });
            Self::add(point, &stretch, &section, &mut stress);
        }
        stress
    }

    /// The derivative is the elastic one less what yielding layers lose, and what stretching takes or gives.
    fn linearise<'a>(
        &'a self,
        strain: &InPlane<P, E>,
        now: &Configuration,
        moduli: Moduli,
        tangent: &'a mut CoupledStiffness<P, E>,
    ) -> (InPlane<P, E>, SectionTangent<'a, P, E>) {
        if moduli == Moduli::Elastic {
            return (self.stress(strain, now), self.elastic.tangent());
        }
        let mut stress = self.drilling(strain);
        let mut changed = false;
        let all = self.layers.at.len() * self.layers.variables;
        for (point, old) in self.points.iter().zip(now.history[self.history_range()].chunks_exact(all)) {
            let mut section = [[0.0; 3]; 2];
            // The losses of N, NM and M are its moments with z⁰, z¹ and z².
            let mut loss = [[[0.0; 3]; 3]; 3];
            let mut yields = false;
            let stretch = self.through(point, strain, old, |[z, w], strain, old| {
                let (sigma, C) = self.layers.law.linearise(PlaneStress, strain, now.dt, old);
                accumulate(&mut section, [z, w], &sigma);
                let Some(C) = C else { return };
                yields = true;
                for i in 0..3 {
                    for j in 0..3 {
                        let lost = w * (self.layers.stiffness[i][j] - C[i][j]);
                        loss[0][i][j] += lost;
                        loss[1][i][j] += z * lost;
                        loss[2][i][j] += z * z * lost;
                    }
                }
            });
            Self::add(point, &stretch, &section, &mut stress);
            if let Some(stretch) = &stretch {
                self.stretched(stretch, &section[0], &mut loss);
            }
            if yields || stretch.is_some() {
                if !changed {
                    tangent.plane.clone_from(&self.elastic);
                    changed = true;
                }
                tangent.coupled |= yields;
                let PointStrains { membrane, bending, weight } = point;
                subtract(*weight, (membrane, &loss[0], membrane), &mut tangent.plane.N);
                subtract(*weight, (membrane, &loss[1], bending), &mut tangent.NM);
                subtract(*weight, (bending, &loss[2], bending), &mut tangent.plane.M);
            }
        }
        (stress, if changed { tangent.tangent() } else { self.elastic.tangent() })
    }

    const FORCES_SIDE_BY_SIDE: bool = true;

    #[inline(always)]
    fn stress_eight(sections: [&Self; LANES], strain: &InPlaneLanes<P, E>, now: &Configuration) -> InPlaneLanes<P, E> {
        match Self::side_by_side(&sections) {
            Some(eight) => eight.stress(strain, now, None),
            None => stress_one_by_one(sections, strain, now),
        }
    }

    #[inline(always)]
    fn linearise_eight(
        sections: [&Self; LANES],
        strain: &InPlaneLanes<P, E>,
        now: &Configuration,
        moduli: Moduli,
    ) -> LinearisedLanes<P, E> {
        let logarithmic = sections[0].layers.logarithmic;
        match Self::side_by_side(&sections) {
            Some(eight) if !logarithmic || moduli == Moduli::Elastic => {
                let mut out =
                    stiffness_side_by_side(InPlaneLanes::ZERO, sections.map(|section| section.elastic.tangent()));
                let tangent = (moduli == Moduli::Algorithmic).then_some(&mut out);
                out.stress = eight.stress(strain, now, tangent);
                out
            }
            _ => linearise_one_by_one(sections, strain, now, moduli),
        }
    }

    fn surface_strain(&self, strain: &InPlane<P, E>) -> (f64, bool) {
        let largest = |point: &PointStrains<P, E>| {
            let [[a, b, shear], _] = Self::strain(point, strain);
            let (mean, radius) = (0.5 * (a + b), (0.5 * (a - b)).hypot(0.5 * shear));
            if mean < 0.0 { mean - radius } else { mean + radius }
        };
        let larger = |most: f64, strain: f64| if strain.abs() > most.abs() { strain } else { most };
        (self.points.iter().map(largest).fold(0.0, larger), self.layers.logarithmic)
    }

    fn can_fail(&self) -> bool {
        self.layers.law.can_fail()
    }

    fn has_failed(&self, history: &[f64]) -> bool {
        let Layers { law, variables, .. } = &*self.layers;
        law.can_fail()
            && history[self.history_range()].chunks_exact(*variables).all(|old| law.has_failed(PlaneStress, old))
    }

    fn energy(&self, strain: &InPlane<P, E>, now: &Configuration) -> f64 {
        let mut sum = 0.5 * self.drilling(strain).dot(strain);
        self.each(strain, now.history, |_, [_, w], strain, old| {
            sum += w * self.layers.law.elastic_energy(PlaneStress, strain, old);
        });
        sum
    }

    fn update_history(&self, strain: &InPlane<P, E>, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut dissipation = Dissipation::default();
        let mut new = new[self.history_range()].chunks_exact_mut(self.layers.variables);
        self.each(strain, now.history, |_, [_, w], strain, old| {
            if let Some(new) = new.next() {
                dissipation += self.layers.law.advance(PlaneStress, strain, (now.dt, part), old, new).1 * w;
            }
        });
        dissipation
    }

    fn advance(&self, strain: &InPlane<P, E>, now: &Configuration, new: &mut [f64]) -> (InPlane<P, E>, Dissipation) {
        let (mut stress, mut dissipation) = (self.drilling(strain), Dissipation::default());
        let all = self.layers.at.len() * self.layers.variables;
        let old = now.history[self.history_range()].chunks_exact(all);
        let new = new[self.history_range()].chunks_exact_mut(all);
        for ((point, old), new) in self.points.iter().zip(old).zip(new) {
            let mut section = [[0.0; 3]; 2];
            let mut new = new.chunks_exact_mut(self.layers.variables);
            let stretch = self.through(point, strain, old, |[z, w], strain, old| {
                let Some(new) = new.next() else { return };
                let (sigma, spent) = self.layers.law.advance(PlaneStress, strain, (now.dt, 1.0), old, new);
                accumulate(&mut section, [z, w], &sigma);
                dissipation += spent * (w * point.weight);
            });
            Self::add(point, &stretch, &section, &mut stress);
        }
        (stress, dissipation)
    }

    fn layers(&self, strain: &InPlane<P, E>, now: &Configuration, layers: &mut [LayerStress]) -> usize {
        let count = self.layers.at.len();
        let layers = &mut layers[..count];
        layers.fill(LayerStress::default());
        let whole: f64 = self.points.iter().map(|point| point.weight).sum();
        let mut next = 0;
        self.each(strain, now.history, |point, [z, _], strain, old| {
            let layer = &mut layers[next % count];
            next += 1;
            let sigma = self.layers.law.stress(PlaneStress, strain, now.dt, old);
            layer.z = z;
            (0..3).for_each(|i| layer.stress[i] += point.weight / whole * sigma[i]);
            layer.plastic_strain = layer.plastic_strain.max(self.layers.law.accumulated(PlaneStress, old));
        });
        count
    }

    fn plastic_strain(&self, history: &[f64]) -> f64 {
        let variables = history[self.history_range()].chunks_exact(self.layers.variables);
        variables.map(|old| self.layers.law.accumulated(PlaneStress, old)).fold(0.0, f64::max)
    }

    fn history(&self) -> usize {
        self.points.len() * self.layers.at.len() * self.layers.variables
    }
}
