//! drifts.csv: displacements of points relative to others.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::math::Vec3;
use base::quantities::{Column, DRIFT, names};
use model::{Drift, ExpectAt};
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "drifts.csv",
    about: "One row for each of `[[drifts]]`. Written if the deck has any.",
    columns: &[&[Column::key("drift", "name of the drift")], &DRIFT],
    wanted: |model| !model.output.drifts.is_empty(),
    needs: Wanted::NOTHING,
    has_last: |_| true,
    every_step: false,
    extent: |extent| {
        let drifts = &extent.model.output.drifts;
        Rows::named(drifts.iter().map(|drift| drift.name.as_str()), DRIFT.len() * drifts.len())
    },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::NOTHING, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Drift(_) => names(&[&DRIFT]),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Drift(drift) = at else { return None };
    values(frame.model.output.drifts.get(drift)?, frame)[index]
}

/// The columns of a drift, in the order of [`DRIFT`].
fn values(drift: &Drift, frame: &Frame) -> [Option<f64>; DRIFT.len()] {
    let [from, to] = drift.ends.map(|node| (frame.model.nodes[node].x, &frame.state.nodes[node]));
    let moved: Vec3 = to.1.moved(&to.0) - from.1.moved(&from.0);
    let line = to.0 - from.0;
    let length = line.norm();
    let apart = length > 0.0;
    let across = if apart { moved - line * (line.dot(&moved) / (length * length)) } else { moved };
    // |line + moved| − |line| without the difference of two nearly equal lengths.
    let longer = (2.0 * line.dot(&moved) + moved.norm_squared()) / ((line + moved).norm() + length);
    let longer = match frame.case {
        Some(_) if apart => line.dot(&moved) / length,
        _ if apart => longer,
        _ => moved.norm(),
    };
    let lateral = across.norm();
    let ratio = apart.then(|| lateral / length);
    [Some(moved.x), Some(moved.y), Some(moved.z), Some(longer), Some(lateral), ratio]
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    frame.model.output.drifts.iter().try_for_each(|drift| {
        let row = table.row(frame.step, frame.state.time).text(&drift.name);
        for value in values(drift, frame) {
            row.optional(value);
        }
        row.end()
    })
}
