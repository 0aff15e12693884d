//! Warns if parts other than the scaled elements limit the time step more than mass scaling assumed.

use super::accelerations::Accelerations;
use crate::context::Context;
use crate::tolerances::scaled_step::{MOST, ROUNDING};
use crate::warning::Warning;
use crate::workspace::Workspace;
use base::math::Vec6;
use mechanics::elements::Moduli;
use mechanics::state::{Configuration, State};

/// Warns once if the critical time step `longest` is below the critical step of scaled elements; `mode` is the fastest motion by node, in
/// the trial motion.
pub fn check_scaled_step(
    cx: &Context,
    ws: &mut Workspace,
    accelerations: &Accelerations,
    state: &State,
    (longest, mode): (f64, &[Vec6]),
) {
    let Some(scaling) = cx.system.mass_scaling() else { return };
    if scaling.of_sections.is_some() {
        return;
    }
    let wanted = scaling.critical_step;
    if longest >= (1.0 - ROUNDING) * wanted || ws.warnings.knows(|known| matches!(known, Warning::ScaledStep { .. })) {
        return;
    }
    let energy = |&node: &usize| match accelerations.masses.as_ref() {
        Some(masses) => {
            masses.of(node).map_or(0.0, |of| of.inner_product(&ws.trial.nodes[node], &mode[node], &mode[node]))
        }
        None => mode[node].norm_squared(),
    };
    let Some(node) = cx.independent_nodes.iter().copied().max_by(|a, b| energy(a).total_cmp(&energy(b))) else {
        return;
    };
    // A mode of unit inner product has the squared frequency 4/Δt² as stiffness.
    let stiffness = cx.independent_nodes.iter().map(energy).sum::<f64>() * (2.0 / longest).powi(2);
    let (label, cause) = (cx.model.nodes[node].label.clone(), cause(cx, ws, state, (mode, stiffness)));
    ws.warnings.add(Warning::ScaledStep { wanted, longest, label, cause });
}

/// The link or contact with most of the stiffness of a mode; empty if there is none.
fn cause(cx: &Context, ws: &Workspace, state: &State, (mode, stiffness): (&[Vec6], f64)) -> String {
    let mut motions = mode.to_vec();
    cx.system.project(&ws.trial.nodes, &mut motions);
    let now = Configuration { nodes: &ws.trial.nodes, history: &state.history, dt: 0.0, previous: None };
    let mut K = Vec::new();
    for group in cx.system.groups.iter().filter(|group| !group.kind.is_deformable()) {
        let (now, dofs) = (group.configuration(&now), group.block.dofs());
        let mut of_mode = |e: usize| {
            let motion: Vec<f64> =
                group.block.nodes(e).iter().flat_map(|&node| motions[node].iter().copied().take(dofs)).collect();
            K.clear();
            K.resize(motion.len().pow(2), 0.0);
            group.block.tangent(e, &now, 0.0, Moduli::Elastic, &mut K);
            K.chunks(motion.len())
                .zip(&motion)
                .map(|(row, x)| x * row.iter().zip(&motion).map(|(k, y)| k * y).sum::<f64>())
                .sum::<f64>()
        };
        let is_most = |&e: &usize| !group.block.is_inactive(e, &now) && of_mode(e) > MOST * stiffness;
        if let Some(e) = (0..group.block.len()).find(is_most) {
            return group.part_of(e, cx.model).name().to_owned();
        }
    }
    String::new()
}
