//! The transverse loads of joints, which determine their friction, stored with their rates at the end of each step.

use super::group::Group;
use super::parts::links::{self, LinkElement};
use base::math::{Vec3, linear};
use mechanics::constraints::joint::{ConstraintEquation, Joint};
use mechanics::state::State;
use model::Model;

/// A joint whose friction grows with its load.
pub struct JointLoad {
    /// The number of its first constraint equation, and the number of its equations without a drive.
    equations: [usize; 2],
    /// Index among the joints of the system.
    joint: usize,
    /// The equation that would lock its coordinate.
    lock: ConstraintEquation,
    /// Place of the load among all history variables; its rate stands behind it.
    place: usize,
}

/// Finds the joints whose friction grows with their load, by all joints, links and groups of a system.
pub fn find(model: &Model, joints: &[Joint], (links, groups): (&[LinkElement], &[Group])) -> Vec<JointLoad> {
    let mut first = 0;
    let mut found = Vec::new();
    for (joint, (made, of_model)) in joints.iter().zip(&model.constraints.joints).enumerate() {
        let held = made.equations.len() - usize::from(made.drive.is_some());
        let spring = of_model.coordinate.as_ref().and_then(|coordinate| coordinate.spring);
        if let Some((index, LinkElement::Joint(along))) = spring.map(|index| (index, &links[index]))
            && let Some(place) = along.law.load_memory()
        {
            let place = links::history_of(links, groups, index).start + place;
            found.push(JointLoad { equations: [first, held], joint, lock: along.lock, place });
        }
        first += made.equations.len();
    }
    found
}

impl JointLoad {
    /// Writes the transverse load of the joint and its rate at the end of a step of length `dt`, which is zero at a start or a jump.
    pub fn remember(&self, joints: &[Joint], state: &mut State, dt: f64) {
        let JointLoad { equations: [first, held], joint, lock, place } = self;
        let made = &joints[*joint];
        let [a, b] = made.nodes.map(|node| &state.nodes[node]);
        let of = |(row, lambda): (&ConstraintEquation, &f64)| *lambda * linear(&row.gradient(a, b)[0]);
        let whole: Vec3 = made.equations[..*held].iter().zip(&state.multipliers[*first..]).map(of).sum();
        let Some(axis) = lock.axis(a, b) else { return };
        let load = (whole - axis * axis.dot(&whole)).norm();
        let before = std::mem::replace(&mut state.history[*place], load);
        state.history[*place + 1] = if dt > 0.0 { (load - before) / dt } else { 0.0 };
    }
}
