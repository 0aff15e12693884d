//! The gyroscopic moments of bodies that spin, and the Coriolis forces in frames that turn with centrifugal loads, as matrices of small motions.
//!
//! A small rotation θ of a body changes its angular momentum π by θ×π + Jθ̇, whatever its earlier rotation. The rate changes by Jθ̈ + (ω~J
//! − Jω~ − π~)θ̇ − π̇~θ. About an axis of symmetry the first two terms cancel.

use super::linearized::Linearized;
use super::mode::EigenMode;
use super::speed_modes::Whirl;
use super::spinning_parts::spinning_parts;
use crate::system::{ConsistentMass, dependents};
use crate::tolerances::gyroscopic::{ORBIT, SAG, SYMMETRIC, UNEVEN};
use base::math::{Mat3, Mat6, Vec3, angular, linear, skew};
use base::names::short;
use model::Part;
use std::collections::BTreeMap;

/// The rows and columns of two nodes.
type Rows = [[Option<usize>; 6]; 2];

/// The matrices of the bodies and parts that spin.
pub struct Gyroscopic {
    /// The matrices of rates and of motions between two nodes.
    blocks: Vec<(Rows, [Mat6; 2])>,
    /// The sum of the angular momenta, whose direction is that of the spin.
    momentum: Vec3,
    /// Neglected terms, in words.
    pub warnings: Vec<String>,
}

impl Gyroscopic {
    /// The matrices of the bodies that spin in a state.
    pub fn of(at: &Linearized) -> Gyroscopic {
        let mut gyroscopic = Gyroscopic { blocks: Vec::new(), momentum: Vec3::zeros(), warnings: Vec::new() };
        let mut sums = Sums::new(at);
        sums.add_coriolis(at);
        for inertia in &at.system.inertias {
            let (root, arm) = at.root(inertia.node);
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
            let varies = |omega: &Vec3| skew(omega) * J - J * skew(omega);
            let is_round = |omega: &Vec3| varies(omega).norm() <= SYMMETRIC * (J * omega).norm();
            let near = [omega, along_principal_axis(J, &omega)].into_iter().find(is_round);
            let omega = near.unwrap_or(omega);
            let (momentum, varies) = (J * omega, varies(&omega));
            gyroscopic.momentum += momentum;
            if near.is_none() {
                gyroscopic.warnings.push(format!(
                    "`{}` is not symmetric about its spin axis: its inertia varies as it rotates, and modes are those of the current instant. Give it equal \
                     moments of `inertia` about both other axes, or compute the motion with `kind = \"dynamic\"`",
                    name()
                ));
            }
            let of_turns = [varies - skew(&momentum), -skew(&omega.cross(&momentum))].map(|of_turns| {
                let mut of = Mat6::zeros();
                of.fixed_view_mut::<3, 3>(3, 3).copy_from(&of_turns);
                of
            });
            sums.add([root; 2], &of_turns);
        }
        for part in spinning_parts(at) {
            gyroscopic.momentum += part.momentum;
            part.visit(&mut |ends, of| sums.add(ends, of));
            gyroscopic.warnings.extend(part.warning);
        }
        gyroscopic.warnings.extend(at.model.parts.iter().filter_map(|part| uneven_spin(at, part)));
        let rows = |node: usize| std::array::from_fn(|dof| at.plan.dofs.row(node, dof));
        gyroscopic.blocks = sums.of.into_iter().map(|(ends, of)| (ends.map(rows), of)).collect();
        gyroscopic.warnings.dedup();
        gyroscopic
    }

    /// True where anything spins.
    pub fn acts(&self) -> bool {
        !self.blocks.is_empty()
    }

    /// The orbits of a mode, weighted by mass and inertia.
    pub fn whirl(&self, at: &Linearized, mode: &EigenMode) -> Option<Whirl> {
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
        for part in &at.model.reductions {
            let nodes = part.nodes();
            let mass = part.made.as_ref().map_or(0.0, |made| made.mass()) / nodes.clone().count() as f64;
            nodes.for_each(|node| orbit([mass; 2], linear(&mode.shape[node]), linear(&mode.quadrature[node])));
        }
        for (node, _, mass) in at.system.consistent.iter().flat_map(ConsistentMass::pairs) {
            orbit([mass; 2], linear(&mode.shape[node]), linear(&mode.quadrature[node]));
        }
        // Torsion and motion along the shaft have no orbits, and rounding across it has any.
        if size <= ORBIT * along {
            return (along > 0.0).then_some(Whirl { sense: 0.0, is_along: true });
        }
        Some(Whirl { sense: sense / size, is_along: false })
    }

