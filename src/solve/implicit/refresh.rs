//! When the matrix is formed and factorised anew.

use super::convergence::Judgement;
use crate::elements::Moduli;
use crate::model::{Method, Update};

/// Decides from counts and contraction alone, never from the clock, so that the same deck takes the same path.
#[derive(Debug, Clone)]
pub struct Refresh {
    method: Method,
    update: Update,
    /// Iterations that a fresh matrix costs.
    cost: f64,
    /// Step length of the matrix in hand; `None`: there is none, or it has proved useless.
    dt: Option<f64>,
    wanted: bool,
    /// Iterations of the step for which the matrix was formed, and those spent beyond that number since.
    baseline: Option<usize>,
    excess: usize,
    /// Steps still to start with a fresh matrix, and how many to ask for next time an old one misleads.
    eager: usize,
    patience: usize,
    /// The step in hand gets a fresh matrix in every iteration: anything less has failed.
    insisting: bool,
}

/// What to do after a correction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Advice {
    GoOn,
    /// An old matrix has led astray: back to the prediction, with a fresh one.
    Restart,
}

impl Refresh {
    pub fn new(method: Method, update: Update, linear: bool, cost: f64) -> Self {
        let update = if linear { Update::Never } else { update };
        Refresh {
            method,
            update,
            cost,
            dt: None,
            wanted: false,
            baseline: None,
            excess: 0,
            eager: 0,
            patience: 1,
            insisting: false,
        }
    }

    /// What the matrix is to be formed with.
    pub fn moduli(&self) -> Moduli {
        match self.method {
            Method::InitialLoad if !self.insisting => Moduli::Elastic,
            _ => Moduli::Algorithmic,
        }
    }

    /// Asked before each solve of a step of length `dt`; `iteration` counts from 0.
    pub fn due(&self, iteration: usize, dt: f64) -> bool {
        // Steps of one length differ by the rounding of their ends.
        if self.wanted || self.insisting || self.dt.is_none_or(|of| (of - dt).abs() > 1e-9 * dt) {
            return true;
        }
        match self.update {
            Update::Iteration => true,
            Update::Step => iteration == 0,
            Update::Auto => iteration == 0 && self.eager > 0,
            Update::Never => false,
        }
    }

    pub fn done(&mut self, dt: f64) {
        self.dt = Some(dt);
        self.baseline = None;
        self.excess = 0;
        self.wanted = false;
    }

    /// After a correction that was judged against another of the same step. `fresh`: the matrix was formed in this step.
    pub fn watch(&mut self, fresh: bool, judgement: &Judgement) -> Advice {
        let contraction = judgement.contraction;
        // An elastic matrix contracts slowly where material yields, and a new one no faster.
        let patient = self.update == Update::Never || self.method == Method::InitialLoad;
        if patient && (contraction < 1.0 || fresh) {
            return Advice::GoOn;
        }
        if !fresh && contraction > 0.5 && !self.insisting {
            self.wanted = true;
            self.eager = self.patience;
            self.patience = (2 * self.patience).min(64);
            return Advice::Restart;
        }
        self.wanted = contraction > 0.9 || (self.update == Update::Auto && judgement.remaining() > 1.0 + self.cost);
        Advice::GoOn
    }

    /// After an accepted step. A matrix is worth renewing once the iterations it has cost beyond those of a fresh one
    /// would have paid for it.
    pub fn accepted(&mut self, iterations: usize) {
        self.insisting = false;
        let baseline = *self.baseline.get_or_insert(iterations);
        self.excess += iterations.saturating_sub(baseline);
        self.wanted = self.update == Update::Auto && self.excess as f64 >= self.cost;
        if self.eager > 0 {
            self.eager -= 1;
        } else {
            self.patience = 1.max(self.patience / 2);
        }
    }

    /// After a step that was given up: the matrix belongs to a motion that was not taken.
    pub fn rejected(&mut self) {
        self.dt = None;
        self.insisting = false;
    }

    /// After a step that did not converge: whether it is to be tried with a fresh matrix in every iteration, which it has
    /// not been so far.
    pub fn insist(&mut self) -> bool {
        let more = !self.insisting && matches!(self.update, Update::Auto | Update::Step);
        self.insisting |= more;
        more
    }
}
