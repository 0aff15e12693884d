//! L Lᵀ by fronts: a supernode takes the updates of its children, eliminates its columns and leaves one update to its parent.
//! I. S. Duff & J. K. Reid, ACM Trans. Math. Softw. 9 (1983).
//!
//! Subtrees of the elimination tree know nothing of each other: each is factored on one thread with a stack of its own, and
//! what stands above them front by front, the large dense operations of a front cut in halves. Both cuts rest on the
//! structure alone, so bits do not depend on the number of threads. Nothing is allocated once planned.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::{matmul, triangular};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::sparse::SymbolicSparseColMat;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::{Accum, MatMut, MatRef, Par};
use std::ops::Range;

/// Subtrees are cut from the tree at about this part of all operations: enough of them to share out evenly.
const SHARE: f64 = 1.0 / 24.0;
/// Fewer operations than this are one subtree.
const WORTH_CUTTING: f64 = 5e7;
/// Dense operations on fewer rows and columns are not cut.
const DENSE: usize = 192;

pub(super) struct Fronts {
    pub(super) tree: Tree,
    pub(super) subtrees: Vec<(Range<usize>, Room)>,
    /// Supernodes above the subtrees.
    pub(super) above: (Vec<usize>, Room),
    pub(super) threads: bool,
    /// For [`super::substitution`]: what is known above the subtrees.
    pub(super) done: Vec<f64>,
}

pub(super) struct Tree {
    /// One more at the end.
    pub fronts: Vec<Front>,
    children: Vec<u32>,
    /// Rows below each supernode, in the order of elimination.
    pub rows: Vec<u32>,
    /// For each of them: its row in the front of the parent.
    pub places: Vec<u32>,
    /// For each number of the matrix: where it goes in the panel of its supernode.
    entries: Vec<u32>,
}

/// Updates that no front has taken yet, the last on top, and what the dense kernels need.
pub(super) struct Room {
    stack: Vec<f64>,
    top: usize,
    scratch: MemBuffer,
    /// The same for right-hand sides: a stack, and one front.
    pub vectors: Vec<f64>,
    pub front: Vec<f64>,
}

/// A supernode: a panel of columns with the rows below them.
pub(super) struct Front {
    /// Its first column.
    pub begin: usize,
    pub columns: usize,
    /// Rows below the square on the diagonal.
    pub rows: usize,
    /// Where its panel starts in L, its rows in `places`, its numbers in the matrix, its children in `children`; the ends are
    /// where the next one starts.
    pub panel: usize,
    pub place: usize,
    entry: usize,
    child: usize,
    /// Where its update lies on a stack, that of right-hand sides on theirs, and of which subtree; none for those above.
    update: usize,
    pub vector: usize,
    pub subtree: Option<usize>,
}

