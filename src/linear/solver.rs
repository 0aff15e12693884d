//! The factorisations behind one interface.

use super::block_lu::BlockLu;
use super::block_slot::BlockSlot;
use super::cholesky::{Cholesky, WORTH_THREADS};
use super::factorization::Factorization;
use super::graph::Graph;
use super::memory::TooLarge;
use super::pivot::Singular;
use super::sparse::Sparse;
use super::stats::Stats;
use super::stops::StopQuery;
use super::structure::Structure;
use base::snapshot::{Keep, Snapshot};

/// A matrix and its factorisation, the memory of both included.
pub enum Solver {
    /// LU on 3×3 blocks: plane problems, or nodes without rotations.
    Block3(Box<BlockLu<3>>),
    /// LU on 6×6 blocks.
    Block6(Box<BlockLu<6>>),
    /// Supernodal Cholesky factorisation, L D Lᵀ where the matrix is indefinite.
    Cholesky(Box<Cholesky>),
}

/// Makes one call on whichever factorisation the solver holds.
macro_rules! each {
    ($solver:expr, $inner:ident => $call:expr) => {
        match $solver {
            Solver::Block3($inner) => $call,
            Solver::Block6($inner) => $call,
            Solver::Cholesky($inner) => $call,
        }
    };
}

impl Keep for Solver {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        each!(self, inner => inner.keep(snapshot));
    }
}

impl Solver {
    /// Plans the factorization and allocates all memory. `threads` matters to the time of a large [`Factorization::Cholesky`] only, and
    /// never to the bits of a result.
    ///
    /// # Errors
    /// The memory does not hold the factor.
    pub fn new(structure: &Structure, factorization: Factorization, threads: usize) -> Result<Self, TooLarge> {
        debug_assert!(structure.sizes.iter().all(|&size| size <= 6), "a group has at most 6 unknowns");
        let graph = Graph::new(structure);
        Ok(match factorization {
            Factorization::Cholesky => Solver::Cholesky(Box::new(Cholesky::new(graph, threads)?)),
            Factorization::BlockLu if structure.sizes.iter().all(|&size| size <= 3) => {
                Solver::Block3(Box::new(BlockLu::new(graph)?))
            }
            Factorization::BlockLu => Solver::Block6(Box::new(BlockLu::new(graph)?)),
        })
    }

    /// True where one triangle is stored: the caller then adds each pair of rows once, with its symmetric value.
    pub fn is_symmetric(&self) -> bool {
        matches!(self, Solver::Cholesky(_))
    }

    /// True where entries, as assembled and before [`Solver::factor`], differ from those across the diagonal. Never where one triangle is
    /// stored.
    pub fn has_unsymmetric_values(&self) -> bool {
        match self {
            Solver::Block3(inner) => inner.has_unsymmetric_values(),
            Solver::Block6(inner) => inner.has_unsymmetric_values(),
            Solver::Cholesky(_) => false,
        }
    }

    /// The place in [`Solver::values`] of the entry in a row and a column (external numbers); none outside the structure.
    /// It is searched for, so assembly keeps the places that it needs.
    pub fn slot(&self, row: usize, col: usize) -> Option<usize> {
        each!(self, inner => inner.slot(row, col))
    }

    /// The block that couples two groups of six unknowns, by the first row of each (external numbers). It may be stored transposed relative
    /// to `col` and `row`. None where the matrix is not symmetric, or a group is smaller.
    pub fn block_slot(&self, row: usize, col: usize) -> Option<(BlockSlot, bool)> {
        match self {
            Solver::Cholesky(inner) => inner.block_slot(row, col),
            _ => None,
        }
    }

    /// The entries of the matrix: assembly sets them to zero and adds to them before each [`Solver::factor`], which may
    /// overwrite them.
    pub fn values(&mut self) -> &mut [f64] {
        each!(self, inner => inner.values())
    }

    /// The matrix as assembled, before [`Solver::factor`], over the first `rows` external rows and columns.
    pub fn matrix(&self, rows: usize) -> Sparse {
        Sparse::from_entries(rows, |visit| {
            let mut inside = |i: usize, j: usize, value: f64| {
                if i < rows && j < rows {
                    visit(i, j, value);
                }
            };
            each!(self, inner => inner.each_entry(&mut inside));
        })
    }

    /// A position in [`Solver::values`] without an entry, for terms that assembly drops.
    pub fn spare(&self) -> usize {
        each!(self, inner => inner.spare())
    }

    /// Factors the matrix in [`Solver::values`].
    ///
    /// # Errors
    /// A pivot is zero or not finite. [`Solver::solve`] then gives nothing of use until values are filled and factored again.
    pub fn factor(&mut self) -> Result<(), Singular> {
        self.factor_unless(&|| false).map(|_| ())
    }

