//! The residual by unknown, its relative size, and the failures that it shows.

use super::context::Context;
use super::failure::{self, Failure};
use super::workspace::Workspace;
use crate::math::larger;
use crate::system::Scale;

/// The forces and moments that a residual is summed from, and the largest of the load steps so far. Where loads go back to
/// zero nothing but rounding is left of the forces, and it is the rounding of those that have been.
#[derive(Debug, Clone, Copy, Default)]
pub struct Magnitudes {
    now: Scale,
    before: Scale,
}

impl Magnitudes {
    /// Takes those of the residual at hand.
    pub fn see(&mut self, now: Scale) {
        self.now = now;
    }

    /// Keeps those of a load step that was accepted.
    pub fn keep(&mut self) {
        self.before = self.largest();
    }

    /// The part, at most 1, that the forces at hand are of the largest so far; `length`: the model's.
    pub fn part(&self, length: f64) -> f64 {
        let (now, largest) = (references(&self.now, length), references(&self.largest(), length));
        let part = |i: usize| if largest[i] > 0.0 { now[i] / largest[i] } else { 1.0 };
        part(0).max(part(1))
    }

    fn largest(&self) -> Scale {
        let Magnitudes { now, before } = self;
        Scale { force: larger(now.force, before.force), moment: larger(now.moment, before.moment) }
    }
}

/// The force and the moment that residuals are judged by. Forces and moments are judged apart; where one has no scale of its
/// own, the other counts over the model's length.
fn references(scale: &Scale, length: f64) -> [f64; 2] {
    [scale.force.max(1e-3 * scale.moment / length), scale.moment.max(1e-3 * scale.force * length)]
}

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
    let [forces, moments] = references(scale, cx.length);
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
