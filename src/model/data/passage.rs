//! Displacements that a path of equilibria is to reach.

/// A displacement on its way through a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    pub node: usize,
    /// 0..3: ux, uy, uz.
    pub dof: usize,
    pub value: f64,
    /// Which time it does so, from 1.
    pub pass: usize,
    /// Where the deck names the direction: first byte, and the one after the last.
    pub place: [usize; 2],
}
