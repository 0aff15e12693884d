//! bodies.csv: the motion of the rigid bodies at their centres of mass, global components.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{
    ACCELERATION, ANGULAR_ACCELERATION, ANGULAR_VELOCITY, Column, POSITION, QUATERNION, VELOCITY, names,
};
use mechanics::state::Node;
use model::ExpectAt;
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "bodies.csv",
    about: "One row for each rigid body, at its centre of mass. Written where there are bodies.",
    columns: &[
        &[Column::key("body", "name of the body")],
        &POSITION,
        &QUATERNION,
        &VELOCITY,
        &ANGULAR_VELOCITY,
        &ACCELERATION,
        &ANGULAR_ACCELERATION,
    ],
    wanted: |model| !model.bodies.is_empty(),
    needs: Wanted::NOTHING,
    has_last: |_| true,
    every_step: false,
    extent: |extent| {
        let bodies = &extent.model.bodies;
        // A quaternion has as many components as its body turns about axes, and one more.
        let turns = |node: usize| extent.moving(node)[3..].iter().any(|moves| *moves);
        let numbers = bodies.iter().map(|body| extent.motion(body.node, [1, 2]) + usize::from(turns(body.node))).sum();
        Rows::named(bodies.iter().map(|body| body.name.as_str()), numbers)
    },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::NOTHING, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Node(_) => names(&[&QUATERNION]),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Node(i) = at else { return None };
    let now = frame.state.nodes.get(i)?;
    quaternion(now).get(index).copied()
}

/// The motion of one body, in the order of the columns.
fn values(now: &Node) -> [f64; 19] {
    let q = quaternion(now);
    let vectors = [now.v, now.omega, now.a, now.alpha];
    std::array::from_fn(|i| match i {
        0..3 => now.x[i],
        3..7 => q[i - 3],
        _ => vectors[(i - 7) / 3][(i - 7) % 3],
    })
}

/// The columns `qw qx qy qz`: of the two quaternions of a rotation the one with qw ≥ 0, so that equal rotations have equal
/// numbers.
fn quaternion(now: &Node) -> [f64; 4] {
    let q = if now.rotation.w < 0.0 { -now.rotation } else { now.rotation };
    [q.w, q.i, q.j, q.k]
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    frame.model.bodies.iter().try_for_each(|body| {
        if !table.reads(&body.name) {
            return Ok(());
        }
        table.row(frame.step, frame.state.time).text(&body.name);
        table.numbers(&values(&frame.state.nodes[body.node])).end()
    })
}
