//! The work of contacts in a load step. The work of loads uses the mean of their values at the ends of a step, which is exact for forces
//! proportional to displacements. A contact that closes or opens within the step is an exception. Its force f is zero while it is open, so
//! the mean of f over the motion Δq is too large. With f₁ and f₂ at the ends, the stored energy U and the dissipated energy D of the
//! contact, the excess of the mean is
//!
//! ```text
//!  e = −½ (f₁ + f₂)·Δq − ΔU − D
//! ```
//!
//! too much. In equilibrium at both ends the work of loads has the same excess e: ½ N g for a gap g that closes under the force N.

use super::equations::{Forces, System};
use super::loads::Loading;
use base::math::Vec3;
use base::math::rotation::log;
use mechanics::elements::Force;
use mechanics::materials::Dissipation;
use mechanics::state::{Configuration, Node, State};
use model::Model;

/// The excess e of the work of the mean contact forces in a load step from `state` to `trial`, a time `dt` later. `history` is that at the
/// end, already written. Contacts with multipliers are omitted, because their multipliers at the start of the step are no longer known.
pub fn excess_of_mean(system: &System, state: &State, (trial, dt): (&[Node], f64), history: &mut [f64]) -> f64 {
    let mut taken = 0.0;
    let mut F: Vec<Force> = vec![[0.0; 6]; trial.len()];
    for (group, block) in system.contact_groups() {
        if block.has_multipliers() || group.history.is_empty() {
            continue;
        }
        let start = state.configuration();
        let found = Configuration { nodes: trial, history: &state.history, dt, previous: None };
        group.block.subtract_forces(&group.configuration(&start), &mut F);
        group.block.subtract_forces(&group.configuration(&found), &mut F);
        // Writing the same history again returns the dissipation of this contact alone.
        let own = &mut history[group.history.clone()];
        let Dissipation { plastic, viscous, stored, friction, impact, eroded } =
            group.block.update_history(&group.configuration(&found), 1.0, own);
        let end = Configuration { nodes: trial, history, dt: 0.0, previous: None };
        let stored_more =
            group.block.energy(&group.configuration(&end)) - group.block.energy(&group.configuration(&start));
        taken += stored_more + plastic + viscous + stored + friction + impact + eroded;
    }
    -0.5 * work_along(&F, &state.nodes, trial) - taken
}

/// The excess of the work of the mean forces in a load step whose start is out of balance, by closed contacts or tightened bars. Their
/// forces at the start fade in the step. Zero if nothing is stored at the start.
pub fn excess_at_start(
    model: &Model,
    system: &System,
    state: &State,
    (trial, loading): (&[Node], &Loading),
    forces: &Forces,
) -> f64 {
    if system.stored_energy(&state.configuration(), 1) == 0.0 {
        return 0.0;
    }
    let mut forces = forces.clone();
    system.residual(&state.configuration(), loading, &mut forces);
    for held in &model.constraints.restraints {
        forces.on_nodes[held.node][held.dof] = 0.0;
    }
    0.5 * work_along(&forces.on_nodes, &state.nodes, trial)
}

/// The work of constant forces from one motion to another.
fn work_along(F: &[Force], from: &[Node], to: &[Node]) -> f64 {
    let of_node = |((F, from), to): ((&Force, &Node), &Node)| {
        let turn = || log(&(to.rotation * from.rotation.conjugate()));
        let (f, m) = (Vec3::new(F[0], F[1], F[2]), Vec3::new(F[3], F[4], F[5]));
        f.dot(&(to.x - from.x)) + if m == Vec3::zeros() { 0.0 } else { m.dot(&turn()) }
    };
    F.iter().zip(from).zip(to).map(of_node).sum()
}
