//! The strain energy of small motions, part by part.

use super::linearized::Linearized;
use super::mode::Share;
use crate::elements::Moduli;
use crate::math::Vec6;
use crate::model::Part;
use crate::state::{Configuration, Node};

/// Energy of a part above this part of its terms without signs is no rounding, ...
const CLEAR: f64 = 1e-6;
/// ... unless its motions are: this is the square of what they are of the largest anywhere.
const STILL: f64 = 1e-16;

/// Twice the strain energies of a small motion.
#[derive(Clone, Default)]
pub struct Energies {
    /// Those of the parts, in the order of the model.
    pub parts: Vec<Share>,
    /// The sum of all terms of all elements, without their signs, by which rounding is measured.
    pub without_signs: f64,
    /// The same of each part, and the sum of its terms were all its motions the largest anywhere.
    of_parts: Vec<[f64; 2]>,
    /// The square of the largest motion anywhere.
    largest: f64,
    /// True where a part stores energy that is not its own rounding.
    pub is_stiff: bool,
}

/// Sums φᵀ K φ over the elements of each part, for several shapes: the matrix of an element is formed once for all.
pub fn energies(at: &Linearized, nodes: &[Node], shapes: &[Vec<Vec6>]) -> Vec<Energies> {
    let now = Configuration { nodes, history: &at.state.history, dt: 0.0, lead: None };
    let largest = |shape: &Vec<Vec6>| shape.iter().map(|motion| motion.amax().powi(2)).fold(0.0, f64::max);
    let mut all: Vec<Energies> =
        shapes.iter().map(|shape| Energies { largest: largest(shape), ..Energies::default() }).collect();
    let (mut K, mut phi) = (Vec::new(), Vec::new());
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
            for (shape, energies) in shapes.iter().zip(&mut all) {
                phi.clear();
                phi.extend(block.nodes(e).iter().flat_map(|&n| shape[n].iter().copied().take(block.dofs())));
                energies.add(&at.model.parts, part, &K, &phi);
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

impl Energies {
    /// Adds the energy of an element with this matrix, row-major, in this motion.
    fn add(&mut self, parts: &[Part], part: usize, K: &[f64], phi: &[f64]) {
        let (mut energy, mut own, mut all) = (0.0, 0.0, 0.0);
        for (row, left) in K.chunks(phi.len()).zip(phi) {
            for (k, right) in row.iter().zip(phi) {
                let term = left * k * right;
                energy += term;
                own += term.abs();
                all += k.abs();
            }
        }
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
