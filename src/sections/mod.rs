//! Cross sections: shape → areas and moments → stiffnesses and inertias per length.
//!
//! A shape lies in the y-z plane of the beam, width along y and height along z. Every constructor answers with the section
//! about its centroid, or with what is wrong in the deck's words.

mod closed;
mod fibres;
mod open;
mod profile;
mod shape;
mod solid;
mod wall;

pub use fibres::{Fibre, flattened};
pub use shape::Shape;

use crate::math::Mat3;

/// Geometry of a cross section, axes parallel to the section's y and z through the centroid.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    pub area: f64,
    /// ∫z² dA.
    pub Iy: f64,
    /// ∫y² dA.
    pub Iz: f64,
    /// ∫yz dA.
    pub Iyz: f64,
    /// Saint-Venant torsion constant.
    pub torsion: f64,
    /// Shear areas: yy, zz and the product yz, which couples the two directions where Iyz does.
    pub shear: [f64; 3],
    /// Shear centre (y_s, z_s) from the centroid.
    pub shear_center: [f64; 2],
}

impl Section {
    /// A section given by its numbers; `moments` = [Iy, Iz]. The shear centre is the centroid.
    ///
    /// Errors: a number that is not positive and finite, or a product of inertia too large for the moments.
    pub fn general(
        area: f64,
        moments: [f64; 2],
        Iyz: f64,
        torsion: f64,
        shear_areas: [f64; 2],
    ) -> Result<Section, String> {
        let [Iy, Iz] = moments;
        let [y, z] = shear_areas;
        positive(&[
            ("area", area),
            ("moments", Iy),
            ("moments", Iz),
            ("torsion_constant", torsion),
            ("shear_areas", y),
            ("shear_areas", z),
        ])?;
        if Iyz.is_nan() || Iyz * Iyz >= Iy * Iz {
            return Err(format!(
                "`product_moment` is {Iyz}, but must be smaller in size than the geometric mean of the moments, {}",
                (Iy * Iz).sqrt()
            ));
        }
        Ok(Section { area, Iy, Iz, Iyz, torsion, shear: [y, z, 0.0], shear_center: [0.0; 2] })
    }

    /// Stiffness and inertia per length of a section of one elastic material.
    ///
    /// The strain at (y, z) is Γ₁ + z κ₂ − y κ₃; shear acts on the strain of the shear centre r_s, Γ + κ×r_s.
    pub fn stiffness(&self, E: f64, nu: f64, density: f64) -> Stiffness {
        let Section { area, Iy, Iz, Iyz, torsion, shear: [y, z, yz], shear_center: [ys, zs] } = *self;
        let G = 0.5 * E / (1.0 + nu);
        // (Γ + κ×r_s)₂ = Γ₂ − z_s κ₁,  (Γ + κ×r_s)₃ = Γ₃ + y_s κ₁: shear forces of a unit twist, and their moment.
        let (Qy, Qz) = (G * (yz * ys - y * zs), G * (z * ys - yz * zs));
        Stiffness {
            N: Mat3::new(E * area, 0.0, 0.0, 0.0, G * y, G * yz, 0.0, G * yz, G * z),
            M: Mat3::new(G * torsion + ys * Qz - zs * Qy, 0.0, 0.0, 0.0, E * Iy, -E * Iyz, 0.0, -E * Iyz, E * Iz),
            NM: Mat3::new(0.0, 0.0, 0.0, Qy, 0.0, 0.0, Qz, 0.0, 0.0),
            mass_per_length: density * area,
            inertia_per_length: density * Mat3::new(Iy + Iz, 0.0, 0.0, 0.0, Iy, -Iyz, 0.0, -Iyz, Iz),
        }
    }
}

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

impl Stiffness {
    /// Stiffnesses and inertias given as such: shear and bending about y and z, inertia about x, y, z.
    pub fn general(
        axial: f64,
        shear: [f64; 2],
        torsion: f64,
        bending: [f64; 2],
        mass_per_length: f64,
        inertia: [f64; 3],
    ) -> Stiffness {
        Stiffness {
            N: Mat3::from_diagonal(&[axial, shear[0], shear[1]].into()),
            M: Mat3::from_diagonal(&[torsion, bending[0], bending[1]].into()),
            NM: Mat3::zeros(),
            mass_per_length,
            inertia_per_length: Mat3::from_diagonal(&inertia.into()),
        }
    }
}

