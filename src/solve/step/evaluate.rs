//! The residual of a trial motion.

use crate::context::Context;
use crate::step::predict::move_trial;
use crate::step::trial::Step;
use crate::workspace::Workspace;

/// Moves the trial motion to the current increments and writes its residual. Returns the relative size of the residual.
pub fn evaluate(cx: &Context, ws: &mut Workspace, step: &Step) -> f64 {
    move_trial(cx, ws, step);
    let scale = cx.system.residual(&step.at_instant(&ws.trial.nodes), &ws.loads.instant, &mut ws.forces);
    let scale = ws.load_steps.peak.scale(scale);
    ws.residual.gather(cx, &ws.forces, &scale)
}
