//! Stabilization of the first matrix of a load step. A body that hangs from a joint is held upright by the force of that joint alone, which
//! is not known before the first correction: until then nothing resists its swing. Springs between all nodes and the ground take part in
//! that one correction. The next matrix has the forces of joints in it, and has to do without. Links that are being pretensioned hold what hangs
//! on them likewise.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::mode::Mode;
use crate::tolerances::stabilization::{HELD, IN_PLACE, ROUNDING};
use linear::{Solver, Sparse};

/// True where forces of joints or of pretensioned links may hold what elements do not.
pub fn may_help(cx: &Context) -> bool {
    // The length that pretension takes up is a number.
    let may_hold = !cx.system.joints.is_empty() || !cx.numbers.is_empty();
    !cx.is_dynamic() && may_hold && !cx.model.analysis.step_length.is_arc_length()
}

/// What held nothing by itself.
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

/// True where a first correction leaves everything in its place.
pub fn stays_in_place(cx: &Context, correction: &[f64]) -> bool {
    let dofs = cx.plan.dofs.nodal_dofs();
    correction.iter().zip(dofs).all(|(by, &(_, dof))| by.abs() * lever(cx, dof) <= IN_PLACE * cx.length)
}

/// The displacement that a unit of this degree of freedom stands for.
fn lever(cx: &Context, dof: usize) -> f64 {
    if dof < 3 { 1.0 } else { cx.length }
}

/// What forces of joints hold where elements hold nothing: the matrix as it was assembled with them, and the stiffness of the springs that
/// were there before.
pub struct HeldByForces {
    pub assembled: Sparse,
    pub springs: f64,
}

impl HeldByForces {
    /// True where forces resist a mode. What they push on, as the weight of a mast that stands on a ball joint, they do not hold.
    pub fn resist(&self, mode: &Mode) -> bool {
        let [energy, terms] = mode.energy(&self.assembled);
        energy > HELD * self.springs + ROUNDING * terms
    }
}
