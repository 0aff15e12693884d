//! Checks rotations fixed only by supports. A fixed rotation is a component of each step's rotation vector, so the total rotation drifts if
//! the node also turns about other axes.

use crate::context::Context;
use crate::guards::guard::{Guard, Taken};
use crate::tolerances::drift::{LOOKS, NOTICED};
use crate::warning::Warnings;
use crate::workspace::Workspace;
use base::math::rotation;
use mechanics::state::State;
use model::DIRECTIONS;

/// Records the largest drift at the end of a step that passes one of a hundred equal parts of the run. A later stage begins with rotations
/// that are no drift.
pub struct DriftGuard;

impl Guard for DriftGuard {
    fn after_step(&mut self, cx: &Context, ws: &mut Workspace, taken: &Taken) {
        let part = |time: f64| (LOOKS * time / cx.model.analysis.end_time).floor();
        if part(taken.from) != part(taken.state.time) {
            look(cx, &mut ws.warnings, taken.state);
        }
    }
}

fn look(cx: &Context, warnings: &mut Warnings, state: &State) {
    let fixed = cx.model.constraints.restraints.iter().filter(|held| held.dof > 2 && held.motion.is_none());
    for held in fixed {
        let others = (3..6).filter(|&dof| dof != held.dof && cx.plan.is_unknown(held.node, dof)).count();
        let drift = rotation::log(&state.nodes[held.node].rotation)[held.dof - 3].abs();
        if others == 2 && drift > NOTICED {
            warnings.drift(&cx.model.nodes[held.node].label, DIRECTIONS[held.dof], drift);
        }
    }
}
