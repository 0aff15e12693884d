//! Matrices of elements by blocks of 6×6 into a symmetric matrix: one place per pair of nodes, in place of one per number.

use crate::linear::{BlockSlot, Solver};

/// The blocks of all elements, one after the other.
pub(super) struct BlockScatter(Vec<Pair>);

/// The block of two nodes of an element.
struct Pair {
    /// Of the block's rows and columns in the system.
    nodes: [u16; 2],
    slot: BlockSlot,
}

impl BlockScatter {
    pub fn new() -> Self {
        BlockScatter(Vec::new())
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// `rows`: the first of the six rows of each node. False, and nothing is added, where a block has no place of its own.
    pub fn push(&mut self, solver: &Solver, rows: &[usize]) -> bool {
        let before = self.0.len();
        for (a, &of_a) in rows.iter().enumerate() {
            for (b, &of_b) in rows.iter().enumerate().skip(a) {
                let Some((slot, swapped)) = solver.block_slot(of_a, of_b) else {
                    self.0.truncate(before);
                    return false;
                };
                let nodes = if swapped { [b as u16, a as u16] } else { [a as u16, b as u16] };
                self.0.push(Pair { nodes, slot });
            }
        }
        true
    }

    /// Adds the symmetric part of an element's matrix, row-major; `range` are its blocks.
    #[inline]
    pub fn add(&self, K: &[f64], range: std::ops::Range<usize>, values: &mut [f64]) {
        let width = K.len().isqrt();
        for Pair { nodes: [p, q], slot } in &self.0[range] {
            let (p, q) = (6 * usize::from(*p), 6 * usize::from(*q));
            for j in 0..6 {
                let column = &mut values[slot.column(j)..][..6];
                let across = &K[(q + j) * width + p..][..6];
                for i in if p == q { j } else { 0 }..6 {
                    column[i] += 0.5 * (across[i] + K[(p + i) * width + q + j]);
                }
            }
        }
    }
}
