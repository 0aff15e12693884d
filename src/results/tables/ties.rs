//! ties.csv: what each tie exerts on its nodes together.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::math::Vec3;
use base::quantities::{Column, TIE, names};
use model::ExpectAt;
use solve::{Frame, Wanted};
use std::io;
use std::ops::Range;

pub static TABLE: TableKind = TableKind {
    file: "ties.csv",
    about: "One row for each of `[[ties]]`: the resultant of its forces and moments on the nodes that it holds. The other side feels the opposite. \
            Written with `[output] reactions = true` if there are ties.",
    columns: &[&[Column::key("tie", "name of the tie")], &TIE],
    wanted: |model| model.output.reactions && model.constraints.tied().next().is_some(),
    needs: Wanted::REACTIONS,
    has_last: |_| true,
    every_step: false,
    extent: |extent| {
        let constraints = &extent.model.constraints;
        let [force, moment] = extent.components();
        let all = constraints.tied().map(|(tie, _)| constraints.ties[tie].as_str());
        Rows::named(all, (force + moment) * constraints.tied().count())
    },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::REACTIONS, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Tie(_) => names(&[&TIE]),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Tie(wanted) = at else { return None };
    let (_, joints) = frame.model.constraints.tied().find(|(tie, _)| *tie == wanted)?;
    values(joints, frame).get(index).copied()
}

/// Force, and moment about the mean of the places of the nodes; in a linear analysis of those at t = 0.
fn values(joints: Range<usize>, frame: &Frame) -> [f64; 6] {
    let made = &frame.model.constraints.joints[joints.clone()];
    let Some(held) = frame.derived.joints.get(joints) else { return [f64::NAN; 6] };
    let place = |node: usize| match &frame.case {
        Some(_) => frame.model.nodes[node].x,
        None => frame.state.nodes[node].x,
    };
    let mean = made.iter().map(|joint| place(joint.ends[0])).sum::<Vec3>() / made.len() as f64;
    let (mut f, mut m) = (Vec3::zeros(), Vec3::zeros());
    for (joint, of) in made.iter().zip(held) {
        f += of.f;
        m += of.m + (place(joint.ends[0]) - mean).cross(&of.f);
    }
    [f.x, f.y, f.z, m.x, m.y, m.z]
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let constraints = &frame.model.constraints;
    constraints.tied().try_for_each(|(tie, joints)| {
        let name = &constraints.ties[tie];
        table.row(frame.step, frame.state.time).text(name).numbers(&values(joints, frame)).end()
    })
}
