//! A point that may touch a surface.

use super::pair_block::PairSide;
use crate::state::Node;
use base::math::Vec3;

/// Largest number of nodes that a point may lie between.
pub const MOST_NODES: usize = 9;

/// The part of a contact point that touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TouchKind {
    /// A point: a weighted sum of them.
    Point,
    /// The line between two of them, by the point of it that is nearest.
    Line,
    /// A line with separate contact points at its ends and at the ends of the lines it meets. It presses by the depth of the crossing
    /// beyond that of the ends.
    Edge,
}

/// A contact point: a weighted sum of nodes, or a line between two nodes that touches at its nearest point.
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
    /// Radius for the moment of friction on the nodes; 0 for nodes without rotation.
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

    /// The point of a line with this share of its second end.
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
