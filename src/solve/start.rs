//! The state at t = 0, with positions and velocities as given and accelerations from equilibrium.

use super::context::Context;
use super::failure::Failure;
use super::warning::Warning;
use super::workspace::Workspace;
use crate::guards::joints;
use crate::system::Side;
use crate::system::TangentWeights;
use crate::tolerances::start::{DIGITS, FIXED, NOWHERE};
use base::math::{Vec3, Vec6, angular, linear, rotation, stack};
use mechanics::elements::Moduli;
use mechanics::state::{Configuration, Increment, Node, State, Work};

/// Finds the state at t = 0; warns where initial velocities do not agree with the joints.
///
/// # Errors
/// [`Failure::Singular`] if a mass matrix is singular, [`Failure::ConstraintsViolated`] if joints do not fit the model.
pub fn start(cx: &Context, ws: &mut Workspace) -> Result<State, Failure> {
    let mut state = given_state(cx);
    cx.excitation.loading(0.0, Side::After, &mut ws.loads.instant);
    cx.excitation.prescribed(0.0, Side::After, &mut ws.prescribed.start);
    prescribe(cx, ws, &mut state);
    update_rates_of_dependent_nodes(cx, ws, &mut state.nodes);
    if cx.system.has_contacts() {
        // Points in contact at t = 0 may rub from then on.
        update_history(cx, ws, &mut state);
    }
    cx.system.residual(&state.configuration(), &ws.loads.instant, &mut ws.forces);
    if cx.is_dynamic() {
        let massless = factor_mass(cx, ws, &state.configuration())?;
        if !cx.system.joints.is_empty() {
            ws.place(&state.nodes);
            joints::note(cx, ws)?;
            let change = project_velocities(cx, ws, &mut state.nodes, &[]);
            if change > DIGITS && given_velocities_change(cx, ws, &state.nodes) {
                ws.warnings.add(Warning::InitialVelocities { change });
            }
            cx.system.residual(&state.configuration(), &ws.loads.instant, &mut ws.forces);
        }
        add_accelerations(cx, ws, &mut state, &massless);
        cx.system.residual(&state.configuration(), &ws.loads.instant, &mut ws.forces);
    }
    for (reaction, restraint) in state.reactions.iter_mut().zip(&cx.model.constraints.restraints) {
        *reaction = -ws.forces.on_nodes[restraint.node][restraint.dof];
    }
    if cx.system.history > 0 {
        // Yielding before the start is not part of the work of the run.
        update_history(cx, ws, &mut state);
    }
    if cx.is_dynamic() {
        state.work.damping_power = cx.system.damping_power(&state.configuration(), cx.plan.threads);
    }
    ws.place(&state.nodes);
    Ok(state)
}

/// The state as the model gives it, before prescribed motion. Omitted degrees of freedom are at rest.
fn given_state(cx: &Context) -> State {
    let node = |(i, spec): (usize, &model::Node)| {
        let mut node = Node::at_rest(spec.x);
        for dof in 0..3 {
            if cx.is_dynamic() && cx.plan.is_unknown(i, dof) {
                node.v[dof] = spec.v[dof];
            }
            if cx.is_dynamic() && cx.plan.is_unknown(i, 3 + dof) {
                node.omega[dof] = spec.omega[dof];
            }
        }
        node
    };
    let n = cx.model.nodes.len();
    State {
        time: 0.0,
        nodes: cx.model.nodes.iter().enumerate().map(node).collect(),
        history: vec![0.0; cx.system.history],
        jerk: vec![Vec6::zeros(); n],
        reactions: vec![0.0; cx.model.constraints.restraints.len()],
        multipliers: vec![0.0; cx.system.multipliers()],
        algorithmic_accelerations: vec![Vec6::zeros(); if cx.algorithmic_acceleration.is_some() { n } else { 0 }],
        work: Work::default(),
    }
}

