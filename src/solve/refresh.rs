//! When the matrix is formed and factorised anew.

use crate::model::Update;

/// Decides from counts and contraction alone, never from the clock, so that the same deck takes the same path.
#[derive(Debug, Clone)]
pub struct Refresh {
    update: Update,
    /// Iterations that a fresh matrix costs.
    cost: f64,
    /// Step length of the matrix in hand; `None`: there is none, or it has proved useless.
    dt: Option<f64>,
    /// Iterations of the first step that used the matrix.
    baseline: Option<usize>,
    wanted: bool,
}

impl Refresh {
    pub fn new(update: Update, linear: bool, cost: f64) -> Self {
        let update = if linear { Update::Never } else { update };
        Refresh { update, cost, dt: None, baseline: None, wanted: false }
    }

    /// Asked before each solve of a step of length `dt`.
    pub fn due(&self, iteration: usize, dt: f64) -> bool {
        if self.dt != Some(dt) || self.wanted {
            return true;
        }
        match self.update {
            Update::Iteration => true,
            Update::Step => iteration == 0,
            Update::Auto | Update::Never => false,
        }
    }

    pub fn done(&mut self, dt: f64) {
        self.dt = Some(dt);
        self.baseline = None;
        self.wanted = false;
    }

    /// After a correction that changed the last one's size by `contraction`, with `remaining` iterations to go at that rate.
    pub fn watch(&mut self, contraction: f64, remaining: f64) {
        // A diverging iteration needs the true tangent whatever the deck says about saving it.
        let slow = contraction > 0.9 || (self.update == Update::Auto && remaining > 1.0 + self.cost);
        self.wanted = slow && self.update != Update::Never || contraction > 2.0;
    }

    /// After an accepted step.
    pub fn accepted(&mut self, iterations: usize) {
        let baseline = *self.baseline.get_or_insert(iterations);
        // One more iteration in each coming step soon costs more than the matrix.
        self.wanted = self.update == Update::Auto && iterations > baseline + 1;
    }

    /// After a step that was given up: the matrix belongs to a motion that was not taken.
    pub fn rejected(&mut self) {
        self.dt = None;
    }
}
