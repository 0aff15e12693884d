//! The tangent of the force of a pair on its two nodes.

use super::pair::{ConvexPair, PairKinematics};
use crate::elements::contact::history::PairMemory;
use crate::state::Configuration;
use base::math::{Mat3, Mat6, Vec3, skew};
use nalgebra::SMatrix;

/// The matrix from the motion of both nodes (δx, δθ of the one, then of the other) to the relative motion in the frame of the other.
type FromNodes = SMatrix<f64, 6, 12>;

/// Writes the tangent of a pair into `K`, initially zero: 12 × 12 over the one and the other. False where the two are apart.
pub(super) fn tangent(
    pair: &ConvexPair,
    old: PairMemory,
    now: &Configuration,
    rate_weight: f64,
    K: &mut [f64],
) -> bool {
    let Some((at, acting)) = pair.touch(old, now) else { return false };
    let [by_motion, by_rates] = pair.derivatives(&at, &acting, old);
    let omega = &now.nodes[pair.other.node].omega;
    let W = by_motion * at.motion() + by_rates * at.rates_by_nodes(rate_weight, omega);
    let (f, m) = at.global(&acting.W);
    let mut W: FromNodes = turned(&at.E) * W;
    // E turns with the carrier, and the force with E.
    subtract_block(&mut W, 0, 9, &skew(&f));
    subtract_block(&mut W, 3, 9, &skew(&m));
    let mut on_carrier = W;
    let arm = skew(&at.d) * W.fixed_view::<3, 12>(0, 0);
    on_carrier.fixed_view_mut::<3, 12>(3, 0).zip_apply(&arm, |a, b| *a += b);
    // δ(d × f) holds δd × f, too.
    subtract_block(&mut on_carrier, 3, 0, &skew(&f));
    subtract_block(&mut on_carrier, 3, 6, &-skew(&f));
    for column in 0..12 {
        for row in 0..6 {
            K[row * 12 + column] = -W[(row, column)];
            K[(6 + row) * 12 + column] = on_carrier[(row, column)];
        }
    }
    true
}

impl PairKinematics<'_> {
    /// δu = Eᵀ(δx − δx_s + d × δθ_s), δψ = Eᵀ(δθ − δθ_s).
    fn motion(&self) -> FromNodes {
        let back = self.E.transpose();
        let mut J = FromNodes::zeros();
        subtract_block(&mut J, 0, 0, &-back);
        subtract_block(&mut J, 0, 6, &back);
        subtract_block(&mut J, 0, 9, &(-back * skew(&self.d)));
        subtract_block(&mut J, 3, 3, &-back);
        subtract_block(&mut J, 3, 9, &back);
        J
    }

    /// The rates u̇ = Eᵀ(v − v_s − ω_s × d) and ψ̇ = Eᵀ(ω − ω_s), where velocities change `rate_weight` times as fast as positions.
    fn rates_by_nodes(&self, rate_weight: f64, omega: &Vec3) -> FromNodes {
        let back = self.E.transpose();
        let (w, spin) = self.global(&self.rates);
        let mut J = rate_weight * self.motion();
        let carried = back * skew(omega);
        subtract_block(&mut J, 0, 0, &carried);
        subtract_block(&mut J, 0, 6, &-carried);
        // E turns with the carrier.
        subtract_block(&mut J, 0, 9, &(-back * skew(&w)));
        subtract_block(&mut J, 3, 9, &(-back * skew(&spin)));
        J
    }
}

fn subtract_block(J: &mut FromNodes, row: usize, column: usize, block: &Mat3) {
    for i in 0..3 {
        for j in 0..3 {
            J[(row + i, column + j)] -= block[(i, j)];
        }
    }
}

/// Turns both halves of a six-vector.
fn turned(E: &Mat3) -> Mat6 {
    let mut both = Mat6::zeros();
    both.fixed_view_mut::<3, 3>(0, 0).copy_from(E);
    both.fixed_view_mut::<3, 3>(3, 3).copy_from(E);
    both
}
