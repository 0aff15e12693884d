//! reactions.csv: force or moment on the structure in every held direction.

use super::table::Table;
use crate::model::DIRECTIONS;
use crate::solve::Frame;
use std::io;

pub(super) fn header() -> String {
    "step,time,node,direction,value".into()
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    frame.model.held.iter().zip(frame.reactions).try_for_each(|(held, value)| {
        let node = &frame.model.nodes[held.node];
        table.row(frame.step, frame.state.time).text(&node.label).text(DIRECTIONS[held.dof]).number(*value).end()
    })
}
