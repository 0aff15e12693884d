//! bodies.csv: the motion of the rigid bodies at their centres of mass, global components.

use super::table::Table;
use crate::solve::Frame;
use crate::state::Node;
use std::io;

/// Position, quaternion body to global, velocity, angular velocity, acceleration, angular acceleration.
pub const COLUMNS: [&str; 19] =
    ["x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz", "ax", "ay", "az", "bx", "by", "bz"];

/// The columns of one body. Of the two quaternions of its rotation the one with qw ≥ 0.
pub fn values(now: &Node) -> [f64; 19] {
    let q = if now.q.w < 0.0 { -now.q } else { now.q };
    let vectors = [now.v, now.omega, now.a, now.alpha];
    std::array::from_fn(|i| match i {
        0..3 => now.x[i],
        3..7 => [q.w, q.i, q.j, q.k][i - 3],
        _ => vectors[(i - 7) / 3][(i - 7) % 3],
    })
}

pub(super) fn header() -> String {
    format!("step,time,body,{}", COLUMNS.join(","))
}

pub(super) fn write(table: &mut Table, frame: &Frame) -> io::Result<()> {
    frame.model.bodies.iter().try_for_each(|body| {
        table.row(frame.step, frame.state.time).text(&body.name);
        table.numbers(&values(&frame.state.nodes[body.node])).end()
    })
}
