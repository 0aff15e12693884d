//! Scenes that move in a plane.

use super::inertia::Inertia;
use crate::constraints::attachment::Attachment;
use crate::math::{Mat3, Vec3, skew};
use crate::model::{BeamElement, Link, LinkKind, Model, Part};

/// The global axis normal to the plane of a scene in which nothing can move out of it, where the deck does not ask to keep
/// what is out of it.
pub fn normal(model: &Model, inertias: &[Inertia], attachments: &[Attachment]) -> Option<usize> {
    if model.analysis.plane { (0..3).rev().find(|&n| is_plane(model, inertias, attachments, n)) } else { None }
}

fn is_plane(model: &Model, inertias: &[Inertia], attachments: &[Attachment], n: usize) -> bool {
    let small = 1e-12; // of the entries beside it: what rounding leaves of a zero
    // Against the largest entry: the norm of large numbers overflows, and nothing exceeds infinity.
    let out_of_plane = |v: &Vec3| v[n].abs() > small * v.amax();
    let not_along = |v: &Vec3| (0..3).any(|i| i != n && v[i].abs() > small * v.amax());
    // A symmetric tensor that keeps the normal and the plane apart.
    let mixes = |J: &Mat3| (0..3).any(|i| i != n && J[(n, i)].abs().max(J[(i, n)].abs()) > small * J.amax());
    // A matrix that pairs a vector in the plane with a rotation along the normal, or the other way round.
    let pairs_wrongly =
        |K: &Mat3| (0..3).any(|i| (0..3).any(|j| (i == n) == (j == n) && K[(i, j)].abs() > small * K.amax()));

    if !model.loading.pressures.is_empty() {
        return false;
    }
    let Some(first) = model.nodes.first() else { return false };
    let size = model.nodes.iter().map(|p| (p.x - first.x).norm()).fold(0.0, f64::max);
    let flat = |p: &crate::model::Node| (p.x[n] - first.x[n]).abs() <= small * size;
    let still = |p: &crate::model::Node| !out_of_plane(&p.v) && !not_along(&p.omega);
    if !model.nodes.iter().all(|p| flat(p) && still(p)) {
        return false;
    }
    if model.loading.nodal.iter().any(|l| out_of_plane(&l.force) || not_along(&l.moment)) {
        return false;
    }
    if out_of_plane(&model.loading.gravity)
        || model.loading.base_accelerations.iter().any(|b| out_of_plane(&b.direction))
    {
        return false;
    }
    let in_plane = |dof: usize| if dof < 3 { dof != n } else { dof - 3 == n };
    if model.constraints.restraints.iter().any(|h| h.motion.is_some() && !in_plane(h.dof)) {
        return false;
    }
    if inertias.iter().any(|i| mixes(&i.J0)) {
        return false;
    }
    let beam_keeps = |e: &BeamElement| {
        let C = &model.stiffnesses[e.section];
        let turn = |K: &Mat3| e.frame * K * e.frame.transpose();
        // What pairs forces with curvatures may be nothing but rounding, that of a shear centre at the centroid: it is small
        // beside what both do by themselves, the geometric mean of forces and moments.
        let rest = turn(&C.NM);
        let paired = rest.amax() > small * C.N.amax().sqrt() * C.M.amax().sqrt();
        !mixes(&turn(&C.N)) && !mixes(&turn(&C.M)) && (!paired || !pairs_wrongly(&rest))
    };
    let link_keeps = |link: &Link| match &link.kind {
        LinkKind::Line { direction, .. } => direction.is_none_or(|d| !out_of_plane(&d)),
        LinkKind::Bushing { stiffness, damping, axes } => [stiffness, damping].into_iter().all(|k| {
            let turn = |k: &[f64]| axes * Mat3::from_diagonal(&Vec3::new(k[0], k[1], k[2])) * axes.transpose();
            !mixes(&turn(&k[..3])) && !mixes(&turn(&k[3..]))
        }),
    };
    let parts = model.parts.iter().all(|part| match part {
        Part::Beam(beam) => beam.elements.iter().all(beam_keeps),
        Part::Bar(_) => true,
        // Shells bend out of any plane they lie in.
        Part::Shell(shell) => shell.elements.is_empty(),
        Part::Link(link) => link_keeps(link),
        Part::Contact(contact) => contact.surface.center[n].abs() <= small * size && contact.surface.keeps(n),
    });
    // Arms lie in the plane with the nodes; skew(arm) pairs rightly by itself.
    let arms = attachments.iter().all(|a| !pairs_wrongly(&skew(&a.S0)) || a.S0 == Vec3::zeros());
    let joints = model.constraints.joints.iter().all(|joint| {
        let d = model.nodes[joint.ends[0]].x - model.nodes[joint.ends[1]].x;
        joint.rows.iter().all(|row| row.in_plane(n, &d).is_some())
    });
    parts && arms && joints
}
