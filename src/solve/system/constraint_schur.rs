//! Joints between nodes that are separate rigid bodies (see [`Masses`]), by the Schur complement of the constraint equations: (G M⁻¹ Gᵀ) λ
//! = c. It gives accelerations that the joints allow, and closes gaps by the least change of positions in the norm of the masses.

use super::equations::System;
use super::gradients::Gradients;
use super::masses::Masses;
use super::schur_group::{self, SchurGroup};
use crate::tolerances::constraint_schur::NEGLIGIBLE;
use base::math::{Vec3, Vec6, angular, linear, stack};
use base::snapshot::keep;
use mechanics::constraints::joint::MOST_ENDS;
use mechanics::elements::Force;
use mechanics::state::Node;
use std::ops::Range;

/// The system of the constraint equations. It is allocated once, before the first step.
pub struct ConstraintSchur {
    /// The gradients G and the responses M⁻¹ Gᵀ.
    gradients: Gradients,
    /// True where constraint equations may be redundant.
    shares: bool,
    /// The translations, and the rotations, of each joint. Their diagonals are raised by a common value, so that the loads shared by
    /// redundant equations do not depend on the axes of the equations.
    alike: Vec<Range<usize>>,
    /// Weights of the loads of equations that redundant ones share.
    weights: Vec<f64>,
    /// Equations between restrained degrees of freedom only, such as those out of the plane of a plane motion. They cause no acceleration,
    /// and their multipliers stay zero.
    inert: Vec<bool>,
    /// G M⁻¹ Gᵀ of groups of joints that no body connects, and their factors.
    groups: Vec<SchurGroup>,
    /// Right-hand side on entry of [`ConstraintSchur::solve`], then the solution.
    pub x: Vec<f64>,
}

keep!(ConstraintSchur { gradients, inert, x } without { shares, alike, weights, groups });

/// The response of an equation to a unit force. Rotations from arms are excluded for translations: joints at different places of one body
/// would otherwise share loads unevenly.
fn same_kind(G: &[Vec6], W: &[Vec6]) -> f64 {
    let of = |part: fn(&Vec6) -> Vec3| G.iter().zip(W).map(|(G, W)| part(G).dot(&part(W))).sum::<f64>();
    let translations = of(linear);
    if translations > 0.0 { translations } else { of(angular) }
}

/// The translations, and the rotations, of each joint.
fn alike(system: &System) -> Vec<Range<usize>> {
    let mut all: Vec<Range<usize>> = Vec::new();
    for (joint, first) in system.numbered() {
        let kinds = joint.equations.chunk_by(|a, b| a.is_rotational() == b.is_rotational());
        all.extend(kinds.scan(first, |begin, kind| {
            let from = *begin;
            *begin += kind.len();
            Some(from..*begin)
        }));
    }
    all
}