impl Tree {
    fn new(symbolic: &SymbolicSupernodalCholesky<usize>, pattern: &SymbolicSparseColMat<usize>) -> Self {
        let count = symbolic.n_supernodes();
        let columns = |s: usize| symbolic.supernode_begin()[s]..symbolic.supernode_end()[s];
        let rows = |s: usize| symbolic.supernode(s).pattern();
        let mut of = vec![0; symbolic.nrows()];
        (0..count).for_each(|s| of[columns(s)].fill(s));
        let mut offspring = vec![Vec::new(); count];
        for s in 0..count {
            if let Some(&row) = rows(s).first() {
                offspring[of[row]].push(s as u32);
            }
        }
        let mut first_place = vec![0];
        (0..count).for_each(|s| first_place.push(first_place[s] + rows(s).len()));

        let mut fronts = Vec::with_capacity(count + 1);
        let (mut children, mut places, mut entries) = (Vec::new(), vec![0; first_place[count]], Vec::new());
        let mut local = vec![0; symbolic.nrows()];
        for s in 0..count {
            let height = columns(s).len() + rows(s).len();
            for (at, row) in columns(s).chain(rows(s).iter().copied()).enumerate() {
                local[row] = at as u32;
            }
            fronts.push(Front {
                begin: columns(s).start,
                columns: columns(s).len(),
                rows: rows(s).len(),
                panel: symbolic.col_ptr_for_val()[s],
                place: first_place[s],
                entry: entries.len(),
                child: children.len(),
                update: 0,
                vector: 0,
                subtree: None,
            });
            children.extend(&offspring[s]);
            for child in offspring[s].iter().map(|&child| child as usize) {
                let places = &mut places[first_place[child]..first_place[child + 1]];
                places.iter_mut().zip(rows(child)).for_each(|(place, &row)| *place = local[row]);
            }
            for (j, column) in columns(s).enumerate() {
                let at = (j * height) as u32;
                entries.extend(pattern.row_idx_of_col_raw(column).iter().map(|&row| at + local[row]));
            }
        }
        let (place, entry, child) = (first_place[count], entries.len(), children.len());
        let (begin, panel) = (symbolic.nrows(), symbolic.len_val());
        fronts.push(Front {
            begin,
            columns: 0,
            rows: 0,
            panel,
            place,
            entry,
            child,
            update: 0,
            vector: 0,
            subtree: None,
        });
        let all = (0..count).flat_map(|s| rows(s).iter().map(|&row| row as u32)).collect();
        Tree { fronts, children, rows: all, places, entries }
    }

    pub fn children(&self, s: usize) -> impl Iterator<Item = usize> {
        self.children[self.fronts[s].child..self.fronts[s + 1].child].iter().map(|&child| child as usize)
    }

    /// Ranges of supernodes that are whole subtrees, ascending, and the supernodes above them.
    fn cut(&self) -> (Vec<Range<usize>>, Vec<usize>) {
        let count = self.fronts.len() - 1;
        // Of each supernode with all below it: operations, and the first one.
        let (mut flops, mut first, mut whole) = (vec![0.0; count], vec![0; count], 0.0);
        for s in 0..count {
            let Front { columns, rows, .. } = self.fronts[s];
            let own: f64 = (rows + 1..=rows + columns).map(|length| (length * length) as f64).sum();
            flops[s] = own + self.children(s).map(|child| flops[child]).sum::<f64>();
            first[s] = self.children(s).next().map_or(s, |child| first[child]);
            whole += own;
        }
        let limit = if whole < WORTH_CUTTING { f64::INFINITY } else { SHARE * whole };
        let (mut subtrees, mut above): (Vec<(Range<usize>, f64)>, Vec<usize>) = (Vec::new(), Vec::new());
        let mut end = count;
        while end > 0 {
            let root = end - 1;
            if flops[root] > limit {
                above.push(root);
                end = root;
                continue;
            }
            end = first[root];
            match subtrees.last_mut() {
                // Neighbours that are small together are one.
                Some((range, sum)) if range.start == root + 1 && *sum + flops[root] <= limit => {
                    range.start = end;
                    *sum += flops[root];
                }
                _ => subtrees.push((end..root + 1, flops[root])),
            }
        }
        above.reverse();
        (subtrees.into_iter().rev().map(|(range, _)| range).collect(), above)
    }

    /// Room for the given supernodes, by walking through them as a factorisation does.
    fn room(&mut self, supernodes: impl Iterator<Item = usize>, subtree: Option<usize>) -> Room {
        let (mut top, mut highest, mut vector, mut longest) = (0, 0, 0, 0);
        let (mut widest, mut tallest) = (0, 0);
        for s in supernodes {
            let Front { columns, rows, .. } = self.fronts[s];
            highest = highest.max(top + rows * rows);
            (widest, tallest) = (widest.max(columns), tallest.max(columns + rows));
            for child in self.children(s).map(|child| &self.fronts[child]).filter(|child| child.subtree == subtree) {
                top -= child.rows * child.rows;
                vector -= child.rows;
            }
            let front = &mut self.fronts[s];
            (front.update, front.vector, front.subtree) = (top, vector, subtree);
            top += rows * rows;
            vector += rows;
            longest = longest.max(vector);
        }
        let scratch = cholesky_in_place_scratch::<f64>(widest, Par::Seq, Default::default());
        Room {
            stack: vec![0.0; highest],
            top: 0,
            scratch: MemBuffer::new(scratch),
            vectors: vec![0.0; longest],
            front: vec![0.0; tallest],
        }
    }

