//! Supernodal Cholesky factorisation: multifrontal K = L Lᵀ, or L D Lᵀ where K is not positive definite.
//!
//! Assembly writes straight into the lower triangle in the order of elimination. L D Lᵀ is formed without pivoting. Beyond a buckling load
//! it is as accurate as the leading minors allow, and the caller checks the residual.

use super::block_slot::BlockSlot;
use super::elimination::Elimination;
use super::factor_store::FactorStore;
use super::fronts::{Fronts, Matrix};
use super::graph::Graph;
use super::memory::{self, TooLarge};
use super::pivot::Singular;
use super::stats::Stats;
use super::stops::StopQuery;
use super::substitution::Factored;
use super::tree::Layout;
use super::triangle::LowerTriangle;
use base::snapshot::{Keep, Snapshot};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{simplicial, supernodal};
use faer::sparse::{FaerError, SymbolicSparseColMat, SymbolicSparseColMatRef};
use std::sync::atomic::AtomicUsize;

/// Factorisations of fewer operations run on one thread: there threads cost more time than they save.
pub(super) const WORTH_THREADS: f64 = 5e8;

/// A symmetric matrix and its Cholesky factorisation.
pub struct Cholesky {
    graph: Graph,
    ordering: &'static str,
    flops: f64,
    /// Numbers of the matrix, the factor and the update matrices.
    numbers: usize,
    /// The place in the order of elimination of each group.
    place: Vec<u32>,
    /// The external row at each position in the order of elimination.
    external: Vec<u32>,
    /// The places of entries in `values`.
    triangle: LowerTriangle,
    fronts: Fronts,
    /// The lower triangle, and the spare place at the end. Written by assembly.
    values: Vec<f64>,
    /// The factor, L or L with D on its diagonal. Written by `factor`.
    L: FactorStore,
    /// The matrix factored last is positive definite, and `L` is that of L Lᵀ. Written by `factor`.
    definite: bool,
    /// Right-hand side and solution in the order of elimination. Written by `solve`.
    x: Vec<f64>,
}

/// A factor in a file is not kept but formed again from the matrix.
impl Keep for Cholesky {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let Cholesky {
            values,
            L,
            definite,
            graph: _,
            ordering: _,
            flops: _,
            numbers: _,
            place: _,
            external: _,
            triangle: _,
            fronts: _,
            x: _,
        } = self;
        values.keep(snapshot);
        definite.keep(snapshot);
        let mut is_kept = !L.is_file();
        is_kept.keep(snapshot);
        if is_kept {
            let mut length = L.len();
            length.keep(snapshot);
            if length == L.len() { L.iter_mut().for_each(|number| number.keep(snapshot)) } else { snapshot.tear() }
        } else if snapshot.gives() {
            // Without an earlier factorization there is nothing to form.
            let _ = self.form(self.definite, &|| false);
        }
    }
}

impl Cholesky {
    /// The factorisation of a pattern, without numbers.
    ///
    /// # Errors
    /// Neither memory nor disk holds the factor.
    pub(super) fn new(graph: Graph, threads: usize) -> Result<Self, TooLarge> {
        Cholesky::with_store(graph, threads, FactorStore::new)
    }

    /// Like [`Self::new`], with storage chosen by `store` from the number of unknowns, the size of the factor, and the memory needed beside
    /// it.
    fn with_store(
        graph: Graph,
        threads: usize,
        store: impl Fn(usize, usize, usize) -> Result<FactorStore, TooLarge>,
    ) -> Result<Self, TooLarge> {
        let elimination = Elimination::new(&graph).or_dissected(&graph).postordered(&graph);
        let triangle = LowerTriangle::new(&graph, &elimination);
        memory::require(graph.unknowns(), triangle.entries())?;
        let bytes = size_of::<f64>() as f64 * elimination.nonzeros as f64;
        let too_large = |_| TooLarge { unknowns: graph.unknowns(), needed: bytes, scratch: None };
        // Places of entries are counted in 32 bits.
        u32::try_from(triangle.entries()).map_err(|_| too_large(FaerError::IndexOverflow))?;
        let symbolic = symbolic(upper_pattern(&triangle).as_ref()).map_err(too_large)?;
        let threads = if elimination.flops > WORTH_THREADS { threads } else { 1 };
        let layout = Layout::new(&symbolic, &triangle);
        let others = triangle.entries() + layout.updates(threads);
        let L = store(graph.unknowns(), symbolic.len_val(), others)?;
        let rows = |g: usize| graph.first[g] as u32..graph.first[g + 1] as u32;
        Ok(Cholesky {
            ordering: elimination.name,
            flops: elimination.flops,
            values: vec![0.0; triangle.entries() + 1],
            numbers: others + L.len(),
            L,
            definite: true,
            x: vec![0.0; graph.unknowns()],
            fronts: Fronts::new(layout, threads),
            place: elimination.position.iter().map(|&place| place as u32).collect(),
            external: elimination.order.iter().flat_map(|&g| rows(g)).collect(),
            graph,
            triangle,
        })
    }

