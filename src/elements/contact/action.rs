//! What acts where a point touches: the push of the surface and the drag along it.

use super::friction::{Drag, drag};
use super::restitution::{Push, push};
use super::{Contacts, Meeting, Point, past};
use crate::math::Vec3;
use crate::state::{Configuration, Node};

/// What acts at a meeting, in the frame of the surface.
pub(super) struct Action {
    pub(super) push: Push,
    pub(super) drag: Option<Drag>,
    /// F and M.
    pub(super) F: Vec3,
    pub(super) M: Vec3,
}

impl Contacts {
    pub(super) fn act(&self, point: &Point, meeting: &Meeting, past: &[f64], nodes: &[Node]) -> Action {
        let (known, law) = (past[past::KNOWN] > 0.0, &self.law);
        let rate = meeting.rate();
        let speed = match known {
            true if past[past::GAP] <= 0.0 => past[past::SPEED].max(rate),
            // Faster now than then where something presses from rest.
            true => past[past::RATE].max(rate),
            false => rate,
        };
        let push = push(law.stiffness, &law.loss, -meeting.gap, rate, speed);
        let n = &meeting.near.n;
        if law.friction == 0.0 || !known {
            return Action { push, drag: None, F: push.force * n, M: Vec3::zeros() };
        }
        let mut phi = Vec3::zeros();
        if point.lever > 0.0 {
            for k in 0..self.count {
                phi += point.weights[k] * self.phi(point, k, past, nodes);
            }
        }
        let drag = drag(
            law.stiffness,
            law.friction,
            push.force,
            &meeting.near,
            &(meeting.p - past::anchor(past)),
            point.lever,
            &phi,
        );
        Action { push, F: push.force * n - drag.T, M: point.lever * n.cross(&drag.T), drag: Some(drag) }
    }

    /// The action on a point that touches and is not known to be far.
    #[inline]
    pub(super) fn touch(&self, e: usize, now: &Configuration) -> Option<(Meeting, Action)> {
        let past = self.share(e, now.history);
        if now.dt < past[past::SAFE] {
            return None;
        }
        let meeting = self.meet(&self.points[e], now.nodes);
        // At a gap of nothing there is stiffness, if no force.
        if meeting.gap > 0.0 {
            return None;
        }
        let action = self.act(&self.points[e], &meeting, past, now.nodes);
        Some((meeting, action))
    }
}
