//! `[[joints]]`: constraint equations between two nodes, held by multipliers.

pub mod coordinate;
pub mod gears;

use crate::data::{History, Joint, Node, PrescribedMotion};
use crate::joints::coordinate::{CoordinateKeys, Joints, PlacedJoint};
use crate::links::ModelLinks;
use crate::parts::ReleasedEnd;
use crate::places::ends::EndTable;
use crate::places::nodes::Nodes;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use base::diagnostic::Diagnostic;
use base::math::{Mat3, Vec3};
use base::names::short;
use mechanics::amplitude::{Amplitude, Side};
use mechanics::constraints::joint::{ConstraintEquation, rotations, translations};
use mechanics::constraints::joints::JointKind;
use mechanics::state;
use std::collections::HashMap;

/// Reads `[[joints]]`. Links along their coordinates follow the `links` of the deck, and motions without an amplitude add one.
pub fn joints<'d>(
    scene: &Scene<'d>,
    links: &mut ModelLinks,
    amplitudes: &mut Vec<Amplitude>,
    nodes: &mut Nodes,
    report: &mut Report<'d>,
) -> Joints {
    let mut joints = Joints::default();
    let mut gears = Vec::new();
    for (index, joint) in scene.deck.joints.iter().enumerate() {
        let (name, owner) = report.named(("joint", "joints", index), joint.name.as_ref(), &joint.span);
        let kind = report.require(&owner, "kind", &joint.kind).map(|kind| kind.value);
        let mut end = |key, end, default| {
            let table = EndTable { owner: &owner, key, end, label: format!("{name}.{key}"), rotations: true, default };
            let node = table.node(scene, nodes, report);
            (node, node.map(|node| nodes.x(node)))
        };
        let (from, place) = end("from", &joint.from, None);
        let (to, _) = end("to", &joint.to, place.filter(|_| kind.is_none_or(|kind| kind.make.ends_meet)));
        let axes = kind.and_then(|kind| {
            let what = format!("a joint of kind \"{}\"", kind.word);
            report.read(&owner, &what, &joint.values, kind, kind.make.axes)
        });
        let acts = kind.map(|kind| CoordinateKeys { owner: &owner, joint, scene, amplitudes, report }.read(kind));
        let (Some(kind), Some(ends), Some(axes)) = (kind, from.zip(to), axes) else { continue };
        let ends = [ends.0, ends.1];
        // The ends of a later joint are at their current positions.
        let later = scene.stage.is_some_and(|stage| stage.comes_later(&joint.stages));
        let placed = PlacedJoint { ends, later, axes, values: &joint.values };
        let Some(equations) = joint_equations(&owner, kind, &placed, nodes, report) else { continue };
        let mut made = Joint::new(name, ends, equations, false);
        if let Some(mut acts) = acts.flatten() {
            gears.extend(acts.gear.take().map(|gear| (joints.list.len(), gear)));
            acts.set_up(&placed, &mut made, (scene, nodes, links), &mut joints.efforts);
        }
        joints.list.push(made);
    }
    gears::connect(scene, &gears, &mut joints.list, nodes, report);
    joints
}

/// The constraint equations between two ends; messages name them as `owner`, and with `later` the ends need not meet at t = 0.
fn joint_equations<'d>(
    owner: &Owner<'d>,
    kind: &JointKind,
    &PlacedJoint { ends, later, axes, values }: &PlacedJoint,
    nodes: &Nodes,
    report: &mut Report<'d>,
) -> Option<Vec<ConstraintEquation>> {
    if ends[0] == ends[1] {
        let node = nodes.label(ends[0]);
        return report.error_with(
            owner.span,
            format!("{} joins `{node}` to itself", owner.what),
            "name another node or body in `to`",
        );
    }
    let d = nodes.x(ends[0]) - nodes.x(ends[1]);
    if !kind.make.ends_meet && d.norm() == 0.0 {
        let message = format!("the ends of {} lie at the same place, so there is no distance", owner.what);
        return report.error_with(owner.span, message, "a \"spherical\" joint holds two points together");
    }
    if kind.make.ends_meet && !later && is_rounded(owner, ends.map(|end| nodes.x(end)), nodes, report)? {
        let message = format!("the ends of {} are {} apart, as rounded coordinates are", owner.what, short(d.norm()));
        let hint = "they are joined in this position; a body's `point` in `to` may be left out";
        report.push(Diagnostic::note(message).at(owner.span).hint(hint));
    }
    Some((kind.make.equations)(&axes, &d, values))
}

/// Compares the distance of ends that should meet: `true` within the rounding of six digits, `false` within machine rounding. Farther is an
/// error.
fn is_rounded<'d>(owner: &Owner<'d>, [a, b]: [Vec3; 2], nodes: &Nodes, report: &mut Report<'d>) -> Option<bool> {
    /// Coordinates written with six digits are off by half a unit of the sixth, at either end.
    const SIX_DIGITS: f64 = 1e-5;
    /// In a scene far from the origin that may be no more than this part of its size.
    const MOST: f64 = 1e-4;
    /// Coordinates that are computed rather than written are off by no more than this part of the size of the scene.
    const COMPUTED: f64 = 1e-9;
    let (gap, rounding) = ((a - b).amax(), 4.0 * f64::EPSILON * a.amax());
    // Most ends meet; the size of the scene costs a look at all nodes.
    if gap <= rounding {
        return Some(false);
    }
    let far = |reach: f64, node: &Node| reach.max((node.x - a).amax());
    let size = nodes.list.iter().fold(0.0, far);
    let written = (SIX_DIGITS * a.amax().max(b.amax())).clamp(1e-6 * size, MOST * size);
    if gap > written.max(rounding) {
        let message = format!("the ends of {} must lie at the same place", owner.what);
        let far = format!("they are {} apart; a body's `point` in `to` may be left out", short((a - b).norm()));
        return report.error_with(owner.span, message, far);
    }
    Some(gap > rounding.max(COMPUTED * size))
}

