//! Multifrontal L Lᵀ: each supernode adds up the update matrices of its children in its front, eliminates its columns and
//! leaves one update matrix, a packed triangle, to its parent. Update matrices wait on two stacks, one for every other level of the tree: a
//! front is then written where it stays, beside those of its children, and nothing is moved.
//! I. S. Duff & J. K. Reid, ACM Trans. Math. Softw. 9 (1983).
//!
//! Subtrees of the elimination tree are independent: each is factored on one thread with a workspace of its own. The
//! supernodes above them follow one by one, the large dense operations of each in halves ([`super::dense`]). Both cuts
//! depend on the structure alone, so the bits do not depend on the number of threads. Factorisations allocate nothing.

use super::dense::{join, potrf, trsm};
use super::packed::Packed;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::cholesky_in_place_scratch;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::sparse::SymbolicSparseColMat;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::{MatMut, Par};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// A subtree has about this part of all operations: there are then enough of them to share out evenly.
const SUBTREE_SHARE: f64 = 1.0 / 24.0;
/// A tree of fewer operations is one subtree.
const WORTH_CUTTING: f64 = 5e7;

/// The factorisation of one structure: the assembly tree and the memory to work through it.
pub(super) struct Fronts {
    /// The assembly tree of the supernodes.
    pub(super) tree: Tree,
    /// Ranges of supernodes that are whole subtrees, ascending.
    pub(super) subtrees: Vec<(Range<usize>, FrontWorkspace)>,
    /// The supernodes above the subtrees.
    pub(super) above: (Vec<usize>, FrontWorkspace),
    /// Subtrees and the halves of dense operations run side by side.
    pub(super) threads: bool,
    /// The solution above the subtrees, by position. Written and read by [`super::substitution`].
    pub(super) done: Vec<f64>,
}

/// The assembly tree: fronts, and lists of all fronts one after the other.
pub(super) struct Tree {
    /// Supernodes in the order of elimination. One more at the end marks where the lists end.
    pub fronts: Vec<Front>,
    /// Children of each supernode.
    children: Vec<u32>,
    /// Rows below each supernode, by position in the order of elimination.
    pub rows: Vec<u32>,
    /// The row in the front of the parent of each of `rows`.
    pub places: Vec<u32>,
    /// Where rows follow each other in the front of the parent too: the first of each such run, counted from the supernode's own first, and
    /// its place in the front of the parent.
    runs: Vec<[u32; 2]>,
    /// The place in the panel of its supernode of each entry of the matrix.
    entries: Vec<u32>,
}

/// The memory of a walk through supernodes: update matrices that wait for their parents, the last on top, by level of the tree, and
/// the scratch of the dense operations.
pub(super) struct FrontWorkspace {
    stacks: [Vec<f64>; 2],
    /// Their lengths while there is something to factor.
    heights: [usize; 2],
    scratch: MemBuffer,
    /// The stack of update vectors of a substitution.
    pub vectors: Vec<f64>,
    /// The right-hand side of one front.
    pub front: Vec<f64>,
}

/// A supernode: a panel of columns with the rows below them. Its parts of the tree's lists end where those of the next
/// supernode start.
pub(super) struct Front {
    /// Its first column.
    pub begin: usize,
    /// The number of its columns.
    pub columns: usize,
    /// The number of rows below the square on the diagonal.
    pub rows: usize,
    /// Start of its panel in L.
    pub panel: usize,
    /// Start of its rows in `Tree::rows` and `Tree::places`.
    pub place: usize,
    /// Start of its entries in the matrix and in `Tree::entries`.
    entry: usize,
    /// Start of its children in `Tree::children`.
    child: usize,
    /// Start of its runs in `Tree::runs`.
    run: usize,
    /// Its level in the tree is odd: the stack of its update matrix.
    level: usize,
    /// Start of its update matrix on its stack.
    update: usize,
    /// Start of its update vector on the stack of vectors.
    pub vector: usize,
    /// The subtree that it belongs to; none for supernodes above the subtrees.
    pub subtree: Option<usize>,
}

impl Front {
    /// An empty supernode at the start of all lists.
    const END: Front = Front {
        begin: 0,
        columns: 0,
        rows: 0,
        panel: 0,
        place: 0,
        entry: 0,
        child: 0,
        run: 0,
        level: 0,
        update: 0,
        vector: 0,
        subtree: None,
    };
}

