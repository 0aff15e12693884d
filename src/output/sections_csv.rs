//! sections.csv: section forces of the beams at their integration points, section axes.

use super::table::Table;
use crate::solve::Frame;
use std::io;

pub(super) fn header() -> String {
    "step,time,beam,element,point,s,N,Qy,Qz,T,My,Mz,plastic_strain".into()
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    frame.sections.iter().try_for_each(|point| {
        let at = &point.at;
        table.row(frame.step, frame.state.time).text(frame.model.parts[point.part].name());
        table.count(point.element).count(point.point).number(at.s).numbers(&at.forces).number(at.plastic_strain).end()
    })
}
