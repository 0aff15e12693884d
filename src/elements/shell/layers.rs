//! A shell of layers in plane stress, each with history variables of its own, that yields. Transverse shear stays elastic.

use super::section::{ShellSection, ShellStiffness, StrainOperator};
use crate::elements::block::Moduli;
use crate::elements::results::LayerStress;
use crate::materials::{Dissipation, MaterialLaw, PlaneStress};
use crate::math::quadrature;
use crate::state::Configuration;
use nalgebra::SMatrix;
use std::array::from_fn;
use std::ops::Range;
use std::sync::Arc;

/// The layers of a shell whose material yields.
#[derive(Debug, Clone)]
pub struct LayerModel {
    /// The law of the layers.
    pub law: MaterialLaw,
    /// The number of Gauss points through the thickness, at most [`super::MOST_LAYERS`].
    pub layers: usize,
}

impl LayerModel {
    /// The layers of a given thickness.
    pub(super) fn layers(&self, thickness: f64) -> Arc<Layers> {
        let (points, weights) = quadrature::gauss(self.layers);
        let half = 0.5 * thickness;
        Arc::new(Layers {
            law: self.law.clone(),
            at: points.iter().zip(weights).map(|(z, w)| [half * z, half * w]).collect(),
            variables: self.law.history(PlaneStress),
            stiffness: self.law.stiffness(PlaneStress),
        })
    }
}

/// The layers and their law, shared by all elements of a part.
pub struct Layers {
    law: MaterialLaw,
    /// Height above the reference surface, and thickness, of each layer.
    at: Vec<[f64; 2]>,
    /// The number of history variables of a layer.
    variables: usize,
    /// ∂stress/∂strain of a layer that does not yield.
    stiffness: [[f64; 3]; 3],
}

/// The sections of one element.
pub struct LayeredSection<const M: usize> {
    layers: Arc<Layers>,
    elastic: ShellStiffness<M>,
    points: Vec<StrainOperator<M>>,
    /// Start of its range in the history of the group.
    first: usize,
}

impl<const M: usize> LayeredSection<M> {
    /// `points`: the strains at its integration points; `first`: the start of its range in the history of the group.
    pub(super) fn new(
        layers: &Arc<Layers>,
        elastic: ShellStiffness<M>,
        points: Vec<StrainOperator<M>>,
        first: usize,
    ) -> Self {
        LayeredSection { layers: Arc::clone(layers), elastic, points, first }
    }

    /// The range of the history of the group that the element has.
    fn history_range(&self) -> Range<usize> {
        self.first..self.first + ShellSection::<M>::history(self)
    }

    /// Membrane strain and curvature at an integration point.
    #[inline(always)]
    fn strain(point: &StrainOperator<M>, strain: &[[f64; M]; 2]) -> [[f64; 3]; 2] {
        strain.map(|part| from_fn(|i| (0..M).map(|m| point.A[(i, m)] * part[m]).sum()))
    }

    /// Calls `of` for each layer of each integration point with the point, [z, volume], strain and history variables.
    #[inline(always)]
    fn each(
        &self,
        strain: &[[f64; M]; 2],
        old: &[f64],
        mut of: impl FnMut(&StrainOperator<M>, [f64; 2], &[f64; 3], &[f64]),
    ) {
        let all = self.layers.at.len() * self.layers.variables;
        for (point, old) in self.points.iter().zip(old[self.history_range()].chunks_exact(all)) {
            self.through(point, strain, old, |[z, w], strain, old| of(point, [z, w * point.weight], strain, old));
        }
    }

    /// Calls `of` for each layer of an integration point with [z, thickness], strain and history variables.
    #[inline(always)]
    fn through(
        &self,
        point: &StrainOperator<M>,
        strain: &[[f64; M]; 2],
        old: &[f64],
        mut of: impl FnMut([f64; 2], &[f64; 3], &[f64]),
    ) {
        let [e, k] = Self::strain(point, strain);
        for (&[z, w], old) in self.layers.at.iter().zip(old.chunks_exact(self.layers.variables)) {
            of([z, w], &from_fn(|i| e[i] + z * k[i]), old);
        }
    }

