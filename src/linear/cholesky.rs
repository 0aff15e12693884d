//! Supernodal Cholesky factorisation: multifrontal K = L Lᵀ, or faer's L D Lᵀ where K is not positive definite.
//!
//! Assembly writes straight into the lower triangle in the order of elimination, the one form that faer takes without
//! permuting the matrix at each factorisation. L is stored as faer stores it. L D Lᵀ is formed without pivoting: beyond a
//! buckling load it is as accurate as the leading minors are away from zero, and the caller's residual shows whether it was.

use super::block_slot::BlockSlot;
use super::elimination::Elimination;
use super::fronts::Fronts;
use super::graph::Graph;
use super::memory::{self, TooLarge};
use super::pivot::{PIVOT_TOLERANCE, Singular};
use super::stats::Stats;
use crate::snapshot::{Keep, Snapshot};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::ldlt::factor::LdltError;
use faer::sparse::linalg::cholesky::{simplicial, supernodal};
use faer::sparse::{FaerError, SparseColMatRef, SymbolicSparseColMat, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};
use std::sync::atomic::{AtomicBool, Ordering};

/// Factorisations of fewer operations run on one thread: there threads cost more time than they save.
const WORTH_THREADS: f64 = 5e8;

/// A symmetric matrix and its Cholesky factorisation.
pub struct Cholesky {
    graph: Graph,
    ordering: &'static str,
    flops: f64,
    /// The position in the order of elimination of each external row.
    position: Vec<usize>,
    /// The external row at each position.
    external: Vec<usize>,
    /// The pattern of the lower triangle in the order of elimination; each column begins with its diagonal entry.
    pattern: SymbolicSparseColMat<usize>,
    symbolic: supernodal::SymbolicSupernodalCholesky<usize>,
    fronts: Fronts,
    par: Par,
    /// The lower triangle, and the spare place at the end. Written by assembly.
    values: Vec<f64>,
    /// The factor, L or L with D on its diagonal. Written by `factor`.
    L: Vec<f64>,
    /// The place in `L` of each diagonal entry.
    diagonal: Vec<usize>,
    /// The matrix factored last is positive definite, and `L` is that of L Lᵀ. Written by `factor`.
    definite: bool,
    /// Right-hand side and solution in the order of elimination. Written by `solve`.
    x: Vec<f64>,
    /// The workspace of faer for L D Lᵀ, empty until a matrix needs it.
    buffer: MemBuffer,
    /// `buffer` is large enough.
    ready_for_indefinite: bool,
}

impl Keep for Cholesky {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let Cholesky {
            values,
            L,
            definite,
            graph: _,
            ordering: _,
            flops: _,
            position: _,
            external: _,
            pattern: _,
            symbolic: _,
            fronts: _,
            par: _,
            diagonal: _,
            x: _,
            buffer: _,
            ready_for_indefinite: _,
        } = self;
        values.keep(snapshot);
        L.keep(snapshot);
        definite.keep(snapshot);
        if snapshot.gives() && !self.definite {
            self.prepare_indefinite();
        }
    }
}

impl Cholesky {
    /// The factorisation of a pattern, without numbers.
    ///
    /// # Errors
    /// The factor does not fit into memory.
    pub(super) fn new(graph: Graph, threads: usize) -> Result<Self, TooLarge> {
        let elimination = Elimination::new(&graph).or_dissected(&graph).postordered(&graph);
        memory::require(graph.unknowns(), elimination.nonzeros)?;
        let external: Vec<usize> = elimination.order.iter().flat_map(|&g| graph.first[g]..graph.first[g + 1]).collect();
        let mut position = vec![0; external.len()];
        for (p, &row) in external.iter().enumerate() {
            position[row] = p;
        }
        let pattern = triangle(&graph, &elimination, &position, |p, q| q >= p);
        let symbolic = symbolic(triangle(&graph, &elimination, &position, |p, q| q <= p).as_ref());
        let bytes = size_of::<f64>() as f64 * elimination.nonzeros as f64;
        let symbolic = symbolic.map_err(|_| TooLarge { unknowns: graph.unknowns(), needed: bytes })?;
        // The patterns have taken their part of the memory, so it is asked once more.
        memory::require(graph.unknowns(), symbolic.len_val())?;
        let par = match elimination.flops > WORTH_THREADS && threads > 1 {
            true => Par::rayon(threads),
            false => Par::Seq,
        };
        let fronts = Fronts::new(&symbolic, &pattern, par != Par::Seq);
        let multipliers = graph.multipliers > 0;
        let mut cholesky = Cholesky {
            ordering: elimination.name,
            flops: elimination.flops,
            values: vec![0.0; pattern.compute_nnz() + 1],
            L: vec![0.0; symbolic.len_val()],
            diagonal: diagonal(&symbolic),
            definite: true,
            x: vec![0.0; external.len()],
            buffer: MemBuffer::new(StackReq::EMPTY),
            fronts,
            ready_for_indefinite: false,
            graph,
            position,
            external,
            pattern,
            symbolic,
            par,
        };
        if multipliers {
            cholesky.prepare_indefinite();
        }
        Ok(cholesky)
    }

