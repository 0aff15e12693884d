//! mode_shapes.csv: the motion of chosen nodes and of bodies in each mode, global components.

use crate::extent::Rows;
use crate::table::{TableKind, WriteRow};
use base::math::Vec6;
use base::quantities::{Axes, Column, Unit};
use solve::{Frame, Wanted};
use std::io;

const fn component(name: &'static str, meaning: &'static str, unit: Unit) -> Column {
    Column::scalar(name, meaning, unit).kind(meaning).in_axes(Axes::Global)
}

const SHAPE: &str = "displacement of the shape, scaled so that the largest is 1";
const TURN: &str = "rotation of the shape";
const AHEAD: &str = "the same a quarter of a period later, less its decay, of a damped mode; 0 of others: cos ωt of the one and sin ωt of \
                     the other make up the motion";

pub static TABLE: TableKind = TableKind {
    file: "mode_shapes.csv",
    about: "One row for each mode and each node that `[output] nodes` chooses, and each body. Written with `kind = \"modal\"` and \
            `\"buckling\"`.",
    columns: &[&[
        Column::key("mode", "number of the mode, from 1"),
        Column::key("node", "name of the node or body"),
        component("ux", SHAPE, Unit::One),
        component("uy", SHAPE, Unit::One),
        component("uz", SHAPE, Unit::One),
        component("rx", TURN, Unit::Radian),
        component("ry", TURN, Unit::Radian),
        component("rz", TURN, Unit::Radian),
        component("ux_ahead", AHEAD, Unit::One),
        component("uy_ahead", AHEAD, Unit::One),
        component("uz_ahead", AHEAD, Unit::One),
        component("rx_ahead", AHEAD, Unit::One),
        component("ry_ahead", AHEAD, Unit::One),
        component("rz_ahead", AHEAD, Unit::One),
    ]],
    wanted: |model| model.analysis.lists_modes() && !(model.output.nodes.is_empty() && model.bodies.is_empty()),
    needs: Wanted::MODES,
    has_last: |_| true,
    every_step: false,
    extent: |_| Rows { rows: 0, letters: 0, numbers: 0 },
    rows: |_| Box::new(write),
    answers: None,
};

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let Some(modes) = frame.modes else { return Ok(()) };
    let model = frame.model;
    let nodes = model.output.nodes.iter().map(|&node| (model.nodes[node].label.as_str(), node));
    let bodies = model.bodies.iter().map(|body| (body.name.as_str(), body.node));
    let named: Vec<(&str, usize)> = nodes.chain(bodies).collect();
    for (number, mode) in (1..).zip(&modes.list) {
        for &(name, node) in &named {
            let ahead = mode.quadrature.get(node).copied().unwrap_or_else(Vec6::zeros);
            let row = table.row(frame.step, frame.state.time).count(number).text(name);
            row.numbers(mode.shape[node].as_slice()).numbers(ahead.as_slice()).end()?;
        }
    }
    Ok(())
}
