//! campbell.csv: modes over speeds of rotation.

use crate::extent::Rows;
use crate::table::{TableKind, WriteRow};
use base::quantities::{CAMPBELL, CAMPBELL_SPEED, Column};
use solve::{Frame, Wanted};
use std::f64::consts::TAU;
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "campbell.csv",
    about: "One row for each speed of `speeds`, ascending, and each mode, by its frequency. All bodies that spin at t = 0 spin in proportion. \
            Written with `kind = \"modal\"` and `speeds`.",
    columns: &[&[CAMPBELL_SPEED], &[Column::key("mode", "number of the mode at this speed, from 1")], &CAMPBELL],
    wanted: |model| !model.analysis.speeds().is_empty(),
    needs: Wanted::MODES,
    has_last: |_| true,
    every_step: false,
    extent: |_| Rows { rows: 0, letters: 0, numbers: 0 },
    rows: |_| Box::new(write),
    answers: None,
};

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let Some(modes) = frame.modes else { return Ok(()) };
    for at_speed in &modes.speeds {
        for (number, mode) in (1..).zip(&at_speed.list) {
            let row = table.row(frame.step, frame.state.time).number(at_speed.speed).count(number);
            row.number(mode.root[1] / TAU).number(mode.root[1]).optional(mode.damping_ratio());
            row.number(mode.root[0]).optional(mode.whirl.map(|whirl| whirl.sense)).end()?;
        }
    }
    Ok(())
}
