//! reactions.csv: force or moment on the structure in every held direction, and on the first end of every joint.

use super::table::Table;
use crate::model::DIRECTIONS;
use crate::solve::{Frame, JointState};
use std::io;

/// What a joint does to its first end.
pub const OF_JOINTS: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

pub fn of_joint(joint: &JointState) -> [f64; 6] {
    let [f, m] = [joint.f, joint.m];
    [f.x, f.y, f.z, m.x, m.y, m.z]
}

pub(super) fn header() -> String {
    "step,time,node,direction,value".into()
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    let Frame { model, step, state, .. } = *frame;
    model.held.iter().zip(frame.reactions).try_for_each(|(held, value)| {
        let node = &model.nodes[held.node];
        table.row(step, state.time).text(&node.label).text(DIRECTIONS[held.dof]).number(*value).end()
    })?;
    // A joint that holds a node to its support carries what the support does.
    model.joints.iter().zip(frame.joints).filter(|(joint, _)| !joint.supports).try_for_each(|(joint, state_of)| {
        DIRECTIONS.iter().zip(of_joint(state_of)).try_for_each(|(direction, value)| {
            table.row(step, state.time).text(&joint.name).text(direction).number(value).end()
        })
    })
}
