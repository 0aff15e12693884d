//! The structure of a matrix as the model gives it.

/// The couplings of unknowns. Unknowns come in groups (nodes); external row numbers are group-major and compact: the
/// rows of group 0, those of group 1, and so on.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Structure {
    /// Unknowns per group, at most 6.
    pub sizes: Vec<usize>,
    /// Groups that couple pairwise, for instance the nodes of an element.
    pub connectivity: Vec<Vec<usize>>,
    /// Number of groups at the end with Lagrange multipliers, whose diagonal is nearly zero. Each is eliminated after all groups coupled to
    /// it. The matrix is then indefinite.
    pub multipliers: usize,
    /// Positions of the groups without multipliers, for an order by dissection; empty if unknown.
    pub positions: Vec<[f64; 3]>,
}
