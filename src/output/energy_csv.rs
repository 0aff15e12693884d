//! energy.csv: the energy balance and the momenta.

use super::table::Table;
pub use crate::model::ENERGY as COLUMNS;
use crate::solve::Frame;
use crate::system::energy::Energy;
use std::io;

/// The columns of one state.
pub fn values(e: &Energy) -> [f64; 18] {
    let [p, l] = [e.p, e.l];
    [
        e.kinetic,
        e.strain,
        e.plastic,
        e.viscous,
        e.damping,
        e.links,
        e.external,
        e.numerical,
        e.total,
        p.x,
        p.y,
        p.z,
        l.x,
        l.y,
        l.z,
        e.contact,
        e.friction,
        e.impact,
    ]
}

pub(super) fn header() -> String {
    format!("step,time,{}", COLUMNS.join(","))
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    let Some(energy) = frame.energy else { return Ok(()) };
    table.row(frame.step, frame.state.time).numbers(&values(energy)).end()
}
