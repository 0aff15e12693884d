//! contacts.csv: clearances and forces of the contacts.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{CONTACT, CONTACT_FORCE, Column, names};
use model::{Contact, ContactRows, ExpectAt, PartKind};
use solve::{ContactState, Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "contacts.csv",
    about: "One row for each contact: its least clearance, and the force and moment of all its points on the surface. Written with `[output] \
            contacts` if there are contacts.",
    columns: &[&[Column::key("contact", "name of the contact")], &CONTACT],
    wanted: |model| {
        model.output.contacts.is_some_and(|rows| rows != ContactRows::Pairs) && model.has(PartKind::Contact)
    },
    needs: Wanted::CONTACTS,
    has_last: |_| true,
    every_step: false,
    extent: |extent| {
        let contacts = || extent.model.each::<Contact>();
        // Apart there are no forces: the clearance alone.
        Rows::named(contacts().map(|contact| contact.name.as_str()), 2 * contacts().count())
    },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::CONTACTS, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Part(part) if part.kind == PartKind::Contact => names(&[&CONTACT, &[CONTACT_FORCE]]),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Part(part) = at else { return None };
    let contact = frame.derived.contacts.get(part.index)?;
    values(contact).get(index).copied()
}

/// The columns of one contact, and the magnitude of the force for `[[expect]]`.
fn values(contact: &ContactState) -> [f64; 10] {
    let ContactState { touching, slipping, gap, f, m } = *contact;
    [touching as f64, slipping as f64, gap, f.x, f.y, f.z, m.x, m.y, m.z, f.norm()]
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    frame.model.each::<Contact>().zip(&frame.derived.contacts).try_for_each(|(contact, state)| {
        let row = table.row(frame.step, frame.state.time).text(&contact.name);
        let row = row.count(state.touching).count(state.slipping);
        row.numbers(&values(state)[2..CONTACT.len()]).end()
    })
}
