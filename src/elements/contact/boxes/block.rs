//! Pairs of boxes as a block of elements.

use super::pair::{BoxPairs, PairKinematics};
use super::update::update_pair;
use crate::elements::block::{ElementBlock, Force, Moduli, subtract};
use crate::materials::Dissipation;
use crate::math::{Mat3, Mat6, Vec3, Vec6, angular, linear, skew};
use crate::state::Configuration;
use nalgebra::SMatrix;

/// How the motion of a pair in the frame of the touched box follows from that of its two nodes: δx, δθ of the one, then of the other.
type FromNodes = SMatrix<f64, 6, 12>;

impl ElementBlock for BoxPairs {
    fn len(&self) -> usize {
        self.boxes.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.nodes[e]
    }

    fn dofs(&self) -> usize {
        6
    }

    fn history(&self) -> usize {
        self.width() * self.boxes.len()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        if now.history.is_empty() {
            return;
        }
        for (e, one) in self.boxes.iter().enumerate() {
            let Some((at, acting)) = self.touch(e, now) else { continue };
            let (f, m) = at.global(&acting.W);
            subtract(&mut F[one.node], 0, &-f);
            subtract(&mut F[one.node], 3, &-m);
            subtract(&mut F[self.carrier], 0, &f);
            subtract(&mut F[self.carrier], 3, &(m + at.d.cross(&f)));
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        K.fill(0.0);
        if now.history.is_empty() {
            return;
        }
        let Some((at, acting)) = self.touch(e, now) else { return };
        let [by_motion, by_rates] = self.derivatives(&at, &acting, self.history(e, now.history));
        let omega = &now.nodes[self.carrier].omega;
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
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        let mut spent = Dissipation::default();
        for (e, new) in history.chunks_exact_mut(self.width()).enumerate() {
            spent += update_pair(self, e, now, part, new);
        }
        spent
    }

    fn energy(&self, now: &Configuration) -> f64 {
        if now.history.is_empty() {
            return 0.0;
        }
        let k = self.law.stiffness;
        let stored = |e: usize| {
            let (_, acting) = self.touch(e, now)?;
            let pull = acting.rubbing.as_ref().map_or(0.0, |rubbing| rubbing.pull);
            Some(0.5 * k * acting.depth.D * acting.depth.D + 0.5 * pull * pull / k)
        };
        (0..self.boxes.len()).filter_map(stored).sum()
    }

    fn is_inactive(&self, e: usize, now: &Configuration) -> bool {
        now.history.is_empty()
            || now.dt < self.history(e, now.history).safe_time()
            || self.kinematics(e, now.nodes).pose.least_axis().gap > self.law.touching
    }

    fn as_any(&self) -> Option<&dyn std::any::Any> {
        Some(self)
    }
}

impl PairKinematics {
    /// Force and moment on the one body, global components.
    pub fn global(&self, W: &Vec6) -> (Vec3, Vec3) {
        (self.E * linear(W), self.E * angular(W))
    }

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
        let (w, turning) = self.global(&self.rates);
        let mut J = rate_weight * self.motion();
        let carried = back * skew(omega);
        subtract_block(&mut J, 0, 0, &carried);
        subtract_block(&mut J, 0, 6, &-carried);
        // E turns with the carrier.
        subtract_block(&mut J, 0, 9, &(-back * skew(&w)));
        subtract_block(&mut J, 3, 9, &(-back * skew(&turning)));
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
