//! Scatters 6×6 blocks of element matrices into a symmetric matrix: one slot for each pair of nodes instead of one for
//! each entry.

use linear::{BlockSlot, Solver};

/// The blocks of all elements, in the order of the elements.
pub(super) struct BlockScatter(Vec<Pair>);

/// The block that couples two nodes of an element.
struct Pair {
    /// Numbers, within the element, of the nodes that the block's rows and columns belong to.
    nodes: [u16; 2],
    slot: BlockSlot,
}

impl BlockScatter {
    /// No blocks.
    pub fn new() -> Self {
        BlockScatter(Vec::new())
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Adds the blocks of an element; `rows` are the first of the six rows of each of its nodes. Returns false and adds
    /// nothing where a block has no slot.
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

    /// Adds the symmetric part of an element's matrix `K` of this number of rows, row-major, to `values`; `range` holds its
    /// blocks.
    #[inline]
    pub fn add(&self, K: &[f64], width: usize, range: std::ops::Range<usize>, values: &mut [f64]) {
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
