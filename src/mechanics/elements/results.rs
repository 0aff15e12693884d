//! The results of elements for output.

use crate::sections::BeamStresses;
use base::math::Mat3;

/// Results at an integration point of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegrationPoint {
    /// Distance from the element's first node, along the axis at t = 0.
    pub s: f64,
    /// N, V_y, V_z, T, M_y, M_z in section axes.
    pub forces: [f64; 6],
    /// Largest accumulated plastic strain in the section.
    pub plastic_strain: f64,
    /// Extreme stresses of the section's fibres; `None` where it has none.
    pub stresses: Option<BeamStresses>,
}

/// The largest number of points through the thickness of a shell; above ten they are even in number.
pub const MOST_LAYERS: usize = 24;

/// Stress resultants of a shell element: means over its area, per length or area at t = 0, in axes that follow the surface.
/// Moments are positive where the top, the side of the normal, is in tension; ∂M₁₁/∂1 + ∂M₁₂/∂2 = Q₁.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ShellResultants {
    /// Axis 1, axis 2 and the normal in the deformed shell; columns, global components.
    pub frame: Mat3,
    /// N₁₁, N₂₂, N₁₂: force per length.
    pub N: [f64; 3],
    /// M₁₁, M₂₂, M₁₂: moment per length.
    pub M: [f64; 3],
    /// Q₁, Q₂: force per length.
    pub Q: [f64; 2],
    /// See [`ShellResultants::layers`]; the first `count` are in use.
    pub(super) layers: [LayerStress; MOST_LAYERS],
    /// The number of layers in use.
    pub(super) count: usize,
}

impl ShellResultants {
    /// Stress in each layer from the bottom up. None where the material is elastic, until [`ShellResultants::set_elastic_layers`].
    pub fn layers(&self) -> &[LayerStress] {
        &self.layers[..self.count]
    }

    /// Combines each force, moment and stress with that of others of the same layers.
    pub fn combine(&mut self, others: &ShellResultants, of: &mut impl FnMut(&mut f64, f64)) {
        self.N.iter_mut().zip(others.N).for_each(|(own, other)| of(own, other));
        self.M.iter_mut().zip(others.M).for_each(|(own, other)| of(own, other));
        self.Q.iter_mut().zip(others.Q).for_each(|(own, other)| of(own, other));
        for (own, other) in self.layers[..self.count].iter_mut().zip(&others.layers) {
            own.stress.iter_mut().zip(other.stress).for_each(|(own, other)| of(own, other));
        }
    }

    /// Sets the stress at the bottom and at the top of an elastic shell of thickness `h`, linear between them.
    pub fn set_elastic_layers(&mut self, h: f64) {
        let stress = |side: f64| std::array::from_fn(|i| self.N[i] / h + side * 6.0 * self.M[i] / (h * h));
        let layer = |side: f64| LayerStress { z: 0.5 * side * h, stress: stress(side), plastic_strain: 0.0 };
        (self.layers[0], self.layers[1]) = (layer(-1.0), layer(1.0));
        self.count = 2;
    }
}

/// Stress in a shell at a height above its reference surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LayerStress {
    /// Height along the normal at t = 0.
    pub z: f64,
    /// σ₁₁, σ₂₂, σ₁₂: means over the element, in the axes of the resultants.
    pub stress: [f64; 3],
    /// Largest accumulated plastic strain in the layer of the element.
    pub plastic_strain: f64,
}

impl LayerStress {
    /// Von Mises stress, without transverse shear.
    pub fn von_mises(&self) -> f64 {
        let [a, b, ab] = self.stress;
        (a * a + b * b - a * b + 3.0 * ab * ab).sqrt()
    }
}
