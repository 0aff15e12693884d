//! From one stage to the next: the state that the one has reached, in the scene of the other.
//!
//! Positions, rotations, history and multipliers are carried over by the names of nodes, parts and joints. New supports, joints and
//! attachments refer to the current positions. A static stage may begin out of balance because supports, joints, links, contacts or loads
//! have changed, or because inertia no longer acts. Forces then restore the balance and fade to zero over the stage, so that nothing jumps.

use super::context::Context;
use super::outcome::Counts;
use crate::step::load_steps::LoadSteps;
use crate::system::energy::Energy;
use crate::system::{Excitation, Forces, Loading, Scale, Side, System, carry_history};
use crate::tolerances::handover::{LEFT, MEETING};
use base::math::{Vec3, Vec6};
use mechanics::amplitude::{Amplitude, StraightLines};
use mechanics::constraints::joint::ConstraintEquation;
use mechanics::constraints::rigid_link::RigidLink;
use mechanics::elements::Force;
use mechanics::state::{Increment, Node, State};
use model::{AnalysisKind, Joint, Load, Model, set_coordinate_equations};
use std::collections::HashMap;
use std::ops::Range;

/// The start data of a stage.
#[derive(Clone)]
pub struct Handover {
    /// The state, in the order of the new scene.
    pub(super) state: State,
    /// The ranges of history variables of parts that were not there before.
    pub(super) fresh: Vec<Range<usize>>,
    /// The effort of all stages before.
    pub(super) counts: Counts,
    /// The missing energy of the balance so far.
    pub(super) missed: f64,
    /// Mechanical energy at the reference of the balance; `None` if energies are not summed.
    pub(super) initial_energy: Option<f64>,
    /// The unbalanced forces on each node at the end of the previous stage, if a motion continues under changed loads only. Schemes with
    /// equilibrium off the ends of steps cause them.
    pub(super) out_of_balance: Option<Vec<Force>>,
    /// The unbalanced forces on each node due to the scheme at the end of the previous stage; empty unless a motion continues with changed
    /// supports, joints or contacts. Schemes with equilibrium off the ends of steps would oscillate after a restart from equilibrium at the
    /// end.
    pub(super) left_by_scheme: Vec<Force>,
    /// The data that load steps pass to later ones; `None` unless both stages are static.
    pub(super) load_steps: Option<LoadSteps>,
}

/// A stage that has ended.
pub(super) struct EndedStage<'e, 'a> {
    /// The constants of its run.
    pub cx: &'e Context<'a>,
    /// The state at its end.
    pub state: &'e State,
    /// The effort of it and all before.
    pub counts: Counts,
    /// Mechanical energy at the reference of its balance.
    pub initial_energy: Option<f64>,
    /// The data that its load steps pass to later ones.
    pub load_steps: &'e LoadSteps,
}

/// Prepares the model of the next stage for the state at the end of the one before, and builds its system.
///
/// # Errors
/// As for [`System::new`], and if the history of a part does not match.
pub(super) fn hand_over(before: &EndedStage, model: &mut Model) -> Result<(System, Handover), String> {
    let &EndedStage { cx, state, .. } = before;
    let from = NodeMap::new(cx.model, model);
    carry_velocities(&from, (cx.model, state), model);
    // Out-of-plane motion continues, whether or not anything still excites it.
    model.analysis.plane &= cx.system.plane.is_some();
    let mut system = System::new(model)?;
    if system.plane != cx.system.plane && model.analysis.plane {
        model.analysis.plane = false;
        system = System::new(model)?;
    }
    let nodes = from.place(state, model, &system.rigid_links);
    lead_to_targets(&nodes, model);
    if rejoin(&from, cx.model, &nodes, model) {
        system = System::new(model)?;
    }
    let (mut next, fresh) = from.state((cx, state), nodes, (model, &system))?;
    warm(model, &system, &mut next);
    let is_static = !model.analysis.is_dynamic();
    if is_static {
        rest(&mut next);
        if !model.analysis.has_modes() && hold_back(model, &system, &next, cx.length) {
            system = System::new(model)?;
        }
    }
    let handover = Handover {
        out_of_balance: model.analysis.loads_alone_change().then(|| from.out_of_balance(cx, state)).flatten(),
        left_by_scheme: from.left_by_scheme(cx, state, model),
        state: next,
        fresh,
        counts: before.counts,
        missed: before.initial_energy.map_or(0.0, |initial| {
            let energy = Energy::of(cx.system, state, Some(initial), cx.plan.threads);
            energy.numerical
        }),
        initial_energy: before.initial_energy,
        load_steps: (is_static && !cx.is_dynamic()).then(|| before.load_steps.clone()),
    };
    Ok((system, handover))
}

