//! parts.csv: the elastic energy of each beam, bar and shell.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{Column, PLASTIC_STRAIN, Unit};
use model::{ExpectAt, Part};
use solve::{Frame, Wanted};
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
    has_last: |_| true,
    every_step: false,
    extent: |extent| {
        let parts = || extent.model.parts.iter().filter(|part| part.kind().is_deformable());
        let rows = Rows::named(parts().map(|part| part.name()), parts().count());
        Rows { letters: rows.letters + parts().map(|part| part.kind().word().len()).sum::<usize>(), ..rows }
    },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::PLASTIC_STRAINS, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Elements(..) | ExpectAt::Sections(_) => vec![PLASTIC_STRAIN.name],
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, _: usize, frame: &Frame) -> Option<f64> {
    let elements = |parts: &[Part]| parts.iter().map(|part| part.elements()).sum::<usize>();
    let (from, to) = match at {
        ExpectAt::Elements(from, to) => (from, to),
        ExpectAt::Sections(part) => (elements(&frame.model.parts[..part]), elements(&frame.model.parts[..=part])),
        _ => return None,
    };
    frame.derived.plastic_strains.get(from..to)?.iter().copied().reduce(f64::max)
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    frame.derived.parts.iter().try_for_each(|part| {
        let of = part.of(frame.model);
        table.row(frame.step, frame.state.time).text(of.kind().word()).text(of.name()).number(part.strain).end()
    })
}
