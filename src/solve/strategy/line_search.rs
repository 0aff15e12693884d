//! Line search: shortens a correction that went too far. If material begins or ceases to yield, the tangent of one side is wrong on the
//! other, and Newton's method may alternate forever. The work of the residual along the correction shows this. Matthies & Strang, Int. J.
//! Numer. Meth. Eng. 14 (1979), 1613-1626: a correction is shortened if more than four fifths of |s| remain after it.

use crate::tolerances::line_search::{LEFT, SECANT, TRIES};
use base::math::Vec6;
use base::snapshot::keep;
use mechanics::state::Increment;

/// The last correction of a step. It is allocated once.
pub struct LineSearch {
    /// Residual before the correction, then the correction, by nodal unknown. Multipliers do no work as long as joints
    /// are closed, and are left out.
    residual: Vec<f64>,
    correction: Vec<f64>,
    /// Gaps of the joints before the correction.
    gaps: Vec<f64>,
    /// Increments before the correction, by node.
    before: Vec<Vec6>,
    multipliers: Vec<f64>,
    /// Work of the residual before the correction along it.
    at_start: f64,
    /// The current part of the correction. The work changes its sign between `low` and `high`; each holds a part and its work.
    part: f64,
    low: [f64; 2],
    high: Option<[f64; 2]>,
    /// True where `low` moves up: with contacts.
    encloses: bool,
    tries: usize,
    /// Relative residual before the correction.
    size: f64,
}

keep!(LineSearch { residual, correction, gaps, before, multipliers, at_start, part, low, high, tries, size } without { encloses });

impl LineSearch {
    /// Room for corrections of this many nodal unknowns, nodes and multipliers. Where contacts may close, the search encloses the zero of the work.
    pub fn new([directions, nodes, multipliers]: [usize; 3], encloses: bool) -> Self {
        LineSearch {
            residual: vec![0.0; directions],
            correction: vec![0.0; directions],
            gaps: vec![0.0; multipliers],
            before: vec![Vec6::zeros(); nodes],
            multipliers: vec![0.0; multipliers],
            at_start: 0.0,
            part: 1.0,
            low: [0.0; 2],
            high: None,
            encloses,
            tries: TRIES,
            size: f64::INFINITY,
        }
    }

    /// Forgets the correction.
    pub fn forget(&mut self) {
        self.tries = TRIES;
    }

    /// Keeps the residual and the gaps of joints before the system is solved; `size` is the relative size of the residual.
    #[inline(never)]
    pub fn keep_residual(&mut self, residual: &[f64], gaps: &[f64], size: f64) {
        self.residual.copy_from_slice(residual);
        self.gaps.copy_from_slice(gaps);
        self.size = size;
    }

    /// Keeps a correction that is about to be added to the increments.
    #[inline(never)]
    pub fn keep_correction(&mut self, correction: &[f64], increments: &[Increment], multipliers: &[f64]) {
        self.correction.copy_from_slice(correction);
        self.before.iter_mut().zip(increments).for_each(|(before, increment)| *before = increment.q);
        self.multipliers.copy_from_slice(multipliers);
        self.at_start = dot(&self.residual, correction);
        (self.part, self.low, self.high) = (1.0, [0.0, self.at_start], None);
        self.tries = 0;
    }

    /// Shortens the correction where the `residual` after it does too much work along it. Returns whether it did.
    #[inline(never)]
    pub fn shorten(
        &mut self,
        residual: &[f64],
        size: f64,
        increments: &mut [Increment],
        multipliers: &mut [f64],
    ) -> bool {
        // A correction stands if it was no descent direction or reduced the residual.
        if self.tries >= TRIES || self.at_start <= 0.0 || size <= self.size {
            return false;
        }
        let work = dot(residual, &self.correction);
        if work.abs() <= LEFT * self.at_start {
            return false;
        }
        // Open joints do work as they close, for example if a drive lifts a weight. The work of the residual then does not show the right
        // length.
        if self.at_start <= self.work_of_joints(multipliers) {
            return false;
        }
        let factor = self.next_factor(work);
        self.part *= factor;
        for (increment, before) in increments.iter_mut().zip(&self.before) {
            increment.q = before + factor * (increment.q - before);
        }
        for (value, before) in multipliers.iter_mut().zip(&self.multipliers) {
            *value = before + factor * (*value - before);
        }
        self.tries += 1;
        true
    }

    /// The factor on the current part of the correction, which has this work. Contacts that close or stick become a thousand times stiffer within
    /// a short way, and the secant falls short of the zero. The bracket then moves up. Without contacts, halving the part needs fewer iterations.
    fn next_factor(&mut self, work: f64) -> f64 {
        match (work < 0.0, self.high) {
            (true, _) => self.high = Some([self.part, work]),
            (false, Some(_)) if self.encloses && work.is_finite() => self.low = [self.part, work],
            // The work grew.
            (false, _) => return 0.5,
        }
        let ([low, left], [high, beyond]) = (self.low, self.high.unwrap_or([self.part, work]));
        low / self.part + (left / (left - beyond)).clamp(SECANT[0], SECANT[1]) * ((high - low) / self.part)
    }

    /// The largest work that joints can have done as the correction closed them, with multipliers before it or `after`.
    fn work_of_joints(&self, after: &[f64]) -> f64 {
        let forces = self.multipliers.iter().zip(after).map(|(before, after)| before.abs().max(after.abs()));
        self.gaps.iter().zip(forces).map(|(gap, force)| gap.abs() * force).sum()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
