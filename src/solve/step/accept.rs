//! The end of an implicit step: from the instant where equilibrium is written to the end of the step, onto the
//! constraints, into the state.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::jump;
use crate::guards::{contacts, joints, links};
use crate::step::commit::{Account, commit};
use crate::step::projection::ConstraintProjection;
use crate::step::trial::{Stage, differentiate, finish, move_to_step_end, move_trial};
use crate::step::work::WorkQuadrature;
use crate::system::contact_work;
use crate::workspace::Workspace;
use mechanics::state::{Configuration, State};

/// Accepts the equilibrium that was found: the state moves to the time `to`, written once. `work` is that of loads and damping where the
/// stages of the step tell it better than its ends.
///
/// # Errors
/// [`Failure::ConstraintsViolated`] where joints cannot be closed at the end of the step, [`Failure::ContactNotResolved`] where something would have gone
/// through a surface there, [`Failure::BushingTurnedOver`] or [`Failure::BushingTurnsTooFar`] where a bushing has lost count of its turns, [`Failure::EquilibriumJumps`] where a load step does not end on the path that it began on; `state` is untouched.
pub fn accept(
    cx: &Context,
    ws: &mut Workspace,
    mut projection: Option<&mut ConstraintProjection>,
    state: &mut State,
    stage: &Stage,
    to: f64,
    work: Option<WorkQuadrature>,
) -> Result<(), Failure> {
    let dt = to - state.time;
    let mut account = Account { work, ..account(cx, ws, state, stage, dt) };
    finish(cx, ws, state, stage);
    move_to_step_end(cx, ws, state, stage.scheme);
    if let Some(projection) = projection.as_deref_mut().filter(|_| cx.is_dynamic()) {
        projection.project(cx, ws, state, stage.scheme, dt)?;
    }
    if stage.scheme.instant != 1.0 {
        contacts::check_passage(cx, ws, state, dt)?;
    }
    joints::check(cx, ws)?;
    links::check(cx, ws, state, dt)?;
    jump::check_work(cx, ws, state, &account.dissipated, to)?;
    if !cx.is_dynamic() && cx.system.has_contacts() && cx.wants_forces {
        account.contact_excess = contact_work::excess_of_mean(cx.system, state, (&ws.trial, dt), &mut ws.history);
    }
    commit(cx, ws, projection, state, (stage.scheme, to), account);
    Ok(())
}

/// Evaluates the forces and updates the history variables at the instant of equilibrium.
fn account(cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage, dt: f64) -> Account {
    let has_history = cx.system.history > 0;
    if cx.wants_forces || has_history {
        move_trial(cx, ws, state, stage);
    } else {
        differentiate(cx, ws, state, stage);
    }
    let now = Configuration { nodes: &ws.trial, history: &state.history, dt: stage.scheme.instant * dt, lead: None };
    let mut account = Account { damping_power: Some(0.0), ..Account::default() };
    if cx.wants_forces {
        cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
        if cx.system.is_damped() && cx.is_dynamic() {
            account.damping_power = Some(cx.system.damping_power(&now, cx.plan.threads));
        }
    }
    if has_history {
        // Plastic strains, like reactions, are taken where equilibrium is written and extrapolated linearly to the end
        // of the step: at the end itself stiff parts are not in equilibrium, and would yield from step to step.
        account.dissipated =
            cx.system.update_history(&now, 1.0 / stage.scheme.instant, &mut ws.history, cx.plan.threads);
    }
    account
}
