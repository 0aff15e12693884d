//! links.csv: elongations and forces of the links.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{Column, LINK, names};
use model::{ExpectAt, Link, Model, PartKind};
use solve::{Frame, LinkState, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "links.csv",
    about: "One row for each link. Written if `[output] links = true` and there are links.",
    columns: &[&[Column::key("link", "name of the link")], &LINK],
    wanted: |model| model.output.links && of_deck(model).next().is_some(),
    needs: Wanted::LINKS,
    has_last: |model| model.output.failures,
    every_step: false,
    extent: |extent| {
        // Elongation, rate and force, and the force as a vector; few resist moments.
        let [force, _] = extent.components();
        let links = || of_deck(extent.model);
        Rows::named(links().map(|link| link.name.as_str()), (3 + force) * links().count())
    },
    rows: |model| {
        let count = LINK.len() - usize::from(!model.output.failures);
        Box::new(move |table, frame| write(table, frame, count))
    },
    answers: Some(Answers { quantities, needs: Wanted::LINKS, value }),
};

/// Links of joints come after those of the deck, and have rows in joints.csv.
fn of_deck(model: &Model) -> impl Iterator<Item = &Link> {
    model.each::<Link>().filter(|link| !link.is_of_joint())
}

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Part(part) if part.kind == PartKind::Link => names(&[&LINK]),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Part(part) = at else { return None };
    let link = frame.derived.links.get(part.index)?;
    values(link).get(index).copied()
}

/// The columns of one link, in the order of [`LINK`].
fn values(link: &LinkState) -> [f64; 10] {
    let LinkState { elongation, rate, force, f, m, failed } = *link;
    [elongation, rate, force, f.x, f.y, f.z, m.x, m.y, m.z, f64::from(u8::from(failed))]
}

/// Writes the first `count` columns of each link.
fn write(table: &mut dyn WriteRow, frame: &Frame, count: usize) -> io::Result<()> {
    of_deck(frame.model).zip(&frame.derived.links).try_for_each(|(link, state)| {
        table.row(frame.step, frame.state.time).text(&link.name).numbers(&values(state)[..count]).end()
    })
}
