//! The interface of a group of like elements to assembly.

use super::results::{IntegrationPoint, ShellResultants};
use super::slip::Sliding;
use crate::materials::Dissipation;
use crate::state::{Configuration, Node};
use base::math::{Mat3, Vec3};

/// Generalised force on a node: force and moment, global components.
pub type Force = [f64; 6];

/// The moduli of the material that a tangent is formed with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moduli {
    /// The derivative of the stress at the end of the step: K(ep) + K(σ).
    Algorithmic,
    /// The elastic moduli, whatever has yielded: K(e) + K(σ) (11).
    Elastic,
}

/// Why an element has failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FailureCause {
    /// The largest plastic strain in it.
    PlasticStrain(f64),
    /// The forces of a link at its failure.
    Forces {
        /// Normal force, positive in tension.
        normal: f64,
        /// Shear force.
        shear: f64,
    },
}

/// The elements of a group, all alike, and the nodes that they join.
pub trait Elements: Send + Sync {
    /// The number of elements.
    fn len(&self) -> usize;
    /// True where the group has no elements.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// Nodes of element `e`.
    fn nodes(&self, e: usize) -> &[usize];
    /// The block as springs of friction; `None` for all others.
    fn sliding(&self) -> Option<&dyn Sliding> {
        None
    }
    /// Degrees of freedom of each node: 3, translations only, or 6, translations and rotations.
    fn dofs(&self) -> usize;
    /// True where element `e`, with six degrees of freedom a node, acts on the rotations of its `node`-th.
    fn is_rotational(&self, _e: usize, _node: usize) -> bool {
        true
    }
    /// The unit vector of the force of element `e`, if fixed in space.
    fn fixed_direction(&self, _e: usize) -> Option<Vec3> {
        None
    }
}

/// The forces, tangents and material histories of elements, as assembly needs them. Matrices are row-major over the nodes of an element,
/// [`Elements::dofs`] degrees of freedom each.
pub trait Mechanics: Elements {
    /// The number of history variables of all material points.
    fn history(&self) -> usize {
        0
    }
    /// Subtracts the internal forces of all elements from `F`, which is indexed by node.
    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]);
    /// Tangent of element `e`: K ← ∂f/∂(x, θ) + `rate_weight` · ∂f/∂(v, ω), f the internal force, θ spatial.
    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]);
    /// Tangents of the elements from `first` on, one after the other, as many as `K` holds: those of [`Mechanics::tangent`] but for
    /// rounding.
    fn tangents(&self, first: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        let length = (self.dofs() * self.nodes(first).len()).pow(2);
        let each = K.chunks_mut(length).enumerate();
        each.for_each(|(k, K)| self.tangent(first + k, now, rate_weight, moduli, K));
    }
    /// The elastic tangent of element `e` in the configuration `now`, with the stresses at the node positions `stressed`:
    /// it separates the effect of stresses from that of displacements. By default all is that of the nodes `stressed`.
    fn stressed_tangent(&self, e: usize, now: &Configuration, stressed: &[Node], K: &mut [f64]) {
        self.tangent(e, &Configuration { nodes: stressed, previous: None, ..*now }, 0.0, Moduli::Elastic, K);
    }
    /// Writes the history variables at `part` of the way from the last state to `now` into `new`, of length [`Mechanics::history`]. Returns
    /// the work dissipated or stored inelastically by material points.
    fn update_history(&self, _now: &Configuration, _part: f64, _new: &mut [f64]) -> Dissipation {
        Dissipation::default()
    }
    /// Does [`Mechanics::subtract_forces`] and [`Mechanics::update_history`] for the end of the step together, with the material computed
    /// once and the same results.
    fn advance(&self, now: &Configuration, F: &mut [Force], new: &mut [f64]) -> Dissipation {
        self.subtract_forces(now, F);
        self.update_history(now, 1.0, new)
    }
    /// True where the tangent is the same in every configuration.
    fn is_linear(&self) -> bool {
        false
    }
    /// Holds what depends on the speed of shafts at the speeds of these nodes, for a linearization whose nodes are at rest.
    fn hold_speeds(&self, _nodes: &[Node]) {}
    /// True where elastic forces have a potential, so that their tangent is symmetric.
    fn has_potential(&self) -> bool {
        true
    }
    /// True where friction with a limit by the load may make the tangent unsymmetric; contacts tell it themselves.
    fn slips_by_load(&self) -> bool {
        false
    }
    /// True where forces depend on velocities.
    fn is_damped(&self) -> bool {
        false
    }
    /// True where these forces change most with the velocities at rest.
    fn damps_most_at_rest(&self) -> bool {
        false
    }
}

