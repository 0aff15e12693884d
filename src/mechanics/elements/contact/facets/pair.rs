//! A point and a facet at an instant: their relative position and the forces between them.

use super::facet::{Facet, FacetPoint, MOST_CORNERS, Region};
use super::facing::Facing;
use crate::elements::contact::friction::slips;
use crate::elements::contact::history::PairMemory;
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::pair_block::{PairAction, PairSide};
use crate::elements::contact::point::{ContactPoint, MOST_NODES, TouchKind};
use crate::elements::contact::restitution::NormalForce;
use crate::state::Node;
use base::math::rotation::{log, renormalise};
use base::math::{Mat3, Vec3};
use nalgebra::{Quaternion, Rotation3, UnitQuaternion};
use std::borrow::Cow;

/// A point and a facet; the forces between them depend only on their nodes and their memory.
#[derive(Clone)]
pub(super) struct FacetPair<'a> {
    pub law: &'a ContactLaw,
    /// The point; for a line, its nearest point.
    pub point: Cow<'a, ContactPoint>,
    pub facet: &'a Facet,
    /// The reference for the side of the point.
    pub facing: Facing,
    pub memory: Option<PairMemory<'a>>,
    /// Depth without force: the point had it on arrival along the surface; only greater depths push.
    pub inset: f64,
    /// The facet whose frame holds the memory of friction: the last one, if the point has moved on to a neighbour.
    pub kept: &'a Facet,
    /// For a line, the nodes of the line with the memory: the neighbour, if the contact has passed on from it.
    pub kept_line: [usize; 2],
    /// True where the plane of the facet goes on beyond its rim.
    pub goes_on: bool,
    /// True where the friction spring sticks at any force.
    pub sticks: bool,
}

/// Where a point and a facet are to each other; global components.
#[derive(Debug, Clone, Copy)]
pub(super) struct PairPlace {
    pub at: FacetPoint,
    /// The share of each node of the facet.
    pub W: [f64; MOST_CORNERS],
    /// Unit vector from the facet to the point, where this is on its own side.
    pub n: Vec3,
    /// The distance along it, negative where the point has come through to the other side.
    pub d: f64,
    /// The distance d at first touch.
    pub reach: f64,
    /// The depth that does not push.
    pub inset: f64,
    /// The side: 1 if `n` points along the facet's normal.
    pub side: f64,
    /// The point relative to its first node.
    pub x: Vec3,
    /// Velocity of the point relative to the facet.
    pub w: Vec3,
}

impl PairPlace {
    /// The gap, negative where they touch.
    pub fn gap(&self) -> f64 {
        self.d - self.reach + self.inset
    }

    /// The depth that does not push, once the point has come out so far.
    pub fn inset_left(&self) -> f64 {
        self.inset.min(self.reach - self.d).max(0.0)
    }

    /// Approach speed.
    pub fn rate(&self) -> f64 {
        -self.n.dot(&self.w)
    }
}

/// Friction of a pair.
pub(super) struct Rub {
    /// Force on the facet, along the slip.
    pub T: Vec3,
    /// The largest size of this force.
    pub limit: f64,
    /// The way that slips.
    pub slip: Vec3,
}

/// Forces between a point and a facet.
pub(super) struct PairForceOnPoint {
    pub normal: NormalForce,
    /// For edges, the force to subtract because one of their ends already presses.
    pub less: Option<EndForce>,
    pub friction: Option<Rub>,
    /// Force on the point.
    pub F: Vec3,
    /// Moment on the point.
    pub M: Vec3,
    /// Moment on the facet; its force is opposite to `F`.
    pub C: Vec3,
}

impl PairForceOnPoint {
    pub const NONE: PairForceOnPoint = {
        let zero = Vec3::new(0.0, 0.0, 0.0);
        let normal = NormalForce { force: 0.0, by_depth: 0.0, by_rate: 0.0 };
        PairForceOnPoint { normal, less: None, friction: None, F: zero, M: zero, C: zero }
    };
}

/// The force of an end of one of two edges on the other.
pub(super) struct EndForce {
    pub normal: NormalForce,
    /// The depth.
    pub depth: f64,
    /// The power of its damping.
    pub power: f64,
    /// Force on the edge that touches, and the signed shares of the ends of both edges in the vector between them.
    pub F: Vec3,
    pub shares: [f64; 2],
    pub W: [f64; 2],
}

impl PairForceOnPoint {
    /// The force along the normal that friction is limited by.
    pub fn pressed(&self) -> f64 {
        self.normal.force - self.less.as_ref().map_or(0.0, |end| end.normal.force)
    }
}

impl<'a> FacetPair<'a> {
    /// Nodes of the point and of the facet with their signed shares in the vector between them.
    pub fn parts(&self, W: &[f64; MOST_CORNERS]) -> impl Iterator<Item = (usize, f64)> {
        let of_facet = self.facet.nodes().iter().zip(*W).map(|(&node, w)| (node, -w));
        self.point.parts().chain(of_facet)
    }

