//! steps.csv: what each accepted step cost, whether or not it is written elsewhere.

use super::table::Table;
use crate::solve::Frame;
use std::io;

pub(super) fn header() -> String {
    "step,time,dt,iterations,refactorizations,residual,cuts".into()
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    if frame.step == 0 {
        return Ok(()); // no step led to t = 0
    }
    table.row(frame.step, frame.state.time).number(frame.dt).count(frame.iterations).count(frame.refactorizations);
    table.number(frame.residual).count(frame.cuts).end()
}
