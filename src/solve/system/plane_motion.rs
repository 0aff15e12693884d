//! Recognizes scenes that move in a plane.

use super::inertia::Inertia;
use super::parts::assembled;
use super::plane::MotionPlane;
use crate::tolerances::plane::SMALL;
use base::math::{Vec3, skew};
use mechanics::constraints::rigid_link::RigidLink;
use model::{Joint, Loading, Model, Node, Restraint, RotationAxis};

/// The global axis normal to the plane of a model that nothing moves out of it, unless the deck keeps out-of-plane motion.
pub fn normal(model: &Model, inertias: &[Inertia], rigid_links: &[RigidLink]) -> Option<usize> {
    if model.analysis.plane { that_holds(model, inertias, rigid_links) } else { None }
}

/// Like [`normal`], whether or not the deck keeps out-of-plane motion.
pub fn that_holds(model: &Model, inertias: &[Inertia], rigid_links: &[RigidLink]) -> Option<usize> {
    (0..3).rev().find(|&n| is_plane(model, inertias, rigid_links, n))
}

fn is_plane(model: &Model, inertias: &[Inertia], rigid_links: &[RigidLink], normal: usize) -> bool {
    let Some(first) = model.nodes.first() else { return false };
    let size = model.nodes.iter().map(|p| (p.x - first.x).norm()).fold(0.0, f64::max);
    let plane = MotionPlane { normal, size };
    let flat = |p: &Node| (p.x[normal] - first.x[normal]).abs() <= SMALL * size;
    let still = |p: &Node| plane.contains(&p.v) && plane.is_normal(&p.omega);
    model.reductions.is_empty()
        && model.nodes.iter().all(|p| flat(p) && still(p))
        && holds_loading(&plane, first.x[normal], &model.loading)
        && holds_constraints(&plane, model)
        && inertias.iter().all(|i| plane.decouples(&i.J0))
        && model.parts.iter().all(|part| assembled(part).stays_in(&plane, &model.stiffnesses))
        // Arms lie in the plane with the nodes, so only their skew matrices need a check.
        && rigid_links.iter().all(|a| plane.decouples_rotations(&skew(&a.S0)) || a.S0 == Vec3::zeros())
}

/// True where no load and no ground motion drives anything out of the plane at this height along its normal.
fn holds_loading(plane: &MotionPlane, height: f64, loading: &Loading) -> bool {
    loading.pressures.is_empty()
        && loading.nodal.iter().all(|load| plane.contains(&load.force) && plane.is_normal(&load.moment))
        && loading.centrifugal.iter().all(|load| {
            let RotationAxis { direction, through } = &load.axis;
            let lies_in = plane.contains(direction) && (through[plane.normal] - height).abs() <= SMALL * plane.size;
            lies_in || plane.is_normal(direction)
        })
        && plane.contains(&loading.gravity)
        && loading.base_accelerations.iter().all(|base| plane.contains(&base.direction))
}

/// True where no prescribed motion and no joint leads out of the plane.
fn holds_constraints(plane: &MotionPlane, model: &Model) -> bool {
    let in_plane = |dof: usize| if dof < 3 { dof != plane.normal } else { dof - 3 == plane.normal };
    let is_led = |joint: &Joint| joint.coordinate.as_ref().is_some_and(|coordinate| coordinate.drive.is_some());
    let joint_holds = |joint: &Joint| {
        let d = model.nodes[joint.ends[0]].x - model.nodes[joint.ends[1]].x;
        joint.equations.iter().all(|row| row.in_plane(plane.normal, &d).is_some())
            && (!is_led(joint)
                || joint.equations.last().is_some_and(|row| row.in_plane(plane.normal, &d) == Some(true)))
    };
    let constraints = &model.constraints;
    let is_place = |node: usize| !model.nodes[node].is_number;
    let moves = |restraint: &Restraint| restraint.motion.is_some() && is_place(restraint.node);
    constraints.restraints.iter().all(|restraint| !moves(restraint) || in_plane(restraint.dof))
        && constraints.joints.iter().all(joint_holds)
}
