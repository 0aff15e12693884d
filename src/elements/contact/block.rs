//! Points against a surface as a block of elements: forces, tangent and energy.

use super::action::Action;
use super::{Contacts, Meeting};
use crate::elements::{ElementBlock, Force, Moduli, subtract};
use crate::materials::Dissipation;
use crate::math::rotation::inverse_tangent_matrix;
use crate::math::{Mat3, Vec3, skew};
use crate::state::Configuration;

impl ElementBlock for Contacts {
    fn len(&self) -> usize {
        self.points.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.nodes[e][..=self.count]
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_rotational(&self, e: usize, node: usize) -> bool {
        node == self.count || self.law.friction > 0.0 && self.points[e].lever > 0.0
    }

    fn history(&self) -> usize {
        self.stride() * self.points.len()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        if now.history.is_empty() {
            return;
        }
        for (e, point) in self.points.iter().enumerate() {
            let Some((meeting, action)) = self.touch(e, now) else { continue };
            let (f, m) = (meeting.R * action.F, meeting.R * action.M);
            for (node, weight) in point.parts() {
                subtract(&mut F[node], 0, &(-weight * f));
                if point.lever > 0.0 {
                    subtract(&mut F[node], 3, &(-weight * m));
                }
            }
            let carrier = &mut F[self.carrier];
            subtract(carrier, 0, &f);
            subtract(carrier, 3, &(meeting.d.cross(&f) + m));
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        K.fill(0.0);
        if now.history.is_empty() {
            return;
        }
        let Some((meeting, action)) = self.touch(e, now) else { return };
        let (point, count) = (&self.points[e], self.count);
        let past = self.share(e, now.history);
        let Meeting { R, d, w, near, .. } = &meeting;
        let Action { push, drag, F, M } = &action;
        let (n, H) = (&near.n, &near.H);
        let omega = &now.nodes[self.carrier].omega;
        let (f, m, normal) = (R * F, R * M, R * n);

        // δF and δM by δp and δN, in the frame of the surface.
        let mut F_p = push.force * H;
        let mut M_p = Mat3::zeros();
        let (mut F_N, mut M_N) = (*n, Vec3::zeros());
        let (mut F_phi, mut M_phi) = (Mat3::zeros(), Mat3::zeros());
        if let Some(drag) = drag {
            let lever = point.lever * skew(n);
            F_p -= drag.by_p;
            M_p += lever * drag.by_p - point.lever * skew(&drag.T) * H;
            F_N -= drag.by_N;
            M_N += lever * drag.by_N;
            F_phi -= drag.by_phi;
            M_phi += lever * drag.by_phi;
        }
        // δN = by_depth δ(δ) + by_rate δ(δ̇), with δ̇ = −n·w and w = v − v_s − ω_s × d.
        let N_p = R * (-push.by_depth * n - push.by_rate * (H * R.tr_mul(w)));
        let c = push.by_rate;
        let N_x = N_p - c * (rate_weight * normal - normal.cross(omega));
        let N_turn = -d.cross(&N_p) + c * (rate_weight * d.cross(&normal) - normal.cross(w));
        let turned = |A: &Mat3| R * A * R.transpose();
        let (F_p, M_p, F_phi, M_phi) = (turned(&F_p), turned(&M_p), turned(&F_phi), turned(&M_phi));
        let (F_N, M_N) = (R * F_N, R * M_N);
        let D = skew(d);

        // δf and δm at the point, by each motion: (f by, m by).
        let by_x = (F_p + F_N * N_x.transpose(), M_p + M_N * N_x.transpose());
        let mut by_turn =
            (F_p * D + F_N * N_turn.transpose() - skew(&f), M_p * D + M_N * N_turn.transpose() - skew(&m));
        let width = 6 * (count + 1);
        // Of the internal force, which is the opposite: to the nodes of the point by their weights, to the carrier as it is.
        let mut put = |column: usize, (A, B): &(Mat3, Mat3), extra: &Mat3| {
            for k in 0..count {
                let weight = point.weights[k];
                add(K, width, 6 * k, column, &(-weight * A));
                if point.lever > 0.0 {
                    add(K, width, 6 * k + 3, column, &(-weight * B));
                }
            }
            add(K, width, 6 * count, column, A);
            add(K, width, 6 * count + 3, column, &(D * A + B + extra));
        };
        for k in 0..count {
            let weight = point.weights[k];
            // The moment d × f on the carrier changes with d too.
            put(6 * k, &(weight * by_x.0, weight * by_x.1), &(-weight * skew(&f)));
            if drag.is_some() && point.lever > 0.0 {
                let T = turned(&inverse_tangent_matrix(&self.phi(point, k, past, now.nodes)));
                let by_own = (weight * F_phi * T, weight * M_phi * T);
                put(6 * k + 3, &by_own, &Mat3::zeros());
                by_turn.0 -= by_own.0;
                by_turn.1 -= by_own.1;
            }
        }
        put(6 * count, &(-by_x.0, -by_x.1), &skew(&f));
        put(6 * count + 3, &by_turn, &Mat3::zeros());
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        let mut spent = Dissipation::default();
        let stride = self.stride();
        for (e, new) in history.chunks_exact_mut(stride).enumerate() {
            spent += self.remember_point(&self.points[e], now, part, self.share(e, now.history), new);
        }
        spent
    }

    fn energy(&self, now: &Configuration) -> f64 {
        if now.history.is_empty() {
            return 0.0;
        }
        let k = self.law.stiffness;
        let stored = |(meeting, action): (Meeting, Action)| {
            let T = action.drag.map_or(0.0, |drag| drag.T.norm_squared());
            0.5 * k * meeting.gap * meeting.gap + 0.5 * T / k
        };
        (0..self.points.len()).filter_map(|e| self.touch(e, now)).map(stored).sum()
    }

    fn is_inactive(&self, e: usize, now: &Configuration) -> bool {
        let since = self.share(e, now.history).first().copied();
        since.is_none_or(|safe| now.dt < safe) || self.meet(&self.points[e], now.nodes).gap > 0.0
    }

    fn as_contacts(&self) -> Option<&Contacts> {
        Some(self)
    }
}

fn add(K: &mut [f64], width: usize, row: usize, column: usize, block: &Mat3) {
    for i in 0..3 {
        for j in 0..3 {
            K[(row + i) * width + column + j] += block[(i, j)];
        }
    }
}