    /// Factors subtrees; `L` begins at `base` of the whole.
    fn subtrees(&self, of: &mut [(Range<usize>, Room)], K: &[f64], L: &mut [f64], base: usize, threads: bool) -> bool {
        match of {
            [] => true,
            [(supernodes, room)] => {
                room.top = 0;
                let panel = |s: usize| self.fronts[s].panel - base;
                supernodes.clone().all(|s| self.eliminate(s, K, &mut L[panel(s)..panel(s + 1)], room, &[], false))
            }
            _ => {
                let (left, right) = of.split_at_mut(of.len() / 2);
                let middle = self.fronts[right[0].0.start].panel;
                let (head, tail) = L.split_at_mut(middle - base);
                let (left, right) = both(
                    threads,
                    || self.subtrees(left, K, head, base, threads),
                    || self.subtrees(right, K, tail, middle, threads),
                );
                left && right
            }
        }
    }

    /// The panel of supernode `s`, and on the stack its update in place of its children's. False if a pivot is not positive.
    fn eliminate(
        &self,
        s: usize,
        K: &[f64],
        panel: &mut [f64],
        room: &mut Room,
        subtrees: &[(Range<usize>, Room)],
        threads: bool,
    ) -> bool {
        let (front, next) = (&self.fronts[s], &self.fronts[s + 1]);
        let (columns, rows) = (front.columns, front.rows);
        panel.fill(0.0);
        for (&at, &k) in self.entries[front.entry..next.entry].iter().zip(&K[front.entry..next.entry]) {
            panel[at as usize] = k;
        }
        let (old, new) = room.stack.split_at_mut(room.top);
        let update = &mut new[..rows * rows];
        update.fill(0.0);
        for child in self.children(s).map(|child| &self.fronts[child]) {
            let stack = match child.subtree {
                Some(t) if child.subtree != front.subtree => &subtrees[t].1.stack,
                _ => &*old,
            };
            let places = &self.places[child.place..child.place + child.rows];
            take(&stack[child.update..], places, (columns, rows), panel, update);
        }

        let panel = MatMut::from_column_major_slice_mut(panel, columns + rows, columns);
        let (mut square, mut below) = panel.split_at_row_mut(columns);
        if !cholesky(square.rb_mut(), MemStack::new(&mut room.scratch), threads) {
            return false;
        }
        if rows > 0 {
            divide(square.rb(), below.rb_mut(), threads);
            subtract_square(below.rb(), MatMut::from_column_major_slice_mut(update, rows, rows), threads);
            room.stack.copy_within(room.top..room.top + rows * rows, front.update);
        }
        room.top = front.update + rows * rows;
        true
    }
}

impl Fronts {
    pub fn new(
        symbolic: &SymbolicSupernodalCholesky<usize>,
        pattern: &SymbolicSparseColMat<usize>,
        threads: bool,
    ) -> Self {
        let mut tree = Tree::new(symbolic, pattern);
        let (subtrees, above) = tree.cut();
        let subtrees = subtrees.into_iter().enumerate();
        let subtrees = subtrees.map(|(t, range)| (range.clone(), tree.room(range, Some(t)))).collect();
        let room = tree.room(above.iter().copied(), None);
        Fronts { tree, subtrees, above: (above, room), threads, done: vec![0.0; symbolic.nrows()] }
    }

