//! Modes about the state at the end of a run; where that is the state at its start, no load steps lead to it.

use super::control::{Controller, Schedule};
use super::failure::Failure;
use super::march::March;
use super::outcome::Outcome;
use super::recorder::AcceptedStep;
use super::report::StepReport;
use super::warning::Warning;
use crate::model::ModeKind;
use crate::modes::{Linearized, ModesFault, find, multipliers_at_rest};
use crate::system::Side;

/// Leads a run to its end, and shows the modes about the state there where the model asks for them.
///
/// # Errors
/// The outcome that ends it early.
pub fn lead(controller: &mut Controller, march: &mut March, schedule: &Schedule) -> Result<(), Outcome> {
    let Some(asked) = &march.cx.model.analysis.modes else { return controller.run(march, schedule) };
    // Loads of buckling are factors of modes, and bring nothing on before.
    if asked.kind == ModeKind::Buckling || rests(march) {
        let report = &StepReport::begin(0.0);
        march.notify(&AcceptedStep {
            dt: 0.0,
            report,
            cuts: 0,
            due: true,
            compared: false,
            last: true,
            passed: &[],
        })?;
    } else {
        controller.run(march, schedule)?;
    }
    march.check_stop()?;
    show(march)
}

/// True where supports and joints carry all loads, and nothing moves; the state then is that at the end of the run.
fn rests(march: &mut March) -> bool {
    let March { cx, ws, state, .. } = march;
    let end = cx.model.analysis.end_time;
    cx.excitation.loading(end, Side::Before, &mut ws.loads.instant);
    let at = Linearized { model: cx.model, system: cx.system, plan: cx.plan, state, loading: &ws.loads.instant };
    let moved = cx.model.constraints.restraints.iter().any(|restraint| restraint.motion.is_some());
    let linear = (&mut ws.matrix.solver, &mut ws.matrix.assembly);
    let Some(multipliers) = (if moved { None } else { multipliers_at_rest(&at, linear) }) else { return false };
    state.multipliers.copy_from_slice(&multipliers);
    state.time = end;
    true
}

/// Finds the modes about the state and shows them.
fn show(march: &mut March) -> Result<(), Outcome> {
    let March { cx, ws, state, .. } = march;
    cx.excitation.loading(cx.model.analysis.end_time, Side::Before, &mut ws.loads.instant);
    if cx.model.analysis.modes.as_ref().is_some_and(|asked| asked.damped) {
        // Bodies spin about the equilibrium as they do at t = 0.
        for (node, given) in state.nodes.iter_mut().zip(&cx.model.nodes) {
            node.omega = given.omega;
        }
    }
    let at = Linearized { model: cx.model, system: cx.system, plan: cx.plan, state, loading: &ws.loads.instant };
    let found = find(&at, (&mut ws.matrix.solver, &mut ws.matrix.assembly));
    let modes = found.map_err(|fault: ModesFault| march.failed(Failure::Modes(fault)))?;
    if !modes.doubts.is_empty() {
        march.ws.warnings.add(Warning::Modes(modes.doubts.join("; ")));
    }
    let fastest = (1..).zip(&modes.list).max_by(|(_, a), (_, b)| a.root[0].total_cmp(&b.root[0]));
    if let (Some((fastest, mode)), true) = (fastest, modes.unstable > 0) {
        march.ws.warnings.add(Warning::Grows { modes: modes.unstable, rate: mode.root[0], fastest });
    }
    march.ws.factorizations += modes.factorizations;
    march.ws.solves += modes.solves;
    let March { cx, ws, state, recorder, observer, .. } = march;
    recorder.notify_modes(cx, ws, state, *observer, &modes)
}
