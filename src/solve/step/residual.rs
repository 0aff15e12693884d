//! The residual by unknown, its relative size, and the failures that it shows.

use crate::context::Context;
use crate::failure::{self, Failure, NamedResidual};
use crate::system::{Forces, Scale};
use crate::tolerances::residual::OTHER;
use base::math::larger;
use base::snapshot::keep;

/// Forces out of balance by unknown; the entries of multipliers are zero, for gaps of joints stand in their place.
pub struct Residual {
    /// Forces and moments by unknown.
    pub values: Vec<f64>,
}

keep!(Residual { values });

impl Residual {
    /// No forces.
    pub fn new(cx: &Context) -> Residual {
        Residual { values: vec![0.0; cx.plan.dofs.unknowns()] }
    }

    /// The forces on the unknowns of nodes.
    pub fn of_nodes(&self, cx: &Context) -> &[f64] {
        &self.values[..cx.nodal_unknowns()]
    }

    /// The forces on the unknowns of nodes, to be written.
    pub fn of_nodes_mut(&mut self, cx: &Context) -> &mut [f64] {
        &mut self.values[..cx.nodal_unknowns()]
    }

    /// Writes the forces on the nodes times a factor.
    pub fn write(&mut self, cx: &Context, forces: &Forces, factor: f64) {
        for (r, &(node, dof)) in self.values.iter_mut().zip(cx.plan.dofs.nodal_dofs()) {
            *r = factor * forces.on_nodes[node][dof];
        }
    }

    /// Writes the forces on the nodes. Returns the largest relative to the forces or moments that it is summed from.
    pub fn gather(&mut self, cx: &Context, forces: &Forces, scale: &Scale) -> f64 {
        let (mut force, mut moment) = (0.0, 0.0);
        for (r, &(node, dof)) in self.values.iter_mut().zip(cx.plan.dofs.nodal_dofs()) {
            *r = forces.on_nodes[node][dof];
            // A NaN must not vanish in a comparison.
            let size = if r.is_nan() { f64::INFINITY } else { r.abs() };
            if dof < 3 {
                force = larger(force, size);
            } else {
                moment = larger(moment, size);
            }
        }
        // Forces and moments are judged separately; if one has no scale, the other is used with the model's length as arm.
        let forces = scale.force.max(OTHER * scale.moment / cx.length);
        let moments = scale.moment.max(OTHER * scale.force * cx.length);
        let ratio = |size: f64, of: f64| if size == 0.0 { 0.0 } else { size / of.max(f64::MIN_POSITIVE) };
        ratio(force, forces).max(ratio(moment, moments))
    }
}

/// The failure of a motion that left the range of numbers.
pub fn not_finite(cx: &Context, forces: &Forces) -> Failure {
    Failure::NotFinite { largest: largest(cx, forces) }
}

/// The failure of a step by arc length without equilibrium.
pub fn no_equilibrium(cx: &Context, forces: &Forces) -> Failure {
    Failure::NoEquilibriumOnArc { largest: largest(cx, forces) }
}

/// The largest residual forces of the trial motion, by name.
pub fn largest(cx: &Context, forces: &Forces) -> Vec<NamedResidual> {
    let residual: Vec<f64> = cx.plan.dofs.nodal_dofs().iter().map(|&(node, dof)| forces.on_nodes[node][dof]).collect();
    failure::largest(cx.model, cx.plan, &residual)
}
