//! Multifrontal L Lᵀ and L D Lᵀ: each supernode adds the update matrices of its children to its front, and eliminates its columns. One
//! update matrix, a packed triangle, goes to its parent. Update matrices wait on two stacks for alternate levels of the tree. A front is
//! written in its final place beside those of its children, without moving. I. S. Duff & J. K. Reid, ACM Trans. Math. Softw. 9 (1983).
//!
//! Subtrees of the elimination tree are independent. One thread factors each with reusable stacks, and only the update matrices of the
//! roots remain. The supernodes above them follow one by one, the large dense operations of each in halves ([`super::dense`]). Both cuts
//! depend on the structure alone, so the bits do not depend on the number of threads. Factorisations allocate nothing.

use super::dense::{join, potrf, trsm};
use super::indefinite::{ldlt, ldlt_scratch};
use super::packed::Packed;
use super::pivot::PIVOT_TOLERANCE;
use super::pool::LendingPool;
use super::stops::StopQuery;
use super::tree::{Front, Layout, StackSizes, Tree};
use super::triangle::LowerTriangle;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::cholesky_in_place_scratch;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, Par};
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Fronts are assembled in pieces of about so many numbers, which stay in a core's cache.
const PIECE: usize = 1 << 15;
/// Unknowns of most nodes.
const NODE: usize = 6;

/// The factorisation of one structure: the assembly tree and the memory to work through it.
pub(super) struct Fronts {
    /// The assembly tree of the supernodes.
    pub(super) tree: Tree,
    /// Whole subtrees, ascending.
    pub(super) subtrees: Vec<Subtree>,
    /// The supernodes above the subtrees.
    pub(super) above: Vec<usize>,
    /// The vectors of the supernodes above.
    pub(super) vectors: Vectors,
    /// The stacks of the supernodes above.
    stacks: Stacks,
    /// The stacks of subtrees, one for each thread.
    pool: LendingPool<Stacks>,
    /// Subtrees and the halves of dense operations run side by side.
    pub(super) threads: bool,
    /// The solution above the subtrees, by position. Written and read by [`super::substitution`].
    pub(super) done: Vec<f64>,
}

/// Supernodes that are factored one after the other on one thread.
pub(super) struct Subtree {
    pub supernodes: Range<usize>,
    /// Update matrices of its roots for the supernodes above, and their size.
    updates: Vec<f64>,
    left: usize,
    /// The vectors of a substitution.
    pub vectors: Vectors,
}

/// The memory of a substitution, for one right-hand side or several, those of a row beside each other.
pub(super) struct Vectors {
    /// The stack of update vectors.
    stack: Vec<f64>,
    /// The right-hand sides of one front.
    front: Vec<f64>,
    /// Lengths for one.
    lengths: [usize; 2],
}

impl Vectors {
    fn new(sizes: StackSizes) -> Vectors {
        let lengths = [sizes.vectors, sizes.tallest];
        let [stack, front] = lengths.map(|length| vec![0.0; length]);
        Vectors { stack, front, lengths }
    }

    /// Takes memory for so many right-hand sides, where there is too little.
    fn make_room(&mut self, sides: usize) {
        for (memory, length) in [&mut self.stack, &mut self.front].into_iter().zip(self.lengths) {
            grow(memory, sides * length);
        }
    }

    /// The stack of update vectors.
    pub fn stack<const R: usize>(&self) -> &[[f64; R]] {
        self.stack.as_chunks().0
    }

    /// The right-hand sides of one front.
    pub fn front<const R: usize>(&mut self) -> &mut [[f64; R]] {
        self.front.as_chunks_mut().0
    }

    /// The right-hand sides of one front, and the stack.
    pub fn both<const R: usize>(&mut self) -> (&mut [[f64; R]], &mut [[f64; R]]) {
        (self.front.as_chunks_mut().0, self.stack.as_chunks_mut().0)
    }
}

/// Makes a vector of zeros of a shorter one.
fn grow(memory: &mut Vec<f64>, length: usize) {
    if memory.len() < length {
        *memory = vec![0.0; length];
    }
}

/// The memory of a factorisation.
struct Stacks {
    /// Update matrices that wait for their parents, the last on top, by level of the tree.
    updates: [Vec<f64>; 2],
    /// Their lengths while there is something to factor.
    heights: [usize; 2],
    /// The scratch of the dense operations.
    scratch: MemBuffer,
    /// Columns of L D. Untouched where all pivots are positive.
    scaled: Vec<f64>,
}

