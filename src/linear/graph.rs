//! The coupling of unknowns as an undirected graph whose vertices are the groups, and the numbering of the unknowns.

use super::structure::Structure;

/// Groups, the groups they couple with, and the rows of their unknowns.
#[derive(Debug, Clone)]
pub(super) struct Graph {
    /// Unknowns per group.
    pub sizes: Vec<usize>,
    /// First external row of each group, and the number of unknowns at the end.
    pub first: Vec<usize>,
    /// Group of each external row.
    pub group: Vec<u32>,
    /// Number of groups at the end that hold Lagrange multipliers; these are eliminated after their neighbours.
    pub multipliers: usize,
    /// Positions of the other groups; empty if unknown.
    pub positions: Vec<[f64; 3]>,
    start: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Graph {
    /// The graph of a structure.
    pub fn new(structure: &Structure) -> Self {
        let sizes = structure.sizes.clone();
        let mut first = vec![0; sizes.len() + 1];
        let mut group = Vec::new();
        for (g, &size) in sizes.iter().enumerate() {
            first[g + 1] = first[g] + size;
            group.resize(first[g + 1], g as u32);
        }

        let mut pairs: Vec<(u32, u32)> = Vec::new();
        // Groups without unknowns couple nothing; the tree of those with some would not be in postorder with them.
        let held = |&&g: &&usize| sizes[g] > 0;
        for coupled in &structure.connectivity {
            for &g in coupled.iter().filter(held) {
                let others = coupled.iter().filter(held).filter(|&&h| h != g);
                pairs.extend(others.map(|&h| (g as u32, h as u32)));
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut start = vec![0; sizes.len() + 1];
        for &(g, _) in &pairs {
            start[g as usize + 1] += 1;
        }
        for g in 0..sizes.len() {
            start[g + 1] += start[g];
        }
        let neighbours = pairs.into_iter().map(|(_, h)| h).collect();
        Graph {
            sizes,
            first,
            group,
            multipliers: structure.multipliers,
            positions: structure.positions.clone(),
            start,
            neighbours,
        }
    }

    /// Number of groups.
    pub fn groups(&self) -> usize {
        self.sizes.len()
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.group.len()
    }

    /// Groups that couple with `g`, ascending, without `g` itself.
    pub fn neighbours(&self, g: usize) -> &[u32] {
        &self.neighbours[self.start[g]..self.start[g + 1]]
    }

    /// The adjacency in compressed form: the start of each group's neighbours, and the neighbours; both triangles are there.
    pub fn compressed(&self) -> (&[usize], &[u32]) {
        (&self.start, &self.neighbours)
    }

    /// True where the matrix has a block for the groups `g` and `h`.
    pub fn coupled(&self, g: usize, h: usize) -> bool {
        g == h || self.neighbours(g).binary_search(&(h as u32)).is_ok()
    }
}
