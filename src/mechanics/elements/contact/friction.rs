//! Coulomb friction by a spring that slips.
//!
//! A tangential spring from an anchor to the point resists up to μN; beyond that the anchor slips (return mapping). A sticking contact
//! therefore never creeps, in contrast to laws with friction proportional to the slip speed. The anchor is kept in the frame of the surface
//! and turns with it. For a rolling ball of radius r the displacement of its material at the contact counts, p − r φ × n; φ is the relative
//! rotation since the stored one.

use super::surfaces::kind::ClosestPoint;
use base::math::{Mat3, Vec3, skew};

/// Tangential force at an instant, in the frame of the surface.
#[derive(Debug, Clone, Copy)]
pub struct FrictionForce {
    /// Friction force on the surface, along the slip.
    pub T: Vec3,
    /// The largest size of this force.
    pub limit: f64,
    /// Displacement of the anchor by slip.
    pub slip: Vec3,
    /// ∂T/∂p at fixed N.
    pub by_p: Mat3,
    /// ∂T/∂N.
    pub by_N: Vec3,
    /// ∂T/∂φ.
    pub by_phi: Mat3,
}

/// True for friction of this size at its limit. The anchor lies there after a step with slip, but for rounding.
pub fn slips(pull: f64, limit: f64) -> bool {
    pull > 0.0 && pull >= (1.0 - 1e-9) * limit
}

/// The friction force by the stretch s = P e, e = p − a − r φ×n, of the spring; `N` is the normal force.
#[inline]
pub fn friction_force(
    stiffness: f64,
    mu: f64,
    N: f64,
    closest: &ClosestPoint,
    from_anchor: &Vec3,
    radius: f64,
    phi: &Vec3,
) -> FrictionForce {
    let ClosestPoint { n, H, .. } = closest;
    let e = from_anchor - radius * phi.cross(n);
    let across = n.dot(&e);
    let s = e - across * n;
    let length = s.norm();
    let P = Mat3::identity() - n * n.transpose();
    // δs = P δe − (n·e) δn − n (e·δn), δe = δp − r φ×δn − r δφ×n, δn = H δp
    let by_p = P * (Mat3::identity() - radius * skew(phi) * H) - across * H - n * (H * e).transpose();
    let by_phi = radius * P * skew(n);
    let limit = mu * N;
    if stiffness * length <= limit {
        let k = stiffness;
        return FrictionForce {
            T: k * s,
            limit,
            slip: Vec3::zeros(),
            by_p: k * by_p,
            by_N: Vec3::zeros(),
            by_phi: k * by_phi,
        };
    }
    let t = s / length;
    let turn = limit / length * (Mat3::identity() - t * t.transpose());
    FrictionForce {
        T: limit * t,
        limit,
        slip: s - limit / stiffness * t,
        by_p: turn * by_p,
        by_N: mu * t,
        by_phi: turn * by_phi,
    }
}
