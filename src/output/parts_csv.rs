//! parts.csv: the elastic energy of each beam, bar and shell.

use super::table::Table;
use crate::solve::Frame;
use crate::system::GroupKind;
use std::io;

pub(super) fn header() -> String {
    "step,time,kind,part,strain".into()
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    frame.parts.iter().try_for_each(|part| {
        let kind = match part.kind {
            GroupKind::Beam => "beam",
            GroupKind::Bar => "bar",
            GroupKind::Shell => "shell",
            GroupKind::Link => "link",
            GroupKind::Contact => "contact",
        };
        table.row(frame.step, frame.state.time).text(kind).text(part.name(frame.model)).number(part.strain).end()
    })
}