    /// Hands the entries of the matrix of rates to `visit`.
    pub fn damping(&self, visit: &mut dyn FnMut(usize, usize, f64)) {
        self.entries(&mut |i, j, [rate, _]| visit(i, j, rate));
    }

    /// Hands the entries of both matrices, of rates and of turns, to `visit`.
    pub fn entries(&self, visit: &mut dyn FnMut(usize, usize, [f64; 2])) {
        for ([rows, columns], [rate, turn]) in &self.blocks {
            for (i, row) in rows.iter().enumerate() {
                for (j, column) in columns.iter().enumerate() {
                    if let (Some(row), Some(column)) = (row, column) {
                        visit(*row, *column, [rate[(i, j)], turn[(i, j)]]);
                    }
                }
            }
        }
    }
}

/// A warning for a beam with different spins at the ends of an element. No steady motion has them.
fn uneven_spin(at: &Linearized, part: &Part) -> Option<String> {
    let has_torsion = part.kind().has_sections();
    (0..if has_torsion { part.elements() } else { 0 }).find_map(|element| {
        let &[first, .., last] = part.nodes(element) else { return None };
        let axis = (at.model.nodes[last].x - at.model.nodes[first].x).try_normalize(0.0)?;
        let ends = [first, last].map(|node| at.root(node).0);
        let spins = ends.map(|node| at.state.nodes[node].omega.dot(&axis));
        let fastest = spins.map(f64::abs).into_iter().fold(0.0, f64::max);
        let is_uneven = (spins[1] - spins[0]).abs() > UNEVEN * fastest && at.spins(&(fastest * axis));
        is_uneven.then(|| {
            let [from, to] = ends.map(|node| &at.model.nodes[node].label);
            format!(
                "`{}` spins at {} rad per unit of time at `{from}` and at {} at `{to}`: modes omit the torsion that this causes. Give all of it one \
                 `angular_velocity`",
                part.name(),
                short(spins[0]),
                short(spins[1])
            )
        })
    })
}

/// An angular velocity turned to the principal axis beside it. Sag turns that axis from the spin.
fn along_principal_axis(J: Mat3, omega: &Vec3) -> Vec3 {
    let axes = J.symmetric_eigen().eigenvectors;
    let along = axes
        .column_iter()
        .map(|axis| axis * axis.dot(omega))
        .find(|along| along.cross(omega).norm() <= SAG * along.norm() * omega.norm() && along.norm() > 0.0);
    along.map_or(*omega, |along| along.normalize() * omega.norm())
}

/// Matrices of rates and of motions between the independent nodes, by pairs of these.
struct Sums {
    independent: Vec<Vec<usize>>,
    projections: Vec<Vec<Mat6>>,
    of: BTreeMap<[usize; 2], [Mat6; 2]>,
}

impl Sums {
    fn new(at: &Linearized) -> Sums {
        let (nodes, links) = (&at.state.nodes, &at.system.rigid_links);
        let independent = dependents::independent_nodes(links, nodes.len());
        let projections = dependents::projections(links, nodes, &independent);
        Sums { independent, projections, of: BTreeMap::new() }
    }

    /// Adds the matrices between two nodes.
    fn add(&mut self, ends: [usize; 2], of: &[Mat6; 2]) {
        let [left, right] = ends.map(|end| self.independent[end].iter().zip(&self.projections[end]));
        for (row, P) in left {
            for (column, Q) in right.clone() {
                let sums = self.of.entry([*row, *column]).or_insert_with(|| [Mat6::zeros(); 2]);
                sums.iter_mut().zip(of).for_each(|(sum, of)| *sum += P.transpose() * of * Q);
            }
        }
    }

    /// Adds the Coriolis matrices of all masses under centrifugal loads.
    fn add_coriolis(&mut self, at: &Linearized) {
        for (load, square) in
            at.system.centrifugal().iter().zip(&at.loading.squares).filter(|(_, square)| **square > 0.0)
        {
            load.coriolis(square.sqrt(), &at.state.nodes, &mut |ends, G: &Mat6| self.add(ends, &[*G, Mat6::zeros()]));
        }
    }
}
