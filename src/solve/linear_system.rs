//! A matrix with its factorization, and the common solution procedure for systems with joints.

use super::context::Context;
use super::failure::Failure;
use crate::step::correct::Correction;
use crate::step::residual::Residual;
use crate::system::Multipliers;
use crate::system::assembly::Assembly;
use base::snapshot::{Keep, Snapshot, keep};
use linear::{Singular, Solver};
use mechanics::elements::Partners;
use mechanics::state::Configuration;

/// A sparse matrix with the assembly that fills it and its factors.
pub struct LinearSystem {
    /// The sparse matrix with its factorization.
    pub solver: Solver,
    /// The slots of the matrices of elements and nodes.
    pub assembly: Assembly,
    /// True as long as nothing has been computed that a signal may cost.
    pub loses_nothing: bool,
    /// True while a step is under way that may be taken again.
    pub in_step: bool,
    /// True if another analysis has overwritten the matrix of the step.
    pub overwritten: bool,
}

keep!(LinearSystem { solver } without { assembly, loses_nothing, in_step, overwritten });

impl LinearSystem {
    /// A matrix, to be assembled and factorised.
    pub fn new(solver: Solver, assembly: Assembly) -> LinearSystem {
        LinearSystem { solver, assembly, loses_nothing: true, in_step: false, overwritten: false }
    }

    /// Checks if a signal ends the computation: before the first step of a run is complete, and if the current step is too slow.
    ///
    /// # Errors
    /// [`Failure::Stopped`] where one does.
    #[inline]
    pub fn check_stop(&self, cx: &Context) -> Result<(), Failure> {
        let stops = cx.stop.is_made() && (self.loses_nothing || self.in_step && cx.stop.is_overdue());
        if stops { Err(Failure::Stopped) } else { Ok(()) }
    }

    /// Factors the matrix. False if a signal has stopped it.
    ///
    /// # Errors
    /// A pivot is zero or not finite.
    pub fn factor(&mut self, cx: &Context) -> Result<bool, Singular> {
        let (loses_nothing, in_step) = (self.loses_nothing, self.in_step);
        self.solver.factor_unless(&|| cx.stop.is_made() && (loses_nothing || in_step && cx.stop.is_overdue()))
    }

    /// Rebuilds the structure if the matrix has no room for active pairs of elements; all pairs that may soon act then have room. If memory
    /// is short the structure is kept: the matrix then omits these pairs, the forces do not.
    pub fn make_room(&mut self, cx: &Context, now: &Configuration) {
        if !self.assembly.has_room(cx.system, now) {
            self.rebuild(cx, &cx.system.partners(now.nodes));
        }
    }

    /// Saves the pairs with room in the matrix before all other data, because the matrix is rebuilt from them.
    pub fn keep_room(&mut self, cx: &Context, snapshot: &mut Snapshot) {
        if cx.system.wandering_groups().next().is_none() || cx.plan.explicit {
            return;
        }
        let mut partners = self.assembly.partners();
        partners.keep(snapshot);
        if snapshot.gives() {
            self.rebuild(cx, &partners);
        }
    }

    fn rebuild(&mut self, cx: &Context, partners: &[(usize, Partners)]) {
        if let Ok((solver, assembly)) = cx.plan.build_with(cx.system, partners) {
            (self.solver, self.assembly) = (solver, assembly);
        }
    }

    /// Solves for the correction due to a residual and the gaps of joints.
    #[inline]
    pub fn solve(&mut self, multipliers: &Multipliers, residual: &Residual, correction: &mut Correction) {
        correction.values.copy_from_slice(&residual.values);
        self.solve_augmented(multipliers, &mut correction.values);
    }

    /// Solves for nodal unknowns and multipliers together. `rhs` holds the forces on the nodal unknowns and becomes the correction. Its
    /// last entries belong to the multipliers: they are written from the gaps and become δλ/s, ready for [`Multipliers::add`].
    #[inline]
    pub fn solve_augmented(&mut self, multipliers: &Multipliers, rhs: &mut [f64]) {
        let directions = rhs.len() - multipliers.gaps.len();
        multipliers.write_rhs(&mut rhs[directions..]);
        self.solver.solve(rhs);
        multipliers.subtract_gaps(&mut rhs[directions..]);
    }
}