/// Gives parts the temperatures of the stage's beginning, with the work of the change: a load may come with its full value.
fn warm(model: &mut Model, system: &System, state: &mut State) {
    let heats = model.parts.iter_mut().filter_map(|part| part.heat_mut());
    let numbers: Vec<usize> = heats.flat_map(|heat| heat.numbers).flatten().collect();
    if numbers.is_empty() {
        return;
    }
    let before = system.stored_energy(&state.configuration(), 1);
    for held in model.constraints.restraints.iter().filter(|held| numbers.contains(&held.node)) {
        let Some(motion) = &held.motion else { continue };
        let u = motion.scale * model.loading.amplitudes[motion.amplitude].value(model.analysis.begin);
        state.nodes[held.node].place(&model.nodes[held.node].x, &Vec3::zeros(), &Vec3::new(u, 0.0, 0.0));
    }
    state.work.external += system.stored_energy(&state.configuration(), 1) - before;
}

/// Gives motions that end at a place the way that is left to it.
fn lead_to_targets(nodes: &[Node], model: &mut Model) {
    let Model { nodes: at_start, constraints, .. } = model;
    for &([node, dof], to) in &constraints.targets {
        let restraints = &mut constraints.restraints;
        let Ok(at) = restraints.binary_search_by_key(&(node, dof), |held| (held.node, held.dof)) else { continue };
        if let Some(motion) = &mut restraints[at].motion {
            motion.scale = to - nodes[node].moved(&at_start[node].x)[dof];
        }
    }
}

/// Makes no stage plane unless all are: the history of yielding in a plane motion has no components out of the plane.
///
/// # Errors
/// As for [`System::new`].
pub fn share_plane<'m>(stages: impl Iterator<Item = &'m mut Model>) -> Result<(), String> {
    let mut stages: Vec<&mut Model> = stages.collect();
    let mut planes: Vec<Option<usize>> = Vec::new();
    for model in &stages {
        let system = System::new(model)?;
        // Modes out of the plane need no history that was not kept, and change nothing of the motion in it.
        if system.history > 0 || !model.analysis.has_modes() {
            planes.push(system.plane);
        }
    }
    if planes.windows(2).any(|pair| pair[0] != pair[1]) {
        stages.iter_mut().for_each(|model| model.analysis.plane = false);
    }
    Ok(())
}

/// The nodes and joints of the previous stage by those of the new one.
struct NodeMap {
    /// The node of the scene before, for each of the new one.
    old: Vec<Option<usize>>,
    /// For each new support point, the node of its support.
    on: Vec<Option<usize>>,
    /// The joint of the scene before with the same name between the same nodes, for each of the new one.
    joints: Vec<Option<usize>>,
}

impl NodeMap {
    /// Nodes are known by their labels. The point of a support has the label of its node, and follows it in the list.
    fn new(before: &Model, now: &Model) -> NodeMap {
        let mut known: HashMap<&str, Vec<usize>> = HashMap::new();
        before.nodes.iter().enumerate().for_each(|(i, node)| known.entry(&node.label).or_default().push(i));
        let mut seen: HashMap<&str, Vec<usize>> = HashMap::new();
        let (mut old, mut on) = (Vec::new(), Vec::new());
        for (i, node) in now.nodes.iter().enumerate() {
            let same = seen.entry(&node.label).or_default();
            let found = known.get(node.label.as_str()).and_then(|nodes| nodes.get(same.len())).copied();
            on.push(same.first().copied().filter(|_| found.is_none()));
            old.push(found);
            same.push(i);
        }
        let joints = before.constraints.joints.iter().enumerate();
        let known: HashMap<(&str, [usize; 2]), usize> =
            joints.map(|(i, of)| ((of.name.as_str(), of.ends), i)).collect();
        let same =
            |joint: &Joint| known.get(&(joint.name.as_str(), [old[joint.ends[0]]?, old[joint.ends[1]]?])).copied();
        let joints = now.constraints.joints.iter().map(same).collect();
        NodeMap { old, on, joints }
    }

