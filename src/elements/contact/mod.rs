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

pub mod friction;
pub mod restitution;
pub mod surface;

use super::{Block, Force, Moduli, subtract};
use crate::materials::Spent;
use crate::math::rotation::{inverse_tangent_matrix, log, renormalise};
use crate::math::{Mat3, Vec3, rotation, skew};
use crate::state::{Node, Now};
use friction::{Drag, drag};
use nalgebra::Quaternion;
use restitution::{Loss, Push, push};
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
    fn seen_from(&self, carrier: &Node, nodes: &[Node]) -> Vec3 {
        self.parts().map(|(node, w)| w * nodes[node].seen_from(carrier)).sum()
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

/// What a point remembers: numbers in [`crate::state::State::history`].
mod past {
    /// Not to be looked at before this time after the last state.
    pub const SAFE: usize = 0;
    /// 1 where the numbers below are those of the last state.
    pub const KNOWN: usize = 1;
    pub const GAP: usize = 2;
    /// Approach speed, δ̇.
    pub const RATE: usize = 3;
    /// Approach speed when it landed; 0 again some time after it has lifted off.
    pub const SPEED: usize = 4;
    /// Time since the landing, or since the lift-off.
    pub const AGE: usize = 5;
    /// Power that the damping of the impact takes.
    pub const POWER: usize = 6;
    /// |T|.
    pub const PULL: usize = 7;
    /// Three components in the frame of the surface.
    pub const ANCHOR: usize = 8;
    /// Of each node: the quaternion of its rotation relative to the surface, where friction turns nodes.
    pub const TURN: usize = 11;
}

/// The resultant of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resultant {
    /// Points that touch.
    pub touching: usize,
    /// On the surface, and its moment about the node that carries it.
    pub f: Vec3,
    pub m: Vec3,
}

impl Default for Resultant {
    fn default() -> Self {
        Resultant { touching: 0, f: Vec3::zeros(), m: Vec3::zeros() }
    }
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

/// Of the surface, at the start of a step and ahead.
struct Frames {
    start: Mat3,
    now: Mat3,
    /// Bound of |R₁ − R₀|: a chord of the angle, twice that of its half.
    turn: f64,
}

/// What acts at a meeting, in the frame of the surface.
struct Action {
    push: Push,
    drag: Option<Drag>,
    /// F and M.
    F: Vec3,
    M: Vec3,
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

    fn stride(&self) -> usize {
        match (self.law.friction > 0.0, self.rolls) {
            (false, _) => past::PULL,
            (true, false) => past::TURN,
            (true, true) => past::TURN + 4 * self.count,
        }
    }

