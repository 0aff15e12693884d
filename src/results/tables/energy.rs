//! energy.csv: the energy balance and the momenta.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{ENERGY, names};
use model::ExpectAt;
use solve::system::energy::Energy;
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "energy.csv",
    about: "One row: the energies of the whole scene, their balance, and its momenta. Dissipated energies and work are sums from \
            the initial state on. In a static analysis `kinetic` and the momenta are zero.",
    columns: &[&ENERGY],
    wanted: |model| model.output.energy,
    needs: Wanted::ENERGY,
    has_last: |model| model.output.failures,
    every_step: false,
    extent: |extent| {
        let model = extent.model;
        let moves = if extent.is_dynamic() { 1 + extent.components().iter().sum::<usize>() } else { 0 };
        // Elements, contacts and links have a column each.
        let kinds = || model.parts.iter().map(|part| part.kind());
        let deforms = usize::from(kinds().any(|kind| kind.is_deformable()));
        let touches = usize::from(kinds().any(|kind| kind.is_unilateral()));
        let links = usize::from(kinds().any(|kind| !kind.is_deformable() && !kind.is_unilateral()));
        let yields = usize::from(model.yields());
        // Work of loads, numerical dissipation, mechanical energy.
        let numbers = 3 + moves + deforms + yields + links + touches;
        Rows { rows: 1, letters: 0, numbers }
    },
    rows: |model| {
        let count = ENERGY.len() - usize::from(!model.output.failures);
        Box::new(move |table, frame| write(table, frame, count))
    },
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
fn values(e: &Energy) -> [f64; 19] {
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
        e.eroded,
    ]
}

/// Writes the first `count` columns.
fn write(table: &mut dyn WriteRow, frame: &Frame, count: usize) -> io::Result<()> {
    let Some(energy) = &frame.derived.energy else { return Ok(()) };
    table.row(frame.step, frame.state.time).numbers(&values(energy)[..count]).end()
}
