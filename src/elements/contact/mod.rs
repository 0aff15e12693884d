//! Unilateral contact: points, with a radius or without, that touch a surface carried by a node.
//!
//! A penalty spring pushes out what is inside, f = k δ (1 + d δ̇) n, δ from the exact distance ([`surface`]), d from what an
//! impact gives back ([`restitution`]); friction is a spring that slips ([`friction`]). All of it is written in the frame of
//! the surface, in p = Rᵀ(x − x_s) and in the rotation φ of what touches relative to that frame, and so is objective. With
//! F and M the force and moment on the point,
//!
//! ```text
//!  F = N n − T,   M = r n × T,   virtual work F·δp + M·δφ,   δp = Rᵀ(δx − δx_s + (x − x_s) × δθ_s),   δφ = Rᵀ(δθ − δθ_s)
//! ```
//!
//! which gives the forces on both sides, in balance, and the tangent. A point between nodes is a weighted sum of theirs, and
//! its force and moment go to them by the same weights. Closed forms do for these five surfaces: normals and curvature are
//! exact, nothing is iterated, and a general collision library would bring neither.
//!
//! Here is where a point lies against the surface; `action` says what acts on it, `past` and `remember` what it keeps of the
//! way it came, `block` what the equations get of it, `steps` how long steps may be, `resultant` what is shown.

mod action;
mod block;
pub mod friction;
mod past;
mod remember;
pub mod restitution;
mod resultant;
mod steps;
pub mod surface;

use crate::math::{Mat3, Vec3};
use crate::state::Node;
use restitution::Loss;
pub use resultant::{Resultant, least_gap};
pub use surface::{Near, Shape, Surface};

/// Nodes that a touching point may lie between.
pub const MOST_NODES: usize = 5;

/// A point that may touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// The first `count` of them carry it.
    pub nodes: [usize; MOST_NODES],
    /// Σ = 1.
    pub weights: [f64; MOST_NODES],
    pub count: usize,
    /// Of the ball around the point that touches.
    pub radius: f64,
    /// The radius at which friction turns the nodes; 0 where they have no rotation.
    pub lever: f64,
}

impl Point {
    pub fn nodes(&self) -> &[usize] {
        &self.nodes[..self.count]
    }

    /// Nodes and weights.
    fn parts(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.nodes.iter().copied().zip(self.weights).take(self.count)
    }

    /// Where it lies as seen from a node.
    fn relative_position(&self, carrier: &Node, nodes: &[Node]) -> Vec3 {
        self.parts().map(|(node, w)| w * nodes[node].relative_position(carrier)).sum()
    }
}

/// What acts where a point touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Force per depth, normal and tangential.
    pub stiffness: f64,
    pub loss: Loss,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Approach speed from which a landing is an impact, whose motion the steps resolve.
    pub floor: f64,
    /// Longest time ahead at which equilibrium may be written in an impact, and how long an impact may last.
    pub resolution: f64,
    pub duration: f64,
    /// Points nearer than this are looked at in every iteration.
    pub near: f64,
    /// There are velocities, so that what is far stays so for a while.
    pub dynamic: bool,
}

/// Points with equally many nodes against one surface.
pub struct Contacts {
    law: Law,
    surface: Surface,
    carrier: usize,
    points: Vec<Point>,
    /// Of each point: its own, then the carrier.
    nodes: Vec<[usize; MOST_NODES + 1]>,
    count: usize,
    rolls: bool,
}

/// A point against the surface.
struct Meeting {
    /// Of the carrier.
    R: Mat3,
    /// x − x_s.
    d: Vec3,
    /// R ṗ: the velocity relative to the surface.
    w: Vec3,
    p: Vec3,
    near: Near,
    gap: f64,
}

impl Meeting {
    fn rate(&self) -> f64 {
        -(self.R * self.near.n).dot(&self.w)
    }
}

impl Contacts {
    /// `points` have equally many nodes, one or more.
    pub fn new(law: Law, surface: Surface, carrier: usize, points: Vec<Point>) -> Self {
        let count = points.first().map_or(1, |point| point.count);
        let rolls = law.friction > 0.0 && points.iter().any(|point| point.lever > 0.0);
        let nodes = points
            .iter()
            .map(|point| {
                let mut nodes = [carrier; MOST_NODES + 1];
                nodes[..count].copy_from_slice(point.nodes());
                nodes
            })
            .collect();
        Contacts { law, surface, carrier, points, nodes, count, rolls }
    }

    /// Position and velocity relative to the carrier, global components.
    #[inline]
    fn relative(&self, point: &Point, nodes: &[Node]) -> (Vec3, Vec3) {
        let carrier = &nodes[self.carrier];
        let (mut d, mut v) = (Vec3::zeros(), Vec3::zeros());
        for (node, weight) in point.parts() {
            d += weight * nodes[node].relative_position(carrier);
            v += weight * nodes[node].v;
        }
        (d, v - carrier.v - carrier.omega.cross(&d))
    }

    #[inline]
    fn meet(&self, point: &Point, nodes: &[Node]) -> Meeting {
        let (d, w) = self.relative(point, nodes);
        let R = nodes[self.carrier].R();
        let p = R.tr_mul(&d);
        let near = self.surface.near(&p);
        Meeting { R, d, w, p, gap: near.distance - point.radius, near }
    }

    /// A distance from the carrier beyond which nothing touches.
    fn reach(&self) -> f64 {
        self.surface.center.norm() + self.surface.reach()
    }
}
