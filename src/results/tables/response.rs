//! response.csv: the steady motion of chosen nodes and of bodies at each frequency.

use crate::extent::Rows;
use crate::response_rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{Column, RESPONSE, RESPONSE_FREQUENCY, names};
use model::{ExpectAt, ResponseOf};
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
    answers: Some(Answers { quantities, needs: Wanted::MODES, value: response_rows::value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Response(ResponseOf::Node(_), _) => names(&[&RESPONSE]),
        _ => Vec::new(),
    }
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let Some(response) = frame.modes.and_then(|modes| modes.response.as_ref()) else { return Ok(()) };
    let model = frame.model;
    let nodes = model.output.nodes.iter().map(|&node| (model.nodes[node].label.as_str(), node));
    let bodies = model.bodies.iter().map(|body| (body.name.as_str(), body.node));
    let named: Vec<(&str, ResponseOf)> =
        nodes.chain(bodies).map(|(name, node)| (name, ResponseOf::Node(node))).collect();
    response.rows[frame.rows.clone()]
        .iter()
        .try_for_each(|row| response_rows::write(table, frame, (response, row), &named))
}
