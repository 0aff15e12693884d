//! The strain energy of small motions, part by part.

use super::linearized::Linearized;
use super::mode::Share;
use crate::tolerances::shares::{CLEAR, STILL};
use base::math::Vec6;
use mechanics::elements::Moduli;
use mechanics::state::{Configuration, Node};
use model::Part;

/// Twice the strain energies of a small motion.
#[derive(Clone, Default)]
pub struct Energies {
    /// Shares of the parts, in the order of the model.
    pub parts: Vec<Share>,
    /// Sum of the magnitudes of all terms of all elements, the measure of rounding.
    pub without_signs: f64,
    /// Sum of each part, and the sum of its terms with the largest motions anywhere.
    of_parts: Vec<[f64; 2]>,
    /// The square of the largest motion anywhere.
    largest: f64,
    /// True if a part stores energy above its rounding.
    pub is_stiff: bool,
}

/// Sums φᵀ K φ over the elements of each part, for several shapes: the matrix of an element is formed once for all.
pub fn energies(at: &Linearized, nodes: &[Node], shapes: &[Vec<Vec6>]) -> Vec<Energies> {
    let now = Configuration { nodes, history: &at.state.history, dt: 0.0, previous: None };
    let largest = |shape: &Vec<Vec6>| shape.iter().map(|motion| motion.amax().powi(2)).fold(0.0, f64::max);
    let mut all: Vec<Energies> =
        shapes.iter().map(|shape| Energies { largest: largest(shape), ..Energies::default() }).collect();
    if shapes.is_empty() {
        return all;
    }
    let (mut K, mut phi, mut sums) = (Vec::new(), Vec::new(), Sums::new(shapes.len()));
    for group in &at.system.groups {
        let (block, own) = (&group.block, &group.configuration(&now));
        let width = if block.is_empty() { 0 } else { block.dofs() * block.nodes(0).len() };
        for e in 0..block.len() {
            if group.kind.is_unilateral() && block.is_inactive(e, own) {
                continue;
            }
            K.clear();
            K.resize(width * width, 0.0);
            block.tangent(e, own, 0.0, Moduli::Elastic, &mut K);
            let part = match group.kind.is_deformable() || group.kind.is_unilateral() {
                true => group.part,
                false => place(&at.model.parts, group.part, group.part_of(e, at.model)),
            };
            phi.clear();
            for &node in block.nodes(e) {
                (0..block.dofs()).for_each(|dof| phi.extend(shapes.iter().map(|shape| shape[node][dof])));
            }
            sums.form(&K, &phi);
            for (s, energies) in all.iter_mut().enumerate() {
                energies.add(&at.model.parts, part, sums.of_shape(s));
            }
        }
    }
    for energies in &mut all {
        let mut parts = energies.parts.iter().zip(&energies.of_parts);
        energies.is_stiff = parts.any(|(share, [own, all])| share.strain > CLEAR * own && share.strain > STILL * all);
        energies.parts.sort_by_key(|share| share.part);
    }
    all
}

/// The place of a part in the list, from one place on.
fn place(parts: &[Part], from: usize, part: &Part) -> usize {
    from + parts[from..].iter().position(|other| std::ptr::eq(other, part)).unwrap_or(0)
}

/// Sums over the entries of the matrix of an element, for all shapes side by side.
struct Sums {
    /// φᵀ K φ of each shape.
    energy: Vec<f64>,
    /// Sums of the magnitudes of all terms.
    without_signs: Vec<f64>,
    /// One row of K φ, and of the sizes of its terms.
    row: [Vec<f64>; 2],
    /// The sum of the sizes of all entries.
    entries: f64,
}

impl Sums {
    fn new(shapes: usize) -> Sums {
        let zeros = || vec![0.0; shapes];
        Sums { energy: zeros(), without_signs: zeros(), row: [zeros(), zeros()], entries: 0.0 }
    }

    /// Energies of a matrix, row-major, for motions with shapes side by side.
    fn form(&mut self, K: &[f64], phi: &[f64]) {
        let Sums { energy, without_signs, row: [row, sizes], entries } = self;
        let shapes = row.len();
        energy.fill(0.0);
        without_signs.fill(0.0);
        *entries = K.iter().map(|k| k.abs()).sum();
        for (k, left) in K.chunks(phi.len() / shapes).zip(phi.chunks(shapes)) {
            row.fill(0.0);
            sizes.fill(0.0);
            for (k, right) in k.iter().zip(phi.chunks(shapes)) {
                for ((row, size), right) in row.iter_mut().zip(&mut *sizes).zip(right) {
                    *row += k * right;
                    *size += (k * right).abs();
                }
            }
            energy.iter_mut().zip(left).zip(&*row).for_each(|((sum, left), row)| *sum += left * row);
            without_signs.iter_mut().zip(left).zip(&*sizes).for_each(|((sum, left), size)| *sum += left.abs() * size);
        }
    }

    /// The energy of a shape, the same without signs, and the latter were all its motions 1.
    fn of_shape(&self, s: usize) -> [f64; 3] {
        [self.energy[s], self.without_signs[s], self.entries]
    }
}

impl Energies {
    /// Adds an element of a part by its [`Sums::of_shape`].
    fn add(&mut self, parts: &[Part], part: usize, [energy, own, all]: [f64; 3]) {
        self.without_signs += own;
        match self.parts.last_mut() {
            Some(last) if parts[last.part].is_one_with(&parts[part]) => last.strain += energy,
            _ => {
                self.parts.push(Share { part, strain: energy });
                self.of_parts.push([0.0; 2]);
            }
        }
        if let Some(last) = self.of_parts.last_mut() {
            *last = [last[0] + own, last[1] + all * self.largest];
        }
    }
}
