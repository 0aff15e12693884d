//! The assembly tree of a multifrontal factorisation: one front for each supernode, and the places of their update matrices in memory.
//! All of it follows from the structure alone.

use super::packed::Packed;
use super::triangle::LowerTriangle;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use std::ops::Range;

/// A subtree has about this part of all operations: there are then enough of them to share out evenly.
const SUBTREE_SHARE: f64 = 1.0 / 24.0;
/// A tree of fewer operations is one subtree.
const WORTH_CUTTING: f64 = 5e7;

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
    /// Runs of consecutive rows in the front of the parent: the first of each, counted from the supernode's first, and its place in the
    /// front of the parent.
    pub runs: Vec<[u32; 2]>,
    /// First front row of each block of the matrix, by the blocks of [`LowerTriangle`].
    pub blocks: Vec<u32>,
}

/// A supernode: a panel of columns with the rows below them. Its parts of the tree's lists end where those of the next
/// supernode start.
#[derive(Default)]
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
    /// Start of its children in `Tree::children`.
    child: usize,
    /// Start of its runs in `Tree::runs`.
    pub run: usize,
    /// Supernode that receives its update matrix.
    parent: Option<usize>,
    /// Its level in the tree is odd: the stack of its update matrix.
    pub level: usize,
    /// Its update matrix goes to a supernode above its subtree, and waits for it beside the stacks.
    pub is_left: bool,
    /// Start of its update matrix on its stack, or among those that the subtree passes up.
    pub update: usize,
    /// Start of its update vector on the stack of vectors.
    pub vector: usize,
    /// The subtree that it belongs to; none for supernodes above the subtrees.
    pub subtree: Option<usize>,
}

impl Front {
    /// Rows of the whole front.
    pub fn height(&self) -> usize {
        self.columns + self.rows
    }
}

/// Numbers of memory to walk through supernodes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct StackSizes {
    /// The highest that each stack of update matrices becomes.
    pub stacks: [usize; 2],
    /// Update matrices that wait for supernodes above the subtree.
    pub left: usize,
    /// The highest that the stack of update vectors becomes.
    pub vectors: usize,
    /// The most columns and the most rows of a front.
    pub widest: usize,
    pub tallest: usize,
}

/// How a factorisation walks through the tree: subtrees one after the other or side by side, and then the supernodes above them.
pub(super) struct Layout {
    pub tree: Tree,
    /// Ranges of supernodes that are whole subtrees, ascending.
    pub subtrees: Vec<(Range<usize>, StackSizes)>,
    pub above: (Vec<usize>, StackSizes),
}

impl Layout {
    pub fn new(symbolic: &SymbolicSupernodalCholesky<usize>, triangle: &LowerTriangle) -> Layout {
        let mut tree = Tree::new(symbolic, triangle);
        let (ranges, above) = tree.cut();
        let mut subtrees = Vec::with_capacity(ranges.len());
        for (t, supernodes) in ranges.into_iter().enumerate() {
            let sizes = tree.lay_out(supernodes.clone(), Some(t), supernodes.end);
            subtrees.push((supernodes, sizes));
        }
        let sizes = tree.lay_out(above.iter().copied(), None, usize::MAX);
        Layout { tree, subtrees, above: (above, sizes) }
    }

    /// Stack sizes that fit every subtree, and the number of subtrees in parallel for so many threads.
    pub fn side_by_side(&self, threads: usize) -> (StackSizes, usize) {
        let largest = self.subtrees.iter().fold(StackSizes::default(), |largest, (_, sizes)| largest.max(*sizes));
        (largest, threads.clamp(1, self.subtrees.len().max(1)))
    }

    /// Numbers of all update matrices that are held at once.
    pub fn updates(&self, threads: usize) -> usize {
        let (largest, count) = self.side_by_side(threads);
        let stacks = |sizes: StackSizes| sizes.stacks.iter().sum::<usize>();
        let left = self.subtrees.iter().map(|(_, sizes)| sizes.left).sum::<usize>();
        count * stacks(largest) + stacks(self.above.1) + left
    }
}

impl StackSizes {
    /// The sizes that suffice for both.
    pub fn max(self, other: StackSizes) -> StackSizes {
        StackSizes {
            stacks: [0, 1].map(|level| self.stacks[level].max(other.stacks[level])),
            left: self.left.max(other.left),
            vectors: self.vectors.max(other.vectors),
            widest: self.widest.max(other.widest),
            tallest: self.tallest.max(other.tallest),
        }
    }
}

