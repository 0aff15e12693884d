//! The loads that act at one instant.

use base::math::{Mat3, Vec3, angular, linear, rotation, skew};
use base::snapshot::keep;
use mechanics::state::Node;
use model::{self, LoadedCoordinate};

/// Values of the loads at the instant where equilibrium is written. [`super::Excitation`] writes them.
#[derive(Debug, Clone, Default)]
pub struct Loading {
    /// Factor of each nodal load, in the order of the model's list.
    pub factors: Vec<f64>,
    /// Pressure of each follower pressure times its factor, in the order of the model's list.
    pub pressures: Vec<f64>,
    /// Square of each angular velocity of a centrifugal load, in the order of the model's list.
    pub squares: Vec<f64>,
    /// Gravity less the acceleration of the base, global components: every mass m feels the force m × field.
    pub field: Vec3,
}

keep!(Loading: Default { factors, pressures, squares, field });

impl Loading {
    /// These loads and a multiple of others.
    pub fn plus(&self, factor: f64, others: &Loading) -> Loading {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + factor * b).collect();
        Loading {
            factors: sum(&self.factors, &others.factors),
            pressures: sum(&self.pressures, &others.pressures),
            squares: sum(&self.squares, &others.squares),
            field: self.field + factor * others.field,
        }
    }
}

/// Force and moment of a load on its node, global components. A follower load rotates with the node, and an effort acts along the
/// coordinate of its joint.
#[inline]
pub(super) fn load_on(load: &model::Load, factor: f64, nodes: &[Node]) -> (Vec3, Vec3) {
    if let Some(LoadedCoordinate { ends: [a, b], end, lock, effort }) = load.coordinate() {
        let G = lock.gradient(&nodes[*a], &nodes[*b])[*end];
        return (factor * effort * linear(&G), factor * effort * angular(&G));
    }
    let (f, m) = (factor * load.force, factor * load.moment);
    if load.follower {
        let R = nodes[load.node].R();
        (R * f, R * m)
    } else {
        (f, m)
    }
}

/// Load stiffness −∂(f, m)/∂θ of a follower load, as the skew matrices of its force and its moment.
pub(super) fn follower_stiffness(load: &model::Load, factor: f64, nodes: &[Node]) -> [Mat3; 2] {
    let (f, m) = load_on(load, factor, nodes);
    [skew(&f), skew(&m)]
}

/// The work of a load by the mean of its values at two configurations, each a factor and the nodes.
pub(super) fn load_work(load: &model::Load, from: (f64, &[Node]), to: (f64, &[Node])) -> f64 {
    if let Some(coordinate) = load.coordinate() {
        return 0.5 * (from.0 + to.0) * coordinate.effort * coordinate.way(from.1, to.1);
    }
    let (a, b) = (&from.1[load.node], &to.1[load.node]);
    let ((f_a, m_a), (f_b, m_b)) = (load_on(load, from.0, from.1), load_on(load, to.0, to.1));
    let work = 0.5 * (f_a + f_b).dot(&b.relative_position(a));
    match load.moment == Vec3::zeros() {
        true => work,
        false => work + 0.5 * (m_a + m_b).dot(&rotation::log(&(b.rotation * a.rotation.conjugate()))),
    }
}
