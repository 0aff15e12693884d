//! The terms of second order of a reduced part: how products of its displacements stretch it, from the forces of its elements in states that
//! its shapes deform.
//!
//! The forces along a shape i in the state of displacements d are ∂U/∂q_i. Their part of second order, ½ Σ T_ijk d_j d_k, has the third
//! derivatives T of the energy. They are those about small rotations of nodes that are rotation vectors, as the nodes inside move.

use super::linearized::Linearized;
use super::own_nodes::{OwnNodes, each_element};
use crate::tolerances::second_order::{LEAST, MECHANISM, SLOPE, SOFT, TRANSLATION};
use base::math::rotation::{exp, rates};
use base::math::{Vec3, stack};
use mechanics::elements::Force;
use mechanics::elements::superelement::{FloatingElement, Product, SecondOrder};
use mechanics::state::{Configuration, Node};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeSet;

/// The terms of a part with these shapes and this stiffness. `None`: it has no elastic motion. Displacements are those in the
/// frame of `element`, because a turn shortens a bent part along an axis at rest.
pub fn second_order(
    at: &Linearized,
    (own, shapes): (&OwnNodes, &DMatrix<f64>),
    (stiffness, element): (&DMatrix<f64>, &FloatingElement),
) -> Option<SecondOrder> {
    let size = shapes.ncols();
    let slopes = slopes(at, own, shapes);
    let gram = slopes.tr_mul(&slopes);
    let factor = gram.clone().cholesky()?.unpack();
    let half = factor.solve_lower_triangular(stiffness)?;
    let scaled = factor.solve_lower_triangular(&half.transpose())?;
    let eigen = (0.5 * (&scaled + scaled.transpose())).symmetric_eigen();
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    // Six rigid motions, and mechanisms.
    let least = MECHANISM * eigen.eigenvalues.max();
    let is_free = |at: usize| at < 6 || eigen.eigenvalues[order[at]] <= least;
    let order = &order[(0..size).find(|&at| !is_free(at))?..];
    let lambda: Vec<f64> = order.iter().map(|&k| eigen.eigenvalues[k]).collect();
    let vectors = DMatrix::from_fn(size, order.len(), |row, k| eigen.eigenvectors[(row, order[k])]);
    let mut vectors = factor.tr_solve_lower_triangular(&vectors)?;
    let coordinates = (gram * &vectors).transpose();
    vectors.column_iter_mut().for_each(|mut vector| element.relative_to_frame(vector.as_mut_slice()));
    let motions = shapes * &vectors;
    let mut deformed = Deformed { at, own, motions: &motions, nodes: at.nodes_at_rest(), F: Vec::new() };
    let soft = order.len().min(SOFT);
    let turned = &slopes * vectors.columns(0, soft);
    let scales: Vec<f64> = turned.column_iter().map(|column| SLOPE / column.amax()).collect();
    let terms = products(&mut deformed, &lambda, &scales);
    Some(kept(terms, &coordinates, lambda)).filter(|terms| !terms.terms.is_empty())
}

/// The slopes of shapes: rotations of nodes, and differences of displacements of two nodes of an element over their distance. A tenth of
/// displacements over the extent measures translations. Stretching is stiff by this measure, and bending soft at any wavelength.
fn slopes(at: &Linearized, own: &OwnNodes, shapes: &DMatrix<f64>) -> DMatrix<f64> {
    let nodes = own.nodes();
    let x = |k: usize| at.model.nodes[nodes[k]].x;
    let extent = (1..nodes.len()).map(|k| (x(k) - x(0)).norm()).fold(0.0, f64::max);
    let mut pairs = BTreeSet::new();
    each_element(at, &at.nodes_at_rest(), |of, _, _| {
        let places: Vec<usize> = of.iter().map(|&node| own.place[node]).collect();
        let of_one = |(i, &a): (usize, &usize)| places[..i].iter().map(|&b| (a.min(b), a.max(b))).collect::<Vec<_>>();
        pairs.extend(places.iter().enumerate().flat_map(of_one).filter(|&(a, b)| x(a) != x(b)));
    });
    let rows = shapes.nrows();
    let mut slopes = DMatrix::zeros(rows + 3 * pairs.len(), shapes.ncols());
    for row in 0..rows {
        let factor = if row % 6 < 3 { TRANSLATION / extent } else { 1.0 };
        slopes.row_mut(row).copy_from(&(factor * shapes.row(row)));
    }
    for (pair, (a, b)) in pairs.into_iter().enumerate() {
        let distance = (x(a) - x(b)).norm();
        for axis in 0..3 {
            let change = shapes.row(6 * a + axis) - shapes.row(6 * b + axis);
            slopes.row_mut(rows + 3 * pair + axis).copy_from(&(change / distance));
        }
    }
    slopes
}