impl Stacks {
    fn new(sizes: StackSizes) -> Stacks {
        let definite = cholesky_in_place_scratch::<f64>(sizes.widest, Par::Seq, Default::default());
        let (indefinite, scaled) = ldlt_scratch(sizes.widest, sizes.tallest);
        Stacks {
            updates: sizes.stacks.map(|size| vec![0.0; size]),
            heights: sizes.stacks,
            scratch: MemBuffer::new(definite.or(indefinite)),
            scaled: vec![0.0; scaled],
        }
    }
}

/// A symmetric matrix to be factored.
#[derive(Clone, Copy)]
pub(super) struct Matrix<'a> {
    /// The places of its entries.
    pub triangle: &'a LowerTriangle,
    pub values: &'a [f64],
    /// As L Lᵀ, not as L D Lᵀ.
    pub definite: bool,
    /// True where the factorisation is to end before it is done.
    pub stops: StopQuery<'a>,
    /// Lowered to the position of the first pivot that vanishes beside its entry of the diagonal.
    pub vanishing: &'a AtomicUsize,
}

impl Fronts {
    /// The memory to walk through the fronts on so many threads.
    pub fn new(layout: Layout, threads: usize) -> Self {
        let (largest, side_by_side) = layout.side_by_side(threads);
        let Layout { tree, subtrees, above: (above, sizes) } = layout;
        let subtree = |(supernodes, sizes): (Range<usize>, StackSizes)| Subtree {
            supernodes,
            updates: vec![0.0; sizes.left],
            left: sizes.left,
            vectors: Vectors::new(sizes),
        };
        Fronts {
            done: vec![0.0; tree.unknowns()],
            tree,
            subtrees: subtrees.into_iter().map(subtree).collect(),
            above,
            vectors: Vectors::new(sizes),
            stacks: Stacks::new(sizes),
            pool: LendingPool::new((0..side_by_side).map(|_| Stacks::new(largest))),
            threads: threads > 1,
        }
    }

    /// Factors a matrix into `L`.
    ///
    /// # Errors
    /// Position of a zero or non-finite pivot, or of a non-positive pivot of a definite matrix; arbitrary after a stop.
    pub fn factor(&mut self, K: Matrix, L: &mut [f64]) -> Result<(), usize> {
        self.take_memory();
        let Fronts { tree, subtrees, above, stacks, pool, threads, .. } = self;
        tree.factor_subtrees(subtrees, K, (L, 0), pool, *threads)?;
        above
            .iter()
            .try_for_each(|&s| tree.eliminate(s, K, &mut L[tree.panel(s)], (stacks, &mut []), subtrees, *threads))
    }

    /// Gives back the memory of update matrices until there is something to factor.
    pub fn rest(&mut self) {
        self.subtrees.iter_mut().for_each(|subtree| subtree.updates = Vec::new());
        self.each_stacks(|stacks| stacks.updates = Default::default());
    }

    /// Takes it again where it was given back.
    fn take_memory(&mut self) {
        self.subtrees.iter_mut().for_each(|subtree| grow(&mut subtree.updates, subtree.left));
        self.each_stacks(|Stacks { updates, heights, .. }| {
            updates.iter_mut().zip(heights).for_each(|(updates, height)| grow(updates, *height));
        });
    }

    /// Takes the memory to substitute for so many right-hand sides at once.
    pub(super) fn make_room_for_vectors(&mut self, sides: usize) {
        grow(&mut self.done, sides * self.tree.unknowns());
        self.vectors.make_room(sides);
        self.subtrees.iter_mut().for_each(|subtree| subtree.vectors.make_room(sides));
    }

    fn each_stacks(&mut self, mut visit: impl FnMut(&mut Stacks)) {
        visit(&mut self.stacks);
        self.pool.each(visit);
    }
}

