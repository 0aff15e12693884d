//! The gyroscopic moments of bodies that spin, as matrices of small motions.
//!
//! A small rotation θ of a body changes its angular momentum π by θ×π + Jθ̇, whatever its earlier rotation. The rate changes by Jθ̈ + (ω~J
//! − Jω~ − π~)θ̇ − π̇~θ. About an axis of symmetry the first two terms cancel.

use super::linearized::Linearized;
use crate::tolerances::gyroscopic::SYMMETRIC;
use base::math::{Mat3, skew};

/// The matrices of the bodies that spin.
pub struct Gyroscopic {
    /// The rows of the rotations of a node, with the matrices of θ̇ and of θ.
    blocks: Vec<([Option<usize>; 3], Mat3, Mat3)>,
    /// Neglected terms, in words.
    pub warnings: Vec<String>,
}

impl Gyroscopic {
    /// The matrices of the bodies that spin in a state.
    pub fn of(at: &Linearized) -> Gyroscopic {
        let mut gyroscopic = Gyroscopic { blocks: Vec::new(), warnings: Vec::new() };
        let links = &at.system.rigid_links;
        for inertia in &at.system.inertias {
            let mut root = inertia.node;
            let mut arm = false;
            while let Some(link) = links.iter().find(|link| link.node == root && link.rigid) {
                arm |= link.S0.norm() > 0.0;
                root = link.master;
            }
            let node = &at.state.nodes[root];
            let omega = node.omega;
            if !at.spins(&omega) {
                continue;
            }
            let name = || at.model.nodes[root].label.clone();
            if arm && inertia.mass > 0.0 {
                gyroscopic.warnings.push(format!(
                    "`{}` carries masses away from its centre while it spins: their gyroscopic and centrifugal forces are left out",
                    name()
                ));
            }
            if !inertia.rotary {
                continue;
            }
            let J = inertia.J(node);
            let momentum = J * omega;
            let varies = skew(&omega) * J - J * skew(&omega);
            if varies.norm() > SYMMETRIC * momentum.norm() {
                gyroscopic.warnings.push(format!(
                    "`{}` is not symmetric about the axis that it spins about: its inertia varies as it turns, and modes are those of \
                     the instant",
                    name()
                ));
            }
            let rows = std::array::from_fn(|i| at.plan.dofs.row(root, 3 + i));
            gyroscopic.blocks.push((rows, varies - skew(&momentum), -skew(&omega.cross(&momentum))));
        }
        gyroscopic.warnings.dedup();
        gyroscopic
    }

    /// True where anything spins.
    pub fn acts(&self) -> bool {
        !self.blocks.is_empty()
    }

    /// Hands the entries of the matrix of rates to `visit`.
    pub fn damping(&self, visit: &mut dyn FnMut(usize, usize, f64)) {
        self.entries(&mut |i, j, [rate, _]| visit(i, j, rate));
    }

    /// Hands the entries of both matrices, of rates and of turns, to `visit`.
    pub fn entries(&self, visit: &mut dyn FnMut(usize, usize, [f64; 2])) {
        for (rows, rate, turn) in &self.blocks {
            for (i, row) in rows.iter().enumerate() {
                for (j, column) in rows.iter().enumerate() {
                    if let (Some(row), Some(column)) = (row, column) {
                        visit(*row, *column, [rate[(i, j)], turn[(i, j)]]);
                    }
                }
            }
        }
    }
}
