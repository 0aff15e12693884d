//! A step whose load is unknown: equilibrium r(q, t) = 0 and one equation more. With K = −∂r/∂q each correction is
//!   δq = a + δt b,   K a = r,   K b = ∂r/∂t,
//! two substitutions with one factorization. The added equation gives δt exactly: the length of the motion |Δq + δq| = ℓ, without the load
//! (M. A. Crisfield, Comput. Struct. 13 (1981); E. Ramm, 1981), or a prescribed displacement. The arc length has two roots, and the one that
//! continues the path is used. At the start of a step it goes along the last step, whatever the sign of det K (Y. T. Feng et al., Eng.
//! Comput. 12 (1995)); afterwards it goes along the motion so far.

use crate::context::Context;
use crate::failure::Failure;
use crate::step::correct::Correction;
use crate::step::predict::{excite, move_trial};
use crate::step::progress::StepProgress;
use crate::step::residual::no_equilibrium;
use crate::step::trial::{Step, TrialMotion};
use crate::system::{Forces, Loading};
use crate::tolerances::arc_length_constraint::{DIFFERENCE, SHORT};
use crate::workspace::Workspace;
use base::math::rotation::inverse_tangent;
use base::math::{Vec6, angular, linear, stack};
use base::snapshot::keep;
use mechanics::state::Configuration;

/// The condition in place of a given time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// The motion of the step has this length.
    Arc(f64),
    /// One unknown translation moves by this in the step.
    Displacement { node: usize, dof: usize, by: f64 },
}

/// The condition of a step, with the equation that it adds.
pub struct PathCondition<'c> {
    /// The equation.
    pub constraint: &'c mut ArcLengthConstraint,
    /// The condition.
    pub condition: Condition,
}

impl PathCondition<'_> {
    /// Completes the correction such that it meets the condition, and moves the end of the step.
    ///
    /// # Errors
    /// [`Failure::NoEquilibriumOnArc`] and [`Failure::NoLoadIncrement`], as for [`ArcLengthConstraint::close`].
    pub fn close(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: &mut Step,
        progress: &mut StepProgress,
    ) -> Result<(), Failure> {
        step.to = self.constraint.close(cx, ws, step, self.condition)?;
        progress.move_time(cx, step.to);
        Ok(())
    }
}

/// The equation that determines the unknown time, with its data. It is allocated once.
pub struct ArcLengthConstraint {
    /// ∂r/∂t, then b, by unknown.
    rate: Vec<f64>,
    loading: Loading,
    forces: Forces,
    /// Derivative of the gaps of joints with respect to the time.
    gaps: Vec<f64>,
    /// Motion of the last step, by node.
    last: Vec<Vec6>,
    /// True where prescribed degrees of freedom move with the time.
    driven: bool,
    /// Square of the model's length: a rotation counts as a translation over it.
    weight: f64,
}

keep!(ArcLengthConstraint { rate, loading, forces, gaps, last } without { driven, weight });

/// The extent of a step.
pub struct StepMotion {
    /// Length of the motion of the step.
    pub length: f64,
    /// Cosine of the angle with the last step; 1 where there is none.
    pub cosine: f64,
    short: bool,
}

/// Scalar products of motions, with rotations as rotation vectors of the step: D is the motion so far, `ahead` the direction of the path.
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

impl ArcLengthConstraint {
    /// Room for the equation.
    pub fn new(cx: &Context, ws: &Workspace) -> ArcLengthConstraint {
        ArcLengthConstraint {
            rate: vec![0.0; cx.plan.dofs.unknowns()],
            loading: Loading {
                factors: Vec::with_capacity(cx.model.loading.nodal.len()),
                pressures: Vec::with_capacity(cx.model.loading.pressures.len()),
                squares: Vec::with_capacity(cx.model.loading.centrifugal.len()),
                ..Loading::default()
            },
            forces: ws.forces.clone(),
            gaps: vec![0.0; cx.system.multipliers()],
            last: vec![Vec6::zeros(); ws.trial.increments.len()],
            driven: cx.model.constraints.restraints.iter().any(|restraint| restraint.motion.is_some()),
            weight: cx.length * cx.length,
        }
    }

