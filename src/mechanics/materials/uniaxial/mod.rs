//! Laws of normal stress alone, for fibres of different materials in one section.
//!
//! A law answers from the history of the last accepted state; strain and stress of this state belong to the history.

pub mod concrete;
pub mod menegotto_pinto;
mod work;

use super::{Ask, Dissipation, MaterialLaw, Uniaxial};
use concrete::ConcreteState;
pub use concrete::{Concrete, ConcreteModel, Softening};
pub use menegotto_pinto::MenegottoPinto;
use menegotto_pinto::SteelState;

/// A law of normal stress; `C` is concrete as the deck describes it, or at a point. J2 plasticity serves other stress states too.
#[derive(Debug, Clone, PartialEq)]
pub enum UniaxialLaw<C = ConcreteModel> {
    /// Young's modulus alone.
    Elastic(f64),
    /// J2 plasticity.
    Plastic(MaterialLaw),
    /// Concrete.
    Concrete(C),
    /// Reinforcing steel.
    MenegottoPinto(MenegottoPinto),
}

/// A law at an integration point.
pub type PointLaw = UniaxialLaw<Concrete>;

impl UniaxialLaw {
    /// True for a law that depends on the length of the beam at a point.
    pub fn needs_length(&self) -> bool {
        let UniaxialLaw::Concrete(model) = self else { return false };
        [model.crushing, model.cracking].iter().any(|end| matches!(end, Softening::Energy(_)))
    }

    /// The law at a point that stands for this length of the part.
    pub fn of_length(&self, length: f64) -> PointLaw {
        match self {
            UniaxialLaw::Elastic(modulus) => UniaxialLaw::Elastic(*modulus),
            UniaxialLaw::Plastic(law) => UniaxialLaw::Plastic(law.clone()),
            UniaxialLaw::Concrete(model) => UniaxialLaw::Concrete(model.of_length(length)),
            UniaxialLaw::MenegottoPinto(law) => UniaxialLaw::MenegottoPinto(*law),
        }
    }

    /// Young's modulus.
    pub fn modulus(&self) -> f64 {
        match self {
            UniaxialLaw::Elastic(modulus) => *modulus,
            UniaxialLaw::Plastic(law) => law.elastic().E,
            UniaxialLaw::Concrete(law) => law.modulus,
            UniaxialLaw::MenegottoPinto(law) => law.modulus,
        }
    }
}

impl PointLaw {
    /// The number of history variables of a point; all are zero at the start.
    pub fn variables(&self) -> usize {
        match self {
            UniaxialLaw::Elastic(_) => 0,
            UniaxialLaw::Plastic(law) => law.history(Uniaxial),
            UniaxialLaw::Concrete(_) => concrete::VARIABLES,
            UniaxialLaw::MenegottoPinto(_) => menegotto_pinto::VARIABLES,
        }
    }

    /// Stress and slope at `strain`, a time `dt` after the history `old`.
    #[inline]
    pub fn respond(&self, strain: f64, (dt, old): (f64, &[f64])) -> [f64; 2] {
        match self {
            UniaxialLaw::Elastic(modulus) => [modulus * strain, *modulus],
            UniaxialLaw::Plastic(law) => {
                let answer = law.at_point(Uniaxial, &[strain], (dt, old), Ask::Tangent);
                [answer.stress[0], answer.tangent.map_or(law.elastic().E, |C| C[0][0])]
            }
            UniaxialLaw::Concrete(law) => {
                let (to, slope) = law.moved(&ConcreteState::of(old), strain);
                [to.stress, slope]
            }
            UniaxialLaw::MenegottoPinto(law) => {
                let (to, slope) = law.moved(&SteelState::of(old), strain);
                [to.stress, slope]
            }
        }
    }

    /// Writes the history variables `part` of the way to `strain`, and returns the dissipation per volume on it.
    pub fn advance(&self, strain: f64, (dt, old): (f64, &[f64]), part: f64, new: &mut [f64]) -> Dissipation {
        let towards = |x: f64| if part == 1.0 { strain } else { x + part * (strain - x) };
        let plastic = match self {
            UniaxialLaw::Elastic(_) => 0.0,
            UniaxialLaw::Plastic(law) => {
                let answer = law.at_point(Uniaxial, &[strain], (dt, old), Ask::History(part));
                law.remember(Uniaxial, &answer.new, (old, new), |_| 0);
                return answer.dissipation.map_or_else(Dissipation::default, |spent| spent.lane(0));
            }
            UniaxialLaw::Concrete(law) => {
                let from = ConcreteState::of(old);
                let to = law.moved(&from, towards(from.strain)).0;
                new.copy_from_slice(&to.history());
                law.dissipated(&from, &to)
            }
            UniaxialLaw::MenegottoPinto(law) => {
                let from = SteelState::of(old);
                let to = law.moved(&from, towards(from.strain)).0;
                new.copy_from_slice(&to.history());
                law.dissipated(&from, &to)
            }
        };
        Dissipation { plastic, ..Dissipation::default() }
    }

    /// The energy per volume at `strain` that unloading returns.
    pub fn energy(&self, strain: f64, old: &[f64]) -> f64 {
        match self {
            UniaxialLaw::Elastic(modulus) => 0.5 * modulus * strain * strain,
            UniaxialLaw::Plastic(law) => law.elastic_energy(Uniaxial, &[strain], old),
            UniaxialLaw::Concrete(law) => law.energy(&law.moved(&ConcreteState::of(old), strain).0),
            UniaxialLaw::MenegottoPinto(law) => law.energy(&law.moved(&SteelState::of(old), strain).0),
        }
    }

    /// Accumulated plastic strain; in concrete the plastic strain of crushing.
    pub fn plastic_strain(&self, history: &[f64]) -> f64 {
        match self {
            UniaxialLaw::Elastic(_) => 0.0,
            UniaxialLaw::Plastic(law) => law.accumulated(Uniaxial, history),
            UniaxialLaw::Concrete(law) => law.crushed(&ConcreteState::of(history)),
            UniaxialLaw::MenegottoPinto(_) => SteelState::of(history).accumulated(),
        }
    }
}

#[cfg(test)]
mod tests;