/// The part with its nodes displaced by multiples of motions.
struct Deformed<'a> {
    at: &'a Linearized<'a>,
    own: &'a OwnNodes,
    /// Six rows for each node, and a column for each coordinate.
    motions: &'a DMatrix<f64>,
    nodes: Vec<Node>,
    F: Vec<Force>,
}

impl Deformed<'_> {
    /// ∂U/∂p of all coordinates, where these nodes are displaced.
    fn forces(&mut self, moved: &DVector<f64>) -> DVector<f64> {
        let of = self.own.nodes();
        let part = |k: usize, at: usize| Vec3::new(moved[6 * k + at], moved[6 * k + at + 1], moved[6 * k + at + 2]);
        for (k, &node) in of.iter().enumerate() {
            let x = &self.at.model.nodes[node].x;
            self.nodes[node].place(x, &Vec3::zeros(), &part(k, 0));
            self.nodes[node].rotation = exp(&part(k, 3));
        }
        self.F.clear();
        self.F.resize(self.nodes.len(), [0.0; 6]);
        let now = Configuration { nodes: &self.nodes, history: &self.at.state.history, dt: 0.0, previous: None };
        for group in &self.at.system.groups {
            group.block.subtract_forces(&group.configuration(&now), &mut self.F);
        }
        let mut forces = DVector::zeros(moved.len());
        for (k, &node) in of.iter().enumerate() {
            let F = self.F[node].map(|force| -force);
            let moment = Vec3::new(F[3], F[4], F[5]);
            let turned = rates(&-part(k, 3), &moment, &Vec3::zeros()).0;
            let force = stack(&Vec3::new(F[0], F[1], F[2]), &turned);
            forces.fixed_rows_mut::<6>(6 * k).copy_from(&force);
        }
        self.motions.tr_mul(&forces)
    }

    /// The part of even order of the forces.
    fn even(&mut self, moved: &DVector<f64>) -> DVector<f64> {
        0.5 * (self.forces(moved) + self.forces(&-moved))
    }
}

/// The products of the softest coordinates, each with a size that the part may have.
fn products(deformed: &mut Deformed, lambda: &[f64], scales: &[f64]) -> Vec<(Product, f64)> {
    let motions = deformed.motions;
    let moved: Vec<DVector<f64>> = scales.iter().enumerate().map(|(k, scale)| *scale * motions.column(k)).collect();
    let squares: Vec<DVector<f64>> = moved.iter().map(|moved| deformed.even(moved)).collect();
    let mut terms = Vec::new();
    for k in 0..scales.len() {
        for j in 0..=k {
            let scale = scales[j] * scales[k];
            let third = match j == k {
                true => 2.0 * &squares[j],
                false => deformed.even(&(&moved[j] + &moved[k])) - &squares[j] - &squares[k],
            } / scale;
            for sum in k..lambda.len() {
                let shared = match (sum == k, j == k) {
                    (true, true) => 6.0,
                    (false, false) => 1.0,
                    _ => 2.0,
                };
                let size = third[sum].abs() / (lambda[sum] * lambda[j] * lambda[k]).sqrt();
                let factor = third[sum] / (shared * lambda[sum]);
                terms.push((Product { sum, of: [j, k], factor }, size));
            }
        }
    }
    terms
}

/// The terms of weight, with the coordinates in them.
fn kept(mut terms: Vec<(Product, f64)>, coordinates: &DMatrix<f64>, lambda: Vec<f64>) -> SecondOrder {
    let largest = terms.iter().map(|(_, size)| *size).fold(0.0, f64::max);
    terms.retain(|(_, size)| *size > LEAST * largest);
    let used: Vec<usize> =
        (0..lambda.len()).filter(|k| terms.iter().any(|(term, _)| term.sum == *k || term.of.contains(k))).collect();
    let place = |k: usize| used.partition_point(|other| *other < k);
    SecondOrder {
        coordinates: used.iter().flat_map(|&k| coordinates.row(k).iter().copied().collect::<Vec<f64>>()).collect(),
        stiffness: used.iter().map(|&k| lambda[k]).collect(),
        terms: terms
            .iter()
            .map(|(term, _)| Product { sum: place(term.sum), of: term.of.map(place), factor: term.factor })
            .collect(),
    }
}
