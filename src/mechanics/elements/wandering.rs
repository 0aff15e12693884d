//! Elements with changing nodes: a part on a surface of many facets touches one after the other.
//!
//! Their forces are computed from all facets that lie in reach, whatever the matrix has room for. The matrix has room for near pairs. If
//! another pair acts, its structure is rebuilt.

use crate::state::{Configuration, Node};
use base::snapshot::keep;

/// Pairs of elements and possible partners, with room in the matrix.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Partners {
    /// The element and the other of each pair, in ascending order.
    pub pairs: Vec<[usize; 2]>,
    /// The start of the nodes of each pair, and the end of the last.
    pub starts: Vec<usize>,
    /// The nodes of all pairs.
    pub nodes: Vec<usize>,
}

keep!(Partners: Default { pairs, starts, nodes });

impl Partners {
    /// Adds a pair, which comes after all before it.
    pub fn push(&mut self, pair: [usize; 2], nodes: impl Iterator<Item = usize>) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        self.pairs.push(pair);
        self.nodes.extend(nodes);
        self.starts.push(self.nodes.len());
    }

    /// The nodes of a pair.
    pub fn nodes(&self, pair: usize) -> &[usize] {
        &self.nodes[self.starts[pair]..self.starts[pair + 1]]
    }

    /// The place of a pair.
    pub fn place(&self, pair: [usize; 2]) -> Option<usize> {
        self.pairs.binary_search(&pair).ok()
    }

    /// The largest number of nodes of a pair.
    pub fn most_nodes(&self) -> usize {
        (0..self.pairs.len()).map(|pair| self.nodes(pair).len()).max().unwrap_or(0)
    }
}

/// A group of elements acting also on nodes outside [`super::Elements::nodes`].
pub trait Wandering {
    /// Further nodes with forces from the elements, and further nodes with moments.
    fn further_nodes(&self) -> [&[usize]; 2];

    /// All pairs that may act soon at these node positions.
    fn partners(&self, nodes: &[Node]) -> Partners;

    /// True if the partners include every active pair.
    fn has_room(&self, partners: &Partners, now: &Configuration) -> bool;

    /// Tangents of all active pairs among the `partners`. `add` receives the place of the pair and its matrix `K`, row-major with six
    /// degrees of freedom for each node.
    fn pair_tangents(
        &self,
        partners: &Partners,
        now: &Configuration,
        rate_weight: f64,
        K: &mut [f64],
        add: &mut dyn FnMut(usize, &mut [f64]),
    );
}
