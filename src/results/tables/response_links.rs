//! response_links.csv: the steady forces of links at each frequency.

use crate::extent::Rows;
use crate::response_rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{Column, RESPONSE_FREQUENCY, RESPONSE_LINK, names};
use model::{ExpectAt, Model, Part, ResponseOf};
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "response_links.csv",
    about: "One row for each frequency in ascending order and each link, such as a bearing. Its columns are amplitude and phase of the force \
            and moment on its first end, with those of dampers. links.csv has the state at rest. Written with `kind = \"frequency-response\"` \
            if `[output] links = true` and there are links.",
    columns: &[&[RESPONSE_FREQUENCY], &[Column::key("link", "name of the link")], &RESPONSE_LINK],
    wanted: |model| model.analysis.response().is_some() && model.output.links && of_deck(model).next().is_some(),
    needs: Wanted::MODES,
    has_last: |_| true,
    every_step: false,
    extent: |_| Rows { rows: 0, letters: 0, numbers: 0 },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::MODES, value: response_rows::value }),
};

/// The links of the deck.
fn of_deck(model: &Model) -> impl Iterator<Item = &Part> {
    model.parts.iter().filter(|part| part.kind().word() == "link" && part.is_listed())
}

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Response(ResponseOf::LinkForce(_), _) => names(&[&RESPONSE_LINK]),
        _ => Vec::new(),
    }
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let Some(found) = frame.modes.and_then(|modes| modes.response.as_ref()) else { return Ok(()) };
    let named: Vec<(&str, ResponseOf)> =
        of_deck(frame.model).enumerate().map(|(place, link)| (link.name(), ResponseOf::LinkForce(place))).collect();
    let mut rows = found.rows[frame.rows.clone()].iter();
    rows.try_for_each(|row| response_rows::write(table, frame, (found, row), &named))
}
