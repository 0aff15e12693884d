//! Terms of second order in the elastic energy of a reduced part: bending shortens it, and axial forces stiffen it.
//!
//! The coordinates p = L q belong to vectors v_i with K v_i = λ_i W v_i, softest first. W is a sum of squares of slopes.
//! The cubic part of the energy, Σ c_ijk p_i p_j p_k over i ≥ j ≥ k, belongs to the stiffest of the three. So the energy is
//!   U = ½ qᵀ K q + Σ λ_i (p_i e_i + ½ e_i²),  e_i = Σ c_ijk p_j p_k / λ_i.
//!
//! It contains the squares ½ λ_i (p_i + e_i)². A beam that bends freely becomes shorter by e, without an axial force.

use super::vectors::{add_multiple, dot};

/// The coordinates and their products.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SecondOrder {
    /// L: a row for each coordinate.
    pub coordinates: Vec<f64>,
    /// λ of each coordinate.
    pub stiffness: Vec<f64>,
    /// The products.
    pub terms: Vec<Product>,
}

/// Two coordinates whose product, times a factor, adds to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Product {
    /// i.
    pub sum: usize,
    /// j and k.
    pub of: [usize; 2],
    /// c_ijk / λ_i.
    pub factor: f64,
}

/// Memory of an evaluation.
#[derive(Debug, Clone, Default)]
pub struct SecondOrderMemory {
    p: Vec<f64>,
    e: Vec<f64>,
    /// λ_i (p_i + e_i).
    s: Vec<f64>,
    /// ∂U/∂p without the part of K.
    force: Vec<f64>,
    /// ∂e/∂p.
    E: Vec<f64>,
    /// ∂²U/∂p² without Λ.
    change: Vec<f64>,
    /// Its product with L.
    product: Vec<f64>,
}

impl SecondOrderMemory {
    /// Memory for these terms.
    pub fn new(of: &SecondOrder) -> SecondOrderMemory {
        let count = of.stiffness.len();
        let vector = vec![0.0; count];
        let square = vec![0.0; count * count];
        SecondOrderMemory {
            p: vector.clone(),
            e: vector.clone(),
            s: vector.clone(),
            force: vector,
            E: square.clone(),
            change: square,
            product: vec![0.0; of.coordinates.len()],
        }
    }
}

impl SecondOrder {
    /// Writes p, e and λ (p + e).
    fn evaluate(&self, q: &[f64], SecondOrderMemory { p, e, s, .. }: &mut SecondOrderMemory) {
        for (p, row) in p.iter_mut().zip(self.coordinates.chunks_exact(q.len())) {
            *p = dot(row, q);
        }
        e.fill(0.0);
        for Product { sum, of: [j, k], factor } in &self.terms {
            e[*sum] += factor * p[*j] * p[*k];
        }
        for (i, s) in s.iter_mut().enumerate() {
            *s = self.stiffness[i] * (p[i] + e[i]);
        }
    }

    /// The energy beside ½ qᵀ K q.
    pub fn energy(&self, q: &[f64], memory: &mut SecondOrderMemory) -> f64 {
        self.evaluate(q, memory);
        let SecondOrderMemory { p, e, .. } = memory;
        (0..p.len()).map(|i| self.stiffness[i] * e[i] * (p[i] + 0.5 * e[i])).sum()
    }

    /// Adds its derivatives by q to `g`.
    pub fn add_forces(&self, q: &[f64], memory: &mut SecondOrderMemory, g: &mut [f64]) {
        self.evaluate(q, memory);
        let SecondOrderMemory { p, e, s, force, .. } = memory;
        for (i, force) in force.iter_mut().enumerate() {
            *force = self.stiffness[i] * e[i];
        }
        self.add_products(p, s, force);
        self.add_rows(force, g);
    }

    /// Adds the forces by β times the rates of strain ṗ + ė, beside β K q̇, to `g`.
    pub fn add_viscous(&self, (q, rates): (&[f64], &[f64]), beta: f64, memory: &mut SecondOrderMemory, g: &mut [f64]) {
        let SecondOrderMemory { p, e, s, force, E, .. } = memory;
        let own = &mut E[..p.len()];
        for (i, row) in self.coordinates.chunks_exact(q.len()).enumerate() {
            (p[i], own[i]) = (dot(row, q), dot(row, rates));
        }
        e.fill(0.0);
        for Product { sum, of: [j, k], factor } in &self.terms {
            e[*sum] += factor * (p[*j] * own[*k] + own[*j] * p[*k]);
        }
        for (i, stiffness) in self.stiffness.iter().enumerate() {
            (force[i], s[i]) = (beta * stiffness * e[i], beta * stiffness * (own[i] + e[i]));
        }
        self.add_products(p, s, force);
        self.add_rows(force, g);
    }

    /// Adds the forces on both coordinates of each product that follow from the force on its sum.
    fn add_products(&self, p: &[f64], sums: &[f64], force: &mut [f64]) {
        for Product { sum, of: [j, k], factor } in &self.terms {
            let by = factor * sums[*sum];
            force[*j] += by * p[*k];
            force[*k] += by * p[*j];
        }
    }

    /// Adds Lᵀ times forces.
    fn add_rows(&self, force: &[f64], g: &mut [f64]) {
        for (force, row) in force.iter().zip(self.coordinates.chunks_exact(g.len())) {
            add_multiple(g, *force, row);
        }
    }

    /// Adds its second derivatives by q to a square matrix, those of strains times a factor.
    pub fn add_stiffness(&self, q: &[f64], of_strains: f64, memory: &mut SecondOrderMemory, K: &mut [f64]) {
        self.evaluate(q, memory);
        let SecondOrderMemory { p, s, E, change, product, .. } = memory;
        let (count, size) = (p.len(), q.len());
        E.fill(0.0);
        change.fill(0.0);
        for Product { sum, of: [j, k], factor } in &self.terms {
            E[sum * count + j] += factor * p[*k];
            E[sum * count + k] += factor * p[*j];
            change[j * count + k] += s[*sum] * factor;
            change[k * count + j] += s[*sum] * factor;
        }
        // ΛE + EᵀΛ + EᵀΛE = EᵀΛ (I + E) + ΛE
        for (i, (row, stiffness)) in E.chunks_exact(count).zip(&self.stiffness).enumerate() {
            for j in (0..count).filter(|&j| row[j] != 0.0) {
                let by = of_strains * stiffness * row[j];
                add_multiple(&mut change[j * count..(j + 1) * count], by, row);
                change[j * count + i] += by;
                change[i * count + j] += by;
            }
        }
        product.fill(0.0);
        for (product, row) in product.chunks_exact_mut(size).zip(change.chunks_exact(count)) {
            for (entry, coordinate) in row.iter().zip(self.coordinates.chunks_exact(size)) {
                add_multiple(product, *entry, coordinate);
            }
        }
        for (coordinate, product) in self.coordinates.chunks_exact(size).zip(product.chunks_exact(size)) {
            for (K, by) in K.chunks_exact_mut(size).zip(coordinate) {
                add_multiple(K, *by, product);
            }
        }
    }
}
