//! contacts.csv: gaps and forces of the contacts.

use super::table::Table;
use crate::solve::{ContactState, Frame};
use std::io;

/// Points that touch, the least gap, force and moment on the surface; then what only `[[expect]]` asks for: the force's size.
pub const QUANTITIES: [&str; 9] = ["touching", "gap", "fx", "fy", "fz", "mx", "my", "mz", "force"];
const COLUMNS: usize = 8;

/// The quantities of one contact.
pub fn values(contact: &ContactState) -> [f64; 9] {
    let ContactState { touching, gap, f, m } = *contact;
    [touching as f64, gap, f.x, f.y, f.z, m.x, m.y, m.z, f.norm()]
}

pub(super) fn header() -> String {
    format!("step,time,contact,{}", QUANTITIES[..COLUMNS].join(","))
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    frame.model.contacts.iter().zip(frame.contacts).try_for_each(|(contact, state)| {
        let row = table.row(frame.step, frame.state.time).text(&contact.name).count(state.touching);
        row.numbers(&values(state)[1..COLUMNS]).end()
    })
}
