//! Mass and inertia of parts as integrals over their elements.

use base::math::{Mat3, Vec3};

/// Integrals of density over elements: 1, x, x xᵀ; and the rotary inertia. Also of 1 instead of density, where there is none.
#[derive(Default)]
pub struct MassIntegrals {
    /// Integral of the density.
    pub mass: f64,
    first: Vec3,
    second: Mat3,
    /// Rotary inertia of sections and thicknesses about the axes and surfaces on which the mass lies.
    pub rotary: Mat3,
    size: f64,
    first_of_size: Vec3,
}

impl MassIntegrals {
    /// An element with `parts` of its size at pairs of its nodes, and a density.
    pub fn add(&mut self, density: f64, x: &[Vec3], part: impl Fn(usize, usize) -> f64) {
        for a in 0..x.len() {
            for b in 0..x.len() {
                let size = part(a, b);
                self.size += size;
                self.first_of_size += size * x[b];
                self.mass += density * size;
                self.first += density * size * x[b];
                self.second += density * size * x[a] * x[b].transpose();
            }
        }
    }

    /// The centre of mass; without mass, the centroid of the elements.
    pub fn center(&self) -> Vec3 {
        if self.mass > 0.0 { self.first / self.mass } else { self.first_of_size / self.size }
    }

    /// The inertia tensor about the centre of mass.
    pub fn inertia(&self) -> Mat3 {
        let c = self.center();
        let S = self.second - self.mass * c * c.transpose();
        let J = self.rotary + S.trace() * Mat3::identity() - S;
        0.5 * (J + J.transpose())
    }
}

/// ∫ N_a N_b over a segment of length one.
pub fn line_mass(a: usize, b: usize) -> f64 {
    if a == b { 1.0 / 3.0 } else { 1.0 / 6.0 }
}
