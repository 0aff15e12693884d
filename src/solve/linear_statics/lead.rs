//! A linear analysis: factorizes once, then solves for each case or time and shows it.

use super::derivatives::{AskedResults, Derivatives};
use super::equations::{LinearEquations, LinearSolution};
use super::instants::{Instant, instants};
use super::yielding::{needs, warn_beyond_yield};
use crate::control::Schedule;
use crate::derived::Derived;
use crate::failure::Failure;
use crate::frame::ShownCase;
use crate::guards::strain::look_at_beams;
use crate::march::March;
use crate::outcome::Outcome;
use crate::recorder::AcceptedStep;
use crate::report::StepReport;
use crate::system::Loading;
use crate::tolerances::linear_statics::LARGE_ROTATION;
use base::math::angular;
use mechanics::integrators::RotationUpdate;
use mechanics::state::{Increment, Node};
use std::sync::atomic::Ordering;

/// Leads a linear run to its end.
///
/// # Errors
/// The outcome that ends it early.
pub fn lead(march: &mut March, schedule: &Schedule) -> Result<(), Outcome> {
    let all = instants(march.cx, schedule);
    if march.cx.model.cases.list.is_empty() {
        march.notify_start()?;
    }
    let equations = LinearEquations::new(march.cx, march.ws, march.state);
    let mut equations = equations.map_err(|failure| march.failed(failure))?;
    let mut derivatives = Derivatives::new(march.cx, march.state);
    let (mut solution, mut loading, mut prescribed) = (LinearSolution::default(), Loading::default(), Vec::new());
    let mut factorizations = 1;
    for (index, instant) in all.iter().enumerate() {
        if march.stop.load(Ordering::Relaxed) {
            return Err(march.failed(Failure::Stopped));
        }
        instant.excite(march.cx, &mut loading, &mut prescribed);
        equations.solve(march.cx, march.ws, (&loading, &prescribed), &mut solution);
        take(march, &equations.nodes, &solution, instant);
        warn_of_rotation(march, &solution);
        let (iterations, to) = (1, instant.time);
        let report = &StepReport { iterations, factorizations, ..StepReport::begin(to) };
        let (due, compared, last) = (instant.due, instant.compared, index + 1 == all.len());
        let step = AcceptedStep { dt: instant.time, report, cuts: 0, due, compared, last, passed: &[] };
        let name = instant.case.map(|case| (case, march.cx.model.cases.list[case].name.as_str()));
        let case = ShownCase { name, motions: &solution.motions };
        let March { cx, ws, state, recorder, observer, .. } = march;
        let compute = &mut |asked: &AskedResults, derived: &mut Derived| {
            derivatives.compute(cx, &equations.nodes, (&solution, &loading), asked, derived);
        };
        let found = recorder.notify_case((cx, ws, state), *observer, (&step, case), (needs(cx.model), compute))?;
        warn_beyond_yield(cx.model, found, &mut ws.warnings);
        look_at_beams(cx.model, &found.sections, &mut ws.warnings);
        factorizations = 0;
    }
    Ok(())
}

/// Makes a solution the state.
fn take(march: &mut March, nodes: &[Node], solution: &LinearSolution, instant: &Instant) {
    let state = &mut *march.state;
    state.time = instant.time;
    for ((node, start), motion) in state.nodes.iter_mut().zip(nodes).zip(&solution.motions) {
        let increment = Increment { q: *motion, ..Increment::ZERO };
        node.advance(start, &increment, RotationUpdate::Exponential);
    }
    state.reactions.copy_from_slice(&solution.reactions);
    state.multipliers.copy_from_slice(&solution.multipliers);
    state.work.external = solution.work;
}

/// Warns of a rotation at which a linear analysis is no longer the answer.
fn warn_of_rotation(march: &mut March, solution: &LinearSolution) {
    let cx = march.cx;
    let turns = solution.motions.iter().enumerate().map(|(node, motion)| (node, angular(motion).norm()));
    let Some((node, turn)) = turns.max_by(|a, b| a.1.total_cmp(&b.1)) else { return };
    if turn > LARGE_ROTATION {
        let label = cx.model.nodes[node].label.clone();
        march.ws.warnings.large_rotation(&label, turn);
    }
}