    /// Adds to the stress of the element that of a point, where the section has the resultants N and M.
    #[inline(always)]
    fn add(point: &StrainOperator<M>, section: &[[f64; 3]; 2], stress: &mut [[f64; M]; 2]) {
        for (stress, section) in stress.iter_mut().zip(section) {
            for m in 0..M {
                stress[m] += point.weight * (0..3).map(|i| point.A[(i, m)] * section[i]).sum::<f64>();
            }
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

/// K ← K − w Aᵀ C A.
#[inline(always)]
fn subtract<const M: usize>(w: f64, A: &SMatrix<f64, 3, M>, C: &[[f64; 3]; 3], K: &mut [[f64; M]; M]) {
    for n in 0..M {
        let column: [f64; 3] = from_fn(|i| w * (0..3).map(|j| C[i][j] * A[(j, n)]).sum::<f64>());
        for m in 0..M {
            K[m][n] -= (0..3).map(|i| A[(i, m)] * column[i]).sum::<f64>();
        }
    }
}

impl<const M: usize> ShellSection<M> for LayeredSection<M> {
    fn elastic(&self) -> &ShellStiffness<M> {
        &self.elastic
    }

    fn stress(&self, strain: &[[f64; M]; 2], now: &Configuration) -> [[f64; M]; 2] {
        let mut stress = [[0.0; M]; 2];
        let all = self.layers.at.len() * self.layers.variables;
        for (point, old) in self.points.iter().zip(now.history[self.history_range()].chunks_exact(all)) {
            let mut section = [[0.0; 3]; 2];
            self.through(point, strain, old, |at, strain, old| {
                accumulate(&mut section, at, &self.layers.law.stress(PlaneStress, strain, now.dt, old));
            });
            Self::add(point, &section, &mut stress);
        }
        stress
    }

    /// The derivative is the elastic one less what yielding layers lose.
    fn linearise<'a>(
        &'a self,
        strain: &[[f64; M]; 2],
        now: &Configuration,
        moduli: Moduli,
        tangent: &'a mut ShellStiffness<M>,
    ) -> ([[f64; M]; 2], &'a ShellStiffness<M>) {
        if moduli == Moduli::Elastic {
            return (self.stress(strain, now), &self.elastic);
        }
        let mut stress = [[0.0; M]; 2];
        let mut yields = false;
        let all = self.layers.at.len() * self.layers.variables;
        for (point, old) in self.points.iter().zip(now.history[self.history_range()].chunks_exact(all)) {
            let mut section = [[0.0; 3]; 2];
            // The losses of N, NM and M are its moments with z⁰, z¹ and z².
            let mut loss = [[[0.0; 3]; 3]; 3];
            let mut here = false;
            self.through(point, strain, old, |[z, w], strain, old| {
                let (sigma, C) = self.layers.law.linearise(PlaneStress, strain, now.dt, old);
                accumulate(&mut section, [z, w], &sigma);
                let Some(C) = C else { return };
                here = true;
                for i in 0..3 {
                    for j in 0..3 {
                        let lost = w * (self.layers.stiffness[i][j] - C[i][j]);
                        loss[0][i][j] += lost;
                        loss[1][i][j] += z * lost;
                        loss[2][i][j] += z * z * lost;
                    }
                }
            });
            Self::add(point, &section, &mut stress);
            if here {
                if !yields {
                    tangent.clone_from(&self.elastic);
                    (tangent.coupled, yields) = (true, true);
                }
                let StrainOperator { A, weight } = point;
                for (loss, K) in loss.iter().zip([&mut tangent.N, &mut tangent.NM, &mut tangent.M]) {
                    subtract(*weight, A, loss, K);
                }
            }
        }
        (stress, if yields { tangent } else { &self.elastic })
    }

    fn energy(&self, strain: &[[f64; M]; 2], now: &Configuration) -> f64 {
        let mut sum = 0.0;
        self.each(strain, now.history, |_, [_, w], strain, old| {
            sum += w * self.layers.law.elastic_energy(PlaneStress, strain, old);
        });
        sum
    }

    fn update_history(&self, strain: &[[f64; M]; 2], now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut dissipation = Dissipation::default();
        let mut new = new[self.history_range()].chunks_exact_mut(self.layers.variables);
        self.each(strain, now.history, |_, [_, w], strain, old| {
            if let Some(new) = new.next() {
                dissipation += self.layers.law.advance(PlaneStress, strain, (now.dt, part), old, new).1 * w;
            }
        });
        dissipation
    }

    fn layers(&self, strain: &[[f64; M]; 2], now: &Configuration, layers: &mut [LayerStress]) -> usize {
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