    /// Adds δt b to the correction a, evaluates loads and prescribed motion at the new time, and returns this time.
    ///
    /// # Errors
    /// [`Failure::NoEquilibriumOnArc`] if the line of corrections misses the arc. [`Failure::NoLoadIncrement`] if loads and supports do not
    /// change with time.
    fn close(&mut self, cx: &Context, ws: &mut Workspace, step: &Step, condition: Condition) -> Result<f64, Failure> {
        self.differentiate_residual(cx, ws, step);
        ws.matrix.solve_augmented(&self.forces.multipliers, &mut self.rate);
        ws.solves += 1;
        let unloaded = self.rate.iter().all(|&b| b == 0.0);
        let dt = match condition {
            _ if unloaded => None,
            Condition::Arc(length) => self.on_arc(cx, &ws.trial, &ws.correction, length),
            Condition::Displacement { node, dof, by } => {
                let row = cx.plan.dofs.row(node, dof);
                row.map(|row| (by - ws.trial.increments[node].q[dof] - ws.correction.values[row]) / self.rate[row])
            }
        };
        if let Some(dt) = dt {
            ws.correction.values.iter_mut().zip(&self.rate).for_each(|(r, b)| *r += dt * b);
        }
        match dt.map(|dt| step.to + dt).filter(|to| to.is_finite()) {
            Some(to) => {
                excite(cx, ws, step.state.time, to, 1.0);
                Ok(to)
            }
            None if unloaded => Err(Failure::NoLoadIncrement { time: step.to }),
            None => Err(no_equilibrium(cx, &ws.forces)),
        }
    }

    /// Writes ∂r/∂t at fixed unknowns, and the derivative of the gaps. It is exact for loads. For prescribed motion it is a difference
    /// quotient, whose error only slows the iteration.
    fn differentiate_residual(&mut self, cx: &Context, ws: &mut Workspace, step: &Step) {
        if self.driven {
            return self.difference_residual(cx, ws, step);
        }
        cx.excitation.rates(step.to, &mut self.loading);
        cx.system.external(&ws.trial.nodes, &self.loading, &mut self.forces);
        // Loads alone do not open joints.
        self.forces.multipliers.gaps.fill(0.0);
        for (rate, &(node, dof)) in self.rate.iter_mut().zip(cx.plan.dofs.nodal_dofs()) {
            *rate = self.forces.on_nodes[node][dof];
        }
    }

    fn difference_residual(&mut self, cx: &Context, ws: &mut Workspace, step: &Step) {
        let h = DIFFERENCE * cx.model.analysis.end_time;
        self.rate.fill(0.0);
        self.forces.multipliers.copy_from(&ws.forces.multipliers);
        self.gaps.fill(0.0);
        for side in [1.0, -1.0] {
            excite(cx, ws, step.state.time, step.to + side * h, 1.0);
            move_trial(cx, ws, step);
            let now = Configuration { dt: 0.0, ..step.at_instant(&ws.trial.nodes) };
            cx.system.residual(&now, &ws.loads.instant, &mut self.forces);
            for (rate, &(node, dof)) in self.rate.iter_mut().zip(cx.plan.dofs.nodal_dofs()) {
                *rate += side * self.forces.on_nodes[node][dof] / (2.0 * h);
            }
            let gaps = self.gaps.iter_mut().zip(&self.forces.multipliers.gaps);
            gaps.for_each(|(rate, gap)| *rate += side * gap / (2.0 * h));
        }
        self.forces.multipliers.gaps.copy_from_slice(&self.gaps);
    }

