//! modes.csv: the modes about the state at the end of the run.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{Column, MODE, names};
use model::ExpectAt;
use solve::modes::EigenMode;
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "modes.csv",
    about: "One row for each mode, the lowest first. Written with `kind = \"modal\"` and `\"buckling\"`, and for the modes of a `\"frequency-response\"`.",
    columns: &[&[Column::key("mode", "number of the mode, from 1")], &MODE],
    wanted: |model| model.analysis.lists_modes(),
    needs: Wanted::MODES,
    has_last: |_| true,
    every_step: false,
    extent: |_| Rows { rows: 0, letters: 0, numbers: 0 },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::MODES, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Mode(_) => names(&[&MODE]),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Mode(number) = at else { return None };
    values(frame.modes?.list.get(number)?)[index]
}

/// The columns of a mode, in the order of [`MODE`].
fn values(mode: &EigenMode) -> [Option<f64>; MODE.len()] {
    let frequency = mode.frequency();
    let natural = mode.factor.is_none();
    let strain = (!mode.shares.is_empty()).then(|| mode.shares.iter().map(|share| share.strain).sum());
    let mut all = [None; MODE.len()];
    all[0] = natural.then_some(frequency);
    all[1] = (frequency > 0.0).then(|| 1.0 / frequency);
    all[2] = natural.then(|| mode.angular_frequency());
    all[3] = mode.damping_ratio().filter(|_| natural);
    all[4] = natural.then_some(mode.root[0]);
    all[5] = mode.factor;
    if natural && mode.quadrature.is_empty() {
        all[6] = Some(mode.modal_mass);
        for k in 0..6 {
            all[7 + k] = Some(mode.participation[k]);
            all[13 + k] = Some(mode.effective_mass(k));
        }
    }
    all[19] = strain;
    all[20] = mode.whirl.map(|whirl| whirl.sense);
    all
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let Some(modes) = frame.modes else { return Ok(()) };
    (1..).zip(&modes.list).try_for_each(|(number, mode)| {
        let row = table.row(frame.step, frame.state.time).count(number);
        for value in values(mode) {
            row.optional(value);
        }
        row.end()
    })
}
