//! reactions.csv: force or moment on the structure in every held direction, and on the first end of every joint.

use super::table::Table;
use crate::model::DIRECTIONS;
use crate::solve::Frame;
use std::io;

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
        let values = state_of.f.iter().chain(&state_of.m);
        DIRECTIONS.iter().zip(values).try_for_each(|(direction, value)| {
            table.row(step, state.time).text(&joint.name).text(direction).number(*value).end()
        })
    })
}