/// The children of each supernode in the assembly tree: the parent holds the column of a child's first row.
fn offspring(symbolic: &SymbolicSupernodalCholesky<usize>) -> Vec<Vec<u32>> {
    let count = symbolic.n_supernodes();
    let mut supernode_of = vec![0; symbolic.nrows()];
    for s in 0..count {
        supernode_of[symbolic.supernode_begin()[s]..symbolic.supernode_end()[s]].fill(s);
    }
    let mut offspring = vec![Vec::new(); count];
    for s in 0..count {
        if let Some(&row) = symbolic.supernode(s).pattern().first() {
            offspring[supernode_of[row]].push(s as u32);
        }
    }
    offspring
}

impl Tree {
    fn new(symbolic: &SymbolicSupernodalCholesky<usize>, pattern: &SymbolicSparseColMat<usize>) -> Self {
        let count = symbolic.n_supernodes();
        let columns = |s: usize| symbolic.supernode_begin()[s]..symbolic.supernode_end()[s];
        let rows = |s: usize| symbolic.supernode(s).pattern();
        let offspring = offspring(symbolic);
        let mut first_place = vec![0];
        (0..count).for_each(|s| first_place.push(first_place[s] + rows(s).len()));

        let mut fronts = Vec::with_capacity(count + 1);
        let (mut children, mut places, mut entries) = (Vec::new(), vec![0; first_place[count]], Vec::new());
        // The row of each position in the front at hand.
        let mut local = vec![0; symbolic.nrows()];
        for s in 0..count {
            let (columns, rows_below) = (columns(s), rows(s));
            let height = columns.len() + rows_below.len();
            for (at, row) in columns.clone().chain(rows_below.iter().copied()).enumerate() {
                local[row] = at as u32;
            }
            fronts.push(Front {
                begin: columns.start,
                columns: columns.len(),
                rows: rows_below.len(),
                panel: symbolic.col_ptr_for_val()[s],
                place: first_place[s],
                entry: entries.len(),
                child: children.len(),
                ..Front::END
            });
            children.extend(&offspring[s]);
            for child in offspring[s].iter().map(|&child| child as usize) {
                let places = &mut places[first_place[child]..first_place[child + 1]];
                places.iter_mut().zip(rows(child)).for_each(|(place, &row)| *place = local[row]);
            }
            for (j, column) in columns.enumerate() {
                let at = (j * height) as u32;
                entries.extend(pattern.row_idx_of_col_raw(column).iter().map(|&row| at + local[row]));
            }
        }
        fronts.push(Front {
            begin: symbolic.nrows(),
            panel: symbolic.len_val(),
            place: first_place[count],
            entry: entries.len(),
            child: children.len(),
            ..Front::END
        });
        let all = (0..count).flat_map(|s| rows(s).iter().map(|&row| row as u32)).collect();
        let mut tree = Tree { fronts, children, rows: all, places, runs: Vec::new(), entries };
        tree.find_runs();
        tree.find_levels();
        tree
    }

    fn find_runs(&mut self) {
        for s in 0..self.fronts.len() {
            self.fronts[s].run = self.runs.len();
            let Front { place, rows, .. } = self.fronts[s];
            let places = &self.places[place..place + rows];
            for (j, &place) in places.iter().enumerate() {
                if j == 0 || place != places[j - 1] + 1 {
                    self.runs.push([j as u32, place]);
                }
            }
        }
    }

    /// Levels count from the roots, which come after all below them.
    fn find_levels(&mut self) {
        for s in (0..self.fronts.len() - 1).rev() {
            let level = 1 - self.fronts[s].level;
            for at in self.fronts[s].child..self.fronts[s + 1].child {
                self.fronts[self.children[at] as usize].level = level;
            }
        }
    }

    /// The children of supernode `s`, ascending.
    pub fn children(&self, s: usize) -> impl Iterator<Item = usize> {
        self.children[self.fronts[s].child..self.fronts[s + 1].child].iter().map(|&child| child as usize)
    }

