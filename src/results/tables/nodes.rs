//! nodes.csv: the motion of the chosen nodes, global components.

use crate::extent::Rows;
use crate::table::{Answers, SET, TableKind, WriteRow};
use base::math::{Vec6, angular, linear, rotation};
use base::quantities::{
    ACCELERATION, ANGULAR_ACCELERATION, ANGULAR_VELOCITY, Column, DISPLACEMENT, MOTION, POSITION, ROTATION, VELOCITY,
    names,
};
use mechanics::state;
use model::{self, ExpectAt};
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "nodes.csv",
    about: "One row for each node that `[output] nodes` chooses, named points unless it says otherwise.",
    columns: &[
        &[Column::key("node", "name of the node; nodes between named points as `part[number]`")],
        &POSITION,
        &DISPLACEMENT,
        &ROTATION,
        &VELOCITY,
        &ANGULAR_VELOCITY,
        &ACCELERATION,
        &ANGULAR_ACCELERATION,
        &[Column::key(
            SET,
            "the names in `[output] nodes` that cover the node, with `|` between them; only where one is a set, a group or a part",
        )],
    ],
    wanted: |model| !model.output.nodes.is_empty(),
    needs: Wanted::NOTHING,
    has_last: |model| !model.output.sets.is_empty(),
    every_step: false,
    extent: |extent| {
        let (model, nodes) = (extent.model, &extent.model.output.nodes);
        // Without motion, positions keep their values at t = 0.
        let positions = |node: usize| extent.moving(node)[..3].iter().filter(|moves| **moves).count();
        let numbers = nodes.iter().map(|&node| positions(node) + extent.motion(node, [1, 2])).sum();
        let rows = Rows::named(nodes.iter().map(|&node| model.nodes[node].label.as_str()), numbers);
        Rows { letters: rows.letters + model.output.sets.iter().map(String::len).sum::<usize>(), ..rows }
    },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::NOTHING, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Node(_) => names(&MOTION),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Node(i) = at else { return None };
    let now = frame.state.nodes.get(i)?;
    values(&frame.model.nodes[i], now, motion(frame, i)).get(index).copied()
}

/// The infinitesimal motion of a node in a linear analysis.
fn motion<'f>(frame: &'f Frame, node: usize) -> Option<&'f Vec6> {
    frame.case.as_ref().map(|case| &case.motions[node])
}

/// The motion of one node, in the order of [`MOTION`]. The rotation vector is the shortest, of length at most π; that of a linear analysis is
/// proportional to the loads.
fn values(start: &model::Node, now: &state::Node, small: Option<&Vec6>) -> [f64; 21] {
    let (moved, turn) = match small {
        Some(motion) => (linear(motion), angular(motion)),
        None => (now.moved(&start.x), rotation::log(&now.rotation)),
    };
    let vectors = [now.x, moved, turn, now.v, now.omega, now.a, now.alpha];
    std::array::from_fn(|i| vectors[i / 3][i % 3])
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let output = &frame.model.output;
    output.nodes.iter().enumerate().try_for_each(|(k, &i)| {
        let node = &frame.model.nodes[i];
        if !table.reads(&node.label) {
            return Ok(());
        }
        table.row(frame.step, frame.state.time).text(&node.label);
        table.numbers(&values(node, &frame.state.nodes[i], motion(frame, i)));
        output.sets.get(k).into_iter().for_each(|set| _ = table.text(set));
        table.end()
    })
}
