//! parts.csv: the elastic energy of each beam, bar and shell.

use crate::output::table::TableKind;
use crate::output::table_file::TableFile;
use crate::quantities::{Column, Unit};
use crate::solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "parts.csv",
    about: "One row for each beam, bar and shell that deforms. Written if `[output] parts = true`.",
    columns: &[&[
        Column::key("kind", "`beam`, `bar` or `shell`"),
        Column::key("part", "name of the part"),
        Column::scalar("strain", "elastic energy of the part, and what kinematic hardening stores", Unit::Energy)
            .kind("energy"),
    ]],
    wanted: |model| model.output.parts,
    needs: Wanted::PARTS,
    every_step: false,
    rows: |_| Box::new(write),
};

fn write(table: &mut TableFile, frame: &Frame) -> io::Result<()> {
    frame.derived.parts.iter().try_for_each(|part| {
        let of = part.of(frame.model);
        table.row(frame.step, frame.state.time).text(of.kind().word()).text(of.name()).number(part.strain).end()
    })
}
