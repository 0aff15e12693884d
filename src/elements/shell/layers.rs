//! A shell as layers in plane stress, each with a memory of its own: what yields. Transverse shear stays elastic.

use super::geometry::Spread;
use super::section::{Plane, Section};
use super::{Moduli, Now};
use crate::elements::Layer;
use crate::materials::{Law, PlaneStress, Spent};
use crate::math::quadrature;
use std::array::from_fn;
use std::ops::Range;
use std::sync::Arc;

/// Gauss points through the thickness at most.
pub const MOST_LAYERS: usize = 7;

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
        let mut memories = past[self.share()].chunks_exact(self.layers.memory);
        for point in &self.points {
            let [e, k] = Self::strain(point, strain);
            for (&[z, w], past) in self.layers.at.iter().zip(&mut memories) {
                of(point, [z, w * point.weight], &from_fn(|i| e[i] + z * k[i]), past);
            }
        }
    }

    #[inline(always)]
    fn add(point: &Spread<M>, [z, w]: [f64; 2], sigma: &[f64; 3], stress: &mut [[f64; M]; 2]) {
        for m in 0..M {
            let s = w * (0..3).map(|i| point.A[(i, m)] * sigma[i]).sum::<f64>();
            stress[0][m] += s;
            stress[1][m] += z * s;
        }
    }
}

impl<const M: usize> Section<M> for Layered<M> {
    fn elastic(&self) -> &Plane<M> {
        &self.elastic
    }

    fn stress(&self, strain: &[[f64; M]; 2], now: &Now) -> [[f64; M]; 2] {
        let mut stress = [[0.0; M]; 2];
        self.each(strain, now.past, |point, at, strain, past| {
            Self::add(point, at, &self.layers.law.stress(PlaneStress, strain, now.since, past), &mut stress);
        });
        stress
    }

    /// The elastic derivative less what layers lose that yield.
    fn linearise<'a>(
        &'a self,
        strain: &[[f64; M]; 2],
        now: &Now,
        moduli: Moduli,
        room: &'a mut Plane<M>,
    ) -> ([[f64; M]; 2], &'a Plane<M>) {
        if moduli == Moduli::Elastic {
            return (self.stress(strain, now), &self.elastic);
        }
        let mut stress = [[0.0; M]; 2];
        let mut yields = false;
        *room = self.elastic.clone();
        self.each(strain, now.past, |point, at, strain, past| {
            let (sigma, C) = self.layers.law.linearise(PlaneStress, strain, now.since, past);
            Self::add(point, at, &sigma, &mut stress);
            let Some(C) = C else { return };
            yields = true;
            let [z, w] = at;
            let loss: [[f64; 3]; 3] = from_fn(|i| from_fn(|j| w * (self.layers.stiffness[i][j] - C[i][j])));
            for n in 0..M {
                let column: [f64; 3] = from_fn(|i| (0..3).map(|j| loss[i][j] * point.A[(j, n)]).sum());
                for m in 0..M {
                    let c: f64 = (0..3).map(|i| point.A[(i, m)] * column[i]).sum();
                    room.N[m][n] -= c;
                    room.NM[m][n] -= z * c;
                    room.M[m][n] -= z * z * c;
                }
            }
        });
        room.coupled = yields;
        (stress, if yields { room } else { &self.elastic })
    }

    fn energy(&self, strain: &[[f64; M]; 2], now: &Now) -> f64 {
        let mut sum = 0.0;
        self.each(strain, now.past, |_, [_, w], strain, past| {
            sum += w * self.layers.law.elastic_energy(PlaneStress, strain, past);
        });
        sum
    }

    fn remember(&self, strain: &[[f64; M]; 2], now: &Now, part: f64, history: &mut [f64]) -> Spent {
        let mut spent = Spent::default();
        let mut new = history[self.share()].chunks_exact_mut(self.layers.memory);
        self.each(strain, now.past, |_, [_, w], strain, past| {
            if let Some(new) = new.next() {
                spent += self.layers.law.advance(PlaneStress, strain, (now.since, part), past, new).1 * w;
            }
        });
        spent
    }

    fn layers(&self, strain: &[[f64; M]; 2], now: &Now, layers: &mut [Layer]) -> usize {
        let count = self.layers.at.len();
        let layers = &mut layers[..count];
        layers.fill(Layer::default());
        let whole: f64 = self.points.iter().map(|point| point.weight).sum();
        let mut next = 0;
        self.each(strain, now.past, |point, [z, _], strain, past| {
            let layer = &mut layers[next % count];
            next += 1;
            let sigma = self.layers.law.stress(PlaneStress, strain, now.since, past);
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
