//! Loops over nodes in chunks that several threads share. The chunks rest on the scene alone and sums over them keep their order, so
//! results do not depend on the number of threads.

use model::Restraint;
use std::ops::{AddAssign, Range};

/// Number of nodes in a chunk: their increments stay in the cache from one loop to the next.
const NODES: usize = 512;

/// A range of nodes, with the ranges of their entries in ascending lists.
pub struct NodeChunk {
    /// The nodes.
    pub nodes: Range<usize>,
    /// The range of [`super::context::Context::independent_nodes`] that lies among them.
    pub independent: Range<usize>,
    /// The range of [`NodeChunks::restraints`] that acts on them.
    pub restraints: Range<usize>,
}

/// All nodes of a scene in chunks.
pub struct NodeChunks {
    chunks: Vec<NodeChunk>,
    /// The restraints, by index in the model's list, in ascending order of nodes.
    pub restraints: Vec<usize>,
    threads: bool,
}

/// Data by node that can be split at a node.
pub trait ByNode: Send + Sized {
    /// The numbers of the first `nodes` nodes, and of the others.
    fn split(self, nodes: usize) -> (Self, Self);
}

impl<T: Send> ByNode for &mut [T] {
    fn split(self, nodes: usize) -> (Self, Self) {
        self.split_at_mut(nodes)
    }
}

impl<A: ByNode, B: ByNode> ByNode for (A, B) {
    fn split(self, nodes: usize) -> (Self, Self) {
        let ((a, c), (b, d)) = (self.0.split(nodes), self.1.split(nodes));
        ((a, b), (c, d))
    }
}

impl NodeChunks {
    /// Divides `nodes` nodes into chunks, processed by several threads with `threads`.
    pub fn new(nodes: usize, independent: &[usize], restraints: &[Restraint], threads: bool) -> Self {
        let mut order: Vec<usize> = (0..restraints.len()).collect();
        order.sort_by_key(|&i| restraints[i].node);
        let chunk = |first: usize| {
            let end = (first + NODES).min(nodes);
            let among = |list: &[usize], node: &dyn Fn(usize) -> usize| {
                list.partition_point(|&i| node(i) < first)..list.partition_point(|&i| node(i) < end)
            };
            NodeChunk {
                nodes: first..end,
                independent: among(independent, &|node| node),
                restraints: among(&order, &|i| restraints[i].node),
            }
        };
        let chunks = (0..nodes).step_by(NODES).map(chunk).collect();
        NodeChunks { chunks, restraints: order, threads }
    }

    /// Calls `of` for each chunk with its part of `data` and sums the results.
    pub fn run<D: ByNode, R>(&self, data: D, of: &(impl Fn(&NodeChunk, D) -> R + Sync)) -> R
    where
        R: Default + AddAssign + Send,
    {
        run(&self.chunks, data, self.threads, of)
    }
}

fn run<D: ByNode, R>(chunks: &[NodeChunk], data: D, threads: bool, of: &(impl Fn(&NodeChunk, D) -> R + Sync)) -> R
where
    R: Default + AddAssign + Send,
{
    match chunks {
        [] => R::default(),
        [chunk] => of(chunk, data),
        _ => {
            let (left, right) = chunks.split_at(chunks.len() / 2);
            let (first, second) = data.split(right[0].nodes.start - left[0].nodes.start);
            let (left, right) = (|| run(left, first, threads, of), || run(right, second, threads, of));
            let (mut sum, more) = if threads { rayon::join(left, right) } else { (left(), right()) };
            sum += more;
            sum
        }
    }
}

/// Nothing to sum.
#[derive(Default)]
pub struct Nothing;

impl AddAssign for Nothing {
    fn add_assign(&mut self, _: Nothing) {}
}

/// The largest of non-negative numbers.
#[derive(Default)]
pub struct Largest(pub f64);

impl AddAssign for Largest {
    fn add_assign(&mut self, other: Largest) {
        self.0 = self.0.max(other.0);
    }
}
