//! Accelerations at t = 0, or after a jump of the loads, of light nodes whose velocity dampers change within a small part of a step. If an
//! end of a damped beam suddenly moves, the next node turns with 1e9 rad/s² for a microsecond. Schemes take an acceleration for one that
//! lasts a step, and would turn the node by radians at its end. It is then replaced by the acceleration of an implicit step, (M + γΔt C +
//! βΔt² K) a = f. If the step resolves the motion, this agrees with M a = f to the order of the step.

use super::context::Context;
use super::start::update_rates_of_dependent_nodes;
use super::workspace::Workspace;
use crate::system::TangentWeights;
use crate::tolerances::initial_transient::{LARGE, UNRESOLVED};
use base::math::{Vec3, Vec6, angular, linear, stack};
use mechanics::elements::Moduli;
use mechanics::integrators::Stepping;
use mechanics::state::{Configuration, Node, State};
use model::StepLength;
use std::collections::BTreeSet;

/// Replaces the accelerations that no step resolves, for implicit steps of given length. `before` holds the nodes before a jump, and
/// accelerations that do not jump are kept; `None` at the beginning of a run.
pub fn pass_over(cx: &Context, ws: &mut Workspace, state: &mut State, before: Option<&[Node]>) {
    let explicit = matches!(cx.model.solution.scheme.stepping(), Stepping::Verlet | Stepping::RungeKutta(_));
    let StepLength::Fixed { step: dt } = cx.model.analysis.step_length else { return };
    let leaps = |of: &Vec6| {
        let [moved, turned] = [linear(of).norm() / cx.length, angular(of).norm()].map(|a| 0.5 * dt * dt * a);
        [moved > LARGE, turned > LARGE]
    };
    let accelerations = |state: &State, node: usize| stack(&state.nodes[node].a, &state.nodes[node].alpha);
    let jumps = |now: &Vec3, before: Option<&Vec3>| before.is_none_or(|before| differs(now, before));
    // Masses of superelements are coupled: an acceleration replaced at one node alone would not be that of any force, and a superelement has
    // no light node.
    let floating: BTreeSet<usize> = cx.system.floating_nodes().collect();
    let leaps = |state: &State, node: usize| {
        if floating.contains(&node) {
            return [false; 2];
        }
        let (now, before) = (accelerations(state, node), before.map(|nodes| &nodes[node]));
        let [moves, turns] = leaps(&now);
        let moves = moves && jumps(&linear(&now), before.map(|node| &node.a));
        [moves, turns && jumps(&angular(&now), before.map(|node| &node.alpha))]
    };
    let any = |&node: &usize| leaps(state, node) != [false; 2];
    // Without dampers only vibrations are so short, and schemes treat these as usual.
    let damped = cx.is_dynamic() && !cx.plan.linear && cx.system.is_damped();
    if explicit || !damped || !cx.independent_nodes.iter().any(any) {
        return;
    }
    let factor = solve(cx, ws, state, dt);
    ws.trial.nodes.clone_from(&state.nodes);
    let Some(factor) = factor else { return };
    for &node in &cx.independent_nodes {
        let (own, rows) = (accelerations(state, node), cx.plan.dofs.of(node));
        let seen = Vec6::from_fn(|dof, _| rows.get(dof).map_or(own[dof], |row| factor * ws.correction.values[row]));
        let [moves, turns] = leaps(state, node);
        let node = &mut state.nodes[node];
        let (a, alpha) = (linear(&seen), angular(&seen));
        if moves && differs(&node.a, &a) {
            node.a = a;
        }
        if turns && differs(&node.alpha, &alpha) {
            node.alpha = alpha;
        }
    }
    update_rates_of_dependent_nodes(cx, ws, &mut state.nodes);
    for (acceleration, node) in state.algorithmic_accelerations.iter_mut().zip(&state.nodes) {
        *acceleration = stack(&node.a, &node.alpha);
    }
    ws.place(&state.nodes);
}

/// True where an acceleration differs from another by a large part.
fn differs(acceleration: &Vec3, other: &Vec3) -> bool {
    (other - acceleration).norm() > UNRESOLVED * acceleration.norm()
}

/// Solves the matrix of a step for the forces without inertia. Returns the factor from the solution in `ws.correction` to accelerations, or
/// `None` if the matrix is singular.
fn solve(cx: &Context, ws: &mut Workspace, state: &State, dt: f64) -> Option<f64> {
    ws.trial.nodes.clone_from(&state.nodes);
    for &node in &cx.independent_nodes {
        let rows = cx.plan.dofs.of(node);
        let trial = &mut ws.trial.nodes[node];
        (0..3).filter(|&i| rows.has(i)).for_each(|i| trial.a[i] = 0.0);
        (0..3).filter(|&i| rows.has(3 + i)).for_each(|i| trial.alpha[i] = 0.0);
    }
    let now = Configuration { nodes: &ws.trial.nodes, history: &state.history, dt, previous: None };
    ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
    cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
    let (rate, acceleration) = cx.model.solution.scheme.coefficients(dt).weights();
    let weights = TangentWeights { stiffness: true, rate, acceleration, turning: None, moduli: Moduli::Elastic };
    ws.matrix.make_room(cx, &now);
    let (matrix, loads) = (&mut ws.matrix, &ws.loads.instant);
    matrix.assembly.tangent(cx.system, &now, loads, &mut ws.forces, weights, &mut matrix.solver);
    ws.factorizations += 1;
    matrix.solver.factor().ok()?;
    ws.residual.write(cx, &ws.forces, 1.0);
    ws.forces.multipliers.gaps.fill(0.0);
    matrix.solve(&ws.forces.multipliers, &ws.residual, &mut ws.correction);
    ws.solves += 1;
    Some(acceleration)
}