    /// The place of an entry in [`Cholesky::values`], the same for both triangles; `None` where it is not in the pattern.
    pub(super) fn slot(&self, row: usize, col: usize) -> Option<usize> {
        let (p, q) = (*self.position.get(row)?, *self.position.get(col)?);
        let (p, q) = (p.max(q), p.min(q));
        let place = self.pattern.row_idx_of_col_raw(q).binary_search(&p).ok()?;
        Some(self.pattern.col_ptr()[q] + place)
    }

    pub(super) fn block_slot(&self, row: usize, col: usize) -> Option<(BlockSlot, bool)> {
        let first = |row: usize| {
            let group = *self.graph.group.get(row)? as usize;
            let (own, size) = (self.graph.first[group], self.graph.sizes[group]);
            (size == 6 && row == own).then(|| self.position[own])
        };
        let (p, q) = (first(row)?, first(col)?);
        let (lower, upper) = (p.max(q), p.min(q));
        let column = self.pattern.row_idx_of_col_raw(upper);
        let place = column.binary_search(&lower).ok()?;
        let at = (self.pattern.col_ptr()[upper] + place) as u32;
        Some((BlockSlot { at, step: column.len() as u32 - 1 }, p < q))
    }

    /// The entries of the matrix, to be filled before each factorisation.
    pub(super) fn values(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Hands each entry of both triangles to `visit`: external row, external column, value.
    pub(super) fn each_entry(&self, visit: &mut dyn FnMut(usize, usize, f64)) {
        for (column, &j) in self.external.iter().enumerate() {
            let from = self.pattern.col_ptr()[column];
            for (place, &row) in self.pattern.row_idx_of_col_raw(column).iter().enumerate() {
                let (i, value) = (self.external[row], self.values[from + place]);
                visit(i, j, value);
                if row != column {
                    visit(j, i, value);
                }
            }
        }
    }

    /// A place in [`Cholesky::values`] for entries that are not wanted.
    pub(super) fn spare(&self) -> usize {
        self.values.len() - 1
    }

    /// Tries L Lᵀ first, except with multipliers, whatever the matrices before were: otherwise a resumed run would not give
    /// the same bits. Only the pool of several threads allocates. False where `stop` is raised before L Lᵀ has come to its end.
    pub(super) fn factor(&mut self, stop: &AtomicBool) -> Result<bool, Singular> {
        self.definite = self.graph.multipliers == 0 && self.fronts.factor(&self.values, &mut self.L, stop);
        if self.definite {
            return self.check_pivots().map(|()| true);
        }
        if stop.load(Ordering::Relaxed) {
            return Ok(false);
        }
        self.factor_indefinite().map(|()| true)
    }

    /// Forms L D Lᵀ at once.
    pub(super) fn factor_indefinite(&mut self) -> Result<(), Singular> {
        self.definite = false;
        self.form_indefinite()?;
        self.check_pivots()
    }

    fn check_pivots(&self) -> Result<(), Singular> {
        for (p, &at) in self.diagonal.iter().enumerate() {
            let pivot = if self.definite { self.L[at] * self.L[at] } else { self.L[at] };
            if pivot.abs() <= PIVOT_TOLERANCE * self.values[self.pattern.col_ptr()[p]].abs() {
                return Err(Singular { row: self.external[p], pivot });
            }
        }
        Ok(())
    }

    /// Gives back the memory that L Lᵀ alone needs, until it is formed again.
    pub(super) fn rest(&mut self) {
        self.fronts.rest();
    }

    /// Takes the memory of L D Lᵀ.
    pub(super) fn prepare_indefinite(&mut self) {
        if !self.ready_for_indefinite {
            let indefinite = supernodal::factorize_supernodal_numeric_ldlt_scratch::<usize, f64>(
                &self.symbolic,
                self.par,
                Default::default(),
            );
            self.buffer = MemBuffer::new(indefinite.or(solve_scratch(&self.symbolic)));
            self.ready_for_indefinite = true;
        }
    }

    pub(super) fn is_determinant_negative(&self) -> bool {
        self.negative_eigenvalues() % 2 == 1
    }

    /// The number of negative entries of D: none where K = L Lᵀ.
    pub(super) fn negative_eigenvalues(&self) -> usize {
        if self.definite { 0 } else { self.diagonal.iter().filter(|&&at| self.L[at] < 0.0).count() }
    }

    /// L D Lᵀ by faer.
    fn form_indefinite(&mut self) -> Result<(), Singular> {
        self.prepare_indefinite();
        let nonzeros = self.values.len() - 1;
        let K = SparseColMatRef::new(self.pattern.as_ref(), &self.values[..nonzeros]);
        supernodal::factorize_supernodal_numeric_ldlt(
            &mut self.L,
            K,
            Default::default(),
            &self.symbolic,
            self.par,
            MemStack::new(&mut self.buffer),
            Default::default(),
        )
        .map(|_| ())
        .map_err(|LdltError::ZeroPivot { index }| Singular {
            row: self.external[index],
            pivot: self.L[self.diagonal[index]],
        })
    }

    /// Replaces the right-hand side `b` by the solution.
    pub(super) fn solve(&mut self, b: &mut [f64]) {
        for (x, &row) in self.x.iter_mut().zip(&self.external) {
            *x = b[row];
        }
        if self.definite {
            self.fronts.solve(&self.L, &mut self.x);
        } else {
            // The solution of faer depends in its last bits on the number of threads, so it uses one.
            let n = self.x.len();
            let x = MatMut::from_column_major_slice_mut(&mut self.x, n, 1);
            let stack = MemStack::new(&mut self.buffer);
            let factor = supernodal::SupernodalLdltRef::new(&self.symbolic, &self.L);
            factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, stack);
        }
        for (x, &row) in self.x.iter().zip(&self.external) {
            b[row] = *x;
        }
    }