    /// True for crossing edges: they press by the difference between their depth and that of their ends.
    pub fn is_of_edges(&self) -> bool {
        self.point.extent == TouchKind::Edge
    }

    /// True for a point of a line against a line.
    pub fn is_of_lines(&self) -> bool {
        self.point.is_line()
    }

    /// Where the two are to each other.
    #[inline]
    pub fn place(&self, nodes: &[Node]) -> PairPlace {
        let origin = &nodes[self.point.nodes[0]];
        let x = self.point.relative_position(origin, nodes);
        let p = self.facet.seen_from(&x, origin, nodes);
        let at = if self.goes_on { self.facet.foot(&p) } else { self.facet.closest(&p) };
        let W = self.facet.weights(&at);
        let distance = at.g.norm();
        let normal = self.facet.normal(at.triangle, &p);
        let (facing, has_sides) = match self.facing {
            Facing::Rim(facing) if at.region != Region::Interior => (facing, true),
            Facing::Nothing if at.region != Region::Interior => (normal, false),
            Facing::Normal | Facing::Rim(_) | Facing::Nothing => (normal, true),
        };
        let actual = if at.g.dot(&facing) < 0.0 { -1.0 } else { 1.0 };
        // A point keeps its original side after coming through, except beyond a free rim, which has no sides.
        let known = self.memory.filter(|_| has_sides && self.facet.has_sides() && !self.facet.is_free(&at));
        let side = known.map_or(actual, |memory| memory.side());
        let sign = side * actual;
        let outward = if self.facet.has_sides() { side * normal } else { self.facet.outward(&p) };
        let n = if distance > 1e-12 * (self.facet.half + self.point.radius) { sign / distance * at.g } else { outward };
        let w = self.parts(&W).map(|(node, share)| share * nodes[node].v).sum();
        let reach = self.facet.half + self.point.radius;
        PairPlace { at, W, n, d: sign * distance, reach, inset: self.inset, side, x, w }
    }

    /// The point from the first node of a facet, global components.
    pub fn seen_from(&self, facet: &Facet, x: &Vec3, nodes: &[Node]) -> Vec3 {
        nodes[self.point.nodes[0]].relative_position(&nodes[facet.nodes[0]]) + x
    }

    /// Rotation vector of the point's k-th node since the memory, relative to the facet with the frame (q, R); global components.
    pub fn turned(&self, k: usize, memory: PairMemory, (q, R): (&Quaternion<f64>, &Mat3), nodes: &[Node]) -> Vec3 {
        let now = q.conjugate() * nodes[self.point.nodes[k]].rotation;
        R * log(&renormalise(&(now * memory.rotation(k).conjugate())))
    }

    /// The forces of the pair on its nodes.
    pub fn action<'b>(&'b self, place: &'b PairPlace, force: &'b PairForceOnPoint, nodes: &[Node]) -> PairAction<'b> {
        let (point, k) = (&*self.point, self.law.stiffness);
        let x = nodes[point.nodes[0]].x + place.x;
        let of_end = force.less.as_ref().map_or(0.0, |end| end.depth.powi(2));
        let pressed = place.gap().min(0.0).powi(2) - of_end;
        let arm_of = |end: &EndForce| {
            self.facet.nodes().iter().zip(end.W).map(|(&node, share)| -share * nodes[node].x).sum::<Vec3>()
        };
        let [T, limit] =
            force.friction.as_ref().map_or([0.0; 2], |friction| [friction.T.norm_squared(), friction.limit]);
        let sides = |own: &'b [f64], other: &'b [f64]| {
            [PairSide { nodes: point.nodes(), shares: own }, PairSide { nodes: self.facet.nodes(), shares: other }]
        };
        PairAction {
            sides: sides(&point.weights, &place.W),
            F: force.F,
            M: [if point.rolling_radius > 0.0 { force.M } else { Vec3::zeros() }, force.C],
            arm: x - place.at.g,
            less: force.less.as_ref().map(|end| (sides(&end.shares, &end.W), end.F, arm_of(end))),
            stored: 0.5 * k * pressed + 0.5 * T / k,
            slips: slips(T.sqrt(), limit),
        }
    }
}

/// The rotation of the frame of a facet.
pub(super) fn rotation_of(facet: &Facet, nodes: &[Node]) -> Quaternion<f64> {
    if !facet.has_sides() {
        return nodes[facet.nodes[0]].rotation;
    }
    let R = facet.frame(nodes);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(R)).into_inner()
}

/// Most nodes of a pair.
pub(super) const MOST_OF_PAIR: usize = MOST_NODES + MOST_CORNERS;
