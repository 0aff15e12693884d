//! The cost of a factorization.

/// Size and operations of a factorisation, known from the structure alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stats {
    /// Rows of the matrix.
    pub unknowns: usize,
    /// Numbers stored in the factor.
    pub nonzeros: usize,
    /// Numbers stored: matrix, factor and working memory.
    pub numbers: usize,
    /// True where those of the factor lie in a file, not in memory.
    pub in_file: bool,
    /// Additions and multiplications of one factorisation.
    pub flops: f64,
    /// Name of the elimination order.
    pub ordering: &'static str,
}
