//! Joints between bodies of their own (see [`Masses`]) by a small dense system, a row for each multiplier: (G M⁻¹ Gᵀ) λ = c.
//! It gives accelerations that the joints allow, and closes their gaps by the least change in the norm of the masses.

use super::equations::System;
use super::masses::Masses;
use super::multipliers::REGULARIZATION;
use crate::elements::Force;
use crate::math::{Vec6, angular, linear, stack};
use crate::state::Node;

/// Rows at most: beyond, a sparse factorisation is cheaper.
const MOST: usize = 64;

/// Part of a row that counts as none.
const NEGLIGIBLE: f64 = 1e-12;

/// Allocated once.
pub struct ConstraintSchur {
    /// Of each row: the nodes that move the two ends of its joint, where they are unknown.
    rows: Vec<[Option<usize>; 2]>,
    /// Rows of a joint may say what others say.
    shares: bool,
    /// ∂c/∂(x, θ) of the nodes that move the ends, and the accelerations that a unit of the multiplier causes there.
    G: Vec<[Vec6; 2]>,
    W: Vec<[Vec6; 2]>,
    /// Rows that pull at held directions only, as out of the plane of bodies that stay in one: no acceleration answers them, and
    /// they carry nothing.
    inert: Vec<bool>,
    /// G M⁻¹ Gᵀ, and its Cholesky factor; row-major.
    S: Vec<f64>,
    L: Vec<f64>,
    /// What is asked for, then what answers it, and room beside it.
    pub x: Vec<f64>,
    scratch: Vec<f64>,
}

impl ConstraintSchur {
    /// `None`: too many rows, or an end rides in some directions only.
    pub fn new(system: &System, masses: &Masses, shares: bool) -> Option<ConstraintSchur> {
        let count = system.multipliers();
        if count > MOST {
            return None;
        }
        let master = |node: usize| {
            let mut node = node;
            while let Some(dependent) = system.rigid_links.iter().find(|dependent| dependent.node == node) {
                if !dependent.rigid {
                    return None;
                }
                node = dependent.master;
            }
            Some(node)
        };
        let mut rows = Vec::with_capacity(count);
        for joint in &system.joints {
            let mut ends = [None; 2];
            for (end, &node) in ends.iter_mut().zip(&joint.nodes) {
                let master = master(node)?;
                *end = masses.of(master).map(|_| master);
            }
            rows.extend(joint.equations.iter().map(|_| ends));
        }
        let zeros = vec![[Vec6::zeros(); 2]; count];
        let square = vec![0.0; count * count];
        let x = vec![0.0; count];
        let inert = vec![false; count];
        Some(ConstraintSchur {
            rows,
            shares,
            G: zeros.clone(),
            W: zeros,
            inert,
            S: square.clone(),
            L: square,
            scratch: x.clone(),
            x,
        })
    }

    /// Forms and factorises the system for joints as they lie; false where they leave no way to close them.
    pub fn form(&mut self, system: &System, masses: &Masses, nodes: &[Node]) -> bool {
        let mut k = 0;
        for joint in &system.joints {
            let [a, b] = joint.nodes.map(|node| &nodes[node]);
            for row in &joint.equations {
                let gradient = row.gradient(a, b);
                let (mut whole, mut moving) = (0.0f64, 0.0f64);
                for end in 0..2 {
                    let Some(master) = self.rows[k][end] else { continue };
                    let (f, m) = (linear(&gradient[end]), angular(&gradient[end]));
                    let arm = nodes[joint.nodes[end]].x - nodes[master].x;
                    let G = stack(&f, &(m + arm.cross(&f)));
                    self.G[k][end] = G;
                    let Some(block) = masses.of(master) else { continue };
                    self.W[k][end] = block.accelerate(&nodes[master], G.as_ref());
                    whole = whole.max(G.amax());
                    let free = G.iter().zip(block.free).filter(|(_, free)| *free);
                    moving = free.map(|(g, _)| g.abs()).fold(moving, f64::max);
                }
                self.inert[k] = moving <= NEGLIGIBLE * whole;
                k += 1;
            }
        }
        self.factor()
    }

