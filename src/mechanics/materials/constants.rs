//! The elastic constants of an isotropic material.

/// Elastic constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticConstants {
    /// Young's modulus.
    pub E: f64,
    /// E/(2 (1 + ν)).
    pub G: f64,
    /// E/(1 − ν): equal stresses per equal strains in two directions.
    pub biaxial: f64,
}

impl ElasticConstants {
    /// The constants of a material with E and ν.
    pub fn new(E: f64, nu: f64) -> ElasticConstants {
        ElasticConstants { E, G: 0.5 * E / (1.0 + nu), biaxial: E / (1.0 - nu) }
    }
}