    fn share<'a>(&self, e: usize, past: &'a [f64]) -> &'a [f64] {
        if past.is_empty() {
            return past;
        }
        &past[e * self.stride()..(e + 1) * self.stride()]
    }

    /// Position and velocity relative to the carrier, global components.
    #[inline]
    fn relative(&self, point: &Point, nodes: &[Node]) -> (Vec3, Vec3) {
        let carrier = &nodes[self.carrier];
        let (mut d, mut v) = (Vec3::zeros(), Vec3::zeros());
        for (node, weight) in point.parts() {
            d += weight * nodes[node].seen_from(carrier);
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

    /// Rotation of a node relative to the surface.
    fn turn(&self, node: usize, nodes: &[Node]) -> Quaternion<f64> {
        nodes[self.carrier].q.conjugate() * nodes[node].q
    }

    /// Rotation vector of the k-th node relative to the surface since the remembered one.
    fn phi(&self, point: &Point, k: usize, past: &[f64], nodes: &[Node]) -> Vec3 {
        log(&renormalise(&(self.turn(point.nodes[k], nodes) * kept(past, k).conjugate())))
    }

    fn act(&self, point: &Point, meeting: &Meeting, past: &[f64], nodes: &[Node]) -> Action {
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
        let anchor = Vec3::from_column_slice(&past[past::ANCHOR..past::TURN]);
        let mut phi = Vec3::zeros();
        if point.lever > 0.0 {
            for k in 0..self.count {
                phi += point.weights[k] * self.phi(point, k, past, nodes);
            }
        }
        let drag =
            drag(law.stiffness, law.friction, push.force, &meeting.near, &(meeting.p - anchor), point.lever, &phi);
        Action { push, F: push.force * n - drag.T, M: point.lever * n.cross(&drag.T), drag: Some(drag) }
    }

    /// The action on a point that touches and is not known to be far.
    #[inline]
    fn touch(&self, e: usize, now: &Now) -> Option<(Meeting, Action)> {
        let past = self.share(e, now.past);
        if now.since < past[past::SAFE] {
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

    /// What the points at hand do to the surface.
    pub fn resultant(&self, now: &Now) -> Resultant {
        let mut sum = Resultant::default();
        for e in 0..self.points.len() {
            let Some((meeting, action)) = self.touch(e, now) else { continue };
            let f = meeting.R * action.F;
            sum.touching += 1;
            sum.f -= f;
            sum.m -= meeting.d.cross(&f) + meeting.R * action.M;
        }
        sum
    }

    /// One step of the history of a point, `part` of the way from the last state to `now`.
    fn remember_point(&self, point: &Point, now: &Now, part: f64, old: &[f64], new: &mut [f64]) -> Spent {
        let (law, mut spent) = (&self.law, Spent::default());
        let dt = part * now.since;
        let (d, w) = self.relative(point, now.nodes);
        let speed = w.norm();
        // How soon it could come here at twice its speed.
        let safe = |gap: f64| if law.dynamic && gap > law.near { 0.5 * gap / speed } else { 0.0 };
        let pull = if law.friction > 0.0 { old[past::PULL] } else { 0.0 };
        let far = safe(d.norm() - self.reach() - point.radius);
        if far > 4.0 * now.since && now.since > 0.0 && old[past::SPEED] == 0.0 {
            new.fill(0.0);
            new[past::SAFE] = far;
            spent.friction = 0.5 * pull * pull / law.stiffness;
            return spent;
        }
        let known = old[past::KNOWN] > 0.0;
        // What is not known has no past to come from.
        let beyond = (part - 1.0) * now.since;
        let part = if known { part } else { 1.0 };
        let toward = |old: f64, now: f64| old + part * (now - old);
        let meeting = self.meet(point, now.nodes);
        let (gap, rate) = (meeting.gap, meeting.rate());
        let action = (gap <= 0.0).then(|| self.act(point, &meeting, old, now.nodes));
        let force = action.as_ref().map_or(0.0, |action| action.push.force);
        new[past::KNOWN] = 1.0;
        new[past::GAP] = if known { toward(old[past::GAP], gap) } else { gap - rate * beyond };
        new[past::RATE] = toward(old[past::RATE], rate);
        new[past::SAFE] = safe(new[past::GAP]);
        let touches = new[past::GAP] <= 0.0;
        let touched = known && old[past::GAP] <= 0.0;
        (new[past::SPEED], new[past::AGE]) = match (touches, touched) {
            // The approach speed where the gap closed, on a straight line.
            (true, false) if known => {
                let closed = old[past::GAP] / (old[past::GAP] - gap);
                ((old[past::RATE] + closed * (rate - old[past::RATE])).max(0.0), 0.0)
            }
            (true, false) => (rate.max(0.0), 0.0),
            // Faster than at the landing where something presses.
            (true, true) => (old[past::SPEED].max(new[past::RATE]), old[past::AGE] + dt),
            (false, true) => (old[past::SPEED], 0.0),
            // It touched at the instant: the acceleration of that is carried on.
            (false, false) if gap <= 0.0 => (old[past::RATE].max(rate).max(0.0), 0.0),
            // The impact is over for good once the acceleration it leaves to the scheme is gone.
            (false, false) if old[past::AGE] + dt < law.duration => (old[past::SPEED], old[past::AGE] + dt),
            (false, false) => (0.0, 0.0),
        };
        let power = if gap < 0.0 { (force + law.stiffness * gap) * rate } else { 0.0 };
        new[past::POWER] = toward(old[past::POWER], power);
        spent.impact = 0.5 * dt * (old[past::POWER] + new[past::POWER]);
        if law.friction == 0.0 {
            return spent;
        }
        let drag = action.and_then(|action| action.drag);
        let p = &meeting.p;
        // What slides at t = 0 has been sliding: its spring is stretched.
        let begun =
            if known || now.since > 0.0 || force == 0.0 { Vec3::zeros() } else { self.sliding(point, &meeting, now) };
        let (shift, T, slip) = match &drag {
            Some(drag) => (drag.slip, drag.T.norm(), drag.slip.norm()),
            // Free: the anchor goes along, and what was stretched lets go.
            None => (p - Vec3::from_column_slice(&old[past::ANCHOR..past::TURN]), 0.0, pull / law.stiffness),
        };
        new[past::PULL] = toward(pull, T);
        spent.friction = if drag.is_some() { 0.5 * part * slip * (pull + new[past::PULL]) } else { 0.5 * pull * slip };
        if drag.is_none() {
            new[past::PULL] = self.law.friction * force * begun.norm();
        }
        let mut anchor = Vec3::from_column_slice(&old[past::ANCHOR..past::TURN]) + part * shift
            - self.law.friction * force / law.stiffness * begun;
        if drag.is_some() {
            let n = &meeting.near.n;
            anchor += part * n.dot(&(p - Vec3::from_column_slice(&old[past::ANCHOR..past::TURN]))) * n;
        }
        if self.rolls {
            for k in 0..self.count {
                let turn = self.turn(point.nodes[k], now.nodes);
                let q = if known {
                    let phi = self.phi(point, k, old, now.nodes);
                    if drag.is_some() {
                        // The way rolled so far moves from the rotation to the anchor.
                        anchor += part * point.weights[k] * point.lever * phi.cross(&meeting.near.n);
                    }
                    renormalise(&(rotation::exp(&(part * phi)) * kept(old, k)))
                } else {
                    turn
                };
                new[past::TURN + 4 * k..past::TURN + 4 * k + 4].copy_from_slice(&[q.w, q.i, q.j, q.k]);
            }
        }
        new[past::ANCHOR..past::TURN].copy_from_slice(anchor.as_slice());
        spent
    }

    /// Unit vector along the slip, in the frame of the surface; zero for what does not slip faster than its weight makes it.
    fn sliding(&self, point: &Point, meeting: &Meeting, now: &Now) -> Vec3 {
        let n = &meeting.near.n;
        let spin: Vec3 = point.parts().map(|(node, weight)| weight * now.nodes[node].omega).sum();
        let spin = meeting.R.tr_mul(&(spin - now.nodes[self.carrier].omega));
        let w = meeting.R.tr_mul(&meeting.w);
        let slip = w - n.dot(&w) * n - point.lever * spin.cross(n);
        let speed = slip.norm();
        if speed > self.law.floor { slip / speed } else { Vec3::zeros() }
    }

    /// True where a step from `start` to `now` takes a point through the surface, or into an impact that the step does not
    /// resolve.
    fn is_missed(&self, e: usize, start: &[Node], now: &Now, frames: &Frames) -> bool {
        let (point, past) = (&self.points[e], self.share(e, now.past));
        let [from, to] = [start, now.nodes].map(|nodes| point.seen_from(&nodes[self.carrier], nodes));
        let far = from.norm();
        if far - self.reach() - point.radius > (to - from).norm() + frames.turn * far {
            return false;
        }
        let (p0, p1) = (frames.start.tr_mul(&from), frames.now.tr_mul(&to));
        let (way, gap) = (p1 - p0, |p: &Vec3| self.surface.distance(p) - point.radius);
        let (length, first, last) = (way.norm(), gap(&p0), gap(&p1));
        if first > length {
            return false;
        }
        if last < 0.0 && now.since < past[past::SAFE] {
            return true;
        }
        let normal = |p: &Vec3| self.surface.near(p).n;
        // Nothing lies nearer than the distance: along the way by it, from either end, until the surface is reached.
        let reached = |at: &dyn Fn(f64) -> Vec3| {
            let mut t = 0.0;
            while t < 1.0 {
                let g = gap(&at(t));
                if g < 1e-3 * length {
                    return Some(t);
                }
                t += g / length;
            }
            None
        };
        let Some(t0) = (if first > 0.0 { reached(&|t| p0 + t * way) } else { Some(0.0) }) else { return false };
        let entry = normal(&(p0 + t0 * way));
        // By the other side; or by another side from far inside, and not just round an edge.
        let strayed = |n: &Vec3, depth: f64, length: f64| {
            let along = entry.dot(n);
            along < -0.5 && depth < 0.0 || along < 0.5 && depth < first.min(0.0) - 0.02 * length
        };
        if last < 0.0 {
            let depth = last.min(gap(&(p0 + 0.5 * (1.0 + t0) * way)));
            let fast = 3.0 * self.law.floor;
            let landing = first > 0.0
                && (past[past::KNOWN] == 0.0 || past[past::RATE] > fast || -depth > fast * 2.0 * self.law.resolution);
            return strayed(&normal(&p1), depth, length) || landing && now.since > self.law.resolution;
        }
        // In at one place and out at another; a shallow pass along one side is left alone.
        let Some(t1) = reached(&|t| p1 - t * way).map(|t| 1.0 - t) else { return false };
        let (depth, chord) = (gap(&(p0 + 0.5 * (t0 + t1) * way)), (t1 - t0) * length);
        first > 0.0 && depth < -0.02 * chord || strayed(&normal(&(p0 + t1 * way)), depth, chord)
    }
}

/// The remembered rotation of the k-th node.
fn kept(past: &[f64], k: usize) -> Quaternion<f64> {
    let q = &past[past::TURN + 4 * k..];
    Quaternion::new(q[0], q[1], q[2], q[3])
}

impl Block for Contacts {
    fn len(&self) -> usize {
        self.points.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.nodes[e][..=self.count]
    }

    fn dofs(&self) -> usize {
        6
    }

    fn turns(&self, e: usize, node: usize) -> bool {
        node == self.count || self.law.friction > 0.0 && self.points[e].lever > 0.0
    }

    fn history(&self) -> usize {
        self.stride() * self.points.len()
    }

    fn subtract_forces(&self, now: &Now, F: &mut [Force]) {
        if now.past.is_empty() {
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

    fn tangent(&self, e: usize, now: &Now, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        K.fill(0.0);
        if now.past.is_empty() {
            return;
        }
        let Some((meeting, action)) = self.touch(e, now) else { return };
        let (point, count) = (&self.points[e], self.count);
        let past = self.share(e, now.past);
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

    fn remember(&self, now: &Now, part: f64, history: &mut [f64]) -> Spent {
        let mut spent = Spent::default();
        let stride = self.stride();
        for (e, new) in history.chunks_exact_mut(stride).enumerate() {
            spent += self.remember_point(&self.points[e], now, part, self.share(e, now.past), new);
        }
        spent
    }

    fn energy(&self, now: &Now) -> f64 {
        if now.past.is_empty() {
            return 0.0;
        }
        let k = self.law.stiffness;
        let stored = |(meeting, action): (Meeting, Action)| {
            let T = action.drag.map_or(0.0, |drag| drag.T.norm_squared());
            0.5 * k * meeting.gap * meeting.gap + 0.5 * T / k
        };
        (0..self.points.len()).filter_map(|e| self.touch(e, now)).map(stored).sum()
    }

    fn rests(&self, e: usize, now: &Now) -> bool {
        let since = self.share(e, now.past).first().copied();
        since.is_none_or(|safe| now.since < safe) || self.meet(&self.points[e], now.nodes).gap > 0.0
    }

    fn as_contacts(&self) -> Option<&Contacts> {
        Some(self)
    }
}

impl Contacts {
    /// True where a step from `start` to `now` must be shorter: see [`Law::resolution`].
    pub fn misses(&self, start: &[Node], now: &Now) -> bool {
        let (a, b) = (&start[self.carrier], &now.nodes[self.carrier]);
        let turn = 2.0 * (b.q - a.q).norm().min((b.q + a.q).norm());
        let frames = Frames { start: a.R(), now: b.R(), turn };
        (0..self.points.len()).any(|e| self.is_missed(e, start, now, &frames))
    }

    /// Longest time ahead at which equilibrium may be written next, with what is remembered of the last state.
    pub fn longest(&self, past: &[f64]) -> f64 {
        let law = &self.law;
        let in_impact = |past: &[f64]| {
            past[past::KNOWN] > 0.0 && past[past::SPEED] > 3.0 * law.floor && past[past::AGE] < law.duration
        };
        let any = law.resolution < f64::INFINITY && past.chunks_exact(self.stride()).any(in_impact);
        if any { law.resolution } else { f64::INFINITY }
    }
}

/// Least distance of points from a surface; infinite where there are none.
pub fn least_gap(surface: &Surface, carrier: usize, points: &[Point], nodes: &[Node]) -> f64 {
    let carrier = &nodes[carrier];
    let R = carrier.R();
    let gap = |point: &Point| surface.distance(&R.tr_mul(&point.seen_from(carrier, nodes))) - point.radius;
    points.iter().map(gap).fold(f64::INFINITY, f64::min)
}

fn add(K: &mut [f64], width: usize, row: usize, column: usize, block: &Mat3) {
    for i in 0..3 {
        for j in 0..3 {
            K[(row + i) * width + column + j] += block[(i, j)];
        }
    }
}