    /// L from the numbers of the matrix; false if a pivot is not positive.
    pub fn factor(&mut self, K: &[f64], L: &mut [f64]) -> bool {
        let Fronts { tree, subtrees, above: (above, room), threads, .. } = self;
        room.top = 0;
        tree.subtrees(subtrees, K, L, 0, *threads)
            && above.iter().all(|&s| {
                let panel = &mut L[tree.fronts[s].panel..tree.fronts[s + 1].panel];
                tree.eliminate(s, K, panel, room, subtrees, *threads)
            })
    }
}

/// Adds the update of a child, of which the lower triangle counts, to a front.
fn take(from: &[f64], places: &[u32], (columns, rows): (usize, usize), panel: &mut [f64], update: &mut [f64]) {
    let m = places.len();
    for (j, &place) in places.iter().enumerate() {
        let place = place as usize;
        let from = &from[j * m + j..(j + 1) * m];
        if place < columns {
            let column = &mut panel[place * (columns + rows)..][..columns + rows];
            from.iter().zip(&places[j..]).for_each(|(f, &i)| column[i as usize] += f);
        } else {
            let column = &mut update[(place - columns) * rows..][..rows];
            from.iter().zip(&places[j..]).for_each(|(f, &i)| column[i as usize - columns] += f);
        }
    }
}

pub(super) fn both<A: Send, B: Send>(
    threads: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if threads { rayon::join(a, b) } else { (a(), b()) }
}

/// A ← L of A = L Lᵀ, lower triangles; false if a pivot is not positive.
fn cholesky(A: MatMut<f64>, scratch: &mut MemStack, threads: bool) -> bool {
    let n = A.nrows();
    if n < 2 * DENSE {
        return cholesky_in_place(A, Default::default(), Par::Seq, scratch, Default::default()).is_ok();
    }
    let (mut first, _, mut below, mut rest) = A.split_at_mut(n / 2, n / 2);
    if !cholesky(first.rb_mut(), scratch, threads) {
        return false;
    }
    divide(first.rb(), below.rb_mut(), threads);
    subtract_square(below.rb(), rest.rb_mut(), threads);
    cholesky(rest, scratch, threads)
}

/// B ← B L⁻ᵀ.
fn divide(L: MatRef<f64>, B: MatMut<f64>, threads: bool) {
    let n = B.nrows();
    if n < 2 * DENSE {
        return solve_lower_triangular_in_place(L, B.transpose_mut(), Par::Seq);
    }
    let (upper, lower) = B.split_at_row_mut(n / 2);
    both(threads, || divide(L, upper, threads), || divide(L, lower, threads));
}

/// U ← U − B Bᵀ, lower triangles.
fn subtract_square(B: MatRef<f64>, U: MatMut<f64>, threads: bool) {
    use triangular::BlockStructure::{Rectangular, TriangularLower};
    let n = B.nrows();
    if n < 2 * DENSE {
        let (lhs, rhs) = ((B, Rectangular), (B.transpose(), Rectangular));
        return triangular::matmul(U, TriangularLower, Accum::Add, lhs.0, lhs.1, rhs.0, rhs.1, -1.0, Par::Seq);
    }
    let (upper, lower) = B.split_at_row(n / 2);
    let (first, _, beside, rest) = U.split_at_mut(n / 2, n / 2);
    both(
        threads,
        || subtract_product(lower, upper, beside, threads),
        || both(threads, || subtract_square(upper, first, threads), || subtract_square(lower, rest, threads)),
    );
}

/// U ← U − A Bᵀ.
fn subtract_product(A: MatRef<f64>, B: MatRef<f64>, U: MatMut<f64>, threads: bool) {
    let n = B.nrows();
    if n < 2 * DENSE {
        return matmul(U, Accum::Add, A, B.transpose(), -1.0, Par::Seq);
    }
    let (upper, lower) = B.split_at_row(n / 2);
    let (left, right) = U.split_at_col_mut(n / 2);
    both(threads, || subtract_product(A, upper, left, threads), || subtract_product(A, lower, right, threads));
}
