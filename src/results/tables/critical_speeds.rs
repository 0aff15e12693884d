//! critical_speeds.csv: speeds of rotation that are the frequency of a mode.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{CRITICAL_SPEED, Column, names};
use model::ExpectAt;
use solve::modes::CriticalSpeed;
use solve::{Frame, Wanted};
use std::f64::consts::TAU;
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "critical_speeds.csv",
    about: "One row for each speed within `speeds` at which a mode of any `kind` has the frequency of the rotation, the lowest first. Unbalance excites \
            all but those of torsion and axial motion; backward ones only where supports or bearings are unequal in two directions. \
            Written with `kind = \"modal\"` and `speeds`.",
    columns: &[&NUMBERED, &CRITICAL_SPEED],
    wanted: |model| !model.analysis.speeds().is_empty(),
    needs: Wanted::MODES,
    has_last: |_| true,
    every_step: false,
    extent: |_| Rows { rows: 0, letters: 0, numbers: 0 },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::MODES, value }),
};

const NUMBERED: [Column; 2] = [
    Column::key(
        "critical",
        "number of the critical speed among those of every kind, from 1: the `critical_speed` of `[[expect]]`",
    ),
    Column::key(
        "kind",
        "\"forward\", \"backward\", \"planar\" of orbits, or \"torsion or axial\" of motion about or along the axis",
    ),
];

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::CriticalSpeed(_) => names(&[&CRITICAL_SPEED]),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::CriticalSpeed(number) = at else { return None };
    values(frame.modes?.critical_speeds.get(number)?)[index]
}

/// The columns of a critical speed, in the order of [`CRITICAL_SPEED`].
fn values(critical: &CriticalSpeed) -> [Option<f64>; CRITICAL_SPEED.len()] {
    [
        Some(critical.speed),
        Some(critical.speed / TAU),
        critical.mode.damping_ratio(),
        critical.mode.whirl.map(|whirl| whirl.sense),
    ]
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let Some(modes) = frame.modes else { return Ok(()) };
    (1..).zip(&modes.critical_speeds).try_for_each(|(number, critical)| {
        let row = table.row(frame.step, frame.state.time).count(number);
        let row = row.text(critical.mode.whirl.map_or("", |whirl| whirl.kind()));
        for value in values(critical) {
            row.optional(value);
        }
        row.end()
    })
}
