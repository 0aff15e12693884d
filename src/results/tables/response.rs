//! response.csv: the steady motion of chosen nodes and of bodies at each frequency.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{Column, RESPONSE, RESPONSE_FREQUENCY, names};
use model::{ExpectAt, OverFrequencies, ResponseOf};
use solve::modes::{Response, ResponseRow};
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "response.csv",
    about: "One row for each frequency in ascending order and each body and node that `[output] nodes` chooses. Its columns are amplitude and \
            phase of the steady motion about the state. Multiply by 2π `frequency` for the amplitude of the velocity, and by its square for \
            that of the acceleration. The table is empty where the undamped scene has no steady motion. Written with `kind = \"frequency-response\"`.",
    columns: &[&[RESPONSE_FREQUENCY], &[Column::key("node", "name of the node or body")], &RESPONSE],
    wanted: |model| model.analysis.response().is_some() && !(model.output.nodes.is_empty() && model.bodies.is_empty()),
    needs: Wanted::MODES,
    has_last: |_| true,
    every_step: false,
    extent: |_| Rows { rows: 0, letters: 0, numbers: 0 },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::MODES, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Response(ResponseOf::Node(_), _) => names(&[&RESPONSE]),
        _ => Vec::new(),
    }
}

/// The value of a column of a response at its frequency, or its extreme.
pub(super) fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Response(of, over) = at else { return None };
    let response = frame.modes?.response.as_ref()?;
    let of = |row: &ResponseRow| response.amplitudes(row, of).map(|values| values[index]);
    let all = || response.rows.iter().filter_map(of);
    // Where nothing limits the motion there is no largest.
    let unlimited = all().any(|value| !value.is_finite());
    let finite = || all().filter(|value| value.is_finite());
    match over {
        OverFrequencies::Max | OverFrequencies::Abs if unlimited => None,
        OverFrequencies::At(frequency) => {
            response.rows.iter().find(|row| row.frequency == frequency).and_then(of).filter(|value| value.is_finite())
        }
        OverFrequencies::Max => finite().max_by(f64::total_cmp),
        OverFrequencies::Min => finite().min_by(f64::total_cmp),
        OverFrequencies::Abs => finite().max_by(|a, b| a.abs().total_cmp(&b.abs())),
    }
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let Some(response) = frame.modes.and_then(|modes| modes.response.as_ref()) else { return Ok(()) };
    let model = frame.model;
    let nodes = model.output.nodes.iter().map(|&node| (model.nodes[node].label.as_str(), node));
    let bodies = model.bodies.iter().map(|body| (body.name.as_str(), body.node));
    let named: Vec<(&str, ResponseOf)> =
        nodes.chain(bodies).map(|(name, node)| (name, ResponseOf::Node(node))).collect();
    response.rows[frame.rows.clone()].iter().try_for_each(|row| write_row(table, frame, (response, row), &named))
}

/// The rows of a frequency.
pub(super) fn write_row(
    table: &mut dyn WriteRow,
    frame: &Frame,
    (response, row): (&Response, &ResponseRow),
    named: &[(&str, ResponseOf)],
) -> io::Result<()> {
    for &(name, of) in named {
        let Some(values) = response.amplitudes(row, of) else { continue };
        let mut out = table.row(frame.step, frame.state.time).number(row.frequency).text(name);
        for value in values {
            out = if value.is_finite() { out.number(value) } else { out.text("") };
        }
        out.end()?;
    }
    Ok(())
}
