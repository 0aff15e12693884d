//! Displacements that a path of equilibria is to reach.

/// A displacement that passes a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// The node.
    pub node: usize,
    /// Degree of freedom, 0..3 for ux, uy, uz.
    pub dof: usize,
    /// The value.
    pub value: f64,
    /// Number of the passage that counts, from 1.
    pub pass: usize,
    /// Place in the deck that names the degree of freedom: first byte, and the one after the last.
    pub place: [usize; 2],
}
