//! Cross sections: shape → areas and moments → stiffnesses and inertias per length.

use crate::math::Mat3;

/// What a beam feels of its section, in section axes (x along the beam) about the centroid.
/// (N, Q_y, Q_z) = N·Γ + NM·κ, (T, M_y, M_z) = NMᵀ·Γ + M·κ.
#[derive(Debug, Clone, PartialEq)]
pub struct Stiffness {
    pub N: Mat3,
    pub M: Mat3,
    /// Nonzero where the shear centre is off the centroid.
    pub NM: Mat3,
    pub mass_per_length: f64,
    /// Rotary inertia per length, about the centroid.
    pub inertia_per_length: Mat3,
}

/// stub
#[derive(Debug)]
pub struct Section;

#[allow(clippy::too_many_arguments)]
impl Section {
    fn wall(ok: bool) -> Result<Section, String> {
        if ok { Ok(Section) } else { Err("the walls are thicker than the section".to_owned()) }
    }
    pub fn rectangle(_width: f64, _height: f64) -> Result<Section, String> {
        Ok(Section)
    }
    pub fn tube(radius: f64, thickness: f64) -> Result<Section, String> {
        Self::wall(thickness <= radius)
    }
    pub fn box_(width: f64, height: f64, y: f64, z: f64) -> Result<Section, String> {
        Self::wall(2.0 * y < width && 2.0 * z < height)
    }
    pub fn i(_height: f64, _top: f64, _bottom: f64, _web: f64, _upper: f64, _lower: f64) -> Result<Section, String> {
        Ok(Section)
    }
    pub fn c(_height: f64, _width: f64, _web: f64, _flange: f64) -> Result<Section, String> {
        Ok(Section)
    }
    pub fn l(_height: f64, _width: f64, _vertical: f64, _horizontal: f64) -> Result<Section, String> {
        Ok(Section)
    }
    pub fn general(_: f64, _: [f64; 2], _: f64, _: f64, _: [f64; 2]) -> Result<Section, String> {
        Ok(Section)
    }
    pub fn stiffness(&self, _e: f64, _nu: f64, density: f64) -> Stiffness {
        Stiffness::general(1.0, [1.0; 2], 1.0, [1.0; 2], density, [0.0; 3])
    }
}

impl Stiffness {
    pub fn general(a: f64, s: [f64; 2], t: f64, b: [f64; 2], mass: f64, j: [f64; 3]) -> Self {
        Stiffness {
            N: Mat3::from_diagonal(&[a, s[0], s[1]].into()),
            M: Mat3::from_diagonal(&[t, b[0], b[1]].into()),
            NM: Mat3::zeros(),
            mass_per_length: mass,
            inertia_per_length: Mat3::from_diagonal(&j.into()),
        }
    }
}
