//! The gyroscopic moments of bodies that spin, and the Coriolis forces in frames that turn with centrifugal loads, as matrices of small motions.
//!
//! A small rotation θ of a body changes its angular momentum π by θ×π + Jθ̇, whatever its earlier rotation. The rate changes by Jθ̈ + (ω~J
//! − Jω~ − π~)θ̇ − π̇~θ. About an axis of symmetry the first two terms cancel.

use super::linearized::Linearized;
use super::mode::EigenMode;
use crate::system::{ConsistentMass, dependents};
use crate::tolerances::gyroscopic::{ORBIT, SYMMETRIC};
use base::math::{Mat3, Mat6, Vec3, angular, linear, skew};
use std::collections::BTreeMap;

/// The matrices of the bodies that spin.
pub struct Gyroscopic {
    /// The rows of the rotations of a node, with the matrices of θ̇ and of θ.
    blocks: Vec<([Option<usize>; 3], Mat3, Mat3)>,
    /// The rows and columns of two nodes, with the matrix of rates: Coriolis forces.
    coriolis: Vec<([[Option<usize>; 6]; 2], Mat6)>,
    /// The sum of the angular momenta, whose direction is that of the spin.
    momentum: Vec3,
    /// Neglected terms, in words.
    pub warnings: Vec<String>,
}

/// The warning of a superelement that spins, whose gyroscopic terms are omitted.
pub fn of_superelements(at: &Linearized) -> Option<String> {
    let node = at.system.floating_nodes().find(|&node| at.spins(&at.state.nodes[node].omega))?;
    Some(format!(
        "`{}` spins with a superelement, and modes omit its gyroscopic and centrifugal forces. Replace it by beams and bodies, or compute the \
         motion with `kind = \"dynamic\"`",
        at.model.nodes[node].label
    ))
}

impl Gyroscopic {
    /// The matrices of the bodies that spin in a state.
    pub fn of(at: &Linearized) -> Gyroscopic {
        let mut gyroscopic =
            Gyroscopic { blocks: Vec::new(), coriolis: coriolis(at), momentum: Vec3::zeros(), warnings: Vec::new() };
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
                    "`{}` spins and carries masses away from its centre: modes omit their gyroscopic and centrifugal forces. Join them by a stiff beam in place \
                     of `[[attachments]]`",
                    name()
                ));
            }
            if !inertia.rotary {
                continue;
            }
            let J = inertia.J(node);
            let momentum = J * omega;
            gyroscopic.momentum += momentum;
            let varies = skew(&omega) * J - J * skew(&omega);
            if varies.norm() > SYMMETRIC * momentum.norm() {
                gyroscopic.warnings.push(format!(
                    "`{}` is not symmetric about its spin axis: its inertia varies as it rotates, and modes are those of the current instant. Give it equal \
                     moments of `inertia` about both other axes, or compute the motion with `kind = \"dynamic\"`",
                    name()
                ));
            }
            let rows = std::array::from_fn(|i| at.plan.dofs.row(root, 3 + i));
            gyroscopic.blocks.push((rows, varies - skew(&momentum), -skew(&omega.cross(&momentum))));
        }
        gyroscopic.warnings.extend(of_superelements(at));
        gyroscopic.warnings.dedup();
        gyroscopic
    }

    /// True where anything spins.
    pub fn acts(&self) -> bool {
        !self.blocks.is_empty() || !self.coriolis.is_empty()
    }

    /// The sense of the orbits of a mode, weighted by mass and inertia, as in [`EigenMode::whirl`].
    pub fn whirl(&self, at: &Linearized, mode: &EigenMode) -> Option<f64> {
        let e = self.momentum.try_normalize(0.0)?;
        if mode.root[1] == 0.0 || mode.quadrature.is_empty() {
            return None;
        }
        let (mut sense, mut size, mut along) = (0.0, 0.0, 0.0);
        let mut orbit = |[weight, polar]: [f64; 2], u: Vec3, ahead: Vec3| {
            let across = |v: Vec3| v - e * e.dot(&v);
            sense += 2.0 * weight * e.dot(&u.cross(&ahead));
            size += weight * (across(u).norm_squared() + across(ahead).norm_squared());
            along += polar * (e.dot(&u).powi(2) + e.dot(&ahead).powi(2));
        };
        for inertia in &at.system.inertias {
            let (u, ahead) = (&mode.shape[inertia.node], &mode.quadrature[inertia.node]);
            orbit([inertia.mass; 2], linear(u), linear(ahead));
            if inertia.rotary {
                let J = inertia.J(&at.state.nodes[inertia.node]);
                let polar = e.dot(&(J * e));
                orbit([0.5 * (J.trace() - polar), polar], angular(u), angular(ahead));
            }
        }
        for (node, _, mass) in at.system.consistent.iter().flat_map(ConsistentMass::pairs) {
            orbit([mass; 2], linear(&mode.shape[node]), linear(&mode.quadrature[node]));
        }
        // Torsion and motion along the shaft have no orbits, and rounding across it has any.
        if size <= ORBIT * along {
            return (along > 0.0).then_some(0.0);
        }
        Some(sense / size)
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
        for ([rows, columns], rate) in &self.coriolis {
            for (i, row) in rows.iter().enumerate() {
                for (j, column) in columns.iter().enumerate() {
                    if let (Some(row), Some(column)) = (row, column) {
                        visit(*row, *column, [rate[(i, j)], 0.0]);
                    }
                }
            }
        }
    }
}

/// The Coriolis matrices of all masses under centrifugal loads, for the independent nodes.
fn coriolis(at: &Linearized) -> Vec<([[Option<usize>; 6]; 2], Mat6)> {
    let (nodes, links) = (&at.state.nodes, &at.system.rigid_links);
    let turning = || at.system.centrifugal().iter().zip(&at.loading.squares).filter(|(_, square)| **square > 0.0);
    if turning().next().is_none() {
        return Vec::new();
    }
    let independent = dependents::independent_nodes(links, nodes.len());
    let projections = dependents::projections(links, nodes, &independent);
    let mut sums: BTreeMap<[usize; 2], Mat6> = BTreeMap::new();
    for (load, square) in turning() {
        load.coriolis(square.sqrt(), nodes, &mut |ends, G: &Mat6| {
            let [left, right] = ends.map(|end| independent[end].iter().zip(&projections[end]));
            for (row, P) in left {
                for (column, Q) in right.clone() {
                    *sums.entry([*row, *column]).or_insert_with(Mat6::zeros) += P.transpose() * G * Q;
                }
            }
        });
    }
    let rows = |node: usize| std::array::from_fn(|dof| at.plan.dofs.row(node, dof));
    sums.into_iter().map(|(ends, G)| (ends.map(rows), G)).collect()
}
