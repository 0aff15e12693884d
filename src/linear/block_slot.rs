//! Places of a whole 6×6 block in the values of a symmetric matrix.

/// A 6×6 block of a symmetric matrix in column-compressed storage; of a diagonal block the lower triangle is stored.
#[derive(Debug, Clone, Copy)]
pub struct BlockSlot {
    /// Place of its first entry in [`super::Solver::values`].
    pub(super) at: u32,
    /// Places from the start of its first column to that of its second.
    pub(super) step: u32,
}

impl BlockSlot {
    /// The place in [`super::Solver::values`] where column `j` of the block, 0 ≤ j < 6, begins. Each column of the matrix begins
    /// with its diagonal entry, so that columns become shorter by one from each to the next.
    #[inline]
    pub fn column(&self, j: usize) -> usize {
        self.at as usize + j * self.step as usize - j * j.saturating_sub(1) / 2
    }
}
