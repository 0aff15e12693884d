//! What a point remembers: numbers in [`crate::state::State::history`], the same count for every point.

use super::{Contacts, Point};
use crate::math::Vec3;
use crate::math::rotation::{log, renormalise};
use crate::state::Node;
use nalgebra::Quaternion;

/// Not to be looked at before this time after the last state.
pub(super) const SAFE: usize = 0;
/// 1 where the numbers below are those of the last state.
pub(super) const KNOWN: usize = 1;
pub(super) const GAP: usize = 2;
/// Approach speed, δ̇.
pub(super) const RATE: usize = 3;
/// Approach speed when it landed; 0 again some time after it has lifted off.
pub(super) const SPEED: usize = 4;
/// Time since the landing, or since the lift-off.
pub(super) const AGE: usize = 5;
/// Power that the damping of the impact takes.
pub(super) const POWER: usize = 6;
/// |T|.
pub(super) const PULL: usize = 7;
/// Where the spring of friction is held: three components in the frame of the surface.
pub(super) const ANCHOR: usize = 8;
/// Of each node: the quaternion of its rotation relative to the surface, where friction turns nodes.
pub(super) const TURN: usize = 11;

pub(super) fn anchor(past: &[f64]) -> Vec3 {
    Vec3::from_column_slice(&past[ANCHOR..TURN])
}

/// The remembered rotation of the k-th node.
pub(super) fn kept(past: &[f64], k: usize) -> Quaternion<f64> {
    let q = &past[TURN + 4 * k..];
    Quaternion::new(q[0], q[1], q[2], q[3])
}

impl Contacts {
    /// Numbers of a point.
    pub(super) fn stride(&self) -> usize {
        match (self.law.friction > 0.0, self.rolls) {
            (false, _) => PULL,
            (true, false) => TURN,
            (true, true) => TURN + 4 * self.count,
        }
    }

    /// Those of a point; none before there are any.
    pub(super) fn share<'a>(&self, e: usize, past: &'a [f64]) -> &'a [f64] {
        if past.is_empty() {
            return past;
        }
        &past[e * self.stride()..(e + 1) * self.stride()]
    }

    /// Rotation of a node relative to the surface.
    pub(super) fn turn(&self, node: usize, nodes: &[Node]) -> Quaternion<f64> {
        nodes[self.carrier].q.conjugate() * nodes[node].q
    }

    /// Rotation vector of the k-th node relative to the surface since the remembered one.
    pub(super) fn phi(&self, point: &Point, k: usize, past: &[f64], nodes: &[Node]) -> Vec3 {
        log(&renormalise(&(self.turn(point.nodes[k], nodes) * kept(past, k).conjugate())))
    }
}