/// Area, centroid, and moments about the centroid of rectangles side by side, each as (y, z) of its centre, width, height.
fn rectangles(parts: &[([f64; 2], f64, f64)]) -> (f64, [f64; 2], [f64; 3]) {
    let area = parts.iter().map(|(_, w, h)| w * h).sum::<f64>();
    let mean = |axis: usize| parts.iter().map(|(c, w, h)| w * h * c[axis]).sum::<f64>() / area;
    let center = [mean(0), mean(1)];
    let mut moments = [0.0; 3];
    for (c, w, h) in parts {
        let (y, z) = (c[0] - center[0], c[1] - center[1]);
        moments[0] += w * h * (z * z + h * h / 12.0);
        moments[1] += w * h * (y * y + w * w / 12.0);
        moments[2] += w * h * y * z;
    }
    (area, center, moments)
}

fn positive(dimensions: &[(&str, f64)]) -> Result<(), String> {
    match dimensions.iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
        Some((key, value)) => Err(format!("`{key}` is {value}, but must be a positive number")),
        None => Ok(()),
    }
}

/// `part` must be smaller than `whole`; `rule` says why.
fn smaller(part: (&str, f64), whole: (&str, f64), rule: &str) -> Result<(), String> {
    if part.1 < whole.1 {
        return Ok(());
    }
    Err(format!("`{}` is {}, but {rule} {} = {}", part.0, part.1, whole.0, whole.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Mat6;
    use rand::{RngExt, SeedableRng, rngs::SmallRng};

    pub fn close(value: f64, expected: f64, relative: f64) {
        assert!((value - expected).abs() <= relative * expected.abs(), "{value} for {expected}");
    }

    fn whole(s: &Stiffness) -> Mat6 {
        let mut K = Mat6::zeros();
        K.fixed_view_mut::<3, 3>(0, 0).copy_from(&s.N);
        K.fixed_view_mut::<3, 3>(3, 3).copy_from(&s.M);
        K.fixed_view_mut::<3, 3>(0, 3).copy_from(&s.NM);
        K.fixed_view_mut::<3, 3>(3, 0).copy_from(&s.NM.transpose());
        K
    }

    /// Scenes C1 and C2 list their constants with seven digits.
    #[test]
    fn constants_of_the_scenes() {
        let digits = 5e-7;
        let c1 = Section::rectangle(0.03, 0.005).unwrap().stiffness(210e9, 0.3, 7850.0);
        let c2 = Section::rectangle(0.004, 0.04).unwrap().stiffness(70e9, 0.33, 2700.0);
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
                Section::rectangle(w, h).unwrap(),
                Section::tube(w, t).unwrap(),
                Section::box_(w, h, t, u).unwrap(),
                Section::i(h, w, r(0.05, 0.5), t, u, v).unwrap(),
                Section::c(h, w, t, u).unwrap(),
                Section::l(h, w, t, u).unwrap(),
                Section::general(t * u, [t.powi(4), u.powi(4)], 0.9 * (t * u).powi(2), v, [t * t, u * u]).unwrap(),
            ]);
        }
        sections
    }

    #[test]
    fn energy_is_positive_for_any_strain() {
        for section in random_sections() {
            let stiffness = section.stiffness(210e9, 0.3, 7850.0);
            // Cholesky alone decides; it is applied to K scaled to a unit diagonal, as N and N·m² differ by much.
            let K = whole(&stiffness);
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
            let (gamma, kappa) = (crate::math::top(&strain), crate::math::bottom(&strain));
            let [ys, zs] = section.shear_center;
            let shear = gamma + kappa.cross(&crate::math::Vec3::new(0.0, ys, zs));
            let (E, G) = (2.6, 1.0); // ν = 0.3
            let [y, z, yz] = section.shear;
            let energy = 0.5 * E * section.area * gamma.x * gamma.x
                + 0.5 * G * (y * shear.y * shear.y + z * shear.z * shear.z + 2.0 * yz * shear.y * shear.z)
                + 0.5 * G * section.torsion * kappa.x * kappa.x
                + 0.5 * E * (section.Iy * kappa.y * kappa.y + section.Iz * kappa.z * kappa.z)
                - E * section.Iyz * kappa.y * kappa.z;
            let K = whole(&section.stiffness(E, 0.3, 1.0));
            close(0.5 * strain.dot(&(K * strain)), energy, 1e-13);
        }
    }

    /// A force through the shear centre bends without twist: the strain of (Q_y, Q_z, T = y_s Q_z − z_s Q_y) has κ₁ = 0.
    #[test]
    fn force_at_the_shear_center_does_not_twist() {
        for section in random_sections() {
            let K = whole(&section.stiffness(2.6, 0.3, 1.0));
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
            Section::general(1.0, [1.0, 1.0], 0.0, 0.0, [1.0; 2]).unwrap_err(),
            "`torsion_constant` is 0, but must be a positive number"
        );
        assert!(Section::general(1.0, [1.0, 4.0], 2.0, 1.0, [1.0; 2]).unwrap_err().contains("geometric mean"));
    }
}
