//! `[[joints]]`: constraint equations between two nodes, held by multipliers.

use super::ends::EndTable;
use super::nodes::Nodes;
use super::report::{Owner, Report};
use super::scene::Scene;
use super::values::span;
use super::{Joint, Node};
use crate::constraints::joint::{Row, rotations, translations};
use crate::deck::Deck;
use crate::deck::joints::{Joint as JointTable, Kind as Word};
use crate::math::{Mat3, Vec3};
use crate::names::short;

/// `[[joints]]`, in deck order.
pub(super) fn joints<'d>(scene: &Scene<'d>, nodes: &mut Nodes, report: &mut Report<'d>) -> Vec<Joint> {
    let mut joints = Vec::new();
    for (index, joint) in scene.deck.joints.iter().enumerate() {
        let name = joint.name.as_ref().map_or_else(|| format!("joints.{index}"), |name| name.value.clone());
        let owner = Owner::new(format!("joint `{name}`"), &joint.span);
        report.require(&owner, "name", &joint.name);
        let kind = report.require(&owner, "kind", &joint.kind).map(|kind| kind.value);
        let mut end = |key, end, default| {
            let table = EndTable { owner: &owner, key, end, label: format!("{name}.{key}"), rotations: true, default };
            let node = table.node(scene, nodes, report);
            (node, node.map(|node| nodes.x(node)))
        };
        let (from, place) = end("from", &joint.from, None);
        let (to, _) = end("to", &joint.to, place.filter(|_| kind != Some(Word::Distance)));
        let axes = kind.and_then(|kind| joint_axes(&owner, joint, kind, report));
        let (Some(kind), Some(ends), Some(axes)) = (kind, from.zip(to), axes) else { continue };
        let ends = [ends.0, ends.1];
        if let Some(rows) = joint_rows(&owner, kind, ends, &axes, nodes, report) {
            joints.push(Joint { name, ends, rows, supports: false });
        }
    }
    joints
}

/// Axes whose first is the joint's, whose second is that of its cross.
fn joint_axes<'d>(owner: &Owner<'d>, joint: &'d JointTable, kind: Word, report: &mut Report<'d>) -> Option<Mat3> {
    let cross = [("cross_axis", span(&joint.cross_axis))];
    match kind {
        Word::Ball | Word::Fixed | Word::Distance => {
            let word = format!("a joint of kind \"{}\"", format!("{kind:?}").to_lowercase());
            report.reject_unused(&word, &[("axis", span(&joint.axis)), cross[0]]);
            Some(Mat3::identity())
        }
        Word::Hinge | Word::Slider | Word::Cylinder => {
            report.reject_unused("a joint with one axis", &cross);
            let axis = report.require(owner, "axis", &joint.axis)?;
            let x = report.unit("axis", axis)?;
            // The global axis the most square to it: which one is of no consequence.
            let y = x.cross(&Vec3::ith(x.iamin(), 1.0)).normalize();
            Some(Mat3::from_columns(&[x, y, x.cross(&y)]))
        }
        Word::Universal => {
            let axis = report.require(owner, "axis", &joint.axis);
            let cross = report.require(owner, "cross_axis", &joint.cross_axis);
            let x = axis.and_then(|axis| report.unit("axis", axis));
            let (Some(cross), Some(x)) = (cross, x) else { return None };
            let y = report.unit("cross_axis", cross)?;
            if x.dot(&y).abs() > 1e-6 {
                return report.error(&cross.span, "`cross_axis` must be square to `axis`");
            }
            let y = (y - x * x.dot(&y)).normalize();
            Some(Mat3::from_columns(&[x, y, x.cross(&y)]))
        }
    }
}

fn joint_rows<'d>(
    owner: &Owner<'d>,
    kind: Word,
    ends: [usize; 2],
    axes: &Mat3,
    nodes: &Nodes,
    report: &mut Report<'d>,
) -> Option<Vec<Row>> {
    if ends[0] == ends[1] {
        let node = nodes.label(ends[0]);
        return report.error(owner.span, format!("{} joins `{node}` to itself", owner.what));
    }
    let d = nodes.x(ends[0]) - nodes.x(ends[1]);
    if kind == Word::Distance {
        if d.norm() == 0.0 {
            let message = format!("the ends of {} lie at the same place, so there is no distance", owner.what);
            return report.error_with(owner.span, message, "a \"ball\" holds two points together");
        }
        return Some(vec![Row::Distance { length: d.norm() }]);
    }
    // Of the scene's size, wherever it lies, and what rounding of coordinates leaves.
    let first = nodes.x(ends[0]);
    let far = |reach: f64, node: &Node| reach.max((node.x - first).amax());
    let size = nodes.list.iter().fold(0.0, far);
    if d.amax() > (1e-6 * size).max(4.0 * f64::EPSILON * first.amax()) {
        let message = format!("the ends of {} must lie at the same place", owner.what);
        let far = format!("they are {} apart; a body's `point` in `to` may be left out", short(d.norm()));
        return report.error_with(owner.span, message, far);
    }
    let meet = |rows: Vec<Row>| translations([true; 3], &d).chain(rows).collect();
    let slide = |rows: Vec<Row>| {
        let square = (1..3).map(|i| axes.column(i).into_owned()).map(|e| Row::Carried { e, at: d.dot(&e) });
        square.chain(rows).collect()
    };
    Some(match kind {
        Word::Ball | Word::Distance => meet(Vec::new()),
        Word::Hinge => meet(rotations([false, true, true], axes)),
        Word::Fixed => meet(rotations([true; 3], axes)),
        Word::Universal => meet(rotations([false, false, true], axes)),
        Word::Slider => slide(rotations([true; 3], axes)),
        Word::Cylinder => slide(rotations([false, true, true], axes)),
    })
}

/// Reports joints of the deck between things that cannot move against each other. The deck is sound otherwise.
pub(super) fn check_joints(deck: &Deck, joints: &[Joint], nodes: &Nodes, report: &mut Report) {
    let is_fixed =
        |node: usize| (0..6).all(|dof| nodes.restraint(node, dof).is_some_and(|restraint| restraint.motion.is_none()));
    for joint in &deck.joints {
        // A joint is found by name: one may have been left out for what is wrong elsewhere, as in a mesh that could not be read.
        let named = |made: &&Joint| joint.name.as_ref().is_some_and(|name| name.value == made.name);
        let Some(made) = joints.iter().find(named) else { continue };
        let (ends, name) = (made.ends.map(|node| nodes.carrier(node)), &made.name);
        if ends[0] == ends[1] {
            let label = nodes.label(ends[0]);
            let message = format!("both ends of joint `{name}` lie on `{label}`, so it holds nothing");
            report.error::<()>(&joint.span, message);
        } else if ends.iter().all(|&end| is_fixed(end)) {
            report.error::<()>(&joint.span, format!("both ends of joint `{name}` are fixed, so it holds nothing"));
        }
    }
}

/// Rows between nodes at one place, about global axes at t = 0.
pub(super) fn rows(dofs: [bool; 6]) -> Vec<Row> {
    let [x, y, z, rx, ry, rz] = dofs;
    translations([x, y, z], &Vec3::zeros()).chain(rotations([rx, ry, rz], &Mat3::identity())).collect()
}
