//! bars.csv: the axial force of each element of the bars.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{AXIAL_FORCE, Column};
use model::{Bar, ExpectAt, Model, PartKind};
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "bars.csv",
    about: "One row for each element of each bar. Written with `[output] sections` if there are bars.",
    columns: &[&[
        Column::key("bar", "name of the bar"),
        Column::key("element", "number of the element along the bar, from 0"),
        AXIAL_FORCE,
    ]],
    wanted: |model| model.output.sections.is_some() && model.has(PartKind::Bar),
    needs: Wanted::BARS,
    has_last: |_| true,
    every_step: false,
    extent: |extent| {
        let bars = || extent.model.each::<Bar>();
        let names = bars().flat_map(|bar| std::iter::repeat_n(bar.name.as_str(), bar.elements.len()));
        Rows::named(names, bars().map(|bar| bar.elements.len()).sum())
    },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::BARS, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Elements(..) => vec![AXIAL_FORCE.name],
        _ => Vec::new(),
    }
}

/// The force of the largest magnitude along the bar, with its sign.
fn value(at: ExpectAt, _: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Elements(from, to) = at else { return None };
    let before = elements_before(frame.model);
    let forces = frame.derived.bars.get(from.checked_sub(before)?..to.checked_sub(before)?)?;
    forces.iter().copied().reduce(|most, force| if force.abs() > most.abs() { force } else { most })
}

/// Elements are counted through all parts with sections, then all bars.
fn elements_before(model: &Model) -> usize {
    model.parts.iter().filter(|part| part.kind().has_sections()).map(|part| part.elements()).sum()
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let elements = frame.model.each::<Bar>().flat_map(|bar| (0..bar.elements.len()).map(move |e| (&bar.name, e)));
    elements.zip(&frame.derived.bars).try_for_each(|((name, element), force)| {
        table.row(frame.step, frame.state.time).text(name).count(element).number(*force).end()
    })
}
