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

/// Operations per second of the block LU, on blocks of 3 and of 6.
const BLOCK_RATE: [f64; 2] = [8e9, 15e9];

/// A Cholesky factorisation with two substitutions: operations per second of its dense kernels, and the seconds it
/// spends beside them.
const CHOLESKY_RATE: f64 = 30e9;
const CHOLESKY_PER_NONZERO: f64 = 5e-9;
const CHOLESKY_PER_UNKNOWN: f64 = 100e-9;

impl Kind {
    /// The faster one for symmetric values.
    ///
    /// LU does twice the work of Cholesky, but at a rate that does not fall on small blocks, and substitutes twice as
    /// fast. Chains of any length stay with it; sheets and space frames change over near 5·10⁶ operations of the
    /// Cholesky factorisation, that is near 1000 unknowns. The constants fit `benches/linear.rs` within a fifth where
    /// the two are close; only their ratios matter.
    pub fn choose(structure: &Structure) -> Self {
        let elimination = Elimination::new(&Graph::new(structure));
        let plane = structure.sizes.iter().all(|&size| size <= 3);
        let (cube, rate) = if plane { (27.0, BLOCK_RATE[0]) } else { (216.0, BLOCK_RATE[1]) };
        let block = elimination.block_flops * cube / rate;
        let unknowns: usize = structure.sizes.iter().sum();
        let cholesky = elimination.flops / CHOLESKY_RATE
            + elimination.nonzeros as f64 * CHOLESKY_PER_NONZERO
            + unknowns as f64 * CHOLESKY_PER_UNKNOWN;
        if block <= cholesky { Kind::Block } else { Kind::Cholesky }
    }
}
