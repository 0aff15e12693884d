//! The Lagrange multipliers of joints in the iteration; see [`super::joints`] for the equations.

use crate::tolerances::multipliers::REGULARIZATION;
use base::snapshot::keep;

/// The Lagrange multipliers of all joints, one entry for each constraint equation.
#[derive(Debug, Clone, Default)]
pub struct Multipliers {
    /// λ: the constraint forces and moments. The iteration writes them.
    pub values: Vec<f64>,
    /// c: the violations of the constraint equations. [`super::System::residual`] writes them.
    pub gaps: Vec<f64>,
    /// s: the penalty factors. Assembly of the tangent writes them.
    pub(super) penalties: Vec<f64>,
    /// ε of the system.
    regularization: f64,
}

keep!(Multipliers { values, gaps, penalties } without { regularization });

impl Multipliers {
    /// Zero multipliers for this number of constraint equations, regularized by ε.
    pub fn new(rows: usize, regularization: f64) -> Self {
        Multipliers { values: vec![0.0; rows], gaps: vec![0.0; rows], penalties: vec![0.0; rows], regularization }
    }

    /// True where equations may be redundant, and share loads.
    pub fn may_share(&self) -> bool {
        self.regularization == REGULARIZATION
    }

    /// Copies multipliers and penalty factors; the gaps belong to a configuration and are recomputed.
    pub fn copy_from(&mut self, other: &Multipliers) {
        self.values.copy_from_slice(&other.values);
        self.penalties.copy_from_slice(&other.penalties);
    }

    /// Writes the right-hand side −s (1 + ε) c of the constraint equations into `tail`, the rows of the multipliers.
    #[inline]
    pub fn write_rhs(&self, tail: &mut [f64]) {
        for ((r, s), c) in tail.iter_mut().zip(&self.penalties).zip(&self.gaps) {
            *r = -s * (1.0 + self.regularization) * c;
        }
    }

    /// Turns the solution δμ in `tail` into δλ/s = δμ − c.
    #[inline]
    pub fn subtract_gaps(&self, tail: &mut [f64]) {
        tail.iter_mut().zip(&self.gaps).for_each(|(r, c)| *r -= c);
    }

    /// Updates λ ← λ + s `tail`, with `tail` from [`Multipliers::subtract_gaps`].
    #[inline]
    pub fn add(&mut self, tail: &[f64]) {
        for ((value, s), r) in self.values.iter_mut().zip(&self.penalties).zip(tail) {
            *value += s * r;
        }
    }

    /// Updates λ ← λ + s c with the remaining gaps c of a solution: the penalty supports this part, and equilibrium holds with the sum. An
    /// iteration finds it in its next residual; a single solution must take it in.
    #[inline]
    pub fn add_gaps(&mut self) {
        for ((value, s), c) in self.values.iter_mut().zip(&self.penalties).zip(&self.gaps) {
            *value += s * c;
        }
    }
}
