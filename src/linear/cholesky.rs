//! Supernodal Cholesky factorisation K = L Lᵀ by fronts, or by faer L D Lᵀ where K is not positive definite.
//!
//! Assembly writes straight into the lower triangle in the order of elimination, the one form faer takes without
//! permuting the matrix at each factorisation. L has the form that faer gives it, whose substitutions serve both. L D Lᵀ goes without pivoting: beyond a buckling load it holds as well as
//! the leading minors stay away from zero, and the residual of the caller tells.

use super::elimination::Elimination;
use super::fronts::Fronts;
use super::graph::Graph;
use super::memory::{TooLarge, room};
use super::{Singular, Stats, Tile, VANISHED};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::ldlt::factor::LdltError;
use faer::sparse::linalg::cholesky::{simplicial, supernodal};
use faer::sparse::{FaerError, SparseColMatRef, SymbolicSparseColMat, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};

/// Below this many operations the threads of the dense kernels cost more than they bring.
const WORTH_THREADS: f64 = 5e8;

pub struct Cholesky {
    graph: Graph,
    ordering: &'static str,
    flops: f64,
    /// Position in the order of elimination of each external row, and the other way round.
    position: Vec<usize>,
    external: Vec<usize>,
    /// Pattern of the lower triangle in the order of elimination; each column begins with its diagonal.
    pattern: SymbolicSparseColMat<usize>,
    symbolic: supernodal::SymbolicSupernodalCholesky<usize>,
    fronts: Fronts,
    par: Par,
    /// Lower triangle, and the spare place. Written by assembly.
    values: Vec<f64>,
    /// The factor, its diagonal at `diagonal`. Written by `factor`.
    L: Vec<f64>,
    diagonal: Vec<usize>,
    definite: bool,
    /// Right-hand side and solution in the order of elimination. Written by `solve`.
    x: Vec<f64>,
    buffer: MemBuffer,
    /// Whether `buffer` is large enough for L D Lᵀ: only matrices that need it pay for it.
    ready_for_indefinite: bool,
}

impl Cholesky {
    pub(super) fn new(graph: Graph, threads: usize) -> Result<Self, TooLarge> {
        let elimination = Elimination::new(&graph);
        room(graph.unknowns(), elimination.nonzeros)?;
        let external: Vec<usize> = elimination.order.iter().flat_map(|&g| graph.first[g]..graph.first[g + 1]).collect();
        let mut position = vec![0; external.len()];
        for (p, &row) in external.iter().enumerate() {
            position[row] = p;
        }
        let pattern = triangle(&graph, &elimination, &position, |p, q| q >= p);
        let symbolic = symbolic(triangle(&graph, &elimination, &position, |p, q| q <= p).as_ref());
        let bytes = size_of::<f64>() as f64 * elimination.nonzeros as f64;
        let symbolic = symbolic.map_err(|_| TooLarge { unknowns: graph.unknowns(), needed: bytes })?;
        // Once more: the patterns have taken their part.
        room(graph.unknowns(), symbolic.len_val())?;
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

    pub(super) fn slot(&self, row: usize, col: usize) -> Option<usize> {
        let (p, q) = (*self.position.get(row)?, *self.position.get(col)?);
        let (p, q) = (p.max(q), p.min(q));
        let place = self.pattern.row_idx_of_col_raw(q).binary_search(&p).ok()?;
        Some(self.pattern.col_ptr()[q] + place)
    }

    pub(super) fn tile(&self, rows: &[u32; 6], cols: &[u32; 6]) -> Option<(Tile, bool)> {
        let first = |rows: &[u32; 6]| {
            let group = *self.graph.group.get(rows[0] as usize)? as usize;
            let (own, size) = (self.graph.first[group], self.graph.sizes[group]);
            let whole = size == 6 && (0..6).all(|i| rows[i] as usize == own + i);
            whole.then(|| self.position[own])
        };
        let (p, q) = (first(rows)?, first(cols)?);
        let (lower, upper) = (p.max(q), p.min(q));
        let column = self.pattern.row_idx_of_col_raw(upper);
        let place = column.binary_search(&lower).ok()?;
        let at = (self.pattern.col_ptr()[upper] + place) as u32;
        Some((Tile { at, step: column.len() as u32 - 1 }, p < q))
    }

    pub(super) fn values(&mut self) -> &mut [f64] {
        &mut self.values
    }

    pub(super) fn spare(&self) -> usize {
        self.values.len() - 1
    }

    /// L Lᵀ first, always, but with multipliers: an answer that depended on the matrices before could not be resumed bit for bit.
    /// Allocates only on several threads, whose pool does.
    pub(super) fn factor(&mut self) -> Result<(), Singular> {
        self.definite = self.graph.multipliers == 0 && self.fronts.factor(&self.values, &mut self.L);
        if !self.definite {
            self.factor_indefinite()?;
        }

        for (p, &at) in self.diagonal.iter().enumerate() {
            let pivot = if self.definite { self.L[at] * self.L[at] } else { self.L[at] };
            if pivot.abs() <= VANISHED * self.values[self.pattern.col_ptr()[p]].abs() {
                return Err(Singular { row: self.external[p], pivot });
            }
        }
        Ok(())
    }

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

    /// Those of D: none where K = L Lᵀ.
    pub(super) fn negatives(&self) -> usize {
        if self.definite { 0 } else { self.diagonal.iter().filter(|&&at| self.L[at] < 0.0).count() }
    }

    fn factor_indefinite(&mut self) -> Result<(), Singular> {
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

    pub(super) fn solve(&mut self, b: &mut [f64]) {
        for (x, &row) in self.x.iter_mut().zip(&self.external) {
            *x = b[row];
        }
        if self.definite {
            self.fronts.solve(&self.L, &mut self.x);
        } else {
            // On one thread: faer's solution depends in its last bits on their number.
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

    pub(super) fn stats(&self) -> Stats {
        Stats { unknowns: self.graph.unknowns(), nonzeros: self.L.len(), flops: self.flops, ordering: self.ordering }
    }
}

/// The entries (q, p) of the matrix in the order of elimination that `wanted(p, q)` keeps, by ascending columns p and
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

fn solve_scratch(symbolic: &supernodal::SymbolicSupernodalCholesky<usize>) -> StackReq {
    symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)
}

/// Where the diagonal of each column stands in the factor.
fn diagonal(symbolic: &supernodal::SymbolicSupernodalCholesky<usize>) -> Vec<usize> {
    let mut diagonal = Vec::with_capacity(symbolic.nrows());
    for s in 0..symbolic.n_supernodes() {
        let columns = symbolic.supernode_end()[s] - symbolic.supernode_begin()[s];
        let rows = columns + symbolic.supernode(s).pattern().len();
        diagonal.extend((0..columns).map(|j| symbolic.col_ptr_for_val()[s] + j * rows + j));
    }
    diagonal
}
