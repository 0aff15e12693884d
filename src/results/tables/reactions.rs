//! reactions.csv: force or moment on the structure in every restrained direction, and on the first part of every joint.

use crate::extent::Rows;
use crate::table::{Answers, SET, TableKind, WriteRow};
use base::quantities::{Axes, Column, REACTION, Unit, names};
use model::{DIRECTIONS, ExpectAt, Model, Restraint};
use solve::{Frame, JointState, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "reactions.csv",
    about: "One row for each restrained or prescribed degree of freedom. Ends of joints, links and contact surfaces on the ground count too \
            (`joint.to`, `link.from`, `contact.surface`). Six rows for each joint between two parts: force and moment of its constraints and \
            its drive on its first part (`from`), at that end. joints.csv also includes motors, springs, stops and friction. Written with \
            `[output] reactions = true`.",
    columns: &[&[
        Column::key("node", "name of the supported node, of the end on the ground, or of the joint"),
        Column::key("direction", "`ux uy uz` for forces, `rx ry rz` for moments; global"),
        Column::scalar(
            "value",
            "reaction: force or moment on the structure, or on the joint's first part",
            Unit::ForceOrMoment,
        )
        .in_axes(Axes::Global),
        Column::key(
            SET,
            "the sets, groups and parts under which `[[supports]]` name the node, with `|` between them; only where there are some",
        ),
    ]],
    wanted: |model| model.output.reactions,
    needs: Wanted::REACTIONS,
    has_last: |model| !model.constraints.sets.is_empty(),
    every_step: false,
    extent: |extent| {
        let model = extent.model;
        let restraints = &model.constraints.restraints;
        let joints = model.constraints.joints.iter().filter(|joint| joint.is_listed());
        let written = || restraints.iter().filter(|held| !model.nodes[held.node].is_number);
        let supports = written().map(|restraint| model.nodes[restraint.node].label.as_str());
        let of_joints = joints.flat_map(|joint| [joint.name.as_str(); DIRECTIONS.len()]);
        let all = Rows::named(supports.chain(of_joints), 0);
        let idle = written().filter(|restraint| !extent.in_plane(restraint.dof)).count();
        let sets: usize = written().filter_map(|held| set(model, &model.nodes[held.node].label)).map(str::len).sum();
        Rows { letters: all.letters + 2 * all.rows + sets, numbers: all.rows - idle, ..all }
    },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: Wanted::REACTIONS, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Node(_) | ExpectAt::Reactions(_) => names(&[&REACTION]),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let Frame { model: Model { nodes, constraints, .. }, reactions, .. } = frame;
    let is_here = |held: &Restraint| match at {
        // A node that depends on another is held at a point of its name.
        ExpectAt::Node(node) => held.node == node || nodes[held.node].label == nodes[node].label,
        ExpectAt::Reactions(set) => constraints.sums[set].contains(&nodes[held.node].label),
        _ => false,
    };
    let held = constraints.restraints.iter().zip(*reactions);
    let values = held.filter(|(restraint, _)| restraint.dof == index && is_here(restraint)).map(|(_, value)| *value);
    values.reduce(|sum, value| sum + value)
}

/// The force and moment of a joint on its first part, in the order of [`DIRECTIONS`].
fn of_joint(joint: &JointState) -> [f64; 6] {
    let [f, m] = [joint.f, joint.m];
    [f.x, f.y, f.z, m.x, m.y, m.z]
}

/// The names of the sets of a supported node, empty without any; `None` where no support names a set.
fn set<'m>(model: &'m Model, label: &str) -> Option<&'m str> {
    let sets = &model.constraints.sets;
    (!sets.is_empty()).then(|| sets.get(label).map_or("", String::as_str))
}

/// The effort of drives stands with their joints.
fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    let Frame { model, step, state, derived, .. } = *frame;
    let held = model.constraints.restraints.iter().zip(frame.reactions);
    held.filter(|(restraint, _)| !model.nodes[restraint.node].is_number).try_for_each(|(restraint, value)| {
        let node = &model.nodes[restraint.node];
        table.row(step, state.time).text(&node.label).text(DIRECTIONS[restraint.dof]).number(*value);
        set(model, &node.label).into_iter().for_each(|set| _ = table.text(set));
        table.end()
    })?;
    // A joint between a node and its support transmits the force of the support.
    model.constraints.joints.iter().zip(&derived.joints).filter(|(joint, _)| joint.is_listed()).try_for_each(
        |(joint, state_of)| {
            DIRECTIONS.iter().zip(of_joint(state_of)).try_for_each(|(direction, value)| {
                table.row(step, state.time).text(&joint.name).text(direction).number(value);
                set(model, "").into_iter().for_each(|set| _ = table.text(set));
                table.end()
            })
        },
    )
}