    /// Solves |D + a + δt b|² = ℓ² for δt; `None` where no point of the line lies on the arc.
    fn on_arc(&self, cx: &Context, trial: &TrialMotion, correction: &Correction, length: f64) -> Option<f64> {
        let Products { DD, Da, Db, aa, ab, bb, ahead_b } = self.products(cx, trial, correction);
        let (half, rest) = (Db + ab, DD + 2.0 * Da + aa - length * length);
        let discriminant = half * half - bb * rest;
        if discriminant.is_nan() || discriminant < 0.0 {
            return None;
        }
        // Both roots are computed without cancellation: their product is rest/bb.
        let far = -(half + discriminant.sqrt().copysign(half));
        let roots = if far == 0.0 { [0.0, 0.0] } else { [far / bb, rest / far] };
        // Of the two roots, the one farther along the sign of ahead·b moves farther ahead.
        let [low, high] = [roots[0].min(roots[1]), roots[0].max(roots[1])];
        Some(if ahead_b >= 0.0 { high } else { low })
    }

    fn products(&self, cx: &Context, trial: &TrialMotion, correction: &Correction) -> Products {
        let mut sum = Products::default();
        let mut last_b = 0.0;
        for &node in &cx.independent_nodes {
            let rows = cx.plan.dofs.of(node);
            let D = unknown_part(cx, node, &trial.increments[node].q);
            let theta = angular(&trial.increments[node].q);
            let vector = |x: &[f64]| {
                let x = rows.gather(x);
                // The correction is added as δΘ = T⁻¹ δθ.
                unknown_part(cx, node, &stack(&linear(&x), &inverse_tangent(&theta, &angular(&x))))
            };
            let (a, b) = (vector(&correction.values), vector(&self.rate));
            sum.DD += self.dot(&D, &D);
            sum.Da += self.dot(&D, &a);
            sum.Db += self.dot(&D, &b);
            sum.aa += self.dot(&a, &a);
            sum.ab += self.dot(&a, &b);
            sum.bb += self.dot(&b, &b);
            last_b += self.dot(&self.last[node], &b);
        }
        sum.ahead_b = if sum.DD == 0.0 { last_b } else { sum.Db };
        sum
    }

    fn dot(&self, x: &Vec6, y: &Vec6) -> f64 {
        linear(x).dot(&linear(y)) + self.weight * angular(x).dot(&angular(y))
    }

    /// True if loads grow along the path at the end of the step.
    pub fn loads_grow(&self, cx: &Context, trial: &TrialMotion) -> bool {
        let mut along = 0.0;
        for &node in &cx.independent_nodes {
            let rate = cx.plan.dofs.of(node).gather(&self.rate);
            along += self.dot(&unknown_part(cx, node, &trial.increments[node].q), &unknown_part(cx, node, &rate));
        }
        along >= 0.0
    }

    /// The extent of the step that was found.
    pub fn motion(&self, cx: &Context, trial: &TrialMotion) -> StepMotion {
        let (mut along, mut last, mut now) = (0.0, 0.0, 0.0);
        for &node in &cx.independent_nodes {
            let (D, L) = (unknown_part(cx, node, &trial.increments[node].q), &self.last[node]);
            along += self.dot(&D, L);
            last += self.dot(L, L);
            now += self.dot(&D, &D);
        }
        let short = now <= SHORT * SHORT * last;
        let cosine = if short || last == 0.0 { 1.0 } else { along / (last * now).sqrt() };
        StepMotion { length: now.sqrt(), cosine, short }
    }

    /// Keeps the motion that was found as the direction of the next step, unless it is too short to show one.
    pub fn keep_motion(&mut self, cx: &Context, trial: &TrialMotion, motion: &StepMotion) {
        if motion.short {
            return;
        }
        for &node in &cx.independent_nodes {
            self.last[node] = unknown_part(cx, node, &trial.increments[node].q);
        }
    }
}

fn unknown_part(cx: &Context, node: usize, q: &Vec6) -> Vec6 {
    cx.plan.dofs.of(node).mask(q)
}
