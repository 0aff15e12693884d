//! The end of a step: multipliers and reactions extrapolated to it, work accounted for, the state written once.

use crate::context::Context;
use crate::node_chunks::{NodeChunk, Nothing};
use crate::step::projection::ConstraintProjection;
use crate::step::work::WorkQuadrature;
use crate::system::TurningBody;
use crate::workspace::Workspace;
use base::math::rotation::rates;
use base::math::{Vec6, angular, linear, stack};
use mechanics::integrators::Coefficients;
use mechanics::materials::Dissipation;
use mechanics::state::State;

/// The energies of a step for the balance of work.
#[derive(Default)]
pub struct Account {
    /// Energy dissipated by materials and contacts.
    pub dissipated: Dissipation,
    /// Power of viscous damping at the instant of equilibrium; `None` where the caller accounts for work itself.
    pub damping_power: Option<f64>,
    /// Work of loads and damping by quadrature over the stages; `None`: by the trapezoidal rule over the step.
    pub work: Option<WorkQuadrature>,
    /// Excess of the trapezoidal rule in the work of a load step: contacts close or open within it, or its start is out of balance.
    pub excess: f64,
}

/// Makes the motion at the end of the step the state at the time `to`.
pub fn commit(
    cx: &Context,
    ws: &mut Workspace,
    projection: Option<&mut ConstraintProjection>,
    state: &mut State,
    (scheme, to): (&Coefficients, f64),
    account: Account,
) {
    let dt = to - state.time;
    if cx.is_dynamic() {
        let (nodes, ends) = (&state.nodes, &ws.end.nodes);
        cx.chunks.run(&mut state.jerk[..], &|chunk: &NodeChunk, jerk: &mut [Vec6]| {
            for &node in &cx.independent_nodes[chunk.independent.clone()] {
                let (start, end) = (&nodes[node], &ends[node]);
                jerk[node - chunk.nodes.start] = stack(&(end.a - start.a), &(end.alpha - start.alpha)) / dt;
            }
            Nothing
        });
    }
    update_algorithmic_accelerations(cx, ws, state);
    state.work.material += account.dissipated;
    state.work.external -= account.excess;
    for (old, value) in state.multipliers.iter_mut().zip(&ws.forces.multipliers.values) {
        *old += (value - *old) / scheme.instant;
    }
    let mut reaction_changes: &[f64] = &[];
    if let Some(projection) = projection {
        projection.carry_multipliers(&mut state.multipliers);
        projection.distribute_multipliers(cx, &ws.end.nodes, state);
        reaction_changes = projection.reaction_changes();
    }
    if let Some(damping_power) = account.damping_power.filter(|_| cx.wants_forces) {
        let before = state.work;
        let driven = update_reactions_and_work(cx, ws, state, (scheme, dt), damping_power, reaction_changes);
        if let Some(work) = account.work {
            (state.work.external, state.work.damping) = (before.external, before.damping);
            work.add_to(&mut state.work);
            if !cx.numbers.is_empty() {
                // The reaction of a driven joint within a stage includes the error of the accelerations there. At the end of a step the
                // accelerations are projected, so the trapezoidal rule is of second order.
                state.work.external += driven;
            }
        }
    }
    if cx.system.history > 0 {
        std::mem::swap(&mut state.history, &mut ws.history);
    }
    std::mem::swap(&mut state.nodes, &mut ws.end.nodes);
    state.time = to;
    cx.system.remember_joint_loads(state, dt);
    ws.note_slip(cx, state, dt);
}

/// Like [`commit`], for explicit steps: their trial motion already lies at the end of the step.
pub fn commit_trial(
    cx: &Context,
    ws: &mut Workspace,
    projection: Option<&mut ConstraintProjection>,
    state: &mut State,
    end: (&Coefficients, f64),
    account: Account,
) {
    std::mem::swap(&mut ws.trial, &mut ws.end);
    commit(cx, ws, projection, state, end, account);
    std::mem::swap(&mut ws.trial, &mut ws.end);
}

/// Updates the algorithmic accelerations of schemes that have them.
fn update_algorithmic_accelerations(cx: &Context, ws: &Workspace, state: &mut State) {
    let Some([of_a, of_start, of_end]) = cx.algorithmic_acceleration else { return };
    let mut bodies = cx.system.turning_bodies().iter().peekable();
    for &node in &cx.independent_nodes {
        let (start, end, increment) = (&state.nodes[node], &ws.end.nodes[node], &ws.end.increments[node]);
        let before = stack(&start.a, &start.alpha);
        // The combination applies to the second derivative of the rotation vector of the step, or to the rates of a body's angular
        // momentum. It is stored as a spatial vector like every other acceleration.
        let old = state.algorithmic_accelerations[node];
        let a = old * of_a + before * of_start + increment.dd * of_end;
        let turn = match TurningBody::next_at(&mut bodies, node) {
            Some(body) => {
                body.combine([(start, angular(&old), of_a), (start, start.alpha, of_start), (end, end.alpha, of_end)])
            }
            None => rates(&angular(&increment.q), &angular(&increment.d), &angular(&a)).1,
        };
        state.algorithmic_accelerations[node] = stack(&linear(&a), &turn);
    }
}

/// Updates reactions and work. Reactions and damping power are evaluated at the instant of equilibrium and extrapolated linearly to the end
/// of the step, because stiff parts are out of equilibrium there. Returns the work on prescribed motion.
fn update_reactions_and_work(
    cx: &Context,
    ws: &Workspace,
    state: &mut State,
    (scheme, dt): (&Coefficients, f64),
    damping_power: f64,
    reaction_changes: &[f64],
) -> f64 {
    let mut driven = 0.0;
    let extrapolate = |old: f64, at_instant: f64| old + (at_instant - old) / scheme.instant;
    for (i, restraint) in cx.model.constraints.restraints.iter().enumerate() {
        let old = state.reactions[i];
        let at_instant = -ws.forces.on_nodes[restraint.node][restraint.dof];
        let new = extrapolate(old, at_instant) + reaction_changes.get(i).unwrap_or(&0.0);
        let moved = ws.prescribed.moved[i].u;
        let work = 0.5 * (old + new) * moved;
        state.work.external += work;
        driven += work;
        state.reactions[i] = new;
    }
    state.work.external += cx.system.external_work((&state.nodes, &ws.loads.start), (&ws.end.nodes, &ws.loads.end));
    let carrying = cx.system.carrying_power(&state.nodes) + cx.system.carrying_power(&ws.end.nodes);
    state.work.external += 0.5 * dt * carrying;
    let old = state.work.damping_power;
    let new = extrapolate(old, damping_power);
    state.work.damping += 0.5 * dt * (old + new);
    state.work.damping_power = new;
    driven
}
