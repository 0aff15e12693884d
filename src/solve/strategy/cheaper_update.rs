//! The cheaper update of the matrix: a reused matrix, or a fresh one in every iteration. Both are compared by their costs, which are counts,
//! never times, over the lengths of their steps. The reused matrix leads until a step costs more than two iterations with a fresh matrix
//! each, the least that a nonlinear step needs. Then the cheaper update leads, and the other is tried again ever more rarely.

use crate::tolerances::cheaper_update::{FIRST, LEAST, MOST, TRIAL};
use base::snapshot::keep;

/// The comparison of both updates during a run.
#[derive(Debug, Clone)]
pub struct CheaperUpdate {
    /// Cost of a fresh matrix in iterations.
    matrix: f64,
    /// True if every iteration gets a fresh matrix.
    fresh: bool,
    /// Cost of the steps of the current turn, failed attempts included, in iterations; their number and their lengths.
    cost: f64,
    steps: usize,
    length: f64,
    /// Cost of the leading update over the length of its steps, during a trial of the other one.
    leader: Option<f64>,
    /// Number of steps until the leading update is next compared.
    turn: usize,
}

keep!(CheaperUpdate { fresh, cost, steps, length, leader, turn } without { matrix });

impl CheaperUpdate {
    /// A comparison that begins with a reused matrix; `matrix` is the cost of a fresh one in iterations.
    pub fn new(matrix: f64) -> CheaperUpdate {
        CheaperUpdate { matrix, fresh: false, cost: 0.0, steps: 0, length: 0.0, leader: None, turn: FIRST }
    }

    /// True if every iteration gets a fresh matrix.
    pub fn is_fresh(&self) -> bool {
        self.fresh
    }

    /// The same comparison with a reused matrix.
    pub fn reused(&self) -> CheaperUpdate {
        CheaperUpdate { fresh: false, ..self.clone() }
    }

    /// Counts an iteration.
    pub fn count_iteration(&mut self) {
        self.cost += 1.0;
    }

    /// Counts a matrix.
    pub fn count_matrix(&mut self) {
        self.cost += self.matrix;
    }

    /// Counts an accepted step of this length, and decides on the update of the next one.
    pub fn accepted(&mut self, length: f64) {
        self.steps += 1;
        self.length += length;
        let turn = if self.leader.is_some() { TRIAL } else { self.turn };
        if self.steps < turn {
            return;
        }
        let per_step = self.cost / self.steps as f64;
        let cost = self.cost / self.length;
        (self.cost, self.steps, self.length) = (0.0, 0, 0.0);
        match self.leader.take() {
            Some(leader) if cost < leader => self.turn = FIRST,
            Some(_) => (self.fresh, self.turn) = (!self.fresh, (2 * self.turn).min(MOST)),
            None if self.fresh || per_step > LEAST * (1.0 + self.matrix) => {
                (self.fresh, self.leader) = (!self.fresh, Some(cost));
            }
            None => {}
        }
    }
}
