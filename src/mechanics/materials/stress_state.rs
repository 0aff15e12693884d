//! Stress states: which components a point has, the others being zero stress.
//!
//! Each state has modes: combinations of components with diagonal elastic stiffness, σᵢ = eᵢ εᵢ, and equivalent stress ρ² = Σ pᵢ ξᵢ². Per
//! unit of the multiplier the plastic strain grows by pᵢ ξᵢ/ρ and the equivalent stress drops by cᵢ = eᵢ pᵢ: 3G in every mode but the
//! first.

use super::constants::ElasticConstants;
use base::math::number::Number;

/// N components of stress, and strains work-conjugate to them (shear strains are engineering strains).
pub trait StressState<const N: usize>: Copy + Send + Sync {
    /// p of each mode.
    const P: [f64; N];

    /// e of each mode.
    fn moduli(elastic: &ElasticConstants) -> [f64; N];

    /// Mean stress σ_m: a third of the sum of the normal stresses.
    fn mean(stress: &[f64; N]) -> f64;

    /// Components to modes and modes to components, of stress or strain: orthogonal and its own inverse.
    #[inline(always)]
    fn modes<T: Number>(v: [T; N]) -> [T; N] {
        v
    }
}

/// A bar, or a fibre of a beam without shear: σ.
#[derive(Debug, Clone, Copy)]
pub struct Uniaxial;

/// A fibre of a beam: (σ, τ_y, τ_z), with (ε, γ_y, γ_z).
#[derive(Debug, Clone, Copy)]
pub struct FibreStress;

/// A layer of a shell: (σ_x, σ_y, τ_xy), with (ε_x, ε_y, γ_xy). Modes: sum and difference of the normal stresses, shear.
#[derive(Debug, Clone, Copy)]
pub struct PlaneStress;

impl StressState<1> for Uniaxial {
    const P: [f64; 1] = [1.0];

    #[inline(always)]
    fn moduli(elastic: &ElasticConstants) -> [f64; 1] {
        [elastic.E]
    }

    #[inline(always)]
    fn mean(stress: &[f64; 1]) -> f64 {
        stress[0] / 3.0
    }
}

impl StressState<3> for FibreStress {
    const P: [f64; 3] = [1.0, 3.0, 3.0];

    #[inline(always)]
    fn moduli(elastic: &ElasticConstants) -> [f64; 3] {
        [elastic.E, elastic.G, elastic.G]
    }

    #[inline(always)]
    fn mean(stress: &[f64; 3]) -> f64 {
        stress[0] / 3.0
    }
}

impl StressState<3> for PlaneStress {
    const P: [f64; 3] = [0.5, 1.5, 3.0];

    #[inline(always)]
    fn moduli(elastic: &ElasticConstants) -> [f64; 3] {
        [elastic.biaxial, 2.0 * elastic.G, elastic.G]
    }

    #[inline(always)]
    fn mean(stress: &[f64; 3]) -> f64 {
        (stress[0] + stress[1]) / 3.0
    }

    #[inline(always)]
    fn modes<T: Number>([x, y, xy]: [T; 3]) -> [T; 3] {
        let R = T::splat(std::f64::consts::FRAC_1_SQRT_2);
        [R * (x + y), R * (x - y), xy]
    }
}