impl Tree {
    pub fn new(symbolic: &SymbolicSupernodalCholesky<usize>, triangle: &LowerTriangle) -> Self {
        let count = symbolic.n_supernodes();
        let rows_of = |s: usize| symbolic.supernode(s).pattern();
        let mut tree = Tree {
            fronts: Vec::with_capacity(count + 1),
            children: Vec::new(),
            rows: Vec::new(),
            places: Vec::new(),
            runs: Vec::new(),
            blocks: vec![0; triangle.blocks_count()],
        };
        let mut supernode_of = vec![0; symbolic.nrows()];
        for s in 0..count {
            let (begin, end) = (symbolic.supernode_begin()[s], symbolic.supernode_end()[s]);
            supernode_of[begin..end].fill(s);
            tree.fronts.push(Front {
                begin,
                columns: end - begin,
                rows: rows_of(s).len(),
                panel: symbolic.col_ptr_for_val()[s],
                place: tree.rows.len(),
                ..Front::default()
            });
            tree.rows.extend(rows_of(s).iter().map(|&row| row as u32));
        }
        tree.fronts.push(Front {
            begin: symbolic.nrows(),
            panel: symbolic.len_val(),
            place: tree.rows.len(),
            ..Front::default()
        });
        tree.find_children(&supernode_of);
        tree.find_places(triangle);
        tree.find_runs();
        tree.find_levels();
        tree
    }

    /// The parent holds the column of a child's first row.
    fn find_children(&mut self, supernode_of: &[usize]) {
        let count = self.fronts.len() - 1;
        let mut offspring = vec![Vec::new(); count];
        for s in 0..count {
            let Front { place, rows, .. } = self.fronts[s];
            let parent = self.rows[place..place + rows].first().map(|&row| supernode_of[row as usize]);
            self.fronts[s].parent = parent;
            if let Some(parent) = parent {
                offspring[parent].push(s as u32);
            }
        }
        for (s, children) in offspring.iter().enumerate() {
            self.fronts[s].child = self.children.len();
            self.children.extend(children);
        }
        self.fronts[count].child = self.children.len();
    }

    /// The rows of children and of blocks of the matrix in each front.
    fn find_places(&mut self, triangle: &LowerTriangle) {
        self.places = vec![0; self.rows.len()];
        // Row of each position in the current front.
        let mut local = vec![0; triangle.rows()];
        for s in 0..self.fronts.len() - 1 {
            let Front { begin, columns, rows, place, .. } = self.fronts[s];
            (begin..begin + columns).for_each(|row| local[row] = (row - begin) as u32);
            for (n, &row) in self.rows[place..place + rows].iter().enumerate() {
                local[row as usize] = (columns + n) as u32;
            }
            for at in self.fronts[s].child..self.fronts[s + 1].child {
                let Front { place, rows, .. } = self.fronts[self.children[at] as usize];
                for n in place..place + rows {
                    self.places[n] = local[self.rows[n] as usize];
                }
            }
            for k in triangle.groups_in(begin..begin + columns) {
                for (block, &group) in triangle.blocks(k).zip(triangle.coupled(k)) {
                    // A group without rows may be the last.
                    self.blocks[block] = local.get(triangle.first(group as usize)).copied().unwrap_or(0);
                }
            }
        }
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

    /// Number of columns of all supernodes.
    pub fn unknowns(&self) -> usize {
        self.fronts[self.fronts.len() - 1].begin
    }

    /// The columns of supernode `s`, by position.
    pub fn columns(&self, s: usize) -> Range<usize> {
        self.fronts[s].begin..self.fronts[s + 1].begin
    }

    /// The places of the panel of supernode `s` in L.
    pub fn panel(&self, s: usize) -> Range<usize> {
        self.fronts[s].panel..self.fronts[s + 1].panel
    }

    /// The children of supernode `s`, ascending.
    pub fn children(&self, s: usize) -> impl Iterator<Item = usize> {
        self.children[self.fronts[s].child..self.fronts[s + 1].child].iter().map(|&child| child as usize)
    }

    /// The place in L of each diagonal entry.
    pub fn diagonal(&self) -> impl Iterator<Item = usize> {
        self.fronts.iter().flat_map(|front| (0..front.columns).map(|j| front.panel + j * front.height() + j))
    }

    /// Ranges of supernodes that are whole subtrees, ascending, and the supernodes above them.
    pub fn cut(&self) -> (Vec<Range<usize>>, Vec<usize>) {
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

    /// Places update matrices and vectors of the given supernodes, by walking through them as a factorisation does. Update matrices wait on
    /// two stacks, one for every other level of the tree, but those for supernodes from `end` on.
    pub fn lay_out(
        &mut self,
        supernodes: impl Iterator<Item = usize>,
        subtree: Option<usize>,
        end: usize,
    ) -> StackSizes {
        let (mut top, mut vector, mut sizes) = ([0; 2], 0, StackSizes::default());
        for s in supernodes {
            for child in self.children(s).map(|child| &self.fronts[child]).filter(|child| child.subtree == subtree) {
                top[child.level] -= Packed::new(child.rows).len();
                vector -= child.rows;
            }
            let front = &mut self.fronts[s];
            let size = Packed::new(front.rows).len();
            front.is_left = front.parent.is_some_and(|parent| parent >= end);
            (front.vector, front.subtree) = (vector, subtree);
            if front.is_left {
                front.update = sizes.left;
                sizes.left += size;
            } else {
                front.update = top[front.level];
                top[front.level] += size;
            }
            vector += front.rows;
            for level in 0..2 {
                sizes.stacks[level] = sizes.stacks[level].max(top[level]);
            }
            sizes.vectors = sizes.vectors.max(vector);
            (sizes.widest, sizes.tallest) = (sizes.widest.max(front.columns), sizes.tallest.max(front.height()));
        }
        sizes
    }
}
