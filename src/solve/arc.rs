//! A step whose load is unknown: equilibrium r(q, t) = 0 and one equation more. With K = −∂r/∂q each correction is
//!   δq = a + δt b,   K a = r,   K b = ∂r/∂t,
//! two substitutions with one factorisation, and δt follows from the equation that was added, solved exactly: the length of
//! the motion |Δq + δq| = ℓ, load left out (M. A. Crisfield, Comput. Struct. 13 (1981); E. Ramm, 1981), or a displacement
//! that is given. Of the two roots of the first the one that goes on: along the last step at the start of a step (Y. T. Feng
//! et al., Eng. Comput. 12 (1995)), whatever the sign of det K, along the motion so far afterwards.

use super::failure::{self, Failure};
use super::step::Stepper;
use crate::integrators::load_steps;
use crate::math::rotation::inverse_tangent;
use crate::math::{Vec6, bottom, join, top};
use crate::state::{Configuration, State};
use crate::system::{Forces, Loading, Scale};

/// What takes the place of a given time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// Length of the motion of the step.
    Arc(f64),
    /// The motion of one unknown translation in the step.
    Motion { node: usize, dof: usize, by: f64 },
}

/// What a path needs beside the machinery of a step. Allocated once.
pub struct Path {
    /// ∂r/∂t, then b, per unknown.
    rate: Vec<f64>,
    loading: Loading,
    forces: Forces,
    /// Change of the gaps of joints with the time.
    gaps: Vec<f64>,
    /// Motion of the last step, per node.
    last: Vec<Vec6>,
    /// Held directions move with the time.
    driven: bool,
    /// A rotation counts as a translation over the length of the model: its square.
    weight: f64,
}

/// Of the last motion: below this a motion does not tell a direction.
const SHORT: f64 = 1e-6;

/// How far a step goes.
pub struct Motion {
    pub length: f64,
    /// Of the angle with the last step; 1 where there is none.
    pub cosine: f64,
    short: bool,
}

/// Products of motions, rotations as rotation vectors of the step: D the motion so far, ahead the way to go.
#[derive(Default)]
struct Products {
    DD: f64,
    Da: f64,
    Db: f64,
    aa: f64,
    ab: f64,
    bb: f64,
    ahead_b: f64,
}

impl Path {
    fn dot(&self, x: &Vec6, y: &Vec6) -> f64 {
        top(x).dot(&top(y)) + self.weight * bottom(x).dot(&bottom(y))
    }
}

