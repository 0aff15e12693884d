//! Supports along axes of their own: equations between the node and a fixed point at its place.

use crate::data::{Joint, JointCoordinate, JointDrive, PrescribedMotion};
use crate::places::nodes::Topology;
use crate::places::spot::Spot;
use base::diagnostic::Span;
use base::math::{Mat3, Vec3};
use mechanics::constraints::joint::{ConstraintEquation, rotations};
use std::collections::HashMap;

/// A direction given by a support: with its motion (`None` for rest) and its place in the deck.
pub type GivenDirection<'d> = (usize, Option<PrescribedMotion>, &'d Span);

/// Names of translations along the axes of a support.
const ALONG: [&str; 3] = ["x", "y", "z"];
/// The part of a unit axis that rounding leaves outside held directions.
const HELD: f64 = 1e-9;

/// The directions in which supports hold each node: unit vectors, perpendicular to each other.
#[derive(Default)]
pub struct HeldDirections(HashMap<usize, Vec<Vec3>>);

impl HeldDirections {
    /// Adds a direction of a node; false where it was held before.
    fn add(&mut self, node: usize, axis: &Vec3, topology: &Topology) -> bool {
        let by_restraints = || {
            let held = (0..3).filter(|&dof| topology.restraint(node, dof).is_some());
            held.map(|dof| Vec3::ith(dof, 1.0)).collect()
        };
        let known = self.0.entry(node).or_insert_with(by_restraints);
        let rest = known.iter().fold(*axis, |rest, held| rest - held * held.dot(&rest));
        let is_new = rest.norm() > HELD;
        if is_new {
            known.push(rest.normalize());
        }
        is_new
    }
}

/// A support with axes at one node.
pub struct SupportInAxes<'a> {
    /// The axes, as columns.
    pub axes: &'a Mat3,
    /// Directions at rest: translations along the axes, rotations about them.
    pub fixed: [bool; 6],
    /// Translations that move.
    pub motions: &'a [GivenDirection<'a>],
}

impl SupportInAxes<'_> {
    /// Adds the joints that hold a node. Returns the nodes of the motions and the axis, 0 to 2, of a motion that another support contradicts.
    pub fn hold(
        &self,
        spot: &Spot,
        held: &mut HeldDirections,
        (topology, joints): (&mut Topology, &mut Vec<Joint>),
    ) -> (Vec<[usize; 2]>, Option<usize>) {
        let node = spot.node;
        let (label, x) = (topology.label(node).to_owned(), topology.x(node));
        let axis = |k: usize| self.axes.column(k).into_owned();
        let along = |k: usize| ConstraintEquation::BodyAxis { e: axis(k), at: 0.0 };
        let new: Vec<usize> = (0..3).filter(|&k| self.fixed[k] && held.add(node, &axis(k), topology)).collect();
        let mut equations: Vec<ConstraintEquation> = new.into_iter().map(along).collect();
        equations.extend(rotations([3, 4, 5].map(|dof| self.fixed[dof]), self.axes));
        if equations.is_empty() && self.motions.is_empty() {
            return (Vec::new(), None);
        }
        let point = topology.add(label.clone(), false, x);
        (0..6).for_each(|dof| topology.restrain(point, dof, None));
        if !equations.is_empty() {
            joints.push(Joint::new(format!("{label} on its support"), [node, point], equations, true));
        }
        let mut moved = Vec::new();
        for (k, motion, _) in self.motions {
            if !held.add(node, &axis(*k), topology) {
                return (moved, Some(*k));
            }
            let number = topology.add_number(format!("{label}.{}", ALONG[*k]), node);
            topology.restrain(number, 0, motion.clone());
            moved.push([number, 0]);
            let mut joint =
                Joint::new(format!("{label} on its support, {}", ALONG[*k]), [node, point], Vec::new(), true);
            let (lock, axis) = (along(*k), axis(*k));
            joint.coordinate = Some(JointCoordinate { lock, axis, drive: None, effort: None, spring: None });
            joint.set_drive(JointDrive { node: number, ratio: 1.0, is_free: false });
            joints.push(joint);
        }
        (moved, None)
    }
}
