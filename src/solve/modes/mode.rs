//! Data of a mode.

use super::speed_modes::{CriticalSpeed, SpeedModes, Whirl};
use super::steady::Response;
use base::math::Vec6;
use linear::eigen::Complex;
use std::f64::consts::TAU;

/// The kinds of modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ModeKind {
    /// Natural modes.
    #[default]
    Natural,
    /// Modes of buckling.
    Buckling,
}

/// The modes about a state, the lowest first.
#[derive(Debug, Clone, Default)]
pub struct Modes {
    /// Natural modes or those of buckling.
    pub kind: ModeKind,
    /// The modes.
    pub list: Vec<EigenMode>,
    /// Mass and moments of inertia that a rigid motion along each axis, and a turn about each through the centre of mass, sets in
    /// motion.
    pub masses: [f64; 6],
    /// Modes that grow: the state is unstable.
    pub unstable: usize,
    /// Factorizations that it took.
    pub factorizations: usize,
    /// Solutions of a linear system that it took.
    pub solves: usize,
    /// Warnings about the modes, in words.
    pub warnings: Vec<String>,
    /// The response that has been found by them, or directly.
    pub response: Option<Response>,
    /// Modes over the speeds of rotation that are asked for.
    pub speeds: Vec<SpeedModes>,
    /// Critical speeds within the range of these, the lowest first.
    pub critical_speeds: Vec<CriticalSpeed>,
}

/// A mode: the motion is the real part of shape × exp(root t), or the shape of buckling at a load factor.
#[derive(Debug, Clone)]
pub struct EigenMode {
    /// The root: growth rate and angular frequency.
    pub root: Complex,
    /// Load factor of buckling; `None` for natural modes.
    pub factor: Option<f64>,
    /// Small motion (u, θ) of each node; its largest displacement is 1.
    pub shape: Vec<Vec6>,
    /// The part of the motion a quarter of a period ahead; empty where all nodes move in phase.
    pub quadrature: Vec<Vec6>,
    /// φᵀ M φ with this shape.
    pub modal_mass: f64,
    /// φᵀ M r over the modal mass, for a unit rigid motion r along each axis and about each through the centre of mass.
    pub participation: [f64; 6],
    /// Parts of the strain energy, in the order of [`model::Model::parts`].
    pub shares: Vec<Share>,
    /// Its orbits; `None` where nothing spins or the mode does not oscillate. Nodes of a reduced part count by equal shares of its mass.
    pub whirl: Option<Whirl>,
    /// Frequency below which rounding hides a motion with stiffness, which is listed as zero; `None` otherwise.
    pub lost: Option<f64>,
}

/// The part of the strain energy of a mode in a part of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// Index into [`model::Model::parts`].
    pub part: usize,
    /// Its share of the strain energy; negative if stress removes more stiffness than the part has.
    pub strain: f64,
}

impl EigenMode {
    /// Angular frequency of the motion, in radians per time.
    pub fn angular_frequency(&self) -> f64 {
        self.root[1].abs()
    }

    /// Frequency of the motion, per time.
    pub fn frequency(&self) -> f64 {
        self.angular_frequency() / TAU
    }

    /// The part of critical damping; `None` where nothing oscillates nor decays.
    pub fn damping_ratio(&self) -> Option<f64> {
        let size = self.root[0].hypot(self.root[1]);
        (size > 0.0).then(|| -self.root[0] / size + 0.0)
    }

    /// Mass, or moment of inertia, that a rigid motion along or about an axis shares with the mode.
    pub fn effective_mass(&self, direction: usize) -> f64 {
        self.participation[direction].powi(2) * self.modal_mass
    }
}
