//! Joints at the end of a step and at the start of a run. Where a scheme writes equilibrium past the end of the step, the end
//! itself lies off the joints by its error; there position, velocity and acceleration are put back, one after the other, by the
//! least change in the norm of the matrix at hand (E. Eich, SIAM J. Numer. Anal. 30 (1993)): joints do not drift, and the
//! accelerations of one step bring no oscillation into the next.

use super::failure::{self, Failure};
use super::step::Stepper;
use crate::integrators::Coefficients;
use crate::math::rotation::inverse_tangent;
use crate::math::{Vec3, bottom};
use crate::state::{Node, State};
use crate::system::assembly::NONE;

/// Corrections of a position before the step is given up. The matrix is that of another instant, but near it.
const MOST: usize = 12;

/// Gaps, relative to positions, that rounding may leave.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl Stepper<'_> {
    /// Puts the trial motion, at the end of a step from `state`, onto the joints; the increments lead there.
    ///
    /// # Errors
    /// [`Failure::Apart`] where the joints cannot be closed from there.
    pub(super) fn close_joints(&mut self, state: &State, scheme: &Coefficients, dt: f64) -> Result<(), Failure> {
        let mut last = f64::INFINITY;
        for _ in 0..MOST {
            let gap = self.gap(0);
            // At rounding, or no longer falling next to it.
            if gap <= ROUNDING || (gap >= 0.5 * last && gap <= 1e3 * ROUNDING) {
                self.violation = self.violation.max(gap);
                // Rates only depend on what stands: one correction is exact but for the age of the matrix.
                for derivative in [1, 2] {
                    let mut last = f64::INFINITY;
                    for _ in 0..MOST {
                        let gap = self.gap(derivative);
                        if gap * dt.powi(derivative as i32) <= ROUNDING || gap >= 0.1 * last {
                            break;
                        }
                        last = gap;
                        self.close_gap(state, scheme, derivative);
                    }
                }
                return Ok(());
            }
            if gap.is_nan() {
                break;
            }
            last = gap;
            self.close_gap(state, scheme, 0);
        }
        let largest = failure::gaps(self.model, self.system, &self.forces.multipliers.gaps);
        self.refresh.rejected();
        Err(Failure::Apart { largest })
    }

    /// The largest gap of the trial motion, or of its derivative, relative.
    fn gap(&mut self, derivative: usize) -> f64 {
        let gaps = &mut self.forces.multipliers.gaps;
        self.system.gaps(&self.trial, derivative, gaps);
        self.system.largest_gap(gaps, self.reach)
    }

    /// One correction of the motion, its velocity or its acceleration.
    fn close_gap(&mut self, state: &State, scheme: &Coefficients, derivative: usize) {
        self.solve_for_gaps();
        for &node in &self.movers {
            let rows = &self.plan.rows[node];
            let theta = bottom(&self.increments[node].q);
            let entry = |i: usize| if rows[i] == NONE { 0.0 } else { self.r[rows[i] as usize] };
            let turn = inverse_tangent(&theta, &Vec3::new(entry(3), entry(4), entry(5)));
            let increment = &mut self.increments[node];
            let change = match derivative {
                0 => &mut increment.q,
                1 => &mut increment.d,
                _ => &mut increment.dd,
            };
            for i in 0..3 {
                change[i] += entry(i);
                if rows[3 + i] != NONE {
                    change[3 + i] += turn[i];
                }
            }
            self.trial[node].advance(&state.nodes[node], &self.increments[node], scheme.rotation);
        }
        for rider in &self.system.attachments {
            rider.follow(&mut self.trial, &mut self.increments, &state.nodes[rider.node]);
        }
    }

    /// The least motion that closes the gaps at hand, into `r`.
    pub(super) fn solve_for_gaps(&mut self) {
        let directions = self.plan.directions.len();
        self.r[..directions].fill(0.0);
        self.forces.multipliers.ask(&mut self.r[directions..]);
        self.solver.solve(&mut self.r);
        self.solves += 1;
    }

    /// At the start, with a factorised mass matrix: velocities that the joints allow, the nearest in kinetic energy.
    pub(super) fn start_on_joints(&mut self, nodes: &mut [Node]) {
        let mut fastest = [0.0f64; 2];
        for node in nodes.iter() {
            fastest = [fastest[0].max(node.v.amax()), fastest[1].max(node.omega.amax())];
        }
        // Rows that share what they carry leave a part of it to the next time: three leave nothing.
        for _ in 0..3 {
            self.system.gaps(nodes, 1, &mut self.forces.multipliers.gaps);
            if self.forces.multipliers.gaps.iter().all(|&gap| gap == 0.0) {
                break;
            }
            self.solve_for_gaps();
            for (node, rows) in nodes.iter_mut().zip(&self.plan.rows) {
                let entry = |i: usize| if rows[i] == NONE { 0.0 } else { self.r[rows[i] as usize] };
                let change = [Vec3::new(entry(0), entry(1), entry(2)), Vec3::new(entry(3), entry(4), entry(5))];
                node.v += change[0];
                node.omega += change[1];
                self.start_jump = [0, 1].map(|i| self.start_jump[i].max(change[i].amax()));
            }
            self.ride(nodes);
        }
        for (jump, fastest) in self.start_jump.iter_mut().zip(fastest) {
            *jump /= fastest.max(f64::MIN_POSITIVE);
        }
    }
}
