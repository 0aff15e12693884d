//! The masses of nodes, by bodies, point masses and deformable parts.

use super::inertia::{ConsistentMass, Inertia};
use super::parts::{NodalMasses, assembled};
use base::math::Vec3;
use model::{Body, Mass, Model, Part};

/// Lumped and consistent masses of bodies, point masses and deformable parts; `x` are the initial positions of all
/// nodes.
pub fn masses(model: &Model, x: &[Vec3]) -> (Vec<Inertia>, Vec<ConsistentMass>) {
    let parts = model.parts.iter().enumerate().filter(|(part, _)| model.reduction(*part).is_none());
    masses_of(model, x, model.bodies.iter(), model.masses.iter(), parts.map(|(_, part)| part))
}

/// [`masses`] of some of the bodies, point masses and parts.
pub fn masses_of<'m>(
    model: &Model,
    x: &[Vec3],
    bodies: impl Iterator<Item = &'m Body>,
    points: impl Iterator<Item = &'m Mass>,
    parts: impl Iterator<Item = &'m Part>,
) -> (Vec<Inertia>, Vec<ConsistentMass>) {
    let mut masses = NodalMasses::new(model, x);
    let damping = &model.damping;
    if model.parts.iter().any(|part| part.own_damping().alpha.is_some()) {
        masses.lumped.with_drags();
    }
    masses.lumped.set_alpha(damping.mass_factor);
    bodies.for_each(|body| masses.lumped.add(body.node, body.mass, &body.inertia));
    points.for_each(|mass| masses.lumped.add(mass.node, mass.mass, &mass.inertia));
    for part in parts {
        let (first, alpha) = (masses.consistent.len(), damping.alpha(&part.own_damping()));
        masses.lumped.set_alpha(alpha);
        assembled(part).add_masses(&model.stiffnesses, &mut masses);
        masses.consistent[first..].iter_mut().for_each(|mass| mass.alpha = alpha);
    }
    (masses.lumped.finish(), masses.consistent)
}