impl Stepper<'_> {
    pub(super) fn new_path(&self) -> Path {
        Path {
            rate: vec![0.0; self.plan.unknowns],
            loading: Loading {
                factors: Vec::with_capacity(self.model.loads.len()),
                pressures: Vec::with_capacity(self.model.pressures.len()),
                ..Loading::default()
            },
            forces: self.forces.clone(),
            gaps: vec![0.0; self.system.multipliers()],
            last: vec![Vec6::zeros(); self.increments.len()],
            driven: self.model.held.iter().any(|held| held.motion.is_some()),
            weight: self.length * self.length,
        }
    }

    /// With a in `r`: puts a + δt b there, and loads and held motion at the new time, which it returns.
    ///
    /// # Errors
    /// [`Failure::Bend`] where the line of corrections misses the arc, [`Failure::Idle`] where nothing changes with the time.
    pub(super) fn close(&mut self, state: &State, to: f64, condition: Condition) -> Result<f64, Failure> {
        let Some(mut path) = self.path.take() else { return Err(Failure::Idle { time: to }) };
        self.rate(&mut path, state, to);
        self.solver.solve(&mut path.rate);
        self.solves += 1;
        path.forces.multipliers.shift(&mut path.rate[self.plan.directions.len()..]);
        let idle = path.rate.iter().all(|&b| b == 0.0);
        let dt = match condition {
            _ if idle => None,
            Condition::Arc(length) => self.on_arc(&path, length),
            Condition::Motion { node, dof, by } => {
                let row = self.plan.dofs.row(node, dof);
                row.map(|row| (by - self.increments[node].q[dof] - self.r[row]) / path.rate[row])
            }
        };
        if let Some(dt) = dt {
            self.r.iter_mut().zip(&path.rate).for_each(|(r, b)| *r += dt * b);
        }
        self.path = Some(path);
        match dt.map(|dt| to + dt).filter(|to| to.is_finite()) {
            Some(to) => {
                self.give(state.time, to, 1.0);
                Ok(to)
            }
            None if idle => Err(Failure::Idle { time: to }),
            None => Err(self.no_way()),
        }
    }

    /// ∂r/∂t at fixed unknowns: of the loads exactly; where held directions move, by differences, whose error only slows
    /// the iteration.
    fn rate(&mut self, path: &mut Path, state: &State, to: f64) {
        if path.driven {
            let h = 1e-6 * self.model.analysis.end_time;
            path.rate.fill(0.0);
            path.forces.multipliers.copy_from(&self.forces.multipliers);
            path.gaps.fill(0.0);
            for side in [1.0, -1.0] {
                self.give(state.time, to + side * h, 1.0);
                self.move_trial(state, &load_steps::coefficients());
                let now = Configuration { nodes: &self.trial, history: &state.history, dt: 0.0 };
                self.system.residual(&now, &self.given[2], &mut path.forces);
                for (rate, &(node, dof)) in path.rate.iter_mut().zip(&self.plan.directions) {
                    *rate += side * path.forces.on_nodes[node][dof] / (2.0 * h);
                }
                let gaps = path.gaps.iter_mut().zip(&path.forces.multipliers.gaps);
                gaps.for_each(|(rate, gap)| *rate += side * gap / (2.0 * h));
            }
            path.forces.multipliers.gaps.copy_from_slice(&path.gaps);
            path.forces.multipliers.ask(&mut path.rate[self.plan.directions.len()..]);
            return;
        }
        self.drive.rates(to, &mut path.loading);
        self.system.external(&self.trial, &path.loading, &mut path.forces);
        for (rate, &(node, dof)) in path.rate.iter_mut().zip(&self.plan.directions) {
            *rate = path.forces.on_nodes[node][dof];
        }
        // Loads alone do not open joints.
        path.rate[self.plan.directions.len()..].fill(0.0);
    }

    /// |D + a + δt b|² = ℓ²; `None`: no point of the line lies on the arc.
    fn on_arc(&self, path: &Path, length: f64) -> Option<f64> {
        let Products { DD, Da, Db, aa, ab, bb, ahead_b } = self.products(path);
        let (half, rest) = (Db + ab, DD + 2.0 * Da + aa - length * length);
        let discriminant = half * half - bb * rest;
        if discriminant.is_nan() || discriminant < 0.0 {
            return None;
        }
        // Both roots without cancellation: their product is rest/bb.
        let far = -(half + discriminant.sqrt().copysign(half));
        let roots = if far == 0.0 { [0.0, 0.0] } else { [far / bb, rest / far] };
        // The motion ahead is the larger the further δt goes with the sign of ahead·b.
        let [low, high] = [roots[0].min(roots[1]), roots[0].max(roots[1])];
        Some(if ahead_b >= 0.0 { high } else { low })
    }

    fn products(&self, path: &Path) -> Products {
        let mut sum = Products::default();
        let mut last_b = 0.0;
        for &node in &self.movers {
            let rows = self.plan.dofs.of(node);
            let D = self.unknown_part(node, &self.increments[node].q);
            let theta = bottom(&self.increments[node].q);
            let vector = |x: &[f64]| {
                let x = rows.gather(x);
                // As the correction will be added: δΘ = T⁻¹ δθ
                self.unknown_part(node, &join(&top(&x), &inverse_tangent(&theta, &bottom(&x))))
            };
            let (a, b) = (vector(&self.r), vector(&path.rate));
            sum.DD += path.dot(&D, &D);
            sum.Da += path.dot(&D, &a);
            sum.Db += path.dot(&D, &b);
            sum.aa += path.dot(&a, &a);
            sum.ab += path.dot(&a, &b);
            sum.bb += path.dot(&b, &b);
            last_b += path.dot(&path.last[node], &b);
        }
        sum.ahead_b = if sum.DD == 0.0 { last_b } else { sum.Db };
        sum
    }

    fn unknown_part(&self, node: usize, q: &Vec6) -> Vec6 {
        self.plan.dofs.of(node).mask(q)
    }

    /// The motion of the step that was found.
    pub(super) fn motion(&self) -> Motion {
        let Some(path) = &self.path else { return Motion { length: 0.0, cosine: 1.0, short: true } };
        let (mut along, mut last, mut now) = (0.0, 0.0, 0.0);
        for &node in &self.movers {
            let (D, L) = (self.unknown_part(node, &self.increments[node].q), &path.last[node]);
            along += path.dot(&D, L);
            last += path.dot(L, L);
            now += path.dot(&D, &D);
        }
        let short = now <= SHORT * SHORT * last;
        let cosine = if short || last == 0.0 { 1.0 } else { along / (last * now).sqrt() };
        Motion { length: now.sqrt(), cosine, short }
    }

    /// The next step goes on along the motion that was found, unless that is too short to tell a direction.
    pub(super) fn keep_motion(&mut self, motion: &Motion) {
        let Some(mut path) = self.path.take() else { return };
        if !motion.short {
            for &node in &self.movers {
                path.last[node] = self.unknown_part(node, &self.increments[node].q);
            }
        }
        self.path = Some(path);
    }

    /// Goes back to a part of the motion that was found, to begin the search for a point on the way.
    pub(super) fn shorten(&mut self, state: &State, part: f64) {
        for &node in &self.movers {
            self.increments[node].q *= part;
        }
        let values = self.forces.multipliers.values.iter_mut().zip(&state.multipliers);
        values.for_each(|(value, start)| *value = start + part * (*value - start));
    }

    /// Where no equilibrium is found at the length of the step.
    pub(super) fn no_way(&mut self) -> Failure {
        self.gather(&Scale::default());
        Failure::Bend { largest: failure::largest(self.model, self.plan, &self.r) }
    }
}
