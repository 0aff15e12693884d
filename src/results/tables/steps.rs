//! steps.csv: the cost of the steps, at the times of the rows of tables.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{Column, TIME, Unit};
use model::ExpectAt;
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "steps.csv",
    about: "One row at each time of output, for all accepted steps that have ended since the row before: with `every = 1` one for each step. \
            Always written.",
    columns: &[&[
        Column::scalar(
            "dt",
            "length of the last step; along a path by arc length, its increment of the load factor",
            Unit::Time,
        ),
        Column::scalar("iterations", "equilibrium iterations, of all steps since the row before", Unit::Count),
        Column::scalar("refactorizations", "factorizations of the matrix, likewise", Unit::Count),
        Column::scalar("residual", "relative residual force at the last evaluation of a step, the largest", Unit::One),
        Column::scalar("cuts", "cutbacks before the steps were accepted, of all", Unit::Count),
    ]],
    wanted: |_| true,
    needs: Wanted::NOTHING,
    has_last: |_| true,
    every_step: true,
    // Length and residual; the rest are counts, like zeros in length.
    extent: |_| Rows { rows: 1, letters: 0, numbers: 2 },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::NOTHING, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Analysis => vec![TIME.name],
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, _: usize, frame: &Frame) -> Option<f64> {
    matches!(at, ExpectAt::Analysis).then_some(frame.state.time)
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    // No step led to t = 0.
    if frame.step == 0 || !frame.due {
        return Ok(());
    }
    let cost = frame.derived.effort;
    table.row(frame.step, frame.state.time).number(frame.dt).count(cost.iterations).count(cost.refactorizations);
    table.number(cost.residual).count(cost.cuts).end()
}