    /// The nodes at their current positions; new nodes move with their masters, or keep the positions of the deck.
    fn place(&self, state: &State, model: &Model, links: &[RigidLink]) -> Vec<Node> {
        let at = |(i, old): (usize, &Option<usize>)| match old {
            Some(old) => state.nodes[*old],
            None => Node::at_rest(model.nodes[i].x),
        };
        let mut nodes: Vec<Node> = self.old.iter().enumerate().map(at).collect();
        let mut increments = vec![Increment::ZERO; nodes.len()];
        for link in links.iter().filter(|link| link.rigid && self.old[link.node].is_none()) {
            let start = nodes[link.node];
            link.move_with_master(&mut nodes, &mut increments, &start);
        }
        for (i, on) in self.on.iter().enumerate() {
            if let Some(on) = *on {
                (nodes[i].x, nodes[i].low) = (nodes[on].x, nodes[on].low);
            }
        }
        nodes
    }

    /// The state in the new scene, and the history variables that are new.
    fn state(
        &self,
        (cx, state): (&Context, &State),
        nodes: Vec<Node>,
        (model, system): (&Model, &System),
    ) -> Result<(State, Vec<Range<usize>>), String> {
        let mapped = |of: &[Vec6]| -> Vec<Vec6> {
            let value = |old: &Option<usize>| old.and_then(|old| of.get(old)).copied().unwrap_or_else(Vec6::zeros);
            self.old.iter().map(value).collect()
        };
        let restraints = cx.model.constraints.restraints.iter().zip(&state.reactions);
        let reactions: HashMap<(usize, usize), f64> = restraints.map(|(of, r)| ((of.node, of.dof), *r)).collect();
        let reaction = |of: &model::Restraint| {
            self.old[of.node].and_then(|old| reactions.get(&(old, of.dof))).copied().unwrap_or(0.0)
        };
        let mut history = vec![0.0; system.history];
        let fresh = carry_history((cx.model, cx.system), &state.history, (model, system), &mut history)?;
        let next = State {
            time: state.time,
            nodes,
            history,
            jerk: mapped(&state.jerk),
            reactions: model.constraints.restraints.iter().map(reaction).collect(),
            multipliers: self.multipliers((cx.system, &state.multipliers), system),
            algorithmic_accelerations: match state.algorithmic_accelerations.is_empty() {
                true => Vec::new(),
                false => mapped(&state.algorithmic_accelerations),
            },
            work: state.work,
        };
        Ok((next, fresh))
    }

    /// The unbalanced forces of the scheme on free nodes, and zero on new nodes.
    fn left_by_scheme(&self, cx: &Context, state: &State, model: &Model) -> Vec<Force> {
        let is_same = cx.is_dynamic()
            && model.analysis.kind == AnalysisKind::Dynamic
            && cx.model.solution.scheme.in_words() == model.solution.scheme.in_words();
        if !is_same || model.analysis.goes_on() || model.analysis.loads_alone_change() {
            return Vec::new();
        }
        let mut forces = self.forces_left(cx, state);
        for restraint in &cx.model.constraints.restraints {
            forces.on_nodes[restraint.node][restraint.dof] = 0.0;
        }
        self.old.iter().map(|old| old.map_or([0.0; 6], |old| forces.on_nodes[old])).collect()
    }

    /// The forces out of balance on the nodes; `None` where the new scene has other nodes.
    fn out_of_balance(&self, cx: &Context, state: &State) -> Option<Vec<Force>> {
        let forces = self.forces_left(cx, state);
        self.old.iter().map(|old| old.map(|old| forces.on_nodes[old])).collect()
    }