    /// Factors the matrix as [`Solver::factor`] does. False if `stops` became true before the end; there are no factors then. `stops` is
    /// evaluated every few milliseconds.
    ///
    /// # Errors
    /// As for [`Solver::factor`].
    pub fn factor_unless(&mut self, stops: StopQuery) -> Result<bool, Singular> {
        match self {
            Solver::Block3(inner) => inner.factor(stops),
            Solver::Block6(inner) => inner.factor(stops),
            Solver::Cholesky(inner) => inner.factor(stops),
        }
    }

    /// Factors a matrix that is known to be indefinite, as [`Solver::factor`] does but without looking whether it is positive definite
    /// first. Where one factor is to give the bits of another one, both are to be known.
    ///
    /// # Errors
    /// As for [`Solver::factor`].
    pub fn factor_indefinite(&mut self) -> Result<(), Singular> {
        match self {
            Solver::Cholesky(inner) => inner.factor_indefinite(),
            _ => self.factor(),
        }
    }

    /// A solver without unknowns.
    pub fn none() -> Self {
        let nothing = BlockLu::new(Graph::new(&Structure::default()));
        Solver::Block3(Box::new(nothing.expect("no unknowns need no memory")))
    }

    /// Gives back the memory that is needed to factor and not to solve, until there is something to factor.
    pub fn rest(&mut self) {
        if let Solver::Cholesky(inner) = self {
            inner.rest();
        }
    }

    /// Replaces the right-hand side `b`, by external rows, by the solution for the matrix factored last.
    pub fn solve(&mut self, b: &mut [f64]) {
        match self {
            Solver::Block3(inner) => inner.solve(b),
            Solver::Block6(inner) => inner.solve(b),
            Solver::Cholesky(inner) => inner.solve([b]),
        }
    }

    /// Replaces right-hand sides by their solutions, each with the bits of [`Solver::solve`]; a Cholesky factor is read once for two of
    /// them.
    pub fn solve_all(&mut self, b: &mut [Vec<f64>]) {
        let Solver::Cholesky(inner) = self else { return b.iter_mut().for_each(|b| self.solve(b)) };
        let (pairs, rest) = b.as_chunks_mut::<2>();
        pairs.iter_mut().for_each(|pair| inner.solve(pair.each_mut().map(|b| &mut b[..])));
        rest.iter_mut().for_each(|b| inner.solve([b]));
    }

    /// The number of negative eigenvalues of the matrix factored last, where it is symmetric (Sylvester's law of inertia).
    pub fn negative_eigenvalues(&self) -> usize {
        each!(self, inner => inner.negative_eigenvalues())
    }

    /// True where the determinant of the matrix factored last is negative.
    pub fn is_determinant_negative(&self) -> bool {
        each!(self, inner => inner.is_determinant_negative())
    }

    /// Size and operations of the factorisation.
    pub fn stats(&self) -> Stats {
        each!(self, inner => inner.stats())
    }

    /// The factorisation and its size in one line for people.
    pub fn describe(&self) -> String {
        let name = match self {
            Solver::Block3(_) => "LU on 3×3 blocks",
            Solver::Block6(_) => "LU on 6×6 blocks",
            Solver::Cholesky(_) => "supernodal Cholesky",
        };
        let Stats { unknowns, nonzeros, numbers, in_file, flops, ordering } = self.stats();
        let megabytes = (size_of::<f64>() * numbers) as f64 / 1e6;
        let file = if in_file { format!(", {}", self.scratch()) } else { String::new() };
        let threads = if self.is_worth_threads() { "all threads" } else { "one thread" };
        format!(
            "{name}: {unknowns} unknowns, {nonzeros} nonzeros in the factor, {megabytes:.1} MB, {flops:.3e} flops, {ordering} order, \
             {threads}{file}"
        )
    }

    /// Place and size of the factor, if it is in a file.
    pub fn scratch(&self) -> String {
        let gigabytes = (size_of::<f64>() * self.stats().nonzeros) as f64 / 1e9;
        let folder = std::env::temp_dir();
        format!(
            "{gigabytes:.2} GB of the factor lie in a file in {} (TMPDIR), because the memory does not hold them: every solution reads the disk \
             twice. Take a coarser mesh, or run with more memory",
            folder.display()
        )
    }

    /// True where several threads share the factorisation if there are any.
    fn is_worth_threads(&self) -> bool {
        matches!(self, Solver::Cholesky(_)) && self.stats().flops > WORTH_THREADS
    }
}