/// Energies, stresses, strains and failure of elements, for output and warnings.
pub trait Results: Elements {
    /// Elastic energy stored.
    fn energy(&self, now: &Configuration) -> f64;
    /// Power that the damping of the elements dissipates, ≥ 0.
    fn damping_power(&self, _now: &Configuration) -> f64 {
        0.0
    }
    /// Internal forces on the two end nodes of a line element `e`; `None` for other elements.
    fn end_forces(&self, _e: usize, _now: &Configuration) -> Option<[Force; 2]> {
        None
    }
    /// Force along element `e` with its damping, positive in tension; `None` for what resists more than stretching.
    fn axial_force(&self, _e: usize, _now: &Configuration) -> Option<f64> {
        None
    }
    /// The number of integration points with results of [`Results::point`].
    fn points(&self) -> usize {
        0
    }
    /// Stress resultants at an integration point, in the axes of `frame` (columns, global at t = 0).
    fn point(&self, _e: usize, _point: usize, _frame: &Mat3, _now: &Configuration) -> Option<IntegrationPoint> {
        None
    }
    /// Calls `write` with the number and the stress resultants of each shell element; nodes lay at `start`. Axis 1 is `axis` projected on
    /// the surface at t = 0; if `axis` is normal to the surface, the global axis farthest from the normal is projected.
    fn resultants(
        &self,
        _axis: &Vec3,
        _start: &dyn Fn(usize) -> Vec3,
        _now: &Configuration,
        _write: &mut dyn FnMut(usize, ShellResultants),
    ) {
    }
    /// Calls `of` for each element whose material yields and that has not failed: with its number, the strain of largest size in its
    /// surface, of Green, and whether its law is for large strains.
    fn surface_strains(&self, _now: &Configuration, _of: &mut dyn FnMut(usize, f64, bool)) {}
    /// The largest rotation of a node relative to the frame of a linear element, in radians; zero for other elements.
    fn local_rotation(&self, _now: &Configuration) -> f64 {
        0.0
    }
    /// Largest accumulated plastic strain in element `e`, by the history variables of the group.
    fn plastic_strain(&self, _e: usize, _history: &[f64]) -> f64 {
        0.0
    }
    /// True for elements that may fail: such as carry nothing any more from some state on.
    fn can_fail(&self) -> bool {
        false
    }
    /// True where element `e` has failed, by the history variables of the group.
    fn has_failed(&self, _e: usize, _history: &[f64]) -> bool {
        false
    }
    /// Why element `e` has failed.
    fn failure_cause(&self, e: usize, history: &[f64]) -> FailureCause {
        FailureCause::PlasticStrain(self.plastic_strain(e, history))
    }
}

/// Kinks in the forces of elements, and states that elements must not pass.
pub trait Branches: Elements {
    /// True where element `e` has neither force nor tangent in this configuration.
    fn is_inactive(&self, _e: usize, _now: &Configuration) -> bool {
        false
    }
    /// True where forces have kinks: their slope jumps at opening, closing, slip, yielding and stops.
    fn has_kinks(&self) -> bool {
        false
    }
    /// A number of the branches between kinks on which the elements are; histories tell the others.
    fn branches(&self, _now: &Configuration) -> usize {
        0
    }
    /// True where element `e` has passed through zero length or area, or is reversed against its sections, and no longer represents the
    /// structure. `before`: the nodes at the start of the step.
    fn is_turned_over(&self, _e: usize, _before: &[Node], _now: &[Node]) -> bool {
        false
    }
}

/// A group of like elements with all that is asked of it.
pub trait ElementBlock: Mechanics + Results + Branches {}

impl<B: Mechanics + Results + Branches> ElementBlock for B {}

/// Subtracts `f` from three components of `F` from `at` on: 0, the force, or 3, the moment.
#[inline]
pub fn subtract(F: &mut Force, at: usize, f: &Vec3) {
    F[at] -= f.x;
    F[at + 1] -= f.y;
    F[at + 2] -= f.z;
}
