//! Modes about the state at the end of a run; no load steps precede if this is the initial state.

use super::context::Context;
use super::control::{Controller, Schedule};
use super::failure::Failure;
use super::march::March;
use super::outcome::Outcome;
use super::recorder::AcceptedStep;
use super::report::StepReport;
use super::warning::Warning;
use crate::linear_statics;
use crate::modes::{Linearized, Modes, ModesFault, ResponseProgress, find, multipliers_at_rest, own_stiffnesses};
use crate::system::{Loading, Side};
use crate::tolerances::modes_at_end::{BALANCED, ROUNDING};
use model::PrescribedMotion;

/// The interval of a run that has come to the state of its modes.
const AT_ITS_END: usize = usize::MAX;

/// Completes a run, and shows the modes about its final state if the model requires them.
///
/// # Errors
/// The outcome that ends it early.
pub fn run(controller: &mut Controller, march: &mut March, schedule: &Schedule) -> Result<(), Outcome> {
    let analysis = &march.cx.model.analysis;
    if analysis.is_linear() {
        return linear_statics::lead(march, schedule);
    }
    if !analysis.has_modes() {
        return controller.run(march, schedule);
    }
    // A stage of modes uses the current state; buckling loads are scaled by the factors of modes, so they are not applied before.
    if analysis.stage.is_none() && march.place.interval < AT_ITS_END {
        if analysis.buckles() || rests(march) {
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
    }
    march.place.interval = AT_ITS_END;
    loop {
        march.pause(controller)?;
        match show(march, controller) {
            // A checkpoint is due, or a signal requires one.
            Err(Outcome::Stopped { .. }) => {}
            shown => return shown,
        }
    }
}

/// The loads of the state, and the loads scaled by buckling factors: all loads, or in a stage the loads that begin there.
fn loads(cx: &Context) -> [Loading; 2] {
    let (model, mut base) = (cx.model, Loading::default());
    cx.excitation.loading(model.analysis.end_time, Side::Before, &mut base);
    let nothing = base.plus(-1.0, &base);
    if !model.analysis.buckles() {
        return [base, nothing];
    }
    let Some(stage) = &model.analysis.stage else { return [nothing, base] };
    let mut factored = base.clone();
    let is_factored = |amplitude: Option<usize>| amplitude == Some(stage.own_amplitude);
    *(if is_factored(model.loading.gravity_amplitude) { &mut base.field } else { &mut factored.field }) = nothing.field;
    let nodal = model.loading.nodal.iter().map(|load| load.amplitude);
    let pressures = model.loading.pressures.iter().map(|load| load.amplitude);
    let each = base.factors.iter_mut().zip(&mut factored.factors).zip(nodal);
    let turning = model.loading.centrifugal.iter().map(|load| load.amplitude);
    let each = each.chain(base.pressures.iter_mut().zip(&mut factored.pressures).zip(pressures));
    let each = each.chain(base.squares.iter_mut().zip(&mut factored.squares).zip(turning));
    for ((base, factored), amplitude) in each {
        *(if is_factored(amplitude) { base } else { factored }) = 0.0;
    }
    [base, factored]
}

/// True if supports and joints carry all loads and nothing moves; the state then becomes the final state of the run.
fn rests(march: &mut March) -> bool {
    let March { cx, ws, state, stop, .. } = march;
    let end = cx.model.analysis.end_time;
    let [loading, factored] = &loads(cx);
    let at = Linearized { model: cx.model, system: cx.system, plan: cx.plan, state, loading, factored, stop };
    let amplitudes = &cx.model.loading.amplitudes;
    let moves = |motion: &PrescribedMotion| amplitudes[motion.amplitude].harmonic_phase().is_none();
    let moved = cx.model.constraints.restraints.iter().any(|restraint| restraint.motion.as_ref().is_some_and(moves));
    let linear = (&mut ws.matrix.solver, &mut ws.matrix.assembly);
    let Some(multipliers) = (if moved { None } else { multipliers_at_rest(&at, linear) }) else { return false };
    state.multipliers.copy_from_slice(&multipliers);
    state.time = end;
    true
}

/// The largest residual force relative to the largest force, in a state reached by a stage; `None` if it is in equilibrium, and in a deck
/// without stages.
fn unbalanced(march: &mut March, loading: &Loading) -> Option<f64> {
    let March { cx, ws, state, stop, .. } = march;
    cx.model.analysis.stage.as_ref()?;
    ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
    let scale = cx.system.residual(&state.configuration(), loading, &mut ws.forces);
    let moment = scale.moment_beside_forces(cx.length);
    let left = |&(node, dof): &(usize, usize)| ws.forces.on_nodes[node][dof].abs();
    let part = |of: &(usize, usize)| match left(of) {
        0.0 => 0.0,
        left => left / if of.1 < 3 { scale.force } else { moment },
    };
    let all = cx.plan.dofs.nodal_dofs();
    let most = all.iter().map(part).fold(0.0, f64::max);
    if most <= BALANCED {
        return None;
    }
    let at = Linearized { model: cx.model, system: cx.system, plan: cx.plan, state, loading, factored: loading, stop };
    let stiffness = own_stiffnesses(&at, (&mut ws.matrix.solver, &mut ws.matrix.assembly));
    let reach = state.nodes.iter().map(|node| node.x.amax()).fold(0.0, f64::max);
    let [force, moment] = loads_at_full_size(cx, reach);
    let is_rounding = |(of, own): (&(usize, usize), &f64)| {
        left(of) <= ROUNDING * if of.1 < 3 { own * reach + force } else { own + moment }
    };
    (!all.iter().zip(&stiffness).all(is_rounding)).then_some(most)
}

/// The sums of the forces and of the moments of all loads on nodes, whatever of them acts, arms being no longer than `reach`.
fn loads_at_full_size(cx: &Context, reach: f64) -> [f64; 2] {
    let loads = &cx.model.loading.nodal;
    let force: f64 = loads.iter().map(|load| load.force.norm()).sum();
    let moment: f64 = loads.iter().map(|load| load.moment.norm()).sum();
    [force, moment + reach * force]
}

/// Finds the modes about the state and shows them.
///
/// # Errors
/// [`Outcome::Stopped`] if the search is interrupted; the computed part of a response is kept.
fn show(march: &mut March, controller: &mut Controller) -> Result<(), Outcome> {
    let [loading, factored] = &loads(march.cx);
    let left = unbalanced(march, loading);
    let March { cx, ws, state, stop, observer, .. } = march;
    if cx.model.analysis.damps_modes() {
        // Bodies spin about the equilibrium as they do at t = 0.
        for (node, given) in state.nodes.iter_mut().zip(&cx.model.nodes) {
            node.omega = given.omega;
        }
    }
    let at = Linearized { model: cx.model, system: cx.system, plan: cx.plan, state, loading, factored, stop };
    let progress = ResponseProgress { so_far: &mut ws.response, pauses: &mut || observer.wants_checkpoint(false) };
    let found = find(&at, (&mut ws.matrix.solver, &mut ws.matrix.assembly), progress);
    let mut modes = found.map_err(|fault| match fault {
        ModesFault::Stopped => Outcome::stopped(march.state.time),
        fault => march.failed(Failure::Modes(fault)),
    })?;
    modes.warnings.extend(left.map(|left| {
        format!(
            "the state is not in equilibrium: {left:.1e} of the forces is out of balance, so the modes are those of a passing state. Let a static \
             stage find the equilibrium first (`[[stages]]`)"
        )
    }));
    if march.place.step > 0 {
        // They have been shown before a checkpoint.
        return show_response(march, controller, modes);
    }
    if !modes.warnings.is_empty() {
        march.ws.warnings.add(Warning::Modes(modes.warnings.join("; ")));
    }
    let fastest = (1..).zip(&modes.list).max_by(|(_, a), (_, b)| a.root[0].total_cmp(&b.root[0]));
    if let (Some((fastest, mode)), true) = (fastest, modes.unstable > 0) {
        march.ws.warnings.add(Warning::Grows { modes: modes.unstable, rate: mode.root[0], fastest });
    }
    march.ws.factorizations += modes.factorizations;
    march.ws.solves += modes.solves;
    let March { cx, ws, state, recorder, observer, place, .. } = march;
    recorder.notify_modes(cx, ws, state, *observer, &modes)?;
    place.step = 1;
    show_response(march, controller, modes)
}

/// Shows the rows of a response that have not been shown, with a pause now and then; the place tells how many have.
fn show_response(march: &mut March, controller: &mut Controller, mut modes: Modes) -> Result<(), Outcome> {
    /// Rows between two pauses.
    const ROWS: usize = 256;
    let mut rows = modes.response.as_mut().map_or_else(Vec::new, |response| std::mem::take(&mut response.rows));
    while march.place.step <= rows.len() {
        // A checkpoint includes the rows computed so far.
        std::mem::swap(&mut march.ws.response.rows, &mut rows);
        let paused = march.pause(controller);
        std::mem::swap(&mut march.ws.response.rows, &mut rows);
        paused?;
        let begin = march.place.step - 1;
        let shown = begin..(begin + ROWS).min(rows.len());
        let March { cx, ws, state, recorder, observer, place, .. } = march;
        place.step = 1 + shown.end;
        if let Some(response) = &mut modes.response {
            std::mem::swap(&mut response.rows, &mut rows);
        }
        recorder.notify_response(cx, ws, state, *observer, (&modes, shown))?;
        if let Some(response) = &mut modes.response {
            std::mem::swap(&mut response.rows, &mut rows);
        }
    }
    Ok(())
}