/// Adds the prescribed motion at t = 0.
fn prescribe(cx: &Context, ws: &Workspace, state: &mut State) {
    for (i, (restraint, given)) in cx.model.constraints.restraints.iter().zip(&ws.prescribed.start).enumerate() {
        let node = &mut state.nodes[restraint.node];
        if restraint.dof < 3 {
            node.x[restraint.dof] += given.u;
            node.v[restraint.dof] = given.v;
            node.a[restraint.dof] = given.a;
        } else {
            let mut turn = Vec3::zeros();
            turn[restraint.dof - 3] = if cx.excitation.is_turned(i) { 0.0 } else { given.u };
            node.rotation = rotation::exp(&turn) * node.rotation;
            node.omega[restraint.dof - 3] = given.v;
            node.alpha[restraint.dof - 3] = given.a;
        }
    }
    for turn in cx.excitation.turns() {
        let u = Vec3::from(turn.restraints.map(|i| ws.prescribed.start[i].u));
        let node = &mut state.nodes[cx.model.constraints.restraints[turn.restraints[0]].node];
        node.rotation = turn.angles.rotation(&u) * node.rotation;
    }
    // A prescribed motion may start rotated; dependent nodes then start with the components of the rotation that follow
    // the master.
    for dependent in &cx.system.rigid_links {
        let turn = rotation::log(&state.nodes[dependent.master].rotation);
        let following = Vec3::from_fn(|i, _| if dependent.dofs[3 + i] { turn[i] } else { 0.0 });
        let node = &mut state.nodes[dependent.node];
        node.rotation = rotation::exp(&following) * node.rotation;
    }
}

fn update_history(cx: &Context, ws: &mut Workspace, state: &mut State) {
    cx.system.update_history(&state.configuration(), 1.0, &mut ws.history, cx.plan.threads);
    std::mem::swap(&mut state.history, &mut ws.history);
}

/// Writes the rates of dependent nodes from their masters; nothing is displaced.
pub fn update_rates_of_dependent_nodes(cx: &Context, ws: &mut Workspace, nodes: &mut [Node]) {
    for (increment, node) in ws.trial.increments.iter_mut().zip(&*nodes) {
        let (d, dd) = (stack(&node.v, &node.omega), stack(&node.a, &node.alpha));
        *increment = Increment { q: Vec6::zeros(), d, dd };
    }
    for dependent in &cx.system.rigid_links {
        let start = nodes[dependent.node];
        dependent.move_with_master(nodes, &mut ws.trial.increments, &start);
    }
}

/// Replaces velocities by the nearest ones in kinetic energy that the joints allow, after an `impulse` on the unknowns of nodes, if not
/// empty. The mass matrix is factorized already. Returns the largest change relative to the largest velocity.
pub fn project_velocities(cx: &Context, ws: &mut Workspace, nodes: &mut [Node], impulse: &[f64]) -> f64 {
    let (mut change, mut largest) = (0.0f64, 0.0f64);
    let geared = geared_nodes(cx);
    // Redundant equations leave a fraction of the gaps to the next correction: three leave nothing.
    for pass in 0..3 {
        cx.system.gaps(nodes, 1, &mut ws.forces.multipliers.gaps);
        let pushes = pass == 0 && !impulse.is_empty();
        if !pushes && ws.forces.multipliers.gaps.iter().all(|&gap| gap == 0.0) {
            break;
        }
        match pushes {
            true => ws.residual.of_nodes_mut(cx).copy_from_slice(impulse),
            false => ws.residual.of_nodes_mut(cx).fill(0.0),
        }
        ws.matrix.solve(&ws.forces.multipliers, &ws.residual, &mut ws.correction);
        ws.solves += 1;
        for (index, (node, rows)) in nodes.iter_mut().zip(cx.plan.dofs.each_node()).enumerate() {
            let found = ws.correction.of(rows);
            let (dv, domega) = (linear(&found), angular(&found));
            let before = speed(cx, &node.v, &node.omega);
            node.v += dv;
            node.omega += domega;
            if geared.contains(&index) {
                continue;
            }
            largest = largest.max(before);
            change = change.max(speed(cx, &dv, &domega));
            largest = largest.max(speed(cx, &node.v, &node.omega));
        }
        update_rates_of_dependent_nodes(cx, ws, nodes);
    }
    // Parts that move by less than rounding over the whole run are at rest.
    let nowhere = NOWHERE * cx.length / (cx.model.analysis.end_time - cx.model.analysis.begin);
    if change > nowhere { change / largest } else { 0.0 }
}

/// The nodes of geared coordinates: the deck gives them no velocity that could contradict the joints.
fn geared_nodes(cx: &Context) -> Vec<usize> {
    let joints = cx.model.constraints.joints.iter();
    let drives = joints.filter_map(|joint| joint.coordinate.as_ref()?.drive);
    drives.filter(|drive| drive.is_free).map(|drive| drive.node).collect()
}

/// True if joints have changed initial velocities of the deck, from `trial` to `nodes`. A drive that starts suddenly also moves joined
/// parts without initial velocity, and this is no contradiction. Without drives any change concerns velocities of the deck.
fn given_velocities_change(cx: &Context, ws: &Workspace, nodes: &[Node]) -> bool {
    if ws.prescribed.start.iter().all(|given| given.v == 0.0) {
        return true;
    }
    let largest = nodes.iter().map(|node| speed(cx, &node.v, &node.omega)).fold(0.0, f64::max);
    let pairs = cx.model.nodes.iter().zip(ws.trial.nodes.iter().zip(nodes));
    pairs
        .filter(|(given, _)| speed(cx, &given.v, &given.omega) > 0.0)
        .any(|(_, (before, after))| speed(cx, &(after.v - before.v), &(after.omega - before.omega)) > DIGITS * largest)
}

