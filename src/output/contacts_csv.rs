//! contacts.csv: gaps and forces of the contacts.

use super::table::Table;
pub use crate::model::CONTACT as QUANTITIES;
use crate::model::Contact;
use crate::solve::{ContactState, Frame};
use std::io;

/// All but the size of the force, which only `[[expect]]` asks for.
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
    frame.model.each::<Contact>().zip(frame.contacts).try_for_each(|(contact, state)| {
        let row = table.row(frame.step, frame.state.time).text(&contact.name).count(state.touching);
        row.numbers(&values(state)[1..COLUMNS]).end()
    })
}
