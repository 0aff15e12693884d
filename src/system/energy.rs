//! Energies and momenta of a state.

use crate::math::Vec3;

/// The columns of energy.csv.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    pub kinetic: f64,
    /// Elastic energy of beams and bars.
    pub strain: f64,
    /// Dissipated so far by plastic flow.
    pub plastic: f64,
    /// Dissipated so far by viscous flow.
    pub viscous: f64,
    /// Dissipated so far by dampers, nodal and Rayleigh damping.
    pub damping: f64,
    /// Stored in links.
    pub links: f64,
    /// Work of loads, gravity and prescribed motion so far.
    pub external: f64,
    /// What the time integration has taken: initial energy + external − dissipated − stored.
    pub numerical: f64,
    /// kinetic + strain + links.
    pub total: f64,
    /// Linear momentum.
    pub p: Vec3,
    /// Angular momentum about the origin.
    pub l: Vec3,
}
