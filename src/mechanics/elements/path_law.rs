//! Forces over a coordinate that depend on its past: for links along a line and for coordinates of joints.

use super::bouc_wen::{self, BoucWen, BoucWenState};
use super::deteriorating::{self, Deteriorating, DeterioratingState};
use super::hysteresis::Hysteresis;
use super::isotropic::{self, Isotropic};
use super::pinching::{self, Pinching, PinchingState};
use super::slider::CoordinateState;

/// The force over a coordinate and its past.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathLaw {
    /// Springs that slip side by side: straight lines, unloading by twice the backbone.
    Backbone(Hysteresis),
    /// Straight lines with a yield force that grows in both senses.
    Isotropic(Isotropic),
    /// Bouc and Wen.
    BoucWen(BoucWen),
    /// Ibarra, Medina and Krawinkler.
    Deteriorating(Deteriorating),
    /// Reloading towards the largest coordinate so far, with pinching.
    Pinching(Pinching),
}

impl PathLaw {
    /// Force per coordinate before anything yields.
    pub fn stiffness(&self) -> f64 {
        match self {
            PathLaw::Backbone(backbone) => backbone.stiffness(),
            PathLaw::Isotropic(law) => law.stiffness,
            PathLaw::BoucWen(law) => law.stiffness,
            PathLaw::Deteriorating(law) => law.stiffness,
            PathLaw::Pinching(law) => law.stiffness(),
        }
    }

    /// The number of history variables.
    pub fn memory(&self) -> usize {
        match self {
            PathLaw::Backbone(backbone) => backbone.memory(),
            PathLaw::Isotropic(_) => isotropic::MEMORY,
            PathLaw::BoucWen(_) => bouc_wen::MEMORY,
            PathLaw::Deteriorating(_) => deteriorating::MEMORY,
            PathLaw::Pinching(_) => pinching::MEMORY,
        }
    }

    /// Adds force, slope and recoverable energy at the coordinate of `state`.
    pub fn add(&self, memory: &[f64], state: &mut CoordinateState) {
        let [force, slope, energy] = match self {
            PathLaw::Backbone(backbone) => return backbone.add(memory, state),
            PathLaw::Isotropic(law) => return law.add(memory, state),
            PathLaw::BoucWen(law) => {
                let from = BoucWenState::of(memory);
                let [force, slope] = law.force(&from, state.q);
                [force, slope, law.energy(&law.moved(&from, state.q))]
            }
            PathLaw::Deteriorating(law) => {
                let (at, slope) = law.moved(&DeterioratingState::of(memory), state.q);
                [at.force, slope, law.energy(&at)]
            }
            PathLaw::Pinching(law) => {
                let (at, slope) = law.moved(&PinchingState::of(memory), state.q);
                [at.force, slope, law.energy(&at)]
            }
        };
        state.effort += force;
        state.by_q += slope;
        state.energy += energy;
    }

    /// Moves the memory `part` of the way to the coordinate `q`, and returns the dissipation.
    pub fn follow(&self, q: f64, part: f64, memory: &mut [f64]) -> f64 {
        let towards = |x: f64| x + part * (q - x);
        let memory = &mut memory[..self.memory()];
        match self {
            PathLaw::Backbone(backbone) => backbone.follow(q, part, memory),
            PathLaw::Isotropic(law) => law.follow(q, part, memory),
            PathLaw::BoucWen(law) => {
                let from = BoucWenState::of(memory);
                let to = law.moved(&from, towards(from.x));
                memory.copy_from_slice(&[to.x, to.z, to.area]);
                law.dissipated(&from, &to)
            }
            PathLaw::Deteriorating(law) => {
                let from = DeterioratingState::of(memory);
                let to = law.moved(&from, towards(from.x)).0;
                memory.copy_from_slice(&to.memory());
                law.dissipated(&from, &to)
            }
            PathLaw::Pinching(law) => {
                let from = PinchingState::of(memory);
                let to = law.moved(&from, towards(from.x)).0;
                memory.copy_from_slice(&to.memory());
                law.dissipated(&from, &to)
            }
        }
    }
}
