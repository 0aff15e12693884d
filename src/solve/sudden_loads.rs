//! Sudden loads of a static analysis, at t = 0 or at a jump of their amplitude, are ramped over the following step. At its end they have
//! the values of the deck. If the step is cut back, they grow from substep to substep, and their work is the work of growing forces.

use super::context::Context;
use crate::system::{Loading, Side};
use base::snapshot::keep;

/// The step over which sudden loads are ramped.
#[derive(Debug, Clone, Default)]
pub struct SuddenLoads {
    from: f64,
    to: f64,
    /// The jump of the loads at its start.
    jump: Loading,
}

keep!(SuddenLoads: Default { from, to, jump });

impl SuddenLoads {
    /// The ramp up to `to`, from t = 0, where no load acts before, or from a jump.
    pub fn over(cx: &Context, from: f64, to: f64) -> SuddenLoads {
        let (mut before, mut jump) = (Loading::default(), Loading::default());
        cx.excitation.loading(from, Side::After, &mut jump);
        if from > 0.0 {
            cx.excitation.loading(from, Side::Before, &mut before);
            add(&mut jump, -1.0, &before);
        }
        SuddenLoads::new(from, to, jump)
    }

    /// The ramp of a jump of the loads between two times.
    pub fn new(from: f64, to: f64, jump: Loading) -> SuddenLoads {
        SuddenLoads { from, to, jump }
    }

    /// Copies the loads of another step of the same model without allocating.
    pub fn copy_from(&mut self, other: &SuddenLoads) {
        let SuddenLoads { from, to, jump } = other;
        (self.from, self.to, self.jump.field) = (*from, *to, jump.field);
        self.jump.factors.clone_from(&jump.factors);
        self.jump.pressures.clone_from(&jump.pressures);
        self.jump.squares.clone_from(&jump.squares);
    }

    /// Subtracts the part of the jump that does not act yet at a time of the step. At the end of the step the loads keep every bit.
    pub fn bring_on(&self, time: f64, loads: &mut Loading) {
        if time < self.to {
            add(loads, -(self.to - time) / (self.to - self.from), &self.jump);
        }
    }
}

/// y ← y + s x.
fn add(y: &mut Loading, s: f64, x: &Loading) {
    let add = |y: &mut [f64], x: &[f64]| y.iter_mut().zip(x).for_each(|(y, x)| *y += s * x);
    add(&mut y.factors, &x.factors);
    add(&mut y.pressures, &x.pressures);
    add(&mut y.squares, &x.squares);
    y.field += s * x.field;
}
