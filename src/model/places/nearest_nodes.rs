//! The nearest nodes of a line of nodes.

use crate::places::nodes::Nodes;
use base::math::Vec3;
use std::collections::HashSet;

/// Nodes sorted along the axis of their largest extent, so that a search can stop early.
pub struct NodesAlongAxis {
    axis: usize,
    /// Coordinate along the axis, and node.
    sorted: Vec<(f64, usize)>,
}

impl NodesAlongAxis {
    /// Sorts nodes along the global axis of their largest extent.
    pub fn new(of: &HashSet<usize>, nodes: &Nodes) -> Self {
        let (low, high) = of.iter().fold((Vec3::repeat(f64::MAX), Vec3::repeat(f64::MIN)), |(low, high), &node| {
            (low.inf(&nodes.x(node)), high.sup(&nodes.x(node)))
        });
        let axis = (high - low).imax();
        let mut sorted: Vec<(f64, usize)> = of.iter().map(|&node| (nodes.x(node)[axis], node)).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        NodesAlongAxis { axis, sorted }
    }

    /// The two nodes nearest to x by their distance; of equals the first.
    pub fn nearest_two(&self, x: &Vec3, nodes: &Nodes) -> Option<(usize, Option<usize>)> {
        let (line, axis) = (&self.sorted, self.axis);
        let distance = |node: usize| (nodes.x(node) - x).norm();
        let start = line.partition_point(|entry| entry.0 < x[axis]);
        let (mut below, mut above) = (line[..start].iter().rev().peekable(), line[start..].iter().peekable());
        let mut best: Vec<(f64, usize)> = Vec::with_capacity(3);
        loop {
            let gap = |entry: Option<&&(f64, usize)>| entry.map_or(f64::INFINITY, |entry| (entry.0 - x[axis]).abs());
            let (down, up) = (gap(below.peek()), gap(above.peek()));
            // Equal distances count, so a node just as near along the axis is still looked at.
            if best.len() == 2 && down.min(up) > best[1].0 {
                break;
            }
            let Some(&(_, node)) = (if down <= up { below.next() } else { above.next() }) else { break };
            best.push((distance(node), node));
            best.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            best.truncate(2);
        }
        best.first().map(|first| (first.1, best.get(1).map(|second| second.1)))
    }
}
