//! energy.csv: the energy balance and the momenta.

use crate::model::ExpectAt;
use crate::output::table::{Answers, TableKind};
use crate::output::table_file::TableFile;
use crate::quantities::{ENERGY, names};
use crate::solve::{Frame, Wanted};
use crate::system::energy::Energy;
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "energy.csv",
    about: "One row: the energies of the whole scene, their balance, and its momenta. Dissipated energies and work are sums from \
            the initial state on. In a static analysis `kinetic` and the momenta are zero.",
    columns: &[&ENERGY],
    wanted: |model| model.output.energy,
    needs: Wanted::ENERGY,
    every_step: false,
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::ENERGY, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Energy => names(&[&ENERGY]),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Energy = at else { return None };
    let energy = frame.derived.energy.as_ref()?;
    values(energy).get(index).copied()
}

/// The columns of one state, in the order of [`ENERGY`].
fn values(e: &Energy) -> [f64; 18] {
    let [p, l] = [e.p, e.l];
    [
        e.kinetic,
        e.strain,
        e.plastic,
        e.viscoplastic,
        e.damping,
        e.links,
        e.contact,
        e.friction,
        e.impact,
        e.external,
        e.numerical,
        e.mechanical,
        p.x,
        p.y,
        p.z,
        l.x,
        l.y,
        l.z,
    ]
}

fn write(table: &mut TableFile, frame: &Frame) -> io::Result<()> {
    let Some(energy) = &frame.derived.energy else { return Ok(()) };
    table.row(frame.step, frame.state.time).numbers(&values(energy)).end()
}
