//! contacts.csv: clearances and forces of the contacts.

use crate::model::{Contact, PartKind};
use crate::output::table::TableKind;
use crate::output::table_file::TableFile;
use crate::quantities::{CONTACT, Column};
use crate::solve::{ContactState, Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "contacts.csv",
    about: "One row for each contact: its least clearance and what all its points together exert on the surface. Written if \
            `[output] contacts = true` and there are contacts.",
    columns: &[&[Column::key("contact", "name of the contact")], &CONTACT],
    wanted: |model| model.output.contacts && model.has(PartKind::Contact),
    needs: Wanted::CONTACTS,
    every_step: false,
    rows: |_| Box::new(write),
};

/// The columns of one contact, and the magnitude of the force, which only `[[expect]]` asks for.
pub fn values(contact: &ContactState) -> [f64; 9] {
    let ContactState { touching, gap, f, m } = *contact;
    [touching as f64, gap, f.x, f.y, f.z, m.x, m.y, m.z, f.norm()]
}

fn write(table: &mut TableFile, frame: &Frame) -> io::Result<()> {
    frame.model.each::<Contact>().zip(&frame.derived.contacts).try_for_each(|(contact, state)| {
        let row = table.row(frame.step, frame.state.time).text(&contact.name).count(state.touching);
        row.numbers(&values(state)[1..CONTACT.len()]).end()
    })
}
