//! nodes.csv: the motion of the chosen nodes, global components.

use super::table::Table;
use crate::math::rotation;
use crate::model;
use crate::solve::Frame;
use crate::state;
use std::io;

/// Position, displacement, rotation vector, velocity, angular velocity, acceleration, angular acceleration.
pub const COLUMNS: [&str; 21] = [
    "x", "y", "z", "ux", "uy", "uz", "rx", "ry", "rz", "vx", "vy", "vz", "wx", "wy", "wz", "ax", "ay", "az", "bx",
    "by", "bz",
];

/// The columns of one node. The rotation vector is the shortest, of length at most π.
pub fn values(start: &model::Node, now: &state::Node) -> [f64; 21] {
    let vectors = [now.x, now.moved(&start.x), rotation::log(&now.q), now.v, now.omega, now.a, now.alpha];
    std::array::from_fn(|i| vectors[i / 3][i % 3])
}

pub(super) fn header() -> String {
    format!("step,time,node,{}", COLUMNS.join(","))
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    frame.model.output.nodes.iter().try_for_each(|&i| {
        let node = &frame.model.nodes[i];
        table.row(frame.step, frame.state.time).text(&node.label);
        table.numbers(&values(node, &frame.state.nodes[i])).end()
    })
}
