//! Load cases of a linear analysis, and envelopes over them.

use super::stage::Actors;
use mechanics::materials::MaterialLaw;

/// A load case, or a combination of several: named loads with their factors.
#[derive(Debug, Clone, Default)]
pub struct LoadCase {
    /// The deck's name.
    pub name: String,
    /// What acts, and with which factor.
    pub terms: Vec<CaseTerm>,
}

/// A share of a load case.
#[derive(Debug, Clone)]
pub struct CaseTerm {
    /// The loads and motions of one name.
    pub acts: CaseActor,
    /// Their factor.
    pub factor: f64,
}

/// What a load case names.
#[derive(Debug, Clone)]
pub enum CaseActor {
    /// Loads, or motions of a support.
    Named(Actors),
    /// The weight.
    Gravity,
}

/// The extremes of results over some cases.
#[derive(Debug, Clone)]
pub struct Envelope {
    /// The deck's name.
    pub name: String,
    /// The cases, by their places among those of the model.
    pub cases: Vec<usize>,
}

/// What a linear analysis is solved for. Without cases it is solved at each time step.
#[derive(Debug, Clone, Default)]
pub struct LoadCases {
    /// Load cases, then combinations.
    pub list: Vec<LoadCase>,
    /// Envelopes over them.
    pub envelopes: Vec<Envelope>,
    /// The yield stresses of parts that stay elastic.
    pub yield_limits: Vec<YieldLimit>,
}

/// The yield stress of a part that stays elastic in a linear analysis.
#[derive(Debug, Clone)]
pub struct YieldLimit {
    /// The part, by its index in [`super::Model::parts`].
    pub part: usize,
    /// Initial yield stress.
    pub stress: f64,
    /// Young's modulus.
    pub modulus: f64,
    /// Area of a bar; 0 for other parts.
    pub area: f64,
    /// The fibres of a beam in its section axes y and z; none for other parts.
    pub fibres: Vec<[f64; 2]>,
    /// The sections of the elements of a beam, by their indices in [`super::Model::stiffnesses`]; none for other parts.
    pub sections: Vec<usize>,
}

impl YieldLimit {
    /// The limit of a material, in the first part.
    pub fn of(law: &MaterialLaw) -> YieldLimit {
        let (stress, modulus) = (law.initial_yield(), law.elastic().E);
        YieldLimit { part: 0, stress, modulus, area: 0.0, fibres: Vec::new(), sections: Vec::new() }
    }
}
