//! Strain by temperature: the part of the strain that causes no stress.
//!
//! A temperature is a number that a node has for its displacement along x, as the take-up of a link is. The number is α ΔT times a length of
//! the part, so that it is as large as the displacements that it causes. A block that is heated counts these nodes among those of each
//! element, behind the others. Their force is the derivative of the energy by the number, and moving them does the work of heating.

use super::block::Force;
use crate::state::Node;
use base::math::Vec3;
use std::ops::Range;

/// The temperatures of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Heat {
    /// The nodes whose displacements along x stand for strains, each times [`Heat::length`]. The first is the strain of the axis, the second
    /// its derivative along y of the section or along the normal of a shell, the third its derivative along z.
    pub numbers: [Option<usize>; 3],
    /// A length of the part, above 0.
    pub length: f64,
    /// Factors on the first strain by element; empty if all are 1.
    pub factors: Vec<f64>,
}

impl Heat {
    /// No temperatures.
    pub const NONE: Heat = Heat { numbers: [None; 3], length: 1.0, factors: Vec::new() };

    /// The temperatures of some of the elements.
    pub fn piece(&self, elements: Range<usize>) -> Heat {
        let factors = self.factors.get(elements).map_or_else(Vec::new, <[f64]>::to_vec);
        Heat { numbers: self.numbers, length: self.length, factors }
    }

    /// The factor on the first strain in an element.
    pub fn factor(&self, e: usize) -> f64 {
        self.factors.get(e).copied().unwrap_or(1.0)
    }

    /// The nodes that are there.
    pub fn nodes_mut(&mut self) -> impl Iterator<Item = &mut usize> {
        self.numbers.iter_mut().flatten()
    }
}

/// One of the numbers.
#[derive(Debug, Clone)]
struct HeatNode {
    node: usize,
    /// Its position at t = 0.
    start: Vec3,
    /// Its place in [`Heat::numbers`].
    of: usize,
}

/// The temperatures of a group of elements.
#[derive(Debug, Clone)]
pub(super) struct HeatNodes {
    numbers: Vec<HeatNode>,
    per_length: f64,
    /// Factors on the first strain by element; empty if all are 1.
    factors: Vec<f64>,
    /// The nodes of all elements, each with those of heat behind its own.
    nodes: Vec<usize>,
    /// The number of nodes of an element of its own.
    own: usize,
}

impl HeatNodes {
    /// The temperatures of elements with these nodes; `None` without any. `x`: positions of all nodes at t = 0.
    pub fn new<'n>(heat: &Heat, elements: impl Iterator<Item = &'n [usize]>, x: &[Vec3]) -> Option<HeatNodes> {
        let given = heat.numbers.iter().enumerate().filter_map(|(of, node)| Some((of, (*node)?)));
        let numbers: Vec<HeatNode> = given.map(|(of, node)| HeatNode { node, start: x[node], of }).collect();
        if numbers.is_empty() {
            return None;
        }
        let (mut nodes, mut own) = (Vec::new(), 0);
        for element in elements {
            own = element.len();
            nodes.extend(element);
            nodes.extend(numbers.iter().map(|number| number.node));
        }
        let factors = heat.factors.clone();
        Some(HeatNodes { numbers, per_length: 1.0 / heat.length, factors, nodes, own })
    }

    /// The nodes of an element.
    pub fn nodes(&self, e: usize) -> &[usize] {
        let count = self.own + self.numbers.len();
        &self.nodes[e * count..(e + 1) * count]
    }

    /// The factor on the first strain in an element.
    #[inline]
    pub fn factor(&self, e: usize) -> f64 {
        self.factors.get(e).copied().unwrap_or(1.0)
    }

    /// The strain of the axis or surface for a factor of 1, and its derivatives along y or the normal, and along z.
    #[inline]
    pub fn strain(&self, nodes: &[Node]) -> [f64; 3] {
        let mut strain = [0.0; 3];
        for number in &self.numbers {
            strain[number.of] = self.per_length * nodes[number.node].moved(&number.start).x;
        }
        strain
    }

    /// Subtracts the forces of the numbers from `F`, with the work of an element's stress by each of the three strains.
    pub fn subtract_forces(&self, work: &[f64; 3], F: &mut [Force]) {
        for number in &self.numbers {
            F[number.node][0] += self.per_length * work[number.of];
        }
    }

    /// The number of rows of the matrix of an element with `dofs` rows to a node.
    pub fn width(&self, dofs: usize) -> usize {
        dofs * (self.own + self.numbers.len())
    }

    /// Makes the matrix of an element of its own nodes, at the front of `K`, one of all. `column` writes the forces on its own nodes by one
    /// of the strains, and returns the work of their stress by each of the three.
    pub fn widen(&self, dofs: usize, K: &mut [f64], mut column: impl FnMut(usize, &mut [f64]) -> [f64; 3]) {
        let (own, width) = (dofs * self.own, self.width(dofs));
        for row in (0..own).rev() {
            K.copy_within(row * own..(row + 1) * own, row * width);
            K[row * width + own..(row + 1) * width].fill(0.0);
        }
        K[own * width..].fill(0.0);
        for (k, number) in self.numbers.iter().enumerate() {
            let at = own + dofs * k;
            let work = column(number.of, &mut K[at * width..at * width + own]);
            for i in 0..own {
                K[at * width + i] *= self.per_length;
                K[i * width + at] = K[at * width + i];
            }
            for (other, of) in self.numbers.iter().enumerate() {
                K[at * width + own + dofs * other] = -self.per_length * self.per_length * work[of.of];
            }
        }
    }
}
