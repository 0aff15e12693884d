//! Takes back part of a correction that went too far. Where material begins or ceases to yield the tangent of one side leads
//! too far on the other, and Newton's method may go to and fro for ever; along a correction the work of the residual tells.
//! Matthies & Strang, Int. J. Numer. Meth. Eng. 14 (1979), 1613-1626: |s| may shrink by a fifth, or the step shrinks.

use crate::math::Vec6;
use crate::state::Increment;

/// Of the work of the residual before the correction: what may be left after it.
const LEFT: f64 = 0.8;
/// Times a correction is shortened.
const TRIES: usize = 5;

/// The last correction of a step. Allocated once.
pub struct LineSearch {
    /// Residual before it, then the correction, per direction. Multipliers do no work as long as joints hold, and are left out.
    residual: Vec<f64>,
    correction: Vec<f64>,
    /// Increments before it, per node.
    before: Vec<Vec6>,
    multipliers: Vec<f64>,
    /// Work of the residual before it along it.
    at_start: f64,
    tries: usize,
    /// Relative residual before it.
    size: f64,
}

impl LineSearch {
    pub fn new(directions: usize, nodes: usize, multipliers: usize) -> Self {
        LineSearch {
            residual: vec![0.0; directions],
            correction: vec![0.0; directions],
            before: vec![Vec6::zeros(); nodes],
            multipliers: vec![0.0; multipliers],
            at_start: 0.0,
            tries: TRIES,
            size: f64::INFINITY,
        }
    }

    /// There is no correction yet.
    pub fn forget(&mut self) {
        self.tries = TRIES;
    }

    /// Before a system is solved for `residual`, whose relative size is `size`.
    #[inline(never)]
    pub fn keep_residual(&mut self, residual: &[f64], size: f64) {
        self.residual.copy_from_slice(residual);
        self.size = size;
    }

    /// Before `correction` is added to the increments.
    #[inline(never)]
    pub fn keep_correction(&mut self, correction: &[f64], increments: &[Increment], multipliers: &[f64]) {
        self.correction.copy_from_slice(correction);
        self.before.iter_mut().zip(increments).for_each(|(before, increment)| *before = increment.q);
        self.multipliers.copy_from_slice(multipliers);
        self.at_start = dot(&self.residual, correction);
        self.tries = 0;
    }

    /// With the residual after the correction: shortens it where that pulls back as hard as it pulled forth before. Returns
    /// whether it did.
    #[inline(never)]
    pub fn shorten(
        &mut self,
        residual: &[f64],
        size: f64,
        increments: &mut [Increment],
        multipliers: &mut [f64],
    ) -> bool {
        // A correction that was no step downhill, or one that did its work.
        if self.tries >= TRIES || self.at_start <= 0.0 || size <= self.size {
            return false;
        }
        let work = dot(residual, &self.correction);
        if work.abs() <= LEFT * self.at_start {
            return false;
        }
        // Where the work vanishes on the line from the start; halfway where it grew.
        let zero = self.at_start / (self.at_start - work);
        let factor = if work < 0.0 { zero.clamp(0.1, 0.9) } else { 0.5 };
        for (increment, before) in increments.iter_mut().zip(&self.before) {
            increment.q = before + factor * (increment.q - before);
        }
        for (value, before) in multipliers.iter_mut().zip(&self.multipliers) {
            *value = before + factor * (*value - before);
        }
        self.tries += 1;
        true
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