    /// The forces out of balance on the nodes of the scene before.
    fn forces_left(&self, cx: &Context, state: &State) -> Forces {
        let (mut forces, mut loading) = (Forces::new(cx.system, state.nodes.len()), Loading::default());
        forces.multipliers.values.copy_from_slice(&state.multipliers);
        cx.excitation.loading(state.time, Side::Before, &mut loading);
        cx.system.residual(&state.configuration(), &loading, &mut forces);
        forces
    }

    /// The multipliers of the equations that both scenes have; zero for others.
    fn multipliers(&self, (old, values): (&System, &[f64]), system: &System) -> Vec<f64> {
        let number = |first: &mut usize, joint: &mechanics::constraints::joint::Joint| {
            let begin = *first;
            *first += joint.equations.len();
            Some(begin)
        };
        let firsts: Vec<usize> = old.joints.iter().scan(0, number).collect();
        let mut all = Vec::with_capacity(system.multipliers());
        for (joint, known) in system.joints.iter().zip(&self.joints) {
            all.extend(joint.equations.iter().map(|row| {
                let place =
                    |known: usize| Some(firsts[known] + old.joints[known].equations.iter().position(|old| old == row)?);
                known.and_then(place).map_or(0.0, |place| values[place])
            }));
        }
        all
    }
}

/// Writes the velocities of the state into the model, and those of the deck at the current positions; the plan uses them to find the moving
/// parts.
fn carry_velocities(from: &NodeMap, (before, state): (&Model, &State), model: &mut Model) {
    let [goes_on, moved] = [&*model, before].map(|model| model.analysis.kind == AnalysisKind::Dynamic);
    // About modes bodies spin as they have done, or, before any motion, as the deck says.
    if !(goes_on || moved && model.analysis.has_modes()) {
        return;
    }
    for (node, old) in model.nodes.iter_mut().zip(&from.old) {
        let Some(now) = old.map(|old| &state.nodes[old]) else { continue };
        node.v = node.given[0].as_ref().map_or(now.v, |given| given.velocity(&now.x, &(now.R() * given.normal)));
        node.omega = node.given[1].as_ref().map_or(now.omega, |given| given.angular_velocity(&now.x));
    }
    for restraint in model.constraints.restraints.iter().filter(|restraint| restraint.motion.is_none()) {
        let node = &mut model.nodes[restraint.node];
        let given = &node.given[restraint.dof / 3];
        if given.is_some() {
            (if restraint.dof < 3 { &mut node.v } else { &mut node.omega })[restraint.dof % 3] = 0.0;
        }
    }
}

/// Keeps the equations of earlier joints, and refers new equations to the current nodes; true if any differs from the deck. A support may
/// fix other directions than before.
fn rejoin(from: &NodeMap, before: &Model, nodes: &[Node], model: &mut Model) -> bool {
    let mut changed = false;
    for (joint, known) in model.constraints.joints.iter_mut().zip(&from.joints) {
        let [a, b] = joint.ends.map(|end| &nodes[end]);
        let meets = a.relative_position(b).amax() <= MEETING * (a.x.amax() + b.x.amax());
        let known = known.map(|known| &before.constraints.joints[known]);
        let kept = |row: &ConstraintEquation| {
            let of = known?;
            let rows = of.of_deck.iter().zip(&of.equations);
            rows.filter(|(deck, _)| *deck == row).map(|(_, held)| *held).next()
        };
        let hold = |row: &ConstraintEquation| kept(row).unwrap_or_else(|| row.held_here([a, b], joint.supports, meets));
        let held: Vec<ConstraintEquation> = joint.of_deck.iter().map(hold).collect();
        changed |= held != joint.equations;
        joint.equations = held;
    }
    changed | recount(from, before, nodes, model)
}