    fn factor(&mut self) -> bool {
        let n = self.rows.len();
        for k in 0..n {
            for l in 0..=k {
                let mut sum = 0.0;
                let inert = self.inert[k] || self.inert[l];
                for (i, master) in self.rows[k].iter().enumerate().filter(|_| !inert) {
                    for (j, other) in self.rows[l].iter().enumerate() {
                        if master.is_some() && master == other {
                            sum += self.G[k][i].dot(&self.W[l][j]);
                        }
                    }
                }
                self.S[k * n + l] = sum;
                self.S[l * n + k] = sum;
            }
        }
        self.L.copy_from_slice(&self.S);
        let L = &mut self.L;
        for k in 0..n {
            if self.shares {
                L[k * n + k] *= 1.0 + REGULARIZATION;
            }
            for l in 0..k {
                let sum: f64 = (0..l).map(|i| L[k * n + i] * L[l * n + i]).sum();
                L[k * n + l] = (L[k * n + l] - sum) / L[l * n + l];
            }
            if self.inert[k] {
                L[k * n + k] = 1.0;
                continue;
            }
            let sum: f64 = (0..k).map(|i| L[k * n + i] * L[k * n + i]).sum();
            let pivot = L[k * n + k] - sum;
            if pivot <= 0.0 || pivot.is_nan() {
                return false;
            }
            L[k * n + k] = pivot.sqrt();
        }
        true
    }

    /// x ← (G M⁻¹ Gᵀ)⁻¹ x; of rows that say the same, each has its share.
    pub fn solve(&mut self) {
        let n = self.rows.len();
        self.x.iter_mut().zip(&self.inert).filter(|(_, inert)| **inert).for_each(|(x, _)| *x = 0.0);
        if !self.shares {
            return substitute(&self.L, &mut self.x);
        }
        // The shares leave a part of what is asked to be found again; twice leaves its square.
        std::mem::swap(&mut self.scratch, &mut self.x);
        self.x.copy_from_slice(&self.scratch);
        substitute(&self.L, &mut self.x);
        for k in 0..n {
            let done: f64 = self.S[k * n..(k + 1) * n].iter().zip(&self.x).map(|(s, x)| s * x).sum();
            self.scratch[k] -= done;
        }
        substitute(&self.L, &mut self.scratch);
        self.x.iter_mut().zip(&self.scratch).for_each(|(x, more)| *x += more);
    }

    /// x ← x + G δ, by node.
    pub fn add_rates(&mut self, motion: &[Vec6]) {
        for ((x, ends), G) in self.x.iter_mut().zip(&self.rows).zip(&self.G) {
            *x += ends.iter().zip(G).filter_map(|(master, G)| master.map(|master| G.dot(&motion[master]))).sum::<f64>();
        }
    }

    /// F ← F − Gᵀ x, on the nodes that move.
    pub fn subtract_forces(&self, F: &mut [Force]) {
        for ((x, ends), G) in self.x.iter().zip(&self.rows).zip(&self.G) {
            for (master, G) in ends.iter().zip(G) {
                if let Some(master) = master {
                    F[*master].iter_mut().zip(G).for_each(|(f, G)| *f -= G * x);
                }
            }
        }
    }

    /// δ ← δ − M⁻¹ Gᵀ x, by node.
    pub fn subtract_response(&self, motion: &mut [Vec6]) {
        for ((x, ends), W) in self.x.iter().zip(&self.rows).zip(&self.W) {
            for (master, W) in ends.iter().zip(W) {
                if let Some(master) = master {
                    motion[*master] -= W * *x;
                }
            }
        }
    }
}

/// L Lᵀ x = b.
fn substitute(L: &[f64], x: &mut [f64]) {
    let n = x.len();
    for k in 0..n {
        let sum: f64 = (0..k).map(|i| L[k * n + i] * x[i]).sum();
        x[k] = (x[k] - sum) / L[k * n + k];
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|i| L[i * n + k] * x[i]).sum();
        x[k] = (x[k] - sum) / L[k * n + k];
    }
}
