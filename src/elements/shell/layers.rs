//! A shell as layers in plane stress, each with a memory of its own: what yields. Transverse shear stays elastic.

use super::geometry::Spread;
use super::section::{Plane, Section};
use super::{Configuration, Moduli};
use crate::elements::Layer;
use crate::materials::{Dissipation, Law, PlaneStress};
use crate::math::quadrature;
use nalgebra::SMatrix;
use std::array::from_fn;
use std::ops::Range;
use std::sync::Arc;

/// Gauss points through the thickness at most.
pub const MOST_LAYERS: usize = 10;

/// How the material of a shell yields.
#[derive(Debug, Clone)]
pub struct Yielding {
    pub law: Law,
    /// Gauss points through the thickness.
    pub layers: usize,
}

impl Yielding {
    pub(super) fn layers(&self, thickness: f64) -> Arc<Layers> {
        let (points, weights) = quadrature::gauss(self.layers);
        let half = 0.5 * thickness;
        Arc::new(Layers {
            law: self.law.clone(),
            at: points.iter().zip(weights).map(|(z, w)| [half * z, half * w]).collect(),
            memory: self.law.history(PlaneStress),
            stiffness: self.law.stiffness(PlaneStress),
        })
    }
}

/// Shared by all elements of a part.
pub struct Layers {
    law: Law,
    /// Height above the reference surface, and share of the thickness.
    at: Vec<[f64; 2]>,
    /// Numbers a layer remembers.
    memory: usize,
    /// Of a layer that does not yield.
    stiffness: [[f64; 3]; 3],
}

/// The sections of one element.
pub struct Layered<const M: usize> {
    layers: Arc<Layers>,
    elastic: Plane<M>,
    points: Vec<Spread<M>>,
    /// Where its share of the group's history begins.
    first: usize,
}

impl<const M: usize> Layered<M> {
    pub(super) fn new(layers: &Arc<Layers>, elastic: Plane<M>, points: Vec<Spread<M>>, first: usize) -> Self {
        Layered { layers: Arc::clone(layers), elastic, points, first }
    }

    /// What the element remembers, as a range of the group's history.
    fn share(&self) -> Range<usize> {
        self.first..self.first + Section::<M>::history(self)
    }

    /// Membrane strain and curvature at a point.
    #[inline(always)]
    fn strain(point: &Spread<M>, strain: &[[f64; M]; 2]) -> [[f64; 3]; 2] {
        strain.map(|part| from_fn(|i| (0..M).map(|m| point.A[(i, m)] * part[m]).sum()))
    }

    /// Calls for every layer of every point: its point, [z, weight], strain, memory.
    #[inline(always)]
    fn each(&self, strain: &[[f64; M]; 2], past: &[f64], mut of: impl FnMut(&Spread<M>, [f64; 2], &[f64; 3], &[f64])) {
        let all = self.layers.at.len() * self.layers.memory;
        for (point, past) in self.points.iter().zip(past[self.share()].chunks_exact(all)) {
            self.through(point, strain, past, |[z, w], strain, past| of(point, [z, w * point.weight], strain, past));
        }
    }

    /// Calls for every layer of a point: [z, share of the thickness], strain, memory.
    #[inline(always)]
    fn through(
        &self,
        point: &Spread<M>,
        strain: &[[f64; M]; 2],
        past: &[f64],
        mut of: impl FnMut([f64; 2], &[f64; 3], &[f64]),
    ) {
        let [e, k] = Self::strain(point, strain);
        for (&[z, w], past) in self.layers.at.iter().zip(past.chunks_exact(self.layers.memory)) {
            of([z, w], &from_fn(|i| e[i] + z * k[i]), past);
        }
    }

    /// Adds the stress of a point: N and M of the section there.
    #[inline(always)]
    fn add(point: &Spread<M>, section: &[[f64; 3]; 2], stress: &mut [[f64; M]; 2]) {
        for (stress, section) in stress.iter_mut().zip(section) {
            for m in 0..M {
                stress[m] += point.weight * (0..3).map(|i| point.A[(i, m)] * section[i]).sum::<f64>();
            }
        }
    }
}

/// N and M grow by the stress of a layer.
#[inline(always)]
fn pile(section: &mut [[f64; 3]; 2], [z, w]: [f64; 2], sigma: &[f64; 3]) {
    for i in 0..3 {
        section[0][i] += w * sigma[i];
        section[1][i] += w * z * sigma[i];
    }
}

