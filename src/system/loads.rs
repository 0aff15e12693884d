//! The loads that act at one instant.

use crate::math::{Mat3, Vec3, skew};
use crate::model;
use crate::snapshot::keep;
use crate::state::Node;

/// Values of the loads at the instant where equilibrium is written. [`super::Excitation`] writes them.
#[derive(Debug, Clone, Default)]
pub struct Loading {
    /// Factor of each nodal load, in the order of the model's list.
    pub factors: Vec<f64>,
    /// Pressure of each follower pressure times its factor, in the order of the model's list.
    pub pressures: Vec<f64>,
    /// Gravity less the acceleration of the base, global components: every mass m feels the force m × field.
    pub field: Vec3,
}

keep!(Loading: Default { factors, pressures, field });

impl Loading {
    /// These loads and a multiple of others.
    pub fn plus(&self, factor: f64, others: &Loading) -> Loading {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + factor * b).collect();
        Loading {
            factors: sum(&self.factors, &others.factors),
            pressures: sum(&self.pressures, &others.pressures),
            field: self.field + factor * others.field,
        }
    }
}

/// Force and moment of a load on its node, global components; those of a follower load rotate with the node.
#[inline]
pub(super) fn load_on(load: &model::Load, factor: f64, node: &Node) -> (Vec3, Vec3) {
    let (f, m) = (factor * load.force, factor * load.moment);
    if load.follower {
        let R = node.R();
        (R * f, R * m)
    } else {
        (f, m)
    }
}

/// Load stiffness −∂(f, m)/∂θ of a follower load, as the skew matrices of its force and its moment.
pub(super) fn follower_stiffness(load: &model::Load, factor: f64, node: &Node) -> [Mat3; 2] {
    let (f, m) = load_on(load, factor, node);
    [skew(&f), skew(&m)]
}