impl Tree {
    /// Factors subtrees into `L`, which begins at `base` of the whole factor.
    fn factor_subtrees(
        &self,
        of: &mut [Subtree],
        K: Matrix,
        (L, base): (&mut [f64], usize),
        pool: &LendingPool<Stacks>,
        threads: bool,
    ) -> Result<(), usize> {
        match of {
            [] => Ok(()),
            [Subtree { supernodes, updates, .. }] => pool.with(|stacks| {
                supernodes.clone().try_for_each(|s| {
                    let panel = self.panel(s);
                    let panel = &mut L[panel.start - base..panel.end - base];
                    self.eliminate(s, K, panel, (stacks, updates), &[], false)
                })
            }),
            _ => {
                let (left, right) = of.split_at_mut(of.len() / 2);
                let middle = self.fronts[right[0].supernodes.start].panel;
                let (head, tail) = L.split_at_mut(middle - base);
                let (left, right) = join(
                    threads,
                    || self.factor_subtrees(left, K, (head, base), pool, threads),
                    || self.factor_subtrees(right, K, (tail, middle), pool, threads),
                );
                left.and(right)
            }
        }
    }

    /// Assembles and eliminates supernode `s`. It writes its panel of L, and replaces the update matrices of its children on the stack by
    /// its own. Above the subtree the update matrix goes to `left`.
    fn eliminate(
        &self,
        s: usize,
        K: Matrix,
        panel: &mut [f64],
        (stacks, left): (&mut Stacks, &mut [f64]),
        subtrees: &[Subtree],
        threads: bool,
    ) -> Result<(), usize> {
        let front = &self.fronts[s];
        if (K.stops)() {
            return Err(front.begin);
        }
        let (columns, rows, height) = (front.columns, front.rows, front.height());
        let Stacks { updates: [even, odd], scratch, scaled, .. } = stacks;
        let (own, others) = if front.level == 0 { (even, &*odd) } else { (odd, &*even) };
        let own = if front.is_left { left } else { own };
        let update_of = |child: &Front| match child.subtree {
            Some(t) if child.subtree != front.subtree => &subtrees[t].updates[child.update..],
            _ => &others[child.update..],
        };
        let diagonal = |j: usize| j * height + j;
        let begin = |columns: Range<usize>, panel: &mut [f64]| self.begin(s, K, columns, panel);
        self.assemble(s, 0..columns, (panel, &diagonal), &begin, &update_of, threads);

        let shape = Packed::new(rows);
        let update = &mut own[front.update..][..shape.len()];
        let matrix = MatMut::from_column_major_slice_mut(&mut *panel, height, columns);
        let scratch = MemStack::new(scratch);
        if K.definite {
            let (mut square, mut below) = matrix.split_at_row_mut(columns);
            if !potrf(square.rb_mut(), scratch, threads) {
                return Err(front.begin);
            }
            trsm(square.rb(), below.rb_mut(), false, threads);
            shape.subtract(Accum::Replace, (below.rb(), below.rb()), update, threads);
        } else {
            ldlt(matrix, (shape, &mut *update), scaled, scratch, threads).map_err(|column| front.begin + column)?;
        }
        if let Some(position) = self.vanishing(s, K, panel) {
            K.vanishing.fetch_min(position, Ordering::Relaxed);
        }
        let diagonal = |place: usize| shape.diagonal(place - columns);
        self.assemble(s, columns..height, (update, &diagonal), &|_, _| {}, &update_of, threads);
        Ok(())
    }

    /// Position of the first pivot of supernode `s` that vanishes beside its diagonal entry; `panel` belongs to the factor.
    fn vanishing(&self, s: usize, K: Matrix, panel: &[f64]) -> Option<usize> {
        let (mut columns, height) = (self.columns(s), self.fronts[s].height());
        let begin = columns.start;
        let mut k = K.triangle.group(begin);
        columns.find(|&position| {
            while K.triangle.first(k + 1) <= position {
                k += 1;
            }
            let own = panel[(position - begin) * (height + 1)];
            let pivot = if K.definite { own * own } else { own };
            let entry = K.values[K.triangle.diagonal(k, position - K.triangle.first(k))];
            pivot.abs() <= PIVOT_TOLERANCE * entry.abs()
        })
    }

