//! The convergence criterion of the iteration: it rests on the sizes of corrections and residuals alone.

use crate::tolerances::convergence::{FALLS, SATURATED, SECOND_ORDER, SLOW, STAGNANT};

/// Judges the corrections of a step.
pub struct Convergence {
    /// Tolerances of the correction and of the residual.
    tolerances: [f64; 2],
    /// True where the scene is linear: one correction is exact.
    exact: bool,
    last: Option<Correction>,
    /// The contraction that the first correction is judged by.
    usual: f64,
    /// Number of corrections whose residual stayed above half of the previous one.
    stagnant: usize,
}

/// The size of a correction relative to the motion of the step, and the residual before it relative to the forces.
#[derive(Debug, Clone, Copy)]
struct Correction {
    size: f64,
    residual: f64,
}

/// The judgement on a correction.
#[derive(Debug, Clone, Copy)]
pub struct Judgement {
    /// The larger ratio of size or residual to the previous correction; the usual contraction for the first one.
    pub contraction: f64,
    /// The contraction that tells of the matrix: that of sizes alone while the residual has the size of the forces. Stiff parts keep it there
    /// until their rotations are right, so its ratio tells nothing.
    pub of_matrix: f64,
    /// True where there was a correction before.
    pub seen: bool,
    /// True if the correction is larger than the previous one.
    pub grows: bool,
    /// Number of corrections whose residual did not fall.
    stagnant: usize,
    /// Estimated remaining error or residual, the larger, relative; the second one at the contraction of the matrix.
    left: [f64; 2],
    /// The tolerance of the correction.
    pub tolerance: f64,
}

impl Convergence {
    /// A criterion with relative tolerances of the correction and of the residual; the first correction is judged by the `usual` contraction.
    pub fn new(tolerances: [f64; 2], exact: bool, usual: f64) -> Self {
        Convergence { tolerances, exact, last: None, usual, stagnant: 0 }
    }

    /// Takes other tolerances, of the correction and of the residual.
    pub fn adopt(&mut self, tolerances: [f64; 2]) {
        self.tolerances = tolerances;
    }

    /// Forgets the corrections so far, after a return to the prediction.
    pub fn forget(&mut self) {
        (self.last, self.stagnant) = (None, 0);
    }

    /// Judges a correction of this relative size after this relative residual. With `quadratic`, its matrix was formed for the iterate: the
    /// residual after a short correction is of second order in it.
    pub fn judge(&mut self, size: f64, residual: f64, quadratic: bool) -> Judgement {
        let contraction = match self.last {
            _ if self.exact => 0.0,
            None => self.usual,
            Some(last) => (size / last.size).max(residual / last.residual),
        };
        let of_matrix = match self.last {
            Some(last) if last.residual.min(residual) > SATURATED => size / last.size,
            _ => contraction,
        };
        let contraction_of_residual = match self.last {
            Some(last) if quadratic => contraction.min(SECOND_ORDER * (size / last.size).powi(2)),
            _ => contraction,
        };
        self.stagnant = match self.last {
            Some(last) if residual > FALLS * last.residual => self.stagnant + 1,
            // Rounding may halve it by chance.
            _ => self.stagnant,
        };
        // The corrections to come are a geometric series; the next residual contracts likewise.
        let [tolerance, of_residual] = self.tolerances;
        let left = |contraction: f64, of_forces: f64| {
            (contraction / (1.0 - contraction) * size).max(of_forces * residual * (tolerance / of_residual))
        };
        let left =
            [left(contraction, contraction_of_residual), left(of_matrix, of_matrix.min(contraction_of_residual))];
        let grows = self.last.is_some_and(|last| size > last.size);
        let seen = self.last.replace(Correction { size, residual }).is_some();
        Judgement { grows, contraction, of_matrix, stagnant: self.stagnant, seen, left, tolerance }
    }
}

impl Judgement {
    /// True where the remaining error and residual are below the tolerance.
    pub fn converged(&self) -> bool {
        self.contraction < 1.0 && self.left[0] <= self.tolerance
    }

    /// True where the iteration contracts slowly or not at all: only rounding may be left.
    pub fn stalled(&self) -> bool {
        self.contraction > SLOW
    }

    /// True once the residual has failed to fall so often that further iterations are useless. A single rise proves nothing: the first
    /// correction of a step may stretch parts that only bend.
    pub fn is_stagnant(&self) -> bool {
        self.stagnant >= STAGNANT
    }

    /// Number of iterations still needed at this rate, or at the contraction of the matrix.
    pub fn remaining(&self, of_matrix: bool) -> f64 {
        let contraction = if of_matrix { self.of_matrix } else { self.contraction };
        let left = self.left[usize::from(of_matrix)];
        if contraction < 1.0 { (self.tolerance / left).ln() / contraction.ln() } else { f64::INFINITY }
    }
}