/// K −= w Aᵀ C A.
#[inline(always)]
fn subtract<const M: usize>(w: f64, A: &SMatrix<f64, 3, M>, C: &[[f64; 3]; 3], K: &mut [[f64; M]; M]) {
    for n in 0..M {
        let column: [f64; 3] = from_fn(|i| w * (0..3).map(|j| C[i][j] * A[(j, n)]).sum::<f64>());
        for m in 0..M {
            K[m][n] -= (0..3).map(|i| A[(i, m)] * column[i]).sum::<f64>();
        }
    }
}

impl<const M: usize> Section<M> for Layered<M> {
    fn elastic(&self) -> &Plane<M> {
        &self.elastic
    }

    fn stress(&self, strain: &[[f64; M]; 2], now: &Configuration) -> [[f64; M]; 2] {
        let mut stress = [[0.0; M]; 2];
        let all = self.layers.at.len() * self.layers.memory;
        for (point, past) in self.points.iter().zip(now.history[self.share()].chunks_exact(all)) {
            let mut section = [[0.0; 3]; 2];
            self.through(point, strain, past, |at, strain, past| {
                pile(&mut section, at, &self.layers.law.stress(PlaneStress, strain, now.dt, past));
            });
            Self::add(point, &section, &mut stress);
        }
        stress
    }

    /// The elastic derivative less what layers lose that yield.
    fn linearise<'a>(
        &'a self,
        strain: &[[f64; M]; 2],
        now: &Configuration,
        moduli: Moduli,
        room: &'a mut Plane<M>,
    ) -> ([[f64; M]; 2], &'a Plane<M>) {
        if moduli == Moduli::Elastic {
            return (self.stress(strain, now), &self.elastic);
        }
        let mut stress = [[0.0; M]; 2];
        let mut yields = false;
        let all = self.layers.at.len() * self.layers.memory;
        for (point, past) in self.points.iter().zip(now.history[self.share()].chunks_exact(all)) {
            let mut section = [[0.0; 3]; 2];
            // By the power of z.
            let mut loss = [[[0.0; 3]; 3]; 3];
            let mut here = false;
            self.through(point, strain, past, |[z, w], strain, past| {
                let (sigma, C) = self.layers.law.linearise(PlaneStress, strain, now.dt, past);
                pile(&mut section, [z, w], &sigma);
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
                    room.clone_from(&self.elastic);
                    (room.coupled, yields) = (true, true);
                }
                let Spread { A, weight } = point;
                for (loss, K) in loss.iter().zip([&mut room.N, &mut room.NM, &mut room.M]) {
                    subtract(*weight, A, loss, K);
                }
            }
        }
        (stress, if yields { room } else { &self.elastic })
    }

    fn energy(&self, strain: &[[f64; M]; 2], now: &Configuration) -> f64 {
        let mut sum = 0.0;
        self.each(strain, now.history, |_, [_, w], strain, past| {
            sum += w * self.layers.law.elastic_energy(PlaneStress, strain, past);
        });
        sum
    }

    fn update_history(
        &self,
        strain: &[[f64; M]; 2],
        now: &Configuration,
        part: f64,
        history: &mut [f64],
    ) -> Dissipation {
        let mut spent = Dissipation::default();
        let mut new = history[self.share()].chunks_exact_mut(self.layers.memory);
        self.each(strain, now.history, |_, [_, w], strain, past| {
            if let Some(new) = new.next() {
                spent += self.layers.law.advance(PlaneStress, strain, (now.dt, part), past, new).1 * w;
            }
        });
        spent
    }

    fn layers(&self, strain: &[[f64; M]; 2], now: &Configuration, layers: &mut [Layer]) -> usize {
        let count = self.layers.at.len();
        let layers = &mut layers[..count];
        layers.fill(Layer::default());
        let whole: f64 = self.points.iter().map(|point| point.weight).sum();
        let mut next = 0;
        self.each(strain, now.history, |point, [z, _], strain, past| {
            let layer = &mut layers[next % count];
            next += 1;
            let sigma = self.layers.law.stress(PlaneStress, strain, now.dt, past);
            layer.z = z;
            (0..3).for_each(|i| layer.stress[i] += point.weight / whole * sigma[i]);
            layer.plastic_strain = layer.plastic_strain.max(self.layers.law.accumulated(PlaneStress, past));
        });
        count
    }

    fn plastic_strain(&self, past: &[f64]) -> f64 {
        let memories = past[self.share()].chunks_exact(self.layers.memory);
        memories.map(|past| self.layers.law.accumulated(PlaneStress, past)).fold(0.0, f64::max)
    }

    fn history(&self) -> usize {
        self.points.len() * self.layers.at.len() * self.layers.memory
    }
}
