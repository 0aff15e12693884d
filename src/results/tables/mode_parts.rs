//! mode_parts.csv: where the strain energy of each mode is.

use crate::extent::Rows;
use crate::table::{TableKind, WriteRow};
use base::quantities::{Column, Unit};
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "mode_parts.csv",
    about: "One row for each mode and each part that stores energy in it; none for modes without stiffness. Written with \
            `kind = \"modal\"` and `\"buckling\"`, and for the modes of a `\"frequency-response\"`.",
    columns: &[&[
        Column::key("mode", "number of the mode, from 1"),
        Column::key("kind", "`beam`, `bar`, `shell`, `link` or `contact`"),
        Column::key("part", "name of the part"),
        Column::scalar("strain", "part of the strain energy of the mode", Unit::One)
            .positive("stored energy; negative if the stress reduces the stiffness below zero"),
    ]],
    wanted: |model| model.analysis.lists_modes() && !model.parts.is_empty(),
    needs: Wanted::MODES,
    has_last: |_| true,
    every_step: false,
    extent: |_| Rows { rows: 0, letters: 0, numbers: 0 },
    rows: |_| Box::new(write),
    answers: None,
};

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let Some(modes) = frame.modes else { return Ok(()) };
    for (number, mode) in (1..).zip(&modes.list) {
        for share in &mode.shares {
            let part = &frame.model.parts[share.part];
            let row = table.row(frame.step, frame.state.time).count(number);
            row.text(part.kind().word()).text(part.name()).number(share.strain).end()?;
        }
    }
    Ok(())
}
