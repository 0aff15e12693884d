//! The other side of a contact, as far as its law depends on it: a shape on a body or on the ground, or facets.

use crate::places::nodes::Topology;
use base::math::Vec3;
use mechanics::elements::contact::facets::facet_gap;
use mechanics::elements::contact::{ContactPoint, Facet, Surface};
use mechanics::state::Node;

/// The side opposite to the points of a contact.
#[derive(Clone, Copy)]
pub enum Opposite<'a> {
    /// A shape, and the node that carries it.
    Shape(usize, &'a Surface),
    /// The facets of a surface, or balls.
    Facets(&'a [Facet]),
}

impl Opposite<'_> {
    /// Its nodes.
    pub fn nodes(&self) -> Vec<usize> {
        match self {
            Opposite::Shape(node, _) => vec![*node],
            Opposite::Facets(facets) => {
                let mut nodes: Vec<usize> = facets.iter().flat_map(Facet::nodes).copied().collect();
                nodes.sort_unstable();
                nodes.dedup();
                nodes
            }
        }
    }

    /// A node representative of the motion of all, for the choice of stiffness.
    pub fn node(&self) -> usize {
        match self {
            Opposite::Shape(node, _) => *node,
            Opposite::Facets(facets) => facets.first().map_or(0, |facet| facet.nodes[0]),
        }
    }

    /// Its smallest dimension; infinite for a sheet, because a penetration may exceed its thickness.
    pub fn least(&self) -> f64 {
        match self {
            Opposite::Shape(_, surface) => surface.least(),
            Opposite::Facets(facets) => {
                let balls = facets.iter().filter(|facet| facet.is_ball() || facet.is_line());
                balls.map(|facet| 2.0 * facet.half).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Half of the least thickness of faces; 0 of a shape.
    pub fn half(&self) -> f64 {
        match self {
            Opposite::Shape(..) => 0.0,
            Opposite::Facets(facets) => facets.iter().map(|facet| facet.half).fold(f64::INFINITY, f64::min),
        }
    }

    /// The least gap of points at t = 0; infinite without points.
    pub fn gap(&self, points: &[ContactPoint], topology: &Topology) -> f64 {
        match self {
            Opposite::Shape(node, surface) => {
                let center = topology.x(*node);
                let place = |point: &ContactPoint| -> Vec3 {
                    point.nodes().iter().zip(point.weights).map(|(&node, w)| w * topology.x(node)).sum()
                };
                let gap = |point: &ContactPoint| surface.distance(&(place(point) - center)) - point.radius;
                points.iter().map(gap).fold(f64::INFINITY, f64::min)
            }
            Opposite::Facets(facets) => {
                let nodes: Vec<Node> = topology.list.iter().map(|node| Node::at_rest(node.x)).collect();
                let may_touch =
                    |e: usize, facet: usize| !mechanics::elements::contact::facets::is_own(&points[e], &facets[facet]);
                facet_gap(facets, points, &may_touch, &nodes, &mut Vec::new())
            }
        }
    }
}