    /// The size of the factorisation, for `check`.
    pub(super) fn stats(&self) -> Stats {
        Stats { unknowns: self.graph.unknowns(), nonzeros: self.L.len(), flops: self.flops, ordering: self.ordering }
    }
}

/// The pattern of the entries (q, p) in the order of elimination that `wanted(p, q)` keeps, by ascending columns p and
/// rows q.
fn triangle(
    graph: &Graph,
    elimination: &Elimination,
    position: &[usize],
    wanted: impl Fn(usize, usize) -> bool,
) -> SymbolicSparseColMat<usize> {
    let n = graph.unknowns();
    let (mut start, mut rows) = (vec![0], Vec::new());
    for &g in &elimination.order {
        let mut coupled: Vec<usize> = graph.neighbours(g).iter().map(|&h| h as usize).chain([g]).collect();
        coupled.sort_unstable_by_key(|&h| elimination.position[h]);
        for row in graph.first[g]..graph.first[g + 1] {
            let column = coupled.iter().flat_map(|&h| graph.first[h]..graph.first[h + 1]).map(|row| position[row]);
            rows.extend(column.filter(|&q| wanted(position[row], q)));
            start.push(rows.len());
        }
    }
    SymbolicSparseColMat::new_checked(n, n, start, None, rows)
}

/// The structure of the factor from that of the upper triangle.
fn symbolic(upper: SymbolicSparseColMatRef<usize>) -> Result<supernodal::SymbolicSupernodalCholesky<usize>, FaerError> {
    let n = upper.ncols();
    let scratch = simplicial::prefactorize_symbolic_cholesky_scratch::<usize>(n, upper.compute_nnz())
        .or(supernodal::factorize_supernodal_symbolic_cholesky_scratch::<usize>(n));
    let mut buffer = MemBuffer::new(scratch);
    let (mut tree, mut counts) = (vec![0; n], vec![0; n]);
    let tree = simplicial::prefactorize_symbolic_cholesky(&mut tree, &mut counts, upper, MemStack::new(&mut buffer));
    supernodal::factorize_supernodal_symbolic_cholesky(
        upper,
        tree,
        &counts,
        MemStack::new(&mut buffer),
        Default::default(),
    )
}

/// The workspace of a substitution with one right-hand side.
fn solve_scratch(symbolic: &supernodal::SymbolicSupernodalCholesky<usize>) -> StackReq {
    symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)
}

/// The place of each diagonal entry in the factor.
fn diagonal(symbolic: &supernodal::SymbolicSupernodalCholesky<usize>) -> Vec<usize> {
    let mut diagonal = Vec::with_capacity(symbolic.nrows());
    for s in 0..symbolic.n_supernodes() {
        let columns = symbolic.supernode_end()[s] - symbolic.supernode_begin()[s];
        let rows = columns + symbolic.supernode(s).pattern().len();
        diagonal.extend((0..columns).map(|j| symbolic.col_ptr_for_val()[s] + j * rows + j));
    }
    diagonal
}
