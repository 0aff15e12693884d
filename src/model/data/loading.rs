//! Loads, ground motion and damping.

use crate::amplitude::Amplitude;
use crate::elements::pressure::Face;
use crate::math::Vec3;

/// What acts on the nodes from outside.
#[derive(Debug, Clone)]
pub struct Loading {
    /// Functions of time, which loads and prescribed motions name by index.
    pub amplitudes: Vec<Amplitude>,
    pub nodal: Vec<Load>,
    pub pressures: Vec<Pressure>,
    pub gravity: Vec3,
    pub base_accelerations: Vec<BaseAcceleration>,
}

impl Default for Loading {
    fn default() -> Self {
        Loading {
            amplitudes: Vec::new(),
            nodal: Vec::new(),
            pressures: Vec::new(),
            gravity: Vec3::zeros(),
            base_accelerations: Vec::new(),
        }
    }
}

/// Force and moment on a node, global components at t = 0.
#[derive(Debug, Clone)]
pub struct Load {
    pub node: usize,
    pub force: Vec3,
    pub moment: Vec3,
    /// Turns with its node.
    pub follower: bool,
    pub amplitude: Option<usize>,
}

/// Pressure on faces as they are at the moment, against their normals.
#[derive(Debug, Clone)]
pub struct Pressure {
    pub faces: Vec<Face>,
    pub pressure: f64,
    pub amplitude: Option<usize>,
}

/// Acceleration of the ground, felt by every mass as −M a; displacements are then relative to the ground.
#[derive(Debug, Clone)]
pub struct BaseAcceleration {
    pub direction: Vec3,
    pub amplitude: usize,
}

/// Viscous damping beside that of links.
#[derive(Debug, Clone, Default)]
pub struct Damping {
    /// Rayleigh: C = mass_factor M + stiffness_factor K. The stiffness part acts on strain rates of beams and bars.
    pub mass_factor: f64,
    pub stiffness_factor: f64,
    pub nodal: Vec<NodalDamping>,
}

/// Viscous damping of a node against the ground.
#[derive(Debug, Clone)]
pub struct NodalDamping {
    pub node: usize,
    /// Force per velocity, moment per angular velocity.
    pub translation: f64,
    pub rotation: f64,
}
