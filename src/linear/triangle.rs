//! Where the entries of a symmetric matrix lie: its lower triangle in the order of elimination, by columns. As groups couple by whole
//! blocks, one number for each block tells the places of all its entries.

use super::elimination::Elimination;
use super::graph::Graph;

/// The lower triangle of a matrix of dense blocks. Groups are counted by their place in the order of elimination, rows by their position in
/// it. A column holds the rows of its own group from the diagonal down, then those of all later coupled groups, ascending.
pub(super) struct LowerTriangle {
    /// The first row of each group, and the number of all rows at the end.
    first: Vec<u32>,
    /// The first block below the diagonal of each group, and the number of all at the end.
    block: Vec<u32>,
    /// The later group of each block. Groups without rows have none.
    coupled: Vec<u32>,
    /// The rows of its first column above each block, those of the diagonal block included.
    above: Vec<u32>,
    /// The place of the first entry of each group, and the number of all entries at the end.
    start: Vec<usize>,
}

impl LowerTriangle {
    pub fn new(graph: &Graph, elimination: &Elimination) -> Self {
        let (mut first, mut block, mut start) = (vec![0], vec![0], vec![0]);
        let (mut coupled, mut above) = (Vec::<u32>::new(), Vec::new());
        let size = |place: u32| graph.sizes[elimination.order[place as usize]];
        for (k, &g) in elimination.order.iter().enumerate() {
            let begin = coupled.len();
            let places = graph.neighbours(g).iter().map(|&h| elimination.position[h as usize] as u32);
            coupled.extend(places.filter(|&place| place as usize > k && size(place) > 0));
            coupled[begin..].sort_unstable();
            let mut height = graph.sizes[g];
            for &place in &coupled[begin..] {
                above.push(height as u32);
                height += size(place);
            }
            first.push(first[k] + graph.sizes[g] as u32);
            block.push(coupled.len() as u32);
            // Each column is shorter by one than that before it.
            start.push(start[k] + (0..graph.sizes[g]).map(|j| height - j).sum::<usize>());
        }
        LowerTriangle { first, block, coupled, above, start }
    }

    /// Number of groups.
    pub fn groups(&self) -> usize {
        self.first.len() - 1
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.first[self.groups()] as usize
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.start[self.groups()]
    }

    /// Number of blocks below the diagonal.
    pub fn blocks_count(&self) -> usize {
        self.coupled.len()
    }

    /// The group of a row.
    pub fn group(&self, row: usize) -> usize {
        self.first.partition_point(|&first| first as usize <= row) - 1
    }

    /// The first row of group `k`; the number of all rows behind the last.
    pub fn first(&self, k: usize) -> usize {
        self.first[k] as usize
    }

    /// Number of rows of group `k`.
    pub fn size(&self, k: usize) -> usize {
        (self.first[k + 1] - self.first[k]) as usize
    }

    /// The groups whose rows begin in `rows`.
    pub fn groups_in(&self, rows: std::ops::Range<usize>) -> std::ops::Range<usize> {
        let from = |row: usize| self.first[..self.groups()].partition_point(|&first| (first as usize) < row);
        from(rows.start)..from(rows.end)
    }

    /// The blocks below the diagonal of group `k`.
    pub fn blocks(&self, k: usize) -> std::ops::Range<usize> {
        self.block[k] as usize..self.block[k + 1] as usize
    }

    /// The later group of each block of [`LowerTriangle::blocks`].
    pub fn coupled(&self, k: usize) -> &[u32] {
        &self.coupled[self.blocks(k)]
    }

    /// The height of the first column of group `k`.
    fn height(&self, k: usize) -> usize {
        match self.blocks(k).last() {
            Some(block) => self.above[block] as usize + self.size(self.coupled[block] as usize),
            None => self.size(k),
        }
    }

    /// The place of the diagonal entry of column `j` of group `k`.
    pub fn diagonal(&self, k: usize, j: usize) -> usize {
        self.start[k] + j * self.height(k) - j * j.saturating_sub(1) / 2
    }

    /// Entries from the diagonal of column `j` of a group down to `block`.
    pub fn down_to(&self, block: usize, j: usize) -> usize {
        self.above[block] as usize - j
    }

    /// The place of the entry in row `i` of group `row` and column `j` of group `k`, in the lower triangle; none outside the pattern.
    pub fn slot(&self, (row, i): (usize, usize), (k, j): (usize, usize)) -> Option<usize> {
        if row == k {
            return Some(self.diagonal(k, j) + i - j);
        }
        let block = self.blocks(k).start + self.coupled(k).binary_search(&(row as u32)).ok()?;
        Some(self.diagonal(k, j) + self.down_to(block, j) + i)
    }

    /// Entries from a row below the diagonal of the first column of group `k` to that row of its second column.
    pub fn step(&self, k: usize) -> usize {
        self.height(k) - 1
    }

    /// Hands each entry to `visit`: row, column and place.
    pub fn each(&self, visit: &mut dyn FnMut(usize, usize, usize)) {
        for k in 0..self.groups() {
            for j in 0..self.size(k) {
                let own = self.first(k)..self.first(k + 1);
                let later = self.coupled(k).iter().map(|&h| h as usize).flat_map(|h| self.first(h)..self.first(h + 1));
                let diagonal = self.diagonal(k, j);
                for (n, row) in own.skip(j).chain(later).enumerate() {
                    visit(row, self.first(k) + j, diagonal + n);
                }
            }
        }
    }
}
