//! Watches shells that yield by a law of small strains: where they are stretched far their forces are wrong.

use super::context::Context;
use super::workspace::Workspace;
use crate::state::State;

/// Strain from which forces are off by a tenth: stress conjugate to Green's strain makes them twice the strain too large.
const LARGE: f64 = 0.05;
/// How often in a run strains are looked at: plastic ones do not go away.
const LOOKS: f64 = 100.0;

/// Notes the largest strain at the end of a step that began at `from`, where that passes one of a hundred equal parts of the run.
pub fn note(cx: &Context, ws: &mut Workspace, state: &State, from: f64) {
    let (begin, end) = (cx.model.analysis.begin, cx.model.analysis.end_time);
    let part = |time: f64| (LOOKS * (time - begin) / (end - begin)).floor();
    if part(from) == part(state.time) {
        return;
    }
    let now = state.configuration();
    for group in &cx.system.groups {
        let own = group.configuration(&now);
        for e in 0..group.block.len() {
            let strain = group.block.surface_strain(e, &own);
            if strain.abs() > LARGE {
                ws.warnings.stretch(group.part_of(e, cx.model).name(), strain);
            }
        }
    }
}
