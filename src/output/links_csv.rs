//! links.csv: elongations and forces of the links.

use super::table::Table;
use crate::model::Link;
use crate::solve::{Frame, LinkState};
use std::io;

/// Along the line (of a bushing: its first axis); then force and moment on the first end, global components.
pub const COLUMNS: [&str; 9] = ["elongation", "rate", "force", "fx", "fy", "fz", "mx", "my", "mz"];

/// The columns of one link.
pub fn values(link: &LinkState) -> [f64; 9] {
    let LinkState { elongation, rate, force, f, m } = *link;
    [elongation, rate, force, f.x, f.y, f.z, m.x, m.y, m.z]
}

pub(super) fn header() -> String {
    format!("step,time,link,{}", COLUMNS.join(","))
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    frame.model.each::<Link>().zip(frame.links).try_for_each(|(link, state)| {
        table.row(frame.step, frame.state.time).text(&link.name).numbers(&values(state)).end()
    })
}