impl ConstraintSchur {
    /// Returns `None` if memory is short, if an end depends on its master in some directions only, or if gears share a massless unknown.
    pub fn new(system: &System, masses: &Masses, shares: bool) -> Option<ConstraintSchur> {
        let count = system.multipliers();
        if system.joints.iter().any(|joint| joint.shared().is_some()) {
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
        let mut ends: Vec<Vec<Option<usize>>> = Vec::with_capacity(system.joints.len());
        for joint in &system.joints {
            let of = |node| master(node).map(|master| masses.of(master).map(|_| master));
            ends.push(joint.ends().map(of).collect::<Option<_>>()?);
        }
        let rows = system.joints.iter().zip(&ends).flat_map(|(joint, ends)| joint.equations.iter().map(|_| &ends[..]));
        let gradients = Gradients::new(rows);
        let sizes: Vec<usize> = system.joints.iter().map(|joint| joint.equations.len()).collect();
        Some(ConstraintSchur {
            groups: schur_group::of(&sizes, &gradients, shares)?,
            gradients,
            shares,
            alike: alike(system),
            weights: vec![0.0; count],
            inert: vec![false; count],
            x: vec![0.0; count],
        })
    }

    /// Forms and factorizes G M⁻¹ Gᵀ at the given configuration. Returns false where it is singular: the joints cannot
    /// be closed.
    pub fn form(&mut self, system: &System, masses: &Masses, nodes: &[Node]) -> bool {
        let mut k = 0;
        let mut room = [Vec6::zeros(); MOST_ENDS];
        for joint in &system.joints {
            for number in 0..joint.equations.len() {
                let (mut whole, mut moving) = (0.0f64, 0.0f64);
                for (end, (node, G)) in joint.ends().zip(joint.gradient(number, nodes, &mut room)).enumerate() {
                    let Some(master) = self.gradients.nodes(k)[end] else { continue };
                    let (f, m) = (linear(G), angular(G));
                    let arm = nodes[node].x - nodes[master].x;
                    let G = stack(&f, &(m + arm.cross(&f)));
                    let Some(block) = masses.of(master) else { continue };
                    self.gradients.set((k, end), G, block.accelerate(&nodes[master], G.as_ref()));
                    whole = whole.max(G.amax());
                    let free = G.iter().zip(block.free).filter(|(_, free)| *free);
                    moving = free.map(|(g, _)| g.abs()).fold(moving, f64::max);
                }
                self.inert[k] = moving <= NEGLIGIBLE * whole;
                k += 1;
            }
        }
        self.factor(masses)
    }

    fn factor(&mut self, masses: &Masses) -> bool {
        let ConstraintSchur { gradients, inert, groups, shares, alike, weights, .. } = self;
        let entry = |k: usize, l: usize| {
            let mut sum = 0.0;
            for (master, G) in gradients.nodes(k).iter().zip(gradients.of(k)) {
                for (other, W) in gradients.nodes(l).iter().zip(gradients.response(l)) {
                    if master.is_some() && master == other {
                        sum += G.dot(W);
                    }
                }
            }
            sum
        };
        if *shares {
            for range in alike.iter() {
                let own = || range.clone().filter(|&k| !inert[k]);
                let count = own().count().max(1) as f64;
                let without_arms = own().map(|k| same_kind(gradients.of(k), gradients.response(k))).sum::<f64>();
                let sum = if without_arms > 0.0 { without_arms } else { own().map(|k| entry(k, k)).sum::<f64>() };
                weights[range.clone()].fill(sum / count);
            }
        }
        groups.iter_mut().all(|group| group.factor(gradients, inert, (masses, weights), entry))
    }

    /// True where the system of a group is sparse.
    pub fn is_sparse(&self) -> bool {
        self.groups.iter().any(SchurGroup::is_sparse)
    }

    /// Solves x ← (G M⁻¹ Gᵀ)⁻¹ x. Redundant equations share the load by least norm.
    pub fn solve(&mut self) {
        self.x.iter_mut().zip(&self.inert).filter(|(_, inert)| **inert).for_each(|(x, _)| *x = 0.0);
        for group in &mut self.groups {
            group.solve(&mut self.x, self.shares);
        }
    }

    /// Adds the constraint rates: x ← x + G δ, with δ by node.
    pub fn add_rates(&mut self, motion: &[Vec6]) {
        for (x, ends) in self.x.iter_mut().zip(self.gradients.each()) {
            *x += ends.map(|(node, G, _)| G.dot(&motion[node])).sum::<f64>();
        }
    }

    /// Subtracts the constraint forces on independent nodes: F ← F − Gᵀ x.
    pub fn subtract_forces(&self, F: &mut [Force]) {
        for (x, ends) in self.x.iter().zip(self.gradients.each()) {
            ends.for_each(|(node, G, _)| F[node].iter_mut().zip(G).for_each(|(f, G)| *f -= G * x));
        }
    }

    /// Subtracts the response to the constraint forces: δ ← δ − M⁻¹ Gᵀ x, by node.
    pub fn subtract_response(&self, motion: &mut [Vec6]) {
        for (x, ends) in self.x.iter().zip(self.gradients.each()) {
            ends.for_each(|(node, _, W)| motion[node] -= W * *x);
        }
    }
}
