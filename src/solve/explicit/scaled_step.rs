//! What asks for shorter steps than those for which mass scaling has raised the masses of elements.

use super::accelerations::Accelerations;
use crate::math::Vec6;
use crate::solve::context::Context;
use crate::solve::warning::Warning;
use crate::solve::workspace::Workspace;
use crate::state::{Configuration, State};

/// Differences of residuals leave seven digits of the limit.
const ROUNDING: f64 = 1e-4;

/// Warns, once, where the critical time step `longest` is below that of scaled elements; `mode` is the fastest motion by node, in the trial
/// motion.
pub fn check_scaled_step(
    cx: &Context,
    ws: &mut Workspace,
    accelerations: &Accelerations,
    state: &State,
    (longest, mode): (f64, &[Vec6]),
) {
    let Some(scaling) = cx.system.mass_scaling() else { return };
    let wanted = scaling.critical_step;
    if longest >= (1.0 - ROUNDING) * wanted || ws.warnings.knows(|known| matches!(known, Warning::ScaledStep { .. })) {
        return;
    }
    let energy = |&node: &usize| match accelerations.masses.as_ref() {
        Some(masses) => masses.of(node).map_or(0.0, |of| of.inner_product(&ws.trial[node], &mode[node], &mode[node])),
        None => mode[node].norm_squared(),
    };
    let Some(node) = cx.independent_nodes.iter().copied().max_by(|a, b| energy(a).total_cmp(&energy(b))) else {
        return;
    };
    let (label, cause) = (cx.model.nodes[node].label.clone(), cause(cx, ws, state, node));
    ws.warnings.add(Warning::ScaledStep { wanted, longest, label, cause });
}

/// The link or contact that acts on a node, or on what is attached to it; empty where none does.
fn cause(cx: &Context, ws: &Workspace, state: &State, node: usize) -> String {
    let mut moved = vec![false; cx.model.nodes.len()];
    moved[node] = true;
    // A master stands before the nodes that depend on it.
    cx.system.rigid_links.iter().for_each(|link| moved[link.node] |= moved[link.master]);
    let now = Configuration { nodes: &ws.trial, history: &state.history, dt: 0.0, lead: None };
    for group in cx.system.groups.iter().filter(|group| !group.kind.is_deformable()) {
        let now = group.configuration(&now);
        let acts =
            |&e: &usize| group.block.nodes(e).iter().any(|&node| moved[node]) && !group.block.is_inactive(e, &now);
        if let Some(e) = (0..group.block.len()).find(acts) {
            return group.part_of(e, cx.model).name().to_owned();
        }
    }
    String::new()
}
