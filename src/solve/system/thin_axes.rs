//! Axes of bodies with next to no inertia, about which nothing exerts a moment: rods that are free, on springs, or on ball joints.
//!
//! Rounding and the error of the iteration, divided by such an inertia, would become spin. Without a moment the spin depends on ratios of inertias
//! alone: J₁ Ω̇₁ = (J₂ − J₃) Ω₂ Ω₃. So the inertia is raised to [`LEAST`] of the largest, and the difference of the two others in proportion.
//! The spin stays. The motion across changes by that part times the ratio of the spin to the other angular velocity.

use super::inertia::{ConsistentMass, Inertia};
use super::turning_body::carriers;
use crate::tolerances::thin_axes::{LEAST, ON_AXIS, ROUNDING};
use base::math::{Mat3, Vec3};
use mechanics::constraints::joint::ConstraintEquation;
use mechanics::constraints::rigid_link::RigidLink;
use model::{AnalysisKind, Joint, Model, NodalAction};
use nalgebra::SymmetricEigen;

/// Raises the inertias about such axes. A scene in a plane has none: about its normal alone bodies turn.
pub fn raise(
    model: &Model,
    (inertias, consistent): (&mut [Inertia], &[ConsistentMass]),
    links: &[RigidLink],
    plane: Option<usize>,
) {
    if model.analysis.kind != AnalysisKind::Dynamic || plane.is_some() {
        return;
    }
    let carries = carriers(model.nodes.len(), (inertias, consistent), links);
    for body in &model.bodies {
        let Ok(index) = inertias.binary_search_by_key(&body.node, |inertia| inertia.node) else { continue };
        let inertia = &mut inertias[index];
        if body.inertia == inertia.J0
            && !carries[body.node]
            && let Some((axis, J0)) = raised(&inertia.J0)
            && (Surroundings { model, links, node: body.node, axis, reach: reach(inertia) }).leave_it_free()
        {
            // Damping of masses acts on the inertia of the run, so that the spin decays as with that of the deck.
            if let Some(drag) = &mut inertia.drag {
                drag.J0 += (J0 - inertia.J0) * (drag.mass / inertia.mass);
            }
            inertia.of_deck = Some(Box::new(std::mem::replace(&mut inertia.J0, J0)));
        }
    }
}

/// The radius of gyration across the axis.
fn reach(inertia: &Inertia) -> f64 {
    if inertia.mass > 0.0 { (inertia.J0.trace() / inertia.mass).sqrt() } else { 0.0 }
}

/// The thin axis of a body and the tensor with its inertia raised; `None` where no axis is thin, or no body has such inertias.
fn raised(J0: &Mat3) -> Option<(Vec3, Mat3)> {
    let SymmetricEigen { eigenvectors, eigenvalues } = J0.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigenvalues[a].total_cmp(&eigenvalues[b]));
    let [thin, middle, large] = order.map(|k| (eigenvalues[k], eigenvectors.column(k).into_owned()));
    let (least, difference) = (LEAST * large.0, large.0 - middle.0);
    if thin.0 >= least || difference > thin.0.abs() + ROUNDING * large.0 {
        return None;
    }
    let along = |axis: &Vec3| axis * axis.transpose();
    // What rounding leaves of a difference is none.
    let factor = if thin.0 > ROUNDING * large.0 { least / thin.0 } else { 1.0 };
    Some((thin.1, J0 + along(&thin.1) * (least - thin.0) - along(&middle.1) * ((factor - 1.0) * difference)))
}

/// What may act on a body about its thin axis.
struct Surroundings<'m> {
    model: &'m Model,
    links: &'m [RigidLink],
    /// The node of the body, its centre of mass.
    node: usize,
    /// A unit vector in axes of the body, global at t = 0.
    axis: Vec3,
    reach: f64,
}

impl Surroundings<'_> {
    /// True where nothing can exert a moment about the axis.
    fn leave_it_free(&self) -> bool {
        let Model { constraints, damping, loading, parts, .. } = self.model;
        let carried = self.links.iter().filter(|link| link.master == self.node);
        let holds_all = carried.clone().all(|link| link.dofs == [true; 6]);
        let carries_more = self.links.iter().any(|link| carried.clone().any(|own| own.node == link.master));
        let follows = self.links.iter().any(|link| link.node == self.node);
        let held = constraints
            .restraints
            .iter()
            .any(|held| if held.node == self.node { held.dof > 2 } else { self.moves(held.node) });
        let mut dampers = damping.nodal.iter().filter(|damper| self.moves(damper.node));
        let mut loaded = loading.nodal.iter().filter(|load| self.moves(load.node));
        holds_all
            && !carries_more
            && !follows
            && !held
            && dampers.all(|damper| damper.rotation == 0.0 && self.is_on_axis(damper.node))
            && loaded.all(|load| load.moment == Vec3::zeros() && self.is_on_axis(load.node))
            && constraints.joints.iter().all(|joint| self.is_free_of(joint))
            && parts.iter().all(|part| {
                let of_elements = (0..part.elements()).flat_map(|e| part.nodes(e)).copied();
                let mut nodes = of_elements.chain(part.touched_nodes()).filter(|&node| self.moves(node));
                match part.action() {
                    NodalAction::Nothing => true,
                    NodalAction::Forces => nodes.all(|node| self.is_on_axis(node)),
                    NodalAction::Moments => nodes.next().is_none(),
                }
            })
    }

    /// True for the node of the body and for those that it carries.
    fn moves(&self, node: usize) -> bool {
        node == self.node || self.links.iter().any(|link| link.node == node && link.master == self.node)
    }

    fn is_on_axis(&self, node: usize) -> bool {
        let arm = self.model.nodes[node].x - self.model.nodes[self.node].x;
        arm.cross(&self.axis).norm() <= ON_AXIS * self.reach
    }

    fn is_free_of(&self, joint: &Joint) -> bool {
        if joint.more.iter().any(|share| self.moves(share.node)) {
            return false;
        }
        let [first, second] = joint.ends.map(|node| self.moves(node));
        let on_axis = || joint.ends.iter().filter(|&&node| self.moves(node)).all(|&node| self.is_on_axis(node));
        let is_axis = |of: &Vec3| of.cross(&self.axis).norm() <= ON_AXIS * of.norm();
        let is_free = |equation: &ConstraintEquation| match equation {
            ConstraintEquation::GlobalAxis { .. } | ConstraintEquation::Distance { .. } => on_axis(),
            ConstraintEquation::BodyAxis { .. } => !second && on_axis(),
            // Its moment is perpendicular to both, and two of them keep an axis of the other body in line.
            ConstraintEquation::Perpendicular { p, s } => {
                let with = |equation: &&ConstraintEquation, [first, second]: [Option<&Vec3>; 2]| match equation {
                    ConstraintEquation::Perpendicular { p, s } => {
                        first.is_none_or(|of| of == p) && second.is_none_or(|of| of == s)
                    }
                    _ => false,
                };
                let in_line = |of: [Option<&Vec3>; 2]| joint.equations.iter().filter(|one| with(one, of)).count() > 1;
                let of_first = is_axis(p) && (first || in_line([Some(p), None]));
                let of_second = is_axis(s) && (second || in_line([None, Some(s)]));
                of_first || of_second
            }
            ConstraintEquation::Angle(_)
            | ConstraintEquation::Given(_)
            | ConstraintEquation::Turn { .. }
            | ConstraintEquation::Screw { .. } => false,
        };
        let effort = joint.coordinate.as_ref().is_some_and(|coordinate| coordinate.effort.is_some());
        !(first || second) || !effort && joint.equations.iter().all(is_free)
    }
}