    /// Adds the update matrices of the children of `s` to `columns` of its front, after `begin`. `diagonal` gives the position of each
    /// diagonal entry, followed by the entries below it; the first is the start of `to`.
    fn assemble<'a>(
        &self,
        s: usize,
        columns: Range<usize>,
        (to, diagonal): (&mut [f64], &(impl Fn(usize) -> usize + Sync)),
        begin: &(impl Fn(Range<usize>, &mut [f64]) + Sync),
        update_of: &(impl Fn(&Front) -> &'a [f64] + Sync),
        threads: bool,
    ) {
        if to.len() > PIECE && columns.len() > 1 {
            let middle = columns.start + columns.len() / 2;
            let (left, right) = to.split_at_mut(diagonal(middle) - diagonal(columns.start));
            join(
                threads,
                || self.assemble(s, columns.start..middle, (left, diagonal), begin, update_of, threads),
                || self.assemble(s, middle..columns.end, (right, diagonal), begin, update_of, threads),
            );
        } else if !columns.is_empty() {
            begin(columns.clone(), to);
            let (height, base) = (self.fronts[s].height(), diagonal(columns.start));
            for child in self.children(s) {
                let from = update_of(&self.fronts[child]);
                self.extend_add(child, from, columns.clone(), (to, height), |j| diagonal(j) - base);
            }
        }
    }

    /// Sets `columns` of the panel of supernode `s` to the entries of the matrix. `panel` begins on the diagonal of the first.
    fn begin(&self, s: usize, K: Matrix, columns: Range<usize>, panel: &mut [f64]) {
        let (front, triangle) = (&self.fronts[s], K.triangle);
        let height = front.height();
        let mut k = triangle.group(front.begin + columns.start);
        for j in columns.clone() {
            let row = front.begin + j;
            while triangle.first(k + 1) <= row {
                k += 1;
            }
            let within = row - triangle.first(k);
            let column = &mut panel[(j - columns.start) * (height + 1)..][..height - j];
            column.fill(0.0);
            let values = &K.values[triangle.diagonal(k, within)..];
            let own = triangle.size(k) - within;
            column[..own].copy_from_slice(&values[..own]);
            for (block, &group) in triangle.blocks(k).zip(triangle.coupled(k)) {
                let (at, size) = (self.blocks[block] as usize - j, triangle.size(group as usize));
                copy(&mut column[at..at + size], &values[triangle.down_to(block, within)..][..size]);
            }
        }
    }

    /// Adds the update matrix of supernode `s` to `columns` of the parent front with `height` rows. `diagonal` gives the position of each
    /// diagonal entry, followed by the entries below.
    fn extend_add(
        &self,
        s: usize,
        from: &[f64],
        columns: Range<usize>,
        (to, height): (&mut [f64], usize),
        diagonal: impl Fn(usize) -> usize,
    ) {
        let (front, next) = (&self.fronts[s], &self.fronts[s + 1]);
        let (places, runs) = (&self.places[front.place..next.place], &self.runs[front.run..next.run]);
        let column_before = |column: usize| places.partition_point(|&place| (place as usize) < column);
        let columns = column_before(columns.start)..column_before(columns.end);
        let shape = Packed::new(front.rows);
        let mut run = runs.partition_point(|&[first, _]| (first as usize) < columns.start + 1).saturating_sub(1);
        for j in columns {
            let row = places[j] as usize;
            let column = &mut to[diagonal(row)..][..height - row];
            let from = &from[shape.diagonal(j)..][..front.rows - j];
            if runs.get(run + 1).is_some_and(|&[first, _]| first as usize == j) {
                run += 1;
            }
            let mut begin = j;
            for next in run + 1..=runs.len() {
                let end = runs.get(next).map_or(front.rows, |&[first, _]| first as usize);
                let at = places[begin] as usize - row;
                add(&mut column[at..at + end - begin], &from[begin - j..end - j]);
                begin = end;
            }
        }
    }
}

/// a ← a + b, in pieces of a node with six unknowns.
#[inline]
fn add(a: &mut [f64], b: &[f64]) {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks_mut::<NODE>(), b.as_chunks::<NODE>());
    for (a, b) in a.iter_mut().zip(b) {
        for i in 0..NODE {
            a[i] += b[i];
        }
    }
    a_rest.iter_mut().zip(b_rest).for_each(|(a, b)| *a += b);
}

/// Copies the rows of a node, mostly six.
#[inline]
fn copy(to: &mut [f64], from: &[f64]) {
    match (<&mut [f64; NODE]>::try_from(&mut *to), <&[f64; NODE]>::try_from(from)) {
        (Ok(to), Ok(from)) => *to = *from,
        _ => to.copy_from_slice(from),
    }
}
