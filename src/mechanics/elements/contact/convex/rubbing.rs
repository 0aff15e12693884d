//! Friction between two convex solids: a spring at the centre of the common solid, along the faces and about their normal.
//!
//! The limit is μN in sliding and μN r in turning about the normal, with r the mean lever of a uniform pressure. Combined, it is the
//! ellipsoid between the two (S. Goyal, A. Ruina, J. Papadopoulos, Wear 143 (1991)); beyond it slips. The stretch grows by the way of the
//! material at the centre since the last state, so that the centre may wander.

use super::depth::Depth;
use super::memory::Memory;
use super::pose::ConvexPose;
use base::math::{Vec3, Vec6, linear, stack};

/// Friction of a pair.
pub struct Rubbing {
    /// Force and moment on the one body at its node.
    pub W: Vec6,
    /// ∂W/∂N.
    pub by_N: Vec6,
    /// Size of the force and moment of the spring, as a force.
    pub pull: f64,
    /// The largest size of the pull.
    pub limit: f64,
    /// The stretch that the spring keeps.
    pub stretch: Vec3,
    /// The twist that the spring keeps, in radians.
    pub twist: f64,
    /// The length of the way that slipped.
    pub slip: f64,
}

/// The friction of a pair at `depth` under the normal force `N`, with the spring stiffness `k` along the faces. `None` for a normal force
/// without direction.
pub fn rubbing(
    (k, friction): (f64, f64),
    pose: &ConvexPose,
    depth: &Depth,
    N: f64,
    memory: &Memory,
) -> Option<Rubbing> {
    let normal = -linear(&depth.g);
    let n = normal.try_normalize(0.0)?;
    let arm = depth.c - pose.y;
    // The material at the centre lay at y₀ + Q₀ Qᵀ (c − y).
    let way = depth.c - memory.y - memory.Q * pose.Q.tr_mul(&arm);
    let from = memory.stretch + way;
    let e = from - n.dot(&from) * n;
    let twist = memory.twist + n.dot(&memory.turned(&pose.Q));
    let turned = depth.lever * twist;
    let length = (e.norm_squared() + turned * turned).sqrt();
    // The pressing force is N |∂D|, on an edge less than N.
    let limit = friction * N * normal.norm();
    let slips = k * length > limit;
    let factor = if slips { limit / length } else { k };
    let T = factor * e;
    let W = -stack(&T, &(arm.cross(&T) + factor * turned * depth.lever * n));
    // The friction force in slip is proportional to N.
    let by_N = if slips && N > 0.0 { W / N } else { Vec6::zeros() };
    let (pull, part) = if slips { (limit, limit / (k * length)) } else { (k * length, 1.0) };
    Some(Rubbing { W, by_N, pull, limit, stretch: part * e, twist: part * twist, slip: (1.0 - part) * length })
}
