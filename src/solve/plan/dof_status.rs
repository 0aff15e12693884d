//! The status of each degree of freedom: unknown, restrained, dependent or omitted, and why.

use crate::system::System;
use base::math::Vec3;
use mechanics::constraints::joint::ConstraintEquation;
use mechanics::elements::ElementBlock;
use model::{AnalysisKind, Model};

/// The status of a degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DofStatus {
    /// An unknown of the system.
    Unknown,
    /// Restrained or prescribed by a support.
    Restrained,
    /// Follows from a master by a rigid link.
    Dependent,
    /// No element, link or inertia acts on it.
    Unused,
    /// Only inertia acts on it, and nothing can excite it.
    Inactive,
    /// Leads out of the plane of a plane motion.
    Plane,
    /// Follows from the shapes of a reduced part.
    Reduced,
}

/// The status of a node's six degrees of freedom.
pub type NodeStatus = [DofStatus; 6];

/// The status of the degrees of freedom of all nodes, in the order of the model.
pub fn classify(model: &Model, system: &System) -> Vec<NodeStatus> {
    let n = model.nodes.len();
    let resisted = resistance(system, n);
    let moved = match model.analysis.has_modes() {
        // Whatever can move has modes.
        true => vec![[true; 6]; n],
        false => causes(model, system, &resisted),
    };
    let normal = system.plane;
    let mut statuses = vec![[DofStatus::Unused; 6]; n];
    for inertia in &system.inertias {
        for dof in 0..6 {
            if dof < 3 || inertia.rotary {
                statuses[inertia.node][dof] =
                    if moved[inertia.node][dof] { DofStatus::Unknown } else { DofStatus::Inactive };
            }
        }
    }
    for (status, resisted) in statuses.iter_mut().zip(&resisted) {
        for dof in 0..6 {
            if resisted[dof] {
                status[dof] = DofStatus::Unknown;
            }
        }
    }
    if let Some(normal) = normal {
        for status in &mut statuses {
            for (dof, reason) in status.iter_mut().enumerate() {
                let out = if dof < 3 { dof == normal } else { dof - 3 != normal };
                if out && *reason == DofStatus::Unknown {
                    *reason = DofStatus::Plane;
                }
            }
        }
    }
    // A number is no way in space, whatever the plane; one without a name belongs to nothing.
    for node in model.number_nodes() {
        statuses[node] = [DofStatus::Unused; 6];
        if !model.nodes[node].label.is_empty() {
            statuses[node][0] = DofStatus::Unknown;
        }
    }
    for dependent in &model.constraints.dependents {
        for dof in (0..6).filter(|&d| dependent.dofs[d]) {
            statuses[dependent.node][dof] = DofStatus::Dependent;
        }
    }
    for node in system.following().iter().flat_map(|following| following.nodes()) {
        statuses[*node] = [DofStatus::Reduced; 6];
    }
    for restraint in &model.constraints.restraints {
        statuses[restraint.node][restraint.dof] = DofStatus::Restrained;
    }
    statuses
}

/// The degrees of freedom on which elements, joints, dampers or dependent nodes act.
fn resistance(system: &System, n: usize) -> Vec<[bool; 6]> {
    let mut acts = vec![[false; 6]; n];
    for group in &system.groups {
        for e in 0..group.block.len() {
            let reach = reach(&*group.block, e);
            for (k, &node) in group.block.nodes(e).iter().enumerate() {
                let to = if reach[3] && !group.block.is_rotational(e, k) { 3 } else { 6 };
                for dof in 0..to {
                    acts[node][dof] |= reach[dof];
                }
            }
        }
    }
    for group in &system.groups {
        let [nodes, turned] = group.further_nodes();
        nodes.iter().for_each(|&node| acts[node][..3].fill(true));
        turned.iter().for_each(|&node| acts[node][3..].fill(true));
    }
    for damping in system.nodal_damping() {
        for dof in 0..6 {
            acts[damping.node][dof] |= if dof < 3 { damping.translation > 0.0 } else { damping.rotation > 0.0 };
        }
    }
    for joint in &system.joints {
        let moving = || joint.ends().take(if joint.supports { 1 } else { usize::MAX }).enumerate();
        for reach in joint.equations.iter().map(ConstraintEquation::reach) {
            for (end, node) in moving() {
                acts[node].iter_mut().zip(reach[end.min(1)]).for_each(|(acts, reaches)| *acts |= reaches);
            }
        }
    }
    // The entry of a node is `None` without mass, else it says whether there is rotary inertia.
    let mut has_mass = vec![None; n];
    system.inertias.iter().for_each(|i| has_mass[i.node] = Some(i.rotary));
    // Whatever acts on a dependent node acts on its master; a force at an arm also exerts a moment.
    for dependent in system.rigid_links.iter().rev() {
        for dof in (0..6).filter(|&d| dependent.dofs[d]) {
            let own_mass = has_mass[dependent.node].is_some_and(|rotary| dof < 3 || rotary);
            if !(acts[dependent.node][dof] || own_mass) {
                continue;
            }
            acts[dependent.master][dof] = true;
            if dof < 3 && dependent.S0 != Vec3::zeros() {
                acts[dependent.master][3..6].fill(true);
            }
        }
    }
    acts
}

