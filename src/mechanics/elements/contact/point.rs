//! A point that may touch a surface.

use super::pair_block::PairSide;
use crate::state::Node;
use base::math::Vec3;

/// Largest number of nodes that a point may lie between.
pub const MOST_NODES: usize = 9;

/// What of its nodes touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TouchKind {
    /// A point: a weighted sum of them.
    Point,
    /// The line between two of them, by the point of it that is nearest.
    Line,
    /// Such a line, whose ends touch as points of their own, as the ends of the lines that it meets do too: it presses by what is deeper
    /// where it crosses these than the ends are.
    Edge,
}

/// A point that may touch: a weighted sum of nodes; or a line between two nodes, of which the point that is nearest touches.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPoint {
    /// The first `count` of them carry it.
    pub nodes: [usize; MOST_NODES],
    /// Share of each node in the point's position; their sum is 1.
    pub weights: [f64; MOST_NODES],
    /// Number of nodes that carry the point.
    pub count: usize,
    /// Radius of the ball around the point that touches.
    pub radius: f64,
    /// The radius at which friction turns the nodes; 0 where they have no rotation.
    pub rolling_radius: f64,
    /// A point, or the whole line between its two nodes, whose own weights are those of the middle.
    pub extent: TouchKind,
}

impl ContactPoint {
    /// The nodes that carry the point.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes[..self.count]
    }

    /// True for the whole line between its two nodes.
    pub fn is_line(&self) -> bool {
        self.extent != TouchKind::Point
    }

    /// The point of a line at which its second end has this share.
    pub(super) fn at(&self, share: f64) -> ContactPoint {
        let mut point = self.clone();
        (point.weights[0], point.weights[1]) = (1.0 - share, share);
        point
    }

    /// The point as one of two that touch.
    pub(super) fn side(&self) -> PairSide<'_> {
        PairSide { nodes: self.nodes(), shares: &self.weights }
    }

    /// Nodes and their weights.
    pub(super) fn parts(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.nodes.iter().copied().zip(self.weights).take(self.count)
    }

    /// The position of the point relative to a node, global components.
    pub(super) fn relative_position(&self, carrier: &Node, nodes: &[Node]) -> Vec3 {
        self.parts().map(|(node, w)| w * nodes[node].relative_position(carrier)).sum()
    }
}
