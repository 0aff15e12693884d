//! joints.csv: coordinates of the joints, forces along them, and forces and moments on their first parts.

use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{Column, JOINT_COORDINATE, JOINT_POWER, JOINT_REACTION, names};
use mechanics::state;
use model::{ExpectAt, JOINT_MAGNITUDES, Joint, JointCoordinate, Model};
use solve::{Frame, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "joints.csv",
    about: "One row for each joint. Written with `[output] joints = true` if there are joints. Joints without a coordinate leave \
            `coordinate`, `rate` and `effort` empty, joints without a drive or motor `power`. Forces and moments act on the first part, like those of links. They include motors, springs, stops and \
            friction, which reactions.csv excludes.",
    columns: &[
        &[Column::key("joint", "name of the joint")],
        &JOINT_COORDINATE,
        &[JOINT_POWER],
        &JOINT_REACTION,
        &JOINT_MAGNITUDES,
    ],
    wanted: |model| model.output.joints && of_deck(model).next().is_some(),
    needs: NEEDS,
    has_last: |_| true,
    every_step: false,
    extent: |extent| {
        let [force, moment] = extent.components();
        let all = of_deck(extent.model).map(|joint| joint.name.as_str());
        let driven = of_deck(extent.model).filter(|joint| is_driven(joint)).count();
        Rows::named(all, (5 + force + moment) * of_deck(extent.model).count() + driven)
    },
    rows: |_| Box::new(write),
    answers: Some(Answers { quantities, needs: NEEDS, value }),
};

/// Springs count the turns, constraints carry the rest.
const NEEDS: Wanted = Wanted::REACTIONS.with(Wanted::LINKS);

/// The joints of the deck and its attachments; supports have rows in another table.
fn of_deck(model: &Model) -> impl Iterator<Item = &Joint> {
    model.constraints.joints.iter().filter(|joint| joint.is_listed())
}

/// True for joints with a power.
fn is_driven(joint: &Joint) -> bool {
    joint.coordinate.as_ref().is_some_and(JointCoordinate::is_driven)
}

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Joint(_) => names(&[&JOINT_COORDINATE, &[JOINT_POWER], &JOINT_REACTION, &JOINT_MAGNITUDES]),
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Joint(joint) = at else { return None };
    values(joint, frame)?.get(index).copied()
}

/// The columns of one joint; `None` where the frame does not have it. Quantities that a joint lacks are not numbers.
fn values(joint: usize, frame: &Frame) -> Option<[f64; 12]> {
    let (made, held) = (frame.model.constraints.joints.get(joint)?, frame.derived.joints.get(joint)?);
    let (mut f, mut m) = (held.f, held.m);
    let [mut q, mut rate, mut effort, mut power] = [f64::NAN; 4];
    if let Some(coordinate) = &made.coordinate {
        let start = made.ends.map(|node| state::Node::at_rest(frame.model.nodes[node].x));
        let (from, to) = match &frame.case {
            Some(_) => (&start[0], &start[1]),
            None => (&frame.state.nodes[made.ends[0]], &frame.state.nodes[made.ends[1]]),
        };
        let link = coordinate.spring.and_then(|spring| frame.derived.links.get(spring));
        let [mut along, speed, _] = coordinate.lock.gap(from, to);
        if let Some(case) = &frame.case {
            let of_ends = coordinate.lock.gradient(from, to).into_iter().zip(made.ends);
            along += of_ends.map(|(G, node)| G.dot(&case.motions[node])).sum::<f64>();
        }
        (q, rate) = link.map_or((along, speed), |link| (link.elongation, link.rate));
        // Forces besides those of the constraint equations, positive on the second end.
        let motor = motor(coordinate, frame);
        let acting = motor - link.map_or(0.0, |link| link.force);
        effort = held.drive + acting;
        power = rate * (motor + if coordinate.drive.is_some_and(|drive| !drive.is_free) { held.drive } else { 0.0 });
        let [G, _] = coordinate.lock.gradient(from, to);
        f += acting * G.fixed_rows::<3>(0);
        m += acting * G.fixed_rows::<3>(3);
    }
    Some([q, rate, effort, power, f.x, f.y, f.z, m.x, m.y, m.z, f.norm(), m.norm()])
}

/// The effort that the deck gives.
fn motor(coordinate: &JointCoordinate, frame: &Frame) -> f64 {
    // Load cases name loads, and motors have no names.
    let in_case = frame.case.as_ref().is_some_and(|case| case.name.is_some());
    let Some(effort) = coordinate.effort.as_ref().filter(|_| !in_case) else { return 0.0 };
    let (model, time) = (frame.model, frame.state.time);
    effort.value
        * match (effort.amplitude, model.analysis.is_dynamic()) {
            (Some(index), _) => model.loading.amplitudes[index].value(time),
            (None, true) => 1.0,
            (None, false) => time / model.analysis.end_time,
        }
}

fn write(table: &mut dyn WriteRow, frame: &Frame) -> io::Result<()> {
    frame.model.constraints.joints.iter().enumerate().filter(|(_, joint)| joint.is_listed()).try_for_each(
        |(index, joint)| {
            let values = values(index, frame).unwrap_or([f64::NAN; 12]);
            let mut row = table.row(frame.step, frame.state.time).text(&joint.name);
            // A joint without a coordinate or a drive has none to write, which is no fault of a number.
            let has = joint.coordinate.is_some();
            for (value, has) in values.iter().zip([has, has, has, is_driven(joint)]) {
                row = if has { row.number(*value) } else { row.text("") };
            }
            row.numbers(&values[4..]).end()
        },
    )
}