    /// Ranges of supernodes that are whole subtrees, ascending, and the supernodes above them.
    fn cut(&self) -> (Vec<Range<usize>>, Vec<usize>) {
        let count = self.fronts.len() - 1;
        // The operations of the subtree below each supernode, itself included, and the first supernode of it.
        let (mut flops, mut first, mut whole) = (vec![0.0; count], vec![0; count], 0.0);
        for s in 0..count {
            let Front { columns, rows, .. } = self.fronts[s];
            let own: f64 = (rows + 1..=rows + columns).map(|length| (length * length) as f64).sum();
            flops[s] = own + self.children(s).map(|child| flops[child]).sum::<f64>();
            first[s] = self.children(s).next().map_or(s, |child| first[child]);
            whole += own;
        }
        let limit = if whole < WORTH_CUTTING { f64::INFINITY } else { SUBTREE_SHARE * whole };
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
                // Neighbours that are small together are factored as one.
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

    /// The workspace for the given supernodes, and their places in it, by walking through them as a factorisation does.
    fn workspace(&mut self, supernodes: impl Iterator<Item = usize>, subtree: Option<usize>) -> FrontWorkspace {
        let (mut top, mut highest, mut vector, mut longest) = ([0; 2], [0; 2], 0, 0);
        let (mut widest, mut tallest) = (0, 0);
        for s in supernodes {
            let Front { columns, rows, level, .. } = self.fronts[s];
            let size = Packed::new(rows).len();
            highest[level] = highest[level].max(top[level] + size);
            (widest, tallest) = (widest.max(columns), tallest.max(columns + rows));
            for child in self.children(s).map(|child| &self.fronts[child]).filter(|child| child.subtree == subtree) {
                top[child.level] -= Packed::new(child.rows).len();
                vector -= child.rows;
            }
            let front = &mut self.fronts[s];
            (front.update, front.vector, front.subtree) = (top[level], vector, subtree);
            top[level] += size;
            vector += rows;
            longest = longest.max(vector);
        }
        let scratch = cholesky_in_place_scratch::<f64>(widest, Par::Seq, Default::default());
        FrontWorkspace {
            stacks: highest.map(|highest| vec![0.0; highest]),
            heights: highest,
            scratch: MemBuffer::new(scratch),
            vectors: vec![0.0; longest],
            front: vec![0.0; tallest],
        }
    }

    /// Factors subtrees into `L`, which begins at `base` of the whole factor. False if a pivot is not positive, or `stop` is raised.
    fn factor_subtrees(
        &self,
        of: &mut [(Range<usize>, FrontWorkspace)],
        K: &[f64],
        L: &mut [f64],
        base: usize,
        (threads, stop): (bool, &AtomicBool),
    ) -> bool {
        match of {
            [] => true,
            [(supernodes, workspace)] => {
                let panel = |s: usize| self.fronts[s].panel - base;
                supernodes.clone().all(|s| {
                    let panel = &mut L[panel(s)..panel(s + 1)];
                    !stop.load(Ordering::Relaxed) && self.eliminate(s, K, panel, workspace, &[], false)
                })
            }
            _ => {
                let (left, right) = of.split_at_mut(of.len() / 2);
                let middle = self.fronts[right[0].0.start].panel;
                let (head, tail) = L.split_at_mut(middle - base);
                let (left, right) = join(
                    threads,
                    || self.factor_subtrees(left, K, head, base, (threads, stop)),
                    || self.factor_subtrees(right, K, tail, middle, (threads, stop)),
                );
                left && right
            }
        }
    }

    /// Assembles and eliminates supernode `s`: writes its panel of L, and on the stack its update matrix in place of those of
    /// its children. False if a pivot is not positive.
    fn eliminate(
        &self,
        s: usize,
        K: &[f64],
        panel: &mut [f64],
        workspace: &mut FrontWorkspace,
        subtrees: &[(Range<usize>, FrontWorkspace)],
        threads: bool,
    ) -> bool {
        let (front, next) = (&self.fronts[s], &self.fronts[s + 1]);
        let (columns, rows) = (front.columns, front.rows);
        let height = columns + rows;
        for j in 0..columns {
            panel[j * height + j..(j + 1) * height].fill(0.0);
        }
        for (&at, &k) in self.entries[front.entry..next.entry].iter().zip(&K[front.entry..next.entry]) {
            panel[at as usize] = k;
        }
        let [even, odd] = &mut workspace.stacks;
        let (own, others) = if front.level == 0 { (even, &*odd) } else { (odd, &*even) };
        let update_of = |child: &Front| match child.subtree {
            Some(t) if child.subtree != front.subtree => &subtrees[t].1.stacks[child.level][child.update..],
            _ => &others[child.update..],
        };
        for child in self.children(s) {
            let (of_panel, _) = self.split(child, columns);
            let diagonal = |place: usize| place * height + place;
            self.extend_add(child, update_of(&self.fronts[child]), of_panel, (panel, height), diagonal);
        }

        let panel = MatMut::from_column_major_slice_mut(panel, height, columns);
        let (mut square, mut below) = panel.split_at_row_mut(columns);
        if !potrf(square.rb_mut(), MemStack::new(&mut workspace.scratch), threads) {
            return false;
        }
        if rows > 0 {
            trsm(square.rb(), below.rb_mut(), threads);
            let shape = Packed::new(rows);
            let update = &mut own[front.update..front.update + shape.len()];
            shape.fill(below.rb(), update, threads);
            for child in self.children(s) {
                let (_, of_update) = self.split(child, columns);
                let diagonal = |place: usize| shape.diagonal(place - columns);
                self.extend_add(child, update_of(&self.fronts[child]), of_update, (update, height), diagonal);
            }
        }
        true
    }

    /// The columns of the update matrix of supernode `s` that go into the panel of its parent of `columns` columns, and into its update matrix.
    fn split(&self, s: usize, columns: usize) -> (Range<usize>, Range<usize>) {
        let Front { place, rows, .. } = self.fronts[s];
        let of_panel = self.places[place..place + rows].partition_point(|&place| (place as usize) < columns);
        (0..of_panel, of_panel..rows)
    }

    /// Adds `columns` of the update matrix of supernode `s` to a part of the front of its parent, of `height` rows: `diagonal` gives the place
    /// of each entry of its diagonal, which those below follow.
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
    const PIECE: usize = 6;
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks_mut::<PIECE>(), b.as_chunks::<PIECE>());
    for (a, b) in a.iter_mut().zip(b) {
        for i in 0..PIECE {
            a[i] += b[i];
        }
    }
    a_rest.iter_mut().zip(b_rest).for_each(|(a, b)| *a += b);
}