/// Keeps the counts of earlier coordinates, and starts those of new joints at the current positions; true if any differs from the deck.
fn recount(from: &NodeMap, before: &Model, nodes: &[Node], model: &mut Model) -> bool {
    let mut springs = Vec::new();
    let mut changed = false;
    for (joint, known) in model.constraints.joints.iter_mut().zip(&from.joints) {
        let Some(coordinate) = &mut joint.coordinate else { continue };
        let known = known.and_then(|known| before.constraints.joints[known].coordinate.as_ref());
        let lock = match known {
            Some(known) => known.lock,
            None => coordinate.lock.counted_from_here(joint.ends.map(|end| &nodes[end])),
        };
        changed |= lock != coordinate.lock;
        coordinate.lock = lock;
        springs.extend(coordinate.spring.map(|spring| (spring, lock)));
    }
    set_coordinate_equations(model.each_mut(), &springs);
    changed
}

/// Sets all velocities and accelerations to zero.
fn rest(state: &mut State) {
    let zero = Vec3::zeros();
    for node in &mut state.nodes {
        (node.v, node.omega, node.a, node.alpha) = (zero, zero, zero, zero);
    }
    state.jerk.fill(Vec6::zeros());
    state.algorithmic_accelerations.clear();
    (state.work.damping_power, state.work.accelerations, state.work.step) = (0.0, 0.0, 0.0);
}

/// Adds loads that balance the residual forces and fade to zero over the stage; true if there are any. All nonzero forces are balanced,
/// however small beside other forces: they may move a soft part.
fn hold_back(model: &mut Model, system: &System, state: &State, length: f64) -> bool {
    let mut forces = Forces::new(system, state.nodes.len());
    let mut loading = Loading::default();
    forces.multipliers.values.copy_from_slice(&state.multipliers);
    let excitation = Excitation::new(model);
    // After unloading all forces may be rounding errors, so the loads at the end of the stage set the scale.
    excitation.loading(model.analysis.end_time, Side::Before, &mut loading);
    let later = system.residual(&state.configuration(), &loading, &mut forces);
    excitation.loading(state.time, Side::After, &mut loading);
    let scale = system.residual(&state.configuration(), &loading, &mut forces).or_larger(&later);
    for restraint in &model.constraints.restraints {
        forces.on_nodes[restraint.node][restraint.dof] = 0.0;
    }
    if let Some(normal) = system.plane {
        // Rounding errors out of the plane must not cause motion out of it.
        let keep = |of: &mut [f64; 6]| {
            (0..3).for_each(|i| of[if i == normal { i } else { 3 + i }] = 0.0);
        };
        forces.on_nodes.iter_mut().for_each(keep);
    }
    if let Some(stage) = &mut model.analysis.stage {
        stage.holds_back = forces.on_nodes.iter().any(|of| is_felt(of, scale, length));
    }
    let amplitude = model.loading.amplitudes.len();
    let before = model.loading.nodal.len();
    let held = forces.on_nodes.iter().enumerate().filter(|(_, of)| **of != [0.0; 6]);
    model.loading.nodal.extend(held.map(|(node, of)| Load {
        node,
        force: -Vec3::new(of[0], of[1], of[2]),
        moment: -Vec3::new(of[3], of[4], of[5]),
        follower: false,
        amplitude: Some(amplitude),
        origin: None,
        moment_counts: moment_is_felt(of, scale, length),
    }));
    let ends = [[state.time, 1.0], [model.analysis.end_time, 0.0]];
    model.loading.amplitudes.push(Amplitude::Table(StraightLines::new(ends.to_vec())));
    model.loading.nodal.len() > before
}

/// True for forces above the residual of a converged equilibrium.
fn is_felt(of: &[f64; 6], scale: Scale, length: f64) -> bool {
    largest(&of[..3]) > LEFT * scale.force || moment_is_felt(of, scale, length)
}

/// True for moments above the residual of a converged equilibrium.
fn moment_is_felt(of: &[f64; 6], scale: Scale, length: f64) -> bool {
    largest(&of[3..]) > LEFT * scale.moment_beside_forces(length)
}

/// The largest magnitude.
fn largest(of: &[f64]) -> f64 {
    of.iter().fold(0.0, |most, value| most.max(value.abs()))
}
