//! Target displacements of a path of equilibria.

/// A value that a displacement is to pass along a path; a step ends there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplacementTarget {
    /// The index of the node.
    pub node: usize,
    /// The degree of freedom, 0..3 for ux, uy, uz.
    pub dof: usize,
    /// The displacement, global, in units of length.
    pub value: f64,
    /// The number of the crossing that counts, from 1, in either direction.
    pub pass: usize,
    /// True if the path must reach it.
    pub required: bool,
    /// The place in the deck that names the degree of freedom: first byte, and the one after the last.
    pub place: [usize; 2],
}