impl Fronts {
    /// The fronts of a symbolic factorisation and of the pattern of the matrix, lower triangle.
    pub fn new(
        symbolic: &SymbolicSupernodalCholesky<usize>,
        pattern: &SymbolicSparseColMat<usize>,
        threads: bool,
    ) -> Self {
        let mut tree = Tree::new(symbolic, pattern);
        let (subtrees, above) = tree.cut();
        let subtrees = subtrees.into_iter().enumerate();
        let subtrees = subtrees.map(|(t, range)| (range.clone(), tree.workspace(range, Some(t)))).collect();
        let workspace = tree.workspace(above.iter().copied(), None);
        Fronts { tree, subtrees, above: (above, workspace), threads, done: vec![0.0; symbolic.nrows()] }
    }

    /// Factors the matrix with the entries `K`, lower triangle by columns, into `L`. False if a pivot is not positive, or as soon as `stop`
    /// is raised.
    pub fn factor(&mut self, K: &[f64], L: &mut [f64], stop: &AtomicBool) -> bool {
        self.each_workspace().for_each(FrontWorkspace::take_stacks);
        let Fronts { tree, subtrees, above: (above, workspace), threads, .. } = self;
        tree.factor_subtrees(subtrees, K, L, 0, (*threads, stop))
            && above.iter().all(|&s| {
                let panel = &mut L[tree.fronts[s].panel..tree.fronts[s + 1].panel];
                !stop.load(Ordering::Relaxed) && tree.eliminate(s, K, panel, workspace, subtrees, *threads)
            })
    }

    /// Gives back the memory of update matrices until there is something to factor.
    pub fn rest(&mut self) {
        self.each_workspace().for_each(|workspace| workspace.stacks = Default::default());
    }

    fn each_workspace(&mut self) -> impl Iterator<Item = &mut FrontWorkspace> {
        self.subtrees.iter_mut().map(|(_, workspace)| workspace).chain([&mut self.above.1])
    }
}

impl FrontWorkspace {
    fn take_stacks(&mut self) {
        for (stack, height) in self.stacks.iter_mut().zip(self.heights) {
            if stack.len() < height {
                *stack = vec![0.0; height];
            }
        }
    }
}
