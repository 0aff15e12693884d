//! The end of an implicit step: from the instant where equilibrium is written to the end of the step, onto the
//! constraints, into the state.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::list::Guards;
use crate::step::commit::{Account, commit};
use crate::step::predict::move_trial;
use crate::step::projection::ConstraintProjection;
use crate::step::trial::{Stage, Step};
use crate::step::work::WorkQuadrature;
use crate::system::contact_work;
use crate::workspace::Workspace;
use mechanics::state::State;

/// Accepts the equilibrium that was found: the state moves to the time `to`, written once. `work` holds the work of loads and damping by
/// quadrature over the stages; `None` uses the trapezoidal rule over the step.
///
/// # Errors
/// [`Failure::ConstraintsViolated`] if the joints cannot be closed at the end of the step, and the failures of the guards; `state` is
/// untouched.
pub fn accept(
    cx: &Context,
    ws: &mut Workspace,
    (guards, mut projection): (&mut Guards, Option<&mut ConstraintProjection>),
    state: &mut State,
    (stage, to): (&Stage, f64),
    work: Option<WorkQuadrature>,
) -> Result<(), Failure> {
    let step = Step { state, stage: *stage, to };
    let mut account = Account { work, ..account(cx, ws, &step) };
    ws.end.finish(cx, &ws.trial, step.state, stage);
    ws.end.advance(cx, step.state, &ws.prescribed.moved, stage.scheme.rotation);
    if let Some(projection) = projection.as_deref_mut().filter(|_| cx.is_dynamic()) {
        projection.project(cx, (&mut ws.end, ws.reach), step.state, (stage.scheme, step.dt()))?;
    }
    cx.system.recover(&mut ws.end.nodes);
    guards.ask(|guard| guard.at_end(cx, ws, &step, &account.dissipated))?;
    if !cx.is_dynamic() && cx.wants_forces {
        let (state, end) = (step.state, &ws.end.nodes[..]);
        if cx.system.has_contacts() {
            account.excess = contact_work::excess_of_mean(cx.system, state, (end, step.dt()), &mut ws.history);
        }
        if state.time == cx.model.analysis.begin {
            account.excess +=
                contact_work::excess_at_start(cx.model, cx.system, state, (end, &ws.loads.start), &ws.forces);
        }
    }
    commit(cx, ws, projection, state, (stage.scheme, to), account);
    Ok(())
}

/// Evaluates the forces and updates the history variables at the instant of equilibrium.
fn account(cx: &Context, ws: &mut Workspace, step: &Step) -> Account {
    let has_history = cx.system.history > 0;
    if cx.wants_forces || has_history {
        move_trial(cx, ws, step);
    } else {
        ws.trial.differentiate(cx, step.state, &step.stage);
    }
    let now = step.at_instant(&ws.trial.nodes);
    let mut account = Account { damping_power: Some(0.0), ..Account::default() };
    if cx.wants_forces {
        cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
        if cx.system.is_damped() && cx.is_dynamic() {
            account.damping_power = Some(cx.system.damping_power(&now, cx.plan.threads));
        }
    }
    if has_history {
        // Plastic strains are evaluated at the instant of equilibrium and extrapolated linearly to the end of the step. At the end itself
        // stiff parts are out of equilibrium and would yield from step to step.
        let ahead = 1.0 / step.stage.scheme.instant;
        account.dissipated = cx.system.update_history(&now, ahead, &mut ws.history, cx.plan.threads);
    }
    account
}
