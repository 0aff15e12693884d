//! The depth of two convex solids wherever they are: apart, as they begin to touch, and in each other.

use super::cylinder::CylinderPose;
use super::depth::Depth;
use super::pose::{ConvexPose, LeastAxis};
use super::swept::Swept;
use super::volume::depth_by_volume;
use base::math::{Vec3, stack};

/// Below this part of their size, two only begin to touch: forces are those along the way there, without the shape of an overlap
/// that rounding has eaten.
pub const SHALLOW: f64 = 1e-8;

/// The depth of convex solids that overlap or touch; `None` for a gap above `touching`.
pub fn depth(pose: &ConvexPose, touching: f64) -> Option<Depth> {
    depth_along(pose, &pose.least_axis_within(touching), touching)
}

/// The depth by the axis of the largest gap.
pub(super) fn depth_along(pose: &ConvexPose, least: &LeastAxis, touching: f64) -> Option<Depth> {
    if least.gap > touching {
        return None;
    }
    let shallow = SHALLOW * pose.size();
    if -least.gap >= shallow {
        return within(pose, &least.axis).or_else(|| Some(slab(pose, &least.axis, -least.gap)));
    }
    let mut found = first_touch(pose, least);
    found.D *= (-least.gap).max(0.0) / shallow;
    Some(found)
}

/// The negative depth of convex solids apart, extrapolated from their first touch along the separating axis.
pub(super) fn approaching(pose: &ConvexPose, least: &LeastAxis) -> Depth {
    let mut found = first_touch(pose, least);
    found.D *= -least.gap / (SHALLOW * pose.size());
    found
}

/// The negative depth of convex solids apart as the gap along the separating axis.
pub(super) fn gap_along(pose: &ConvexPose, least: &LeastAxis) -> Depth {
    slab(pose, &least.axis, -least.gap)
}

/// The depth of two that are pushed into each other as little as the shape of their overlap allows.
fn first_touch(pose: &ConvexPose, least: &LeastAxis) -> Depth {
    let shallow = SHALLOW * pose.size();
    let shifted = pose.pushed_in(least, shallow);
    within(&shifted, &least.axis).unwrap_or_else(|| slab(&shifted, &least.axis, shallow))
}

/// The depth by the common solid; `None` where rounding leaves no volume.
fn within(pose: &ConvexPose, axis: &Vec3) -> Option<Depth> {
    match pose.as_polyhedra() {
        Some(polyhedra) => depth_by_volume(&polyhedra, axis, &pose.deepest(axis)),
        None => match CylinderPose::of(pose) {
            Some(of_cylinder) => of_cylinder.depth(axis),
            None => Swept::of(pose)?.depth(),
        },
    }
}

/// The depth along the axis at the deepest corner, used where the shape of the overlap is lost to rounding.
fn slab(pose: &ConvexPose, axis: &Vec3, depth: f64) -> Depth {
    let c = pose.deepest(axis);
    Depth { D: depth, g: -stack(axis, &(c - pose.y).cross(axis)), c, lever: 0.0 }
}
