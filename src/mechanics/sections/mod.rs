//! Cross sections: shape → areas and moments → stiffnesses and inertias per length.
//!
//! A shape lies in the y-z plane of the beam, width along y and height along z. Every constructor returns the section about its centroid,
//! or a message with the deck's keys.
//!
//! A shape is one file and one entry of [`SECTIONS`].

pub mod c;
pub mod circle;
pub mod dimensions;
pub mod fibres;
pub mod general;
pub mod hollow_box;
pub mod i;
pub mod l;
mod matrices;
pub mod polygons;
mod profile;
pub mod rectangle;
pub mod rounded;
pub mod section;
pub mod section_shape;
pub mod section_triangle;
pub mod stresses;
pub mod tube;
mod wall;

pub use fibres::{Fibre, balance, flattened};
pub use matrices::from_matrices;
pub use section::{Section, Stiffness};
pub use section_shape::{CrossSection, SectionKind, SectionShape};
pub use stresses::{BeamStresses, SectionOutline, SectionStresses};

/// All shapes of sections, in the order of the reference.
pub static SECTIONS: &[&SectionKind] = &[
    &rectangle::KIND,
    &circle::KIND,
    &tube::KIND,
    &hollow_box::KIND,
    &i::KIND,
    &c::KIND,
    &l::KIND,
    &polygons::KIND,
    &general::KIND,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::c::C;
    use crate::sections::general::general;
    use crate::sections::hollow_box::HollowBox;
    use crate::sections::i::I;
    use crate::sections::l::L;
    use crate::sections::rectangle::rectangle;
    use crate::sections::tube::tube;
    use base::math::Mat6;
    use rand::{RngExt, SeedableRng, rngs::SmallRng};

    pub fn close(value: f64, expected: f64, relative: f64) {
        assert!((value - expected).abs() <= relative * expected.abs(), "{value} for {expected}");
    }

    pub fn angle(height: f64, width: f64, vertical: f64, horizontal: f64) -> Result<Section, String> {
        L { height, width, vertical, horizontal }.section(0.0)
    }

    pub fn channel(height: f64, width: f64, web: f64, flange: f64) -> Result<Section, String> {
        C { height, width, web, flange }.section(0.0)
    }

    pub fn hollow_box(width: f64, height: f64, web: f64, flange: f64) -> Result<Section, String> {
        HollowBox { width, height, web, flange }.section(0.0)
    }

    pub fn i_section(height: f64, widths: [f64; 2], web: f64, flanges: [f64; 2]) -> Result<Section, String> {
        let ([top_width, bottom_width], [top_flange, bottom_flange]) = (widths, flanges);
        I { height, top_width, bottom_width, web, top_flange, bottom_flange }.section(0.0)
    }

    /// Scenes C1 and C2 list their constants with seven digits.
    #[test]
    fn constants_of_the_scenes() {
        let digits = 5e-7;
        let factor = [5.0 / 6.0; 2];
        let c1 = rectangle(0.03, 0.005, 0.3).unwrap().with_shear_factor(factor).stiffness(210e9, 0.3, 7850.0);
        let c2 = rectangle(0.004, 0.04, 0.33).unwrap().with_shear_factor(factor).stiffness(70e9, 0.33, 2700.0);
        for (s, [EA, GA, GJ, EIy, EIz, A_rho]) in [
            (c1, [3.15e7, 1.009615e7, 90.35639, 65.625, 2362.5, 1.1775]),
            (c2, [1.12e7, 3.508772e6, 21.04084, 1493.333, 14.93333, 0.432]),
        ] {
            close(s.N[(0, 0)], EA, digits);
            close(s.N[(1, 1)], GA, digits);
            close(s.N[(2, 2)], GA, digits);
            close(s.M[(0, 0)], GJ, digits);
            close(s.M[(1, 1)], EIy, digits);
            close(s.M[(2, 2)], EIz, digits);
            close(s.mass_per_length, A_rho, digits);
        }
    }

    fn random_sections() -> Vec<Section> {
        let mut random = SmallRng::seed_from_u64(3);
        let mut sections = Vec::new();
        for _ in 0..100 {
            let mut r = |low: f64, high: f64| random.random_range(low..high);
            let (h, w) = (r(0.05, 0.5), r(0.05, 0.5));
            let (t, u, v) = (r(1e-3, 0.012), r(1e-3, 0.012), r(1e-3, 0.012));
            sections.extend([
                rectangle(w, h, 0.3).unwrap(),
                tube(w, t, 0.3).unwrap(),
                hollow_box(w, h, t, u).unwrap(),
                i_section(h, [w, r(0.05, 0.5)], t, [u, v]).unwrap(),
                channel(h, w, t, u).unwrap(),
                angle(h, w, t, u).unwrap(),
                general(t * u, [t.powi(4), u.powi(4)], 0.9 * (t * u).powi(2), v, [t * t, u * u]).unwrap(),
            ]);
        }
        sections
    }

    #[test]
    fn energy_is_positive_for_any_strain() {
        for section in random_sections() {
            let stiffness = section.stiffness(210e9, 0.3, 7850.0);
            // Cholesky alone decides; it is applied to K scaled to a unit diagonal, as N and N·m² differ by much.
            let K = stiffness.matrix();
            let scale = K.diagonal().map(|d| 1.0 / d.sqrt());
            let scaled = Mat6::from_fn(|i, j| K[(i, j)] * scale[i] * scale[j]);
            assert!(scaled.cholesky().is_some(), "{section:?}");
            assert!(stiffness.inertia_per_length.cholesky().is_some(), "{section:?}");
        }
    }

    /// The energy of any strain is that of its parts: axial, shear at the shear centre, torsion, and bending by fibres.
    #[test]
    fn stiffness_is_the_hessian_of_the_energy() {
        let mut random = SmallRng::seed_from_u64(4);
        for section in random_sections() {
            let strain = nalgebra::Vector6::from_fn(|_, _| random.random_range(-1.0..1.0));
            let (gamma, kappa) = (base::math::linear(&strain), base::math::angular(&strain));
            let [ys, zs] = section.shear_center;
            let shear = gamma + kappa.cross(&base::math::Vec3::new(0.0, ys, zs));
            let (E, G) = (2.6, 1.0); // ν = 0.3
            let [y, z, yz] = section.shear;
            let energy = 0.5 * E * section.area * gamma.x * gamma.x
                + 0.5 * G * (y * shear.y * shear.y + z * shear.z * shear.z + 2.0 * yz * shear.y * shear.z)
                + 0.5 * G * section.torsion * kappa.x * kappa.x
                + 0.5 * E * (section.Iy * kappa.y * kappa.y + section.Iz * kappa.z * kappa.z)
                - E * section.Iyz * kappa.y * kappa.z;
            let K = section.stiffness(E, 0.3, 1.0).matrix();
            close(0.5 * strain.dot(&(K * strain)), energy, 1e-13);
        }
    }

    /// A force through the shear centre bends without twist: the strain of (Q_y, Q_z, T = y_s Q_z − z_s Q_y) has κ₁ = 0.
    #[test]
    fn force_at_the_shear_center_does_not_twist() {
        for section in random_sections() {
            let K = section.stiffness(2.6, 0.3, 1.0).matrix();
            let [ys, zs] = section.shear_center;
            let (Qy, Qz) = (0.7, -1.3);
            let force = nalgebra::Vector6::new(0.0, Qy, Qz, ys * Qz - zs * Qy, 0.0, 0.0);
            let scale = K.diagonal().map(|d| 1.0 / d.sqrt());
            let scaled = Mat6::from_fn(|i, j| K[(i, j)] * scale[i] * scale[j]);
            let strain = scaled.cholesky().unwrap().solve(&force.component_mul(&scale));
            assert!(strain[3].abs() < 1e-9 * strain.norm(), "{section:?}: {strain}");
        }
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        assert_eq!(
            general(1.0, [1.0, 1.0], 0.0, 0.0, [1.0; 2]).unwrap_err(),
            "`torsion_constant` is 0, but must be a positive number"
        );
        assert!(general(1.0, [1.0, 4.0], 2.0, 1.0, [1.0; 2]).unwrap_err().contains("geometric mean"));
    }
}
