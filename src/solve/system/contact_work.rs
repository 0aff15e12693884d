//! The work of contacts in a load step. The work of loads is that of the mean of their values at the ends of a step, which is exact where forces
//! grow with displacements. A contact that closes on the way, or opens, does not: its force f is zero until it closes, and the mean of f over
//! the whole of the motion Δq is too much. With f₁ and f₂ at the ends, the energy U that the contact stores and D that it dissipates, the mean
//! counts
//!
//! ```text
//!  e = −½ (f₁ + f₂)·Δq − ΔU − D
//! ```
//!
//! too much. In equilibrium at both ends the work of loads counts the same e too much: of a gap g that closes under the force N it is ½ N g.

use super::equations::System;
use base::math::Vec3;
use base::math::rotation::log;
use mechanics::elements::Force;
use mechanics::materials::Dissipation;
use mechanics::state::{Configuration, Node, State};

/// What the mean of the forces of contacts at the ends of a load step counts too much, as above: from `state` to `trial`, the time `dt`
/// later. `history` is that at the end, already written. Contacts with multipliers are left out,
/// since those of the start of the step are no longer known.
pub fn excess_of_mean(system: &System, state: &State, (trial, dt): (&[Node], f64), history: &mut [f64]) -> f64 {
    let mut taken = 0.0;
    let mut F: Vec<Force> = vec![[0.0; 6]; trial.len()];
    for (group, block) in system.contact_groups() {
        if block.has_multipliers() || group.history.is_empty() {
            continue;
        }
        let start = state.configuration();
        let found = Configuration { nodes: trial, history: &state.history, dt, lead: None };
        group.block.subtract_forces(&group.configuration(&start), &mut F);
        group.block.subtract_forces(&group.configuration(&found), &mut F);
        // Written once more, with the same numbers: what this contact by itself has dissipated.
        let own = &mut history[group.history.clone()];
        let Dissipation { plastic, viscous, stored, friction, impact, eroded } =
            group.block.update_history(&group.configuration(&found), 1.0, own);
        let end = Configuration { nodes: trial, history, dt: 0.0, lead: None };
        let stored_more =
            group.block.energy(&group.configuration(&end)) - group.block.energy(&group.configuration(&start));
        taken += stored_more + plastic + viscous + stored + friction + impact + eroded;
    }
    let of_node = |((F, from), to): ((&Force, &Node), &Node)| {
        let turn = || log(&(to.rotation * from.rotation.conjugate()));
        let (f, m) = (Vec3::new(F[0], F[1], F[2]), Vec3::new(F[3], F[4], F[5]));
        f.dot(&(to.x - from.x)) + if m == Vec3::zeros() { 0.0 } else { m.dot(&turn()) }
    };
    let work: f64 = F.iter().zip(&state.nodes).zip(trial).map(of_node).sum();
    -0.5 * work - taken
}