/// Reports joints of the deck between things that cannot move against each other. The deck is sound otherwise.
pub fn check_joints(scene: &Scene, joints: &[Joint], amplitudes: &[Amplitude], nodes: &Nodes, report: &mut Report) {
    let is_fixed =
        |node: usize| (0..6).all(|dof| nodes.restraint(node, dof).is_some_and(|restraint| restraint.motion.is_none()));
    let duration = scene.analysis.end_time - scene.analysis.begin;
    let by_name: HashMap<&str, &Joint> = joints.iter().rev().map(|made| (made.name.as_str(), made)).collect();
    for joint in &scene.deck.joints {
        // Joints are found by name, because a joint may be missing after errors elsewhere, such as an unreadable mesh.
        let Some(made) = joint.name.as_ref().and_then(|name| by_name.get(name.as_str())) else { continue };
        let (ends, name) = (made.ends.map(|node| nodes.carrier(node)), &made.name);
        if ends[0] == ends[1] {
            let label = nodes.label(ends[0]);
            let message = format!("both ends of joint `{name}` lie on `{label}`, so it holds nothing");
            report.error_with::<()>(&joint.span, message, "name another end, or remove the joint");
        } else if ends.iter().all(|&end| is_fixed(end)) {
            let message = format!("both ends of joint `{name}` are fixed, so it holds nothing");
            report.error_with::<()>(&joint.span, message, "remove the joint, or one of the supports");
        } else if let Some((given, driven)) = initial_rates(
            made,
            ends.map(is_fixed),
            (amplitudes, duration, &|| coordinate::size(scene, nodes, name)),
            nodes,
        ) && let Some(motion) = &joint.motion
        {
            let (given, driven) = (short(given), short(driven));
            let message =
                format!("the motion of joint `{name}` begins at the rate {driven}, but its ends have {given}");
            report.error_with::<()>(&motion.span, message, "the velocities of its ends contradict it");
        }
    }
}

/// The angle, or the part of the size of the scene, that counts as none over a whole run.
const NOWHERE: f64 = 1e-9;

/// The rate of a driven coordinate by the initial velocities of both ends, and by its motion, if they differ. An end at rest may be taken
/// along, unless it is fixed. A velocity that leads nowhere in the `duration` is rest, measured by the `extent` of the scene.
fn initial_rates(
    joint: &Joint,
    fixed: [bool; 2],
    (amplitudes, duration, extent): (&[Amplitude], f64, &dyn Fn() -> f64),
    nodes: &Nodes,
) -> Option<(f64, f64)> {
    /// Velocities are written with six digits.
    const DIGITS: f64 = 1e-5;
    let coordinate = joint.coordinate.as_ref()?;
    let drive = coordinate.drive?;
    let PrescribedMotion { amplitude, scale, history } = nodes.restraint(drive.node, 0)?.motion.clone()?;
    let (amplitude, extent) = (&amplitudes[amplitude], extent());
    let driven = drive.ratio
        * scale
        * match history {
            History::Displacement => amplitude.rate(0.0, Side::After),
            History::Velocity => amplitude.value(0.0),
            History::Acceleration => 0.0,
        };
    let [from, to] = joint.ends.map(|end| {
        let node = &nodes.list[end];
        state::Node { v: node.v, omega: node.omega, ..state::Node::at_rest(node.x) }
    });
    // A way or an angle of rounding is that of a body at rest.
    let nowhere = if duration > 0.0 { NOWHERE / duration } else { 0.0 };
    let moves = |node: &state::Node| node.v.amax() > nowhere * extent || node.omega.amax() > nowhere;
    let [_, given, _] = coordinate.lock.gap(&from, &to);
    let known = (moves(&from) || fixed[0]) && (moves(&to) || fixed[1]);
    // The rate is the difference of both ends' velocities, with their rounding.
    let size = |node: &state::Node| match coordinate.lock.is_rotational() {
        true => node.omega.amax(),
        false => node.v.amax() + node.omega.amax() * node.x.amax(),
    };
    let size = size(&from).max(size(&to)).max(driven.abs());
    let rest = nowhere * if coordinate.lock.is_rotational() { 1.0 } else { extent };
    (known && (given - driven).abs() > rest.max(DIGITS * size)).then_some((given, driven))
}

/// The joint that holds a released end of a beam to its point.
pub fn released(release: &ReleasedEnd) -> Joint {
    let place = Vec3::zeros();
    let held = translations([true; 3], &place).chain(rotations(release.held, &release.axes));
    Joint::new(release.name.clone(), release.ends, held.collect(), false)
}

/// Rows between nodes at one place, about global axes at t = 0.
pub fn equations(dofs: [bool; 6]) -> Vec<ConstraintEquation> {
    let [x, y, z, rx, ry, rz] = dofs;
    translations([x, y, z], &Vec3::zeros()).chain(rotations([rx, ry, rz], &Mat3::identity())).collect()
}
