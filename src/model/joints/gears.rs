//! Gears: joints with proportional coordinates follow one common number.

use crate::data::{Joint, JointDrive};
use crate::joints::coordinate::{Gear, is_later, size};
use crate::places::nodes::Nodes;
use crate::report::Report;
use crate::scene::Scene;

/// Lets geared joints, known by their places in the list, follow the joint that their gears lead to. If that joint is driven, they follow
/// its drive; otherwise they share a new number.
pub fn connect<'d>(
    scene: &Scene<'d>,
    gears: &[(usize, Gear<'d>)],
    joints: &mut [Joint],
    nodes: &mut Nodes,
    report: &mut Report<'d>,
) {
    let mut towards: Vec<Option<(usize, f64)>> = vec![None; joints.len()];
    for (index, gear) in gears {
        towards[*index] = partner(scene, gear, joints, report).map(|other| (other, gear.ratio));
    }
    for (index, gear) in gears {
        let Some((first, ratio)) = first(&towards, *index) else {
            let message = format!("the gears of joint `{}` lead back to it", joints[*index].name);
            report.error_with::<()>(&gear.other.span, message, "leave one of them out");
            continue;
        };
        if first == *index {
            continue;
        }
        let drive = drive_of(scene, &mut joints[first], nodes);
        if let Some(drive) = drive {
            joints[*index].set_drive(JointDrive { ratio: ratio * drive.ratio, ..drive });
        }
    }
}

/// The index of the gear's other joint, if it has a coordinate in all stages.
fn partner<'d>(scene: &Scene<'d>, gear: &Gear<'d>, joints: &[Joint], report: &mut Report<'d>) -> Option<usize> {
    let name = gear.other;
    let Some(other) = joints.iter().position(|joint| joint.name == name.value) else {
        let named = || scene.deck.joints.iter().filter_map(|joint| joint.name.as_ref());
        // The errors of a joint that could not be made are already reported.
        return match named().any(|known| known.value == name.value) {
            true => None,
            false => report.unknown("joint", name, named().map(|known| known.value.as_str())),
        };
    };
    if joints[other].coordinate.is_none() {
        let message = format!("joint `{}` has no coordinate that a gear could follow", name.value);
        return report.error_with(
            &name.span,
            message,
            "a revolute, prismatic, cylindrical, screw, planar or in-line joint has",
        );
    }
    let table =
        scene.deck.joints.iter().find(|joint| joint.name.as_ref().is_some_and(|known| known.value == name.value));
    if table.is_some_and(|joint| is_later(scene, joint)) {
        let message = format!("joint `{}` is not there from t = 0 on, without a break", name.value);
        return report.error_with(&name.span, message, "a gear needs both of its joints all the time");
    }
    Some(other)
}

/// The last joint of the chain of gears, and its coordinate per coordinate of the first; `None` for a closed loop.
fn first(towards: &[Option<(usize, f64)>], index: usize) -> Option<(usize, f64)> {
    let (mut at, mut ratio) = (index, 1.0);
    for _ in 0..towards.len() {
        let Some((next, of_next)) = towards[at] else { return Some((at, ratio)) };
        (at, ratio) = (next, ratio * of_next);
    }
    None
}

/// The drive of a joint without a gear. Without one, a free number is added: the coordinate as a length of the size of the scene, so that
/// efforts along it compare with forces.
fn drive_of(scene: &Scene, joint: &mut Joint, nodes: &mut Nodes) -> Option<JointDrive> {
    let coordinate = joint.coordinate.as_ref()?;
    if let Some(drive) = coordinate.drive {
        return Some(drive);
    }
    let ratio = if coordinate.lock.is_rotational() { 1.0 / size(scene, nodes, &joint.name) } else { 1.0 };
    let node = nodes.add_number(format!("{}.gear", joint.name), joint.ends[0]);
    let drive = JointDrive { node, ratio, is_free: true };
    joint.set_drive(drive);
    Some(drive)
}