/// Translations and rotations are judged together: where one of them is zero, rounding of the other is no change.
pub fn speed(cx: &Context, v: &Vec3, omega: &Vec3) -> f64 {
    v.amax().max(omega.amax() * cx.length)
}

/// Adds M⁻¹ f to the accelerations, with the mass matrix factorized. Degrees of freedom without mass have no equation
/// for their acceleration, which stays.
pub fn add_accelerations(cx: &Context, ws: &mut Workspace, state: &mut State, massless: &[usize]) {
    ws.residual.write(cx, &ws.forces, 1.0);
    massless.iter().for_each(|&row| ws.residual.values[row] = 0.0);
    solve_accelerations(cx, ws, state);
    // Redundant equations leave a fraction of the gaps: a second solution is enough.
    if !cx.system.joints.is_empty() {
        ws.residual.of_nodes_mut(cx).fill(0.0);
        solve_accelerations(cx, ws, state);
    }
    cx.system.remember_joint_loads(state, 0.0);
    // Algorithmic accelerations equal the accelerations of equilibrium after a start or a jump.
    for (acceleration, node) in state.algorithmic_accelerations.iter_mut().zip(&state.nodes) {
        *acceleration = stack(&node.a, &node.alpha);
    }
}

/// Solves for accelerations with the residual, and with the accelerations of the gaps.
fn solve_accelerations(cx: &Context, ws: &mut Workspace, state: &mut State) {
    let multipliers = &mut ws.forces.multipliers;
    multipliers.values.copy_from_slice(&state.multipliers);
    cx.system.gaps(&state.nodes, 2, &mut multipliers.gaps);
    ws.matrix.solve(multipliers, &ws.residual, &mut ws.correction);
    ws.solves += 1;
    multipliers.add(ws.correction.of_multipliers(cx));
    for (node, rows) in state.nodes.iter_mut().zip(cx.plan.dofs.each_node()) {
        for dof in 0..3 {
            if let Some(row) = rows.get(dof) {
                node.a[dof] += ws.correction.values[row];
            }
            if let Some(row) = rows.get(3 + dof) {
                node.alpha[dof] += ws.correction.values[row];
            }
        }
    }
    update_rates_of_dependent_nodes(cx, ws, &mut state.nodes);
    let multipliers = &mut ws.forces.multipliers;
    cx.system.gaps(&state.nodes, 2, &mut multipliers.gaps);
    multipliers.add_gaps();
    state.multipliers.copy_from_slice(&multipliers.values);
}

/// Forms and factorizes M. Returns the rows without mass, whose accelerations stay.
///
/// # Errors
/// [`Failure::Singular`] where a mass matrix cannot be inverted.
pub fn factor_mass(cx: &Context, ws: &mut Workspace, now: &Configuration) -> Result<Vec<usize>, Failure> {
    // A massless direction may be oblique to the axes, as for a thin rod, or for an arm with a point mass at its end. It shows as a
    // vanishing pivot.
    let mut oblique: Vec<usize> = Vec::new();
    loop {
        let weights =
            TangentWeights { stiffness: false, rate: 0.0, acceleration: 1.0, turning: None, moduli: Moduli::Elastic };
        let (matrix, loads) = (&mut ws.matrix, &ws.loads.instant);
        matrix.assembly.tangent(cx.system, now, loads, &mut ws.forces, weights, &mut matrix.solver);
        let mut massless = oblique.clone();
        for row in 0..cx.nodal_unknowns() {
            let Some(slot) = matrix.solver.slot(row, row) else { continue };
            let diagonal = &mut matrix.solver.values()[slot];
            if *diagonal == 0.0 {
                *diagonal = 1.0;
                massless.push(row);
            }
        }
        for &row in &oblique {
            if let Some(slot) = matrix.solver.slot(row, row) {
                matrix.solver.values()[slot] *= FIXED;
            }
        }
        ws.factorizations += 1;
        match matrix.factor(cx) {
            Ok(true) => return Ok(massless),
            Ok(false) => return Err(Failure::Stopped),
            Err(singular) if oblique.contains(&singular.row) => {
                return Err(Failure::singular(cx.model, cx.plan, cx.system, singular.row, (None, true)));
            }
            Err(singular) => oblique.push(singular.row),
        }
    }
}
