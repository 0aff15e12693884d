//! The linear system K x = r of an implicit step, factored thousands of times with one structure.
//!
//! All that depends on the structure alone (order of elimination, fill, where each number goes) is settled once in
//! [`Solver::new`]; `factor` and `solve` then run over flat lists and, on one thread, allocate nothing. Two roads: an
//! LU factorisation on small dense blocks for small systems and unsymmetric values, and a supernodal Cholesky
//! factorisation for large symmetric ones. Iterative methods and orderings by dissection are left out.

mod block_lu;
mod cholesky;
mod elimination;
mod fronts;
mod graph;
mod kernel;
mod kind;
mod memory;
mod substitution;

pub use block_lu::BlockLu;
pub use cholesky::Cholesky;
pub use kind::Kind;
pub use memory::TooLarge;

use elimination::Elimination;
use graph::Graph;
use std::fmt;

/// Who couples with whom. Unknowns come in groups (nodes); external row numbers are group-major and compact: the rows
/// of group 0, those of group 1, and so on.
#[derive(Debug, Clone, PartialEq)]
pub struct Structure {
    /// Unknowns per group, at most 6.
    pub sizes: Vec<usize>,
    /// Groups that couple pairwise, for instance the nodes of an element.
    pub cliques: Vec<Vec<usize>>,
    /// The last so many groups hold multipliers, with next to nothing on their diagonal: each is eliminated after all that it
    /// couples with. The matrix is then indefinite.
    pub multipliers: usize,
}

/// Additions and multiplications of a symmetric factorisation; an unsymmetric one takes twice as many.
pub fn operations(structure: &Structure) -> f64 {
    Elimination::new(&Graph::new(structure)).flops
}

/// A pivot vanished: the matrix is singular to working accuracy, or holds numbers that are not finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Singular {
    /// External row of the pivot.
    pub row: usize,
    pub pivot: f64,
}

impl fmt::Display for Singular {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "the pivot of row {} vanishes ({:e})", self.row, self.pivot)
    }
}

impl std::error::Error for Singular {}

/// A pivot counts as vanished at this fraction of what stood in its row of the diagonal block before elimination.
/// Chains of beams held nowhere leave at most 5e-15 where an exact pivot would be zero, for up to 1000 elements; held
/// at the far end they keep 1e-9, and 5e-14 if slender as well (length of an element 1000 radii of gyration).
const VANISHED: f64 = 1e-14;

/// What a factorisation costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stats {
    pub unknowns: usize,
    /// Numbers stored in the factor.
    pub nonzeros: usize,
    /// Additions and multiplications of one factorisation.
    pub flops: f64,
    /// Name of the elimination order.
    pub ordering: &'static str,
}

/// A block of 6×6 in a symmetric matrix; of one on the diagonal the lower triangle is there.
#[derive(Debug, Clone, Copy)]
pub struct Tile {
    at: u32,
    step: u32,
}

impl Tile {
    /// Where its column `j` begins in [`Solver::values`]. Each column of the matrix begins with its diagonal: they get shorter.
    #[inline]
    pub fn column(&self, j: usize) -> usize {
        self.at as usize + j * self.step as usize - j * j.saturating_sub(1) / 2
    }
}

/// A factorisation with its matrix.
pub enum Solver {
    Block3(Box<BlockLu<3>>),
    Block6(Box<BlockLu<6>>),
    Cholesky(Box<Cholesky>),
}

/// The same call on whichever factorisation it is.
macro_rules! each {
    ($solver:expr, $inner:ident => $call:expr) => {
        match $solver {
            Solver::Block3($inner) => $call,
            Solver::Block6($inner) => $call,
            Solver::Cholesky($inner) => $call,
        }
    };
}

impl Solver {
    /// Plans the factorisation. `threads` only matters to a large [`Kind::Cholesky`] and never to the bits of a result.
    ///
    /// # Errors
    /// There is no memory for the factor.
    pub fn new(structure: &Structure, kind: Kind, threads: usize) -> Result<Self, TooLarge> {
        debug_assert!(structure.sizes.iter().all(|&size| size <= 6), "a group has at most 6 unknowns");
        let graph = Graph::new(structure);
        Ok(match kind {
            Kind::Cholesky => Solver::Cholesky(Box::new(Cholesky::new(graph, threads)?)),
            Kind::Block if structure.sizes.iter().all(|&size| size <= 3) => {
                Solver::Block3(Box::new(BlockLu::new(graph)))
            }
            Kind::Block => Solver::Block6(Box::new(BlockLu::new(graph))),
        })
    }

    /// True: one triangle is stored and the caller adds each pair of rows once, with its symmetric value.
    pub fn symmetric(&self) -> bool {
        matches!(self, Solver::Cholesky(_))
    }

    /// Where the entry of a row and a column (external numbers) stands in `values`; none outside the structure.
    /// Searches: for planning, not for assembly.
    pub fn slot(&self, row: usize, col: usize) -> Option<usize> {
        each!(self, inner => inner.slot(row, col))
    }

    /// Where the block of two groups of six stands, given their rows (external numbers), and whether it is that of `cols` and
    /// `rows`; none where a matrix is not symmetric, or a group smaller.
    pub fn tile(&self, rows: &[u32; 6], cols: &[u32; 6]) -> Option<(Tile, bool)> {
        match self {
            Solver::Cholesky(inner) => inner.tile(rows, cols),
            _ => None,
        }
    }

    /// The numbers of the matrix, to be set to zero and filled before each `factor`, which may overwrite them.
    pub fn values(&mut self) -> &mut [f64] {
        each!(self, inner => inner.values())
    }

    /// A place in `values` that belongs to no entry, for what is to be dropped.
    pub fn spare(&self) -> usize {
        each!(self, inner => inner.spare())
    }

    /// Factors `values`. After a failure, fill them again and factor again; `solve` means nothing in between.
    pub fn factor(&mut self) -> Result<(), Singular> {
        each!(self, inner => inner.factor())
    }

    /// Replaces `b` (external numbers) by the solution for the last matrix factored.
    pub fn solve(&mut self, b: &mut [f64]) {
        each!(self, inner => inner.solve(b))
    }

    /// Where matrices are known to become indefinite: takes the memory for it now rather than in the run.
    pub fn expect_indefinite(&mut self) {
        if let Solver::Cholesky(inner) = self {
            inner.prepare_indefinite();
        }
    }

    /// Negative eigenvalues of the last matrix factored, where it is symmetric (Sylvester's law of inertia).
    pub fn negatives(&self) -> usize {
        each!(self, inner => inner.negatives())
    }

    pub fn stats(&self) -> Stats {
        each!(self, inner => inner.stats())
    }

    /// The factorisation in one line.
    pub fn describe(&self) -> String {
        let name = match self {
            Solver::Block3(_) => "LU on 3×3 blocks",
            Solver::Block6(_) => "LU on 6×6 blocks",
            Solver::Cholesky(_) => "supernodal Cholesky",
        };
        let Stats { unknowns, nonzeros, flops, ordering } = self.stats();
        format!("{name}: {unknowns} unknowns, {nonzeros} nonzeros in the factor, {flops:.3e} flops, {ordering} order")
    }
}
