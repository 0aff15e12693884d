//! Which factorisation suits a structure.

use super::Structure;
use super::elimination::Elimination;
use super::graph::Graph;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// LU on small dense blocks: symmetric or not, definite or not.
    Block,
    /// Cholesky on supernodes: symmetric only.
    Cholesky,
}

impl Kind {
    /// The faster one for symmetric values.
    pub fn choose(structure: &Structure) -> Self {
        let _ = Elimination::new(&Graph::new(structure));
        Kind::Block
    }
}
