//! The residual by unknown, its relative size, and the failures that it shows.

use crate::context::Context;
use crate::failure::{self, Failure};
use crate::system::Scale;
use crate::tolerances::residual::OTHER;
use crate::workspace::Workspace;
use base::math::larger;

/// Writes the residual by unknown into `ws.r`. Returns its largest entry relative to the forces or moments that it is
/// summed from.
pub fn gather(cx: &Context, ws: &mut Workspace, scale: &Scale) -> f64 {
    let (mut force, mut moment) = (0.0, 0.0);
    for (r, &(node, dof)) in ws.r.iter_mut().zip(cx.plan.dofs.nodal_dofs()) {
        *r = ws.forces.on_nodes[node][dof];
        // A NaN must not vanish in a comparison.
        let size = if r.is_nan() { f64::INFINITY } else { r.abs() };
        if dof < 3 {
            force = larger(force, size);
        } else {
            moment = larger(moment, size);
        }
    }
    // Forces and moments are judged apart; where one has no scale of its own, the other counts over the model's length.
    let forces = scale.force.max(OTHER * scale.moment / cx.length);
    let moments = scale.moment.max(OTHER * scale.force * cx.length);
    let ratio = |size: f64, of: f64| if size == 0.0 { 0.0 } else { size / of.max(f64::MIN_POSITIVE) };
    ratio(force, forces).max(ratio(moment, moments))
}

/// The failure of a motion that left the range of numbers.
pub fn not_finite(cx: &Context, ws: &mut Workspace) -> Failure {
    Failure::NotFinite { largest: largest(cx, ws) }
}

/// The failure of a step by arc length without equilibrium.
pub fn no_equilibrium(cx: &Context, ws: &mut Workspace) -> Failure {
    Failure::NoEquilibriumOnArc { largest: largest(cx, ws) }
}

/// The largest residual forces of the trial motion, by name.
pub fn largest(cx: &Context, ws: &mut Workspace) -> Vec<failure::NamedResidual> {
    gather(cx, ws, &Scale::default());
    failure::largest(cx.model, cx.plan, &ws.r)
}
