//! steps.csv: what each accepted step cost, whether or not it is written elsewhere.

use crate::model::ExpectAt;
use crate::output::table::{Answers, TableKind};
use crate::output::table_file::TableFile;
use crate::quantities::{Column, TIME, Unit};
use crate::solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "steps.csv",
    about: "One row for each accepted step, whatever the cadence of output; always written.",
    columns: &[&[
        Column::scalar(
            "dt",
            "length of the step; along a path by arc length, its increment of the load factor",
            Unit::Time,
        ),
        Column::scalar("iterations", "equilibrium iterations", Unit::Count),
        Column::scalar("refactorizations", "factorizations of the matrix", Unit::Count),
        Column::scalar("residual", "relative residual force at the last evaluation", Unit::One),
        Column::scalar("cuts", "cutbacks before the step was accepted", Unit::Count),
    ]],
    wanted: |_| true,
    needs: Wanted::EVERY_STEP,
    every_step: true,
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

fn write(table: &mut TableFile, frame: &Frame) -> io::Result<()> {
    if frame.step == 0 {
        return Ok(()); // no step led to t = 0
    }
    table.row(frame.step, frame.state.time).number(frame.dt).count(frame.iterations).count(frame.refactorizations);
    table.number(frame.residual).count(frame.cuts).end()
}
