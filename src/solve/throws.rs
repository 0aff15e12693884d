//! Detects steps that do not resolve a contact: they throw off a resting body faster than it approached. Nothing dissipates this energy, so
//! the body keeps bouncing, and slides although friction should hold it.

use super::context::Context;
use super::friction_warnings::ContactThrows;
use super::warning::Warning;
use crate::system::{FrictionPlace, law_of};
use crate::tolerances::throws::{BRIEF, FASTER, PERIODS, STEPS};
use base::snapshot::keep;
use mechanics::elements::slip::Slip;
use std::f64::consts::PI;

/// A contact with friction, all of it together.
#[derive(Default)]
pub struct Throw {
    /// The number of its group.
    pub group: usize,
    /// The speed of approach that the weight alone gives, and the longest period of the springs.
    floor: f64,
    period: f64,
    /// Steps and time since anything touches, and the speed with which it met.
    steps: usize,
    closed: f64,
    met: f64,
    /// True after a throw, until it rests again.
    thrown: bool,
    /// The largest speed of a throw, and the way slid while nothing touches.
    parted: f64,
    pub slid: f64,
    /// Data of the current step: whether any point touches, the largest approach and separation velocities, and the slide while apart.
    step: (bool, [f64; 3]),
}

keep!(Throw: Default { group, floor, period, steps, closed, met, thrown, parted, slid, step });

impl Throw {
    /// One for each contact whose points or pairs of solids rub.
    pub fn of_contacts(cx: &Context, rubbing: &[FrictionPlace]) -> Vec<Throw> {
        let mut groups: Vec<usize> = rubbing.iter().map(|of| of.group).collect();
        groups.dedup();
        let of = |group: usize| {
            let (_, law) = law_of(cx.model, &cx.system.groups[group])?;
            let (floor, period) = (law.floor, law.duration);
            period.is_finite().then(|| Throw { group, floor, period, ..Throw::default() })
        };
        groups.into_iter().filter_map(of).collect()
    }

    /// Records one of its springs in a step; `touched` is its state at the start.
    pub fn meet(&mut self, slip: &Slip, touched: bool) {
        let (touches, [met, parts, apart]) = &mut self.step;
        let [before, after] = slip.approach;
        *touches |= slip.touches;
        match slip.touches {
            true => *met = met.max(before),
            false if touched => *parts = parts.max(-after),
            false => {}
        }
        *apart = apart.max(slip.apart);
    }

    /// Records all of its springs, after a step of length `dt`.
    pub fn end_step(&mut self, dt: f64) {
        let (touches, [met, parts, apart]) = std::mem::take(&mut self.step);
        if touches {
            if self.steps == 0 {
                self.met = met.max(self.floor);
            }
            (self.steps, self.closed) = (self.steps + 1, self.closed + dt);
            self.thrown &= self.closed <= (PERIODS * self.period).max(STEPS * dt);
            return;
        }
        if (1..=BRIEF).contains(&self.steps) && parts > FASTER * self.met {
            (self.thrown, self.parted) = (true, self.parted.max(parts));
        }
        (self.steps, self.closed) = (0, 0.0);
        if self.thrown {
            self.slid += apart;
        }
    }

    /// The warning, where steps of the deck are longer than the contact allows.
    pub fn warning(&self, cx: &Context) -> Option<Warning> {
        let (name, law) = law_of(cx.model, &cx.system.groups[self.group])?;
        let step = cx.model.analysis.nominal_step();
        // Steps of two thirds of half a period return the energy of the impact.
        let enough = self.period / PI;
        let throws = ContactThrows {
            name: name.to_owned(),
            speed: self.parted,
            slid: self.slid,
            stiffness: [law.stiffness, law.stiffness * (enough / step).powi(2)],
            step: [step, enough],
        };
        (enough < step).then_some(Warning::ContactThrows(throws))
    }
}