/// The degrees of freedom on which an element acts: those of its matrix, but only one translation for a link along a
/// global axis.
fn reach(block: &dyn ElementBlock, e: usize) -> [bool; 6] {
    let mut reach = [false; 6];
    reach[..block.dofs()].fill(true);
    if let Some(direction) = block.fixed_direction(e) {
        for i in 0..3 {
            reach[i] = direction[i] != 0.0;
        }
    }
    reach
}

/// Marks the degrees of freedom on which loads on nodes act, at any time.
fn moved_by_loads(model: &Model, moved: &mut [[bool; 6]]) {
    for load in &model.loading.nodal {
        let moved = &mut moved[load.node];
        if let Some(along) = load.coordinate() {
            let reach = along.lock.reach()[along.end];
            (0..6).for_each(|dof| moved[dof] |= reach[dof]);
            continue;
        }
        for i in 0..3 {
            moved[i] |= load.follower || load.force[i] != 0.0;
            moved[3 + i] |= load.follower || load.moment[i] != 0.0;
        }
    }
}

/// The degrees of freedom of masses that something can excite.
fn causes(model: &Model, system: &System, resisted: &[[bool; 6]]) -> Vec<[bool; 6]> {
    let dynamic = model.analysis.kind == AnalysisKind::Dynamic;
    let mut moved = resisted.to_vec();
    moved_by_loads(model, &mut moved);
    for node in model.loading.pressures.iter().flat_map(|load| &load.faces).flat_map(|face| face.nodes()) {
        moved[*node][..3].fill(true);
    }
    for inertia in system.centrifugal().iter().flat_map(|load| &load.inertias) {
        moved[inertia.node].fill(true);
    }
    for restraint in model.constraints.restraints.iter().filter(|restraint| restraint.motion.is_some()) {
        moved[restraint.node][restraint.dof] = true;
    }
    let mut field = model.loading.gravity.map(f64::abs);
    for base in &model.loading.base_accelerations {
        field += base.direction.map(f64::abs);
    }
    // Rotations of a mass about the three axes excite one another; in statics there is no inertia to do so.
    let turn = |moved: &mut [bool; 6]| {
        if dynamic && moved[3..6].contains(&true) {
            moved[3..6].fill(true);
        }
    };
    for inertia in &system.inertias {
        let node = &model.nodes[inertia.node];
        let moved = &mut moved[inertia.node];
        for i in 0..3 {
            moved[i] |= field[i] != 0.0 || dynamic && node.v[i] != 0.0;
            moved[3 + i] |= dynamic && node.omega[i] != 0.0;
        }
    }
    // Whatever excites a dependent node excites its master; at an arm it also rotates it.
    for dependent in system.rigid_links.iter().rev() {
        let of_dependent = moved[dependent.node];
        for dof in (0..6).filter(|&d| dependent.dofs[d] && of_dependent[d]) {
            moved[dependent.master][dof] = true;
            if dof < 3 && dependent.S0 != Vec3::zeros() {
                moved[dependent.master][3..6].fill(true);
            }
        }
    }
    let mut rotary = vec![false; moved.len()];
    for inertia in &system.inertias {
        rotary[inertia.node] = inertia.rotary;
        turn(&mut moved[inertia.node]);
    }
    // A rotating master moves its dependent nodes, and their inertia excites their free rotations.
    for dependent in &system.rigid_links {
        for dof in (3..6).filter(|&d| dependent.dofs[d]) {
            moved[dependent.node][dof] |= moved[dependent.master][dof];
        }
        if rotary[dependent.node] {
            turn(&mut moved[dependent.node]);
        }
    }
    moved
}
