//! Stabilization of the first matrix of a load step. A hanging body is kept upright only by the force of its joint, which is unknown before
//! the first correction. The first matrix therefore has no stiffness against its swing. Springs between all nodes and the ground take part
//! in that one correction. The next matrix has the forces of joints in it, and has to do without. Links under pretension restrain hanging
//! parts in the same way.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::mode::Mode;
use crate::tolerances::stabilization::{HELD, IN_PLACE, ROUNDING};
use linear::{Solver, Sparse};

/// True if forces of joints or of pretensioned links may restrain motions that elements do not resist.
pub fn may_help(cx: &Context) -> bool {
    // A number holds the length taken up by pretension.
    let may_hold = !cx.system.joints.is_empty() || !cx.numbers.is_empty();
    !cx.is_dynamic() && may_hold && !cx.model.analysis.step_length.is_arc_length()
}

/// A matrix of the first iteration that is singular without springs.
pub struct Unheld {
    /// The failure of the matrix.
    pub failure: Failure,
    /// Stiffness of the springs that take part in place of forces: the largest force of the residual over the model's length.
    pub stiffness: f64,
}

impl Unheld {
    /// A matrix that has failed under this residual.
    pub fn new(cx: &Context, residual: &[f64], failure: Failure) -> Unheld {
        let forces = residual.iter().zip(cx.plan.dofs.nodal_dofs()).map(|(r, &(_, dof))| r.abs() / lever(cx, dof));
        Unheld { failure, stiffness: forces.fold(0.0, f64::max) / cx.length }
    }

    /// Adds the springs to an assembled matrix.
    pub fn add_springs(&self, cx: &Context, solver: &mut Solver) {
        for (row, &(_, dof)) in cx.plan.dofs.nodal_dofs().iter().enumerate() {
            if let Some(slot) = solver.slot(row, row) {
                solver.values()[slot] += self.stiffness * lever(cx, dof).powi(2);
            }
        }
    }
}

/// True if a first correction moves all nodes only a little.
pub fn stays_in_place(cx: &Context, correction: &[f64]) -> bool {
    let dofs = cx.plan.dofs.nodal_dofs();
    correction.iter().zip(dofs).all(|(by, &(_, dof))| by.abs() * lever(cx, dof) <= IN_PLACE * cx.length)
}

/// The displacement for a unit of this degree of freedom.
fn lever(cx: &Context, dof: usize) -> f64 {
    if dof < 3 { 1.0 } else { cx.length }
}

/// The stiffness from forces of joints where elements have none: the matrix assembled with these forces, and the stiffness of the earlier
/// springs.
pub struct HeldByForces {
    pub assembled: Sparse,
    pub springs: f64,
}

impl HeldByForces {
    /// True where forces resist a mode. They do not restrain a compressed part, such as a mast that stands on a ball joint.
    pub fn resist(&self, mode: &Mode) -> bool {
        let [energy, terms] = mode.energy(&self.assembled);
        energy > HELD * self.springs + ROUNDING * terms
    }
}
