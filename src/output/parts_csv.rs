//! parts.csv: the elastic energy of each beam, bar and shell.

use super::table::Table;
use crate::solve::Frame;
use std::io;

pub(super) fn header() -> String {
    "step,time,kind,part,strain".into()
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    frame.parts.iter().try_for_each(|part| {
        let of = part.of(frame.model);
        table.row(frame.step, frame.state.time).text(of.kind().word()).text(of.name()).number(part.strain).end()
    })
}
