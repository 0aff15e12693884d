//! When an iteration has done enough: from the sizes of corrections and residuals alone.

/// Watches the corrections of a step.
pub struct Convergence {
    tolerance: f64,
    /// One correction leaves nothing: the scene is linear.
    exact: bool,
    last: Option<Correction>,
}

/// A correction relative to the motion of the step, and the residual that asked for it relative to the forces.
#[derive(Debug, Clone, Copy)]
struct Correction {
    size: f64,
    residual: f64,
}

/// What a correction says.
#[derive(Debug, Clone, Copy)]
pub struct Judgement {
    /// Of size or residual against the last one's, the slower; 0.5 is taken where there is no last one.
    pub contraction: f64,
    /// There was a last one.
    pub seen: bool,
    /// Error or residual that is left, the larger, relative.
    left: f64,
    tolerance: f64,
}

impl Convergence {
    pub fn new(tolerance: f64, exact: bool) -> Self {
        Convergence { tolerance, exact, last: None }
    }

    /// After a return to the prediction.
    pub fn forget(&mut self) {
        self.last = None;
    }

    pub fn judge(&mut self, size: f64, residual: f64) -> Judgement {
        let contraction = match self.last {
            _ if self.exact => 0.0,
            None => 0.5,
            Some(last) => (size / last.size).max(residual / last.residual),
        };
        // A geometric series of corrections to come; the residual of the next.
        let error = contraction / (1.0 - contraction) * size;
        let left = error.max(contraction * residual);
        let seen = self.last.replace(Correction { size, residual }).is_some();
        Judgement { contraction, seen, left, tolerance: self.tolerance }
    }
}

impl Judgement {
    pub fn converged(&self) -> bool {
        self.contraction < 1.0 && self.left <= self.tolerance
    }

    /// Where iteration no longer brings the error down, only rounding may be left.
    pub fn stalled(&self) -> bool {
        self.contraction > 0.5
    }

    /// Iterations to go at this rate.
    pub fn remaining(&self) -> f64 {
        if self.contraction < 1.0 { (self.tolerance / self.left).ln() / self.contraction.ln() } else { f64::INFINITY }
    }
}