    /// The group of an external row, by its place in the order of elimination, and the row within it.
    fn placed(&self, row: usize) -> Option<(usize, usize)> {
        let group = *self.graph.group.get(row)? as usize;
        Some((self.place[group] as usize, row - self.graph.first[group]))
    }

    /// The place of an entry in [`Cholesky::values`], the same for both triangles; `None` where it is not in the pattern.
    pub(super) fn slot(&self, row: usize, col: usize) -> Option<usize> {
        let (p, q) = (self.placed(row)?, self.placed(col)?);
        self.triangle.slot(p.max(q), p.min(q))
    }

    pub(super) fn block_slot(&self, row: usize, col: usize) -> Option<(BlockSlot, bool)> {
        let whole = |row: usize| {
            let (place, within) = self.placed(row)?;
            (self.triangle.size(place) == 6 && within == 0).then_some(place)
        };
        let (p, q) = (whole(row)?, whole(col)?);
        let (lower, upper) = (p.max(q), p.min(q));
        let at = self.triangle.slot((lower, 0), (upper, 0))? as u32;
        Some((BlockSlot { at, step: self.triangle.step(upper) as u32 }, p < q))
    }

    /// The entries of the matrix, to be filled before each factorisation.
    pub(super) fn values(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Hands each entry of both triangles to `visit`: external row, external column, value.
    pub(super) fn each_entry(&self, visit: &mut dyn FnMut(usize, usize, f64)) {
        self.triangle.each(&mut |row, column, place| {
            let (i, j, value) = (self.external[row] as usize, self.external[column] as usize, self.values[place]);
            visit(i, j, value);
            if row != column {
                visit(j, i, value);
            }
        });
    }

    /// A place in [`Cholesky::values`] for entries that are not wanted.
    pub(super) fn spare(&self) -> usize {
        self.values.len() - 1
    }

    /// Tries L Lᵀ first, except with multipliers, whatever the matrices before were: otherwise a resumed run would not give
    /// the same bits. Only the pool of several threads allocates. False where `stops` is true before it is done.
    pub(super) fn factor(&mut self, stops: StopQuery) -> Result<bool, Singular> {
        let mut formed = if self.graph.multipliers == 0 { self.form(true, stops) } else { Err(0) };
        self.definite = formed.is_ok();
        if !self.definite {
            formed = self.form(false, stops);
        }
        match formed {
            Ok(None) => Ok(true),
            Err(_) if stops() => Ok(false),
            Ok(Some(position)) | Err(position) => Err(self.singular(position)),
        }
    }

    /// Forms L D Lᵀ at once.
    pub(super) fn factor_indefinite(&mut self) -> Result<(), Singular> {
        self.definite = false;
        match self.form(false, &|| false) {
            Ok(None) => Ok(()),
            Ok(Some(position)) | Err(position) => Err(self.singular(position)),
        }
    }

    /// Forms the factor, and returns the position of the first pivot that vanishes, if any does.
    ///
    /// # Errors
    /// As for [`Fronts::factor`].
    fn form(&mut self, definite: bool, stops: StopQuery) -> Result<Option<usize>, usize> {
        self.L.forget();
        let vanishing = AtomicUsize::new(usize::MAX);
        let matrix = Matrix { triangle: &self.triangle, values: &self.values, definite, stops, vanishing: &vanishing };
        self.fronts.factor(matrix, &mut self.L)?;
        Ok(Some(vanishing.into_inner()).filter(|&position| position != usize::MAX))
    }

    /// Gives back the memory of update matrices until there is something to factor.
    pub(super) fn rest(&mut self) {
        self.fronts.rest();
    }

    fn singular(&self, position: usize) -> Singular {
        let own = self.fronts.tree.diagonal().nth(position).map_or(f64::NAN, |at| self.L[at]);
        let pivot = if self.definite { own * own } else { own };
        Singular { row: self.external[position] as usize, pivot }
    }

    pub(super) fn is_determinant_negative(&self) -> bool {
        self.negative_eigenvalues() % 2 == 1
    }

    /// The number of negative entries of D: none where K = L Lᵀ.
    pub(super) fn negative_eigenvalues(&self) -> usize {
        if self.definite { 0 } else { self.fronts.tree.diagonal().filter(|&at| self.L[at] < 0.0).count() }
    }

    /// Replaces R right-hand sides `b` by their solutions.
    pub(super) fn solve<const R: usize>(&mut self, mut b: [&mut [f64]; R]) {
        let n = self.external.len();
        if self.x.len() < R * n {
            self.x = vec![0.0; R * n];
        }
        let x = &mut self.x.as_chunks_mut().0[..n];
        for (x, &row) in x.iter_mut().zip(&self.external) {
            *x = b.each_ref().map(|b| b[row as usize]);
        }
        self.fronts.solve(Factored { values: &self.L, definite: self.definite }, x);
        for (x, &row) in x.iter().zip(&self.external) {
            b.iter_mut().zip(x).for_each(|(b, x)| b[row as usize] = *x);
        }
    }

    /// The size of the factorisation, for `check`.
    pub(super) fn stats(&self) -> Stats {
        Stats {
            unknowns: self.graph.unknowns(),
            nonzeros: self.L.len(),
            numbers: self.numbers,
            in_file: self.L.is_file(),
            flops: self.flops,
            ordering: self.ordering,
        }
    }
}

/// The pattern of the upper triangle in the order of elimination, by ascending columns and rows.
fn upper_pattern(triangle: &LowerTriangle) -> SymbolicSparseColMat<usize> {
    let n = triangle.rows();
    let mut start = vec![0; n + 1];
    triangle.each(&mut |row, _, _| start[row + 1] += 1);
    for row in 0..n {
        start[row + 1] += start[row];
    }
    let (mut next, mut rows) = (start.clone(), vec![0; start[n]]);
    // A row of the lower triangle is a column of the upper one.
    triangle.each(&mut |row, column, _| {
        rows[next[row]] = column;
        next[row] += 1;
    });
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

#[cfg(test)]
mod tests {
    use super::super::memory::NoScratch;
    use super::*;
    use crate::Structure;

    /// A grid of nodes with three unknowns each.
    fn grid(side: usize) -> Structure {
        let at = |i: usize, j: usize| i * side + j;
        let cells = (0..(side - 1) * (side - 1)).map(|cell| [cell / (side - 1), cell % (side - 1)]);
        let corners = |[i, j]: [usize; 2]| vec![at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
        Structure { sizes: vec![3; side * side], connectivity: cells.map(corners).collect(), ..Structure::default() }
    }

    /// Writes a matrix that is definite, or, with a `shift`, not.
    fn fill(of: &mut Cholesky, side: usize, shift: f64) {
        let n = 3 * side * side;
        of.values().fill(0.0);
        for row in 0..n {
            for column in 0..=row {
                if let Some(slot) = of.slot(row, column) {
                    let own = if row == column { 30.0 + (row % 7) as f64 - shift } else { -1.0 / (1 + row % 5) as f64 };
                    of.values()[slot] = own;
                }
            }
        }
    }

    /// A factor in a file has the bits of one in memory. A snapshot holds the matrix alone, and the factor is formed again in either place.
    #[test]
    fn a_factor_in_a_file_is_that_in_memory() {
        // Machines with temporary files in memory have the test of the whole program.
        if FactorStore::in_file(1).is_err_and(|reason| reason == NoScratch::InMemory) {
            return;
        }
        let side = 12;
        let make = |file: bool| {
            let store = |unknowns: usize, numbers: usize, others: usize| match file {
                true => FactorStore::in_file(numbers).map_err(|scratch| TooLarge {
                    unknowns,
                    needed: 0.0,
                    scratch: Some(scratch),
                }),
                false => FactorStore::new(unknowns, numbers, others),
            };
            Cholesky::with_store(Graph::new(&grid(side)), 1, store).unwrap()
        };
        let solved = |of: &mut Cholesky| {
            let mut b: Vec<f64> = (0..3 * side * side).map(|row| (row % 11) as f64 - 4.0).collect();
            of.solve([&mut b]);
            b
        };
        for shift in [0.0, 25.0] {
            let [mut memory, mut file] = [false, true].map(make);
            assert!(file.stats().in_file && !memory.stats().in_file);
            for of in [&mut memory, &mut file] {
                fill(of, side, shift);
                assert_eq!(of.factor(&|| false), Ok(true));
            }
            let wanted = solved(&mut memory);
            assert!(wanted.iter().all(|x| x.is_finite() && *x != 0.0));
            assert_eq!(solved(&mut file), wanted);
            assert_eq!(file.negative_eigenvalues(), memory.negative_eigenvalues());
            for (from, to) in [(true, true), (true, false), (false, true)] {
                let mut taken = Snapshot::taken();
                if from { &mut file } else { &mut memory }.keep(&mut taken);
                let (mut given, mut other) = (Snapshot::of(taken.into_bytes()), make(to));
                other.keep(&mut given);
                assert!(given.is_used_up());
                assert_eq!(solved(&mut other), wanted, "from a file: {from}, to a file: {to}");
            }
        }
    }
}
