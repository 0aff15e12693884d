//! The start of a step: its loads, prescribed motion and prediction, and the update of the trial motion from the increments.

use crate::context::Context;
use crate::step::trial::{Step, reach};
use crate::system::{Prescribed, Side, between};
use crate::workspace::Workspace;

/// Evaluates loads and prescribed motion at the ends of the step, and at the instant of equilibrium by interpolation or
/// extrapolation from the ends.
pub fn excite(cx: &Context, ws: &mut Workspace, from: f64, to: f64, instant: f64) {
    let loads = &mut ws.loads;
    cx.excitation.loading(from, Side::After, &mut loads.start);
    cx.excitation.loading(to, Side::Before, &mut loads.end);
    if let Some(sudden) = &ws.load_steps.sudden {
        sudden.bring_on(from, &mut loads.start);
        sudden.bring_on(to, &mut loads.end);
    }
    between(&loads.start, &loads.end, instant, &mut loads.instant);
    let prescribed = &mut ws.prescribed;
    cx.excitation.prescribed(from, Side::After, &mut prescribed.start);
    cx.excitation.prescribed(to, Side::Before, &mut prescribed.end);
    cx.excitation.moved(&prescribed.start, &prescribed.end, &mut prescribed.moved);
    prescribed.instant.clear();
    prescribed.instant.extend(prescribed.start.iter().zip(&prescribed.moved).map(|(a, b)| Prescribed {
        u: instant * b.u,
        v: a.v + instant * (b.v - a.v),
        a: a.a + instant * (b.a - a.a),
    }));
    if instant > 1.0 {
        // The accelerations of parts joined to a prescribed motion follow from its positions, so positions and accelerations must be
        // consistent. Past the end of the step, linear extrapolation of positions would leave six sevenths of the acceleration out.
        let tau = instant * (to - from);
        for &i in &cx.driving {
            let (start, now) = (&prescribed.start[i], &mut prescribed.instant[i]);
            now.u = tau * start.v + tau * tau / 6.0 * (2.0 * start.a + now.a);
        }
    }
}

/// Writes the predicted increments of a step, start values for the rotations of bodies, and the multipliers of the last step as a first
/// guess.
pub fn predict(cx: &Context, ws: &mut Workspace, step: &Step) {
    ws.trial.predict(cx, step.state, &step.stage);
    ws.reach = reach(cx, step.state);
    ws.forces.multipliers.values.copy_from_slice(&step.state.multipliers);
}

/// Moves the trial motion to the increments at the instant of equilibrium: rates by the scheme, then prescribed degrees of freedom, then
/// dependent nodes.
pub fn move_trial(cx: &Context, ws: &mut Workspace, step: &Step) {
    ws.trial.differentiate(cx, step.state, &step.stage);
    let drift = ws.trial.advance(cx, step.state, &ws.prescribed.instant, step.stage.scheme.rotation);
    ws.rotation_drift = ws.rotation_drift.max(drift);
}
