//! The properties of a cross section, and its stiffness and inertia for beams.

use base::math::{Mat3, Mat6, Vec3, Vec6, skew};
use std::ops::AddAssign;

/// Geometry of a cross section, axes parallel to the section's y and z through the centroid.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Area.
    pub area: f64,
    /// ∫z² dA.
    pub Iy: f64,
    /// ∫y² dA.
    pub Iz: f64,
    /// ∫yz dA.
    pub Iyz: f64,
    /// Saint-Venant torsion constant.
    pub torsion: f64,
    /// Shear areas: yy, zz and the product yz, which couples the two directions as Iyz does.
    pub shear: [f64; 3],
    /// Shear centre (y_s, z_s) from the centroid.
    pub shear_center: [f64; 2],
}

/// (ν/(1 + ν))²: the share of the energy of anticlastic bending in the flexibility in shear, as Saint-Venant's flexure has it.
pub(super) fn saint_venant(nu: f64) -> f64 {
    (nu / (1.0 + nu)).powi(2)
}

impl Section {
    /// The section with other shear areas: those along y and along z over the area. They no longer couple.
    pub fn with_shear_factor(self, [y, z]: [f64; 2]) -> Section {
        Section { shear: [y * self.area, z * self.area, 0.0], ..self }
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
            mass_center: [0.0; 2],
            inertia_per_length: density * Mat3::new(Iy + Iz, 0.0, 0.0, 0.0, Iy, -Iyz, 0.0, -Iyz, Iz),
        }
    }
}

/// The stiffness and mass of a section, in section axes (x along the beam) about the centroid.
#[derive(Debug, Clone, PartialEq)]
pub struct Stiffness {
    /// Stiffness of forces against Γ.
    pub N: Mat3,
    /// Stiffness of moments against κ.
    pub M: Mat3,
    /// Nonzero where the shear centre is off the centroid.
    pub NM: Mat3,
    /// Mass per length.
    pub mass_per_length: f64,
    /// Centre of mass (y, z).
    pub mass_center: [f64; 2],
    /// Rotary inertia per length, about the centre of mass.
    pub inertia_per_length: Mat3,
}

/// The shear stiffness of a beam without shear deformation, relative to that of its section. The remaining shear deflection is below the
/// mesh error; rounding costs at most four digits.
const RIGID_IN_SHEAR: f64 = 1e4;

impl Stiffness {
    /// The stiffness of a section that hardly deforms in shear, about its shear centre.
    pub fn without_shear(&self) -> Stiffness {
        if self.is_coupled() {
            // The flexibility of shear, and what couples with it, is next to nothing.
            let less =
                Mat6::from_diagonal(&Vec6::new(1.0, RIGID_IN_SHEAR, RIGID_IN_SHEAR, 1.0, 1.0, 1.0).map(|by| by.sqrt()));
            return self.with_matrix(&(less * self.matrix() * less));
        }
        let mut out = self.clone();
        let more = RIGID_IN_SHEAR - 1.0;
        let (shear, forces) = (self.N.fixed_view::<2, 2>(1, 1), self.NM.fixed_view::<2, 1>(1, 0));
        out.N.fixed_view_mut::<2, 2>(1, 1).add_assign(shear * more);
        out.NM.fixed_view_mut::<2, 1>(1, 0).add_assign(forces * more);
        // Forces of a unit twist are those of shear at the arm of the shear centre, and turn about it.
        let arm = shear.try_inverse().map(|flexibility| flexibility * forces);
        out.M[(0, 0)] += arm.map_or(0.0, |arm| more * arm.dot(&forces));
        out
    }

    /// The matrix of forces and moments against strains and curvatures.
    pub fn matrix(&self) -> Mat6 {
        let mut K = Mat6::zeros();
        K.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.N);
        K.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.M);
        K.fixed_view_mut::<3, 3>(0, 3).copy_from(&self.NM);
        K.fixed_view_mut::<3, 3>(3, 0).copy_from(&self.NM.transpose());
        K
    }

    /// The torsional stiffness about the shear centre; `None` where the matrix has no inverse.
    pub fn torsion(&self) -> Option<f64> {
        let scale = self.matrix().diagonal().map(|d| d.sqrt().recip());
        let scaled = self.matrix().component_mul(&(scale * scale.transpose()));
        Some(1.0 / (scaled.try_inverse()?[(3, 3)] * scale[3] * scale[3]))
    }

    /// The section with another matrix.
    pub fn with_matrix(&self, K: &Mat6) -> Stiffness {
        let block = |i: usize, j: usize| K.fixed_view::<3, 3>(i, j).into_owned();
        Stiffness { N: block(0, 0), M: block(3, 3), NM: block(0, 3), ..self.clone() }
    }

    /// True where more is coupled than by a shear centre off the centroid and by axes that are not principal.
    pub fn is_coupled(&self) -> bool {
        let axial = (1..3).any(|i| self.N[(0, i)] != 0.0);
        let twist = (1..3).any(|i| self.M[(0, i)] != 0.0);
        let mixed =
            (0..3).any(|i| self.NM[(0, i)] != 0.0 || i > 0 && (self.NM[(1, i)] != 0.0 || self.NM[(2, i)] != 0.0));
        axial || twist || mixed
    }

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
            mass_center: [0.0; 2],
            inertia_per_length: Mat3::from_diagonal(&inertia.into()),
        }
    }

    /// Returns the section about another axis; its own lies at (y, z) from that, with the strain Γ + κ × (0, y, z).
    pub fn beside(&self, [y, z]: [f64; 2]) -> Stiffness {
        let s = skew(&Vec3::new(0.0, y, z));
        let Stiffness { N, M, NM, mass_center: [my, mz], .. } = self;
        Stiffness {
            N: *N,
            NM: NM - N * s,
            M: M + s * NM - NM.transpose() * s - s * N * s,
            mass_center: [my + y, mz + z],
            ..self.clone()
        }
    }

    /// The section that lies at this part of the way to another: matrices of stiffness and mass are linear. A section equal to the other stays.
    pub fn toward(&self, other: &Stiffness, part: f64) -> Stiffness {
        if self == other {
            return self.clone();
        }
        let between = |a: Mat3, b: Mat3| a + part * (b - a);
        let ((first, about_axis), (other_first, other_about)) = (self.moments_of_mass(), other.moments_of_mass());
        let mass_per_length = self.mass_per_length + part * (other.mass_per_length - self.mass_per_length);
        let stiffness = Stiffness {
            N: between(self.N, other.N),
            M: between(self.M, other.M),
            NM: between(self.NM, other.NM),
            ..self.clone()
        };
        stiffness.with_mass(mass_per_length, (first + part * (other_first - first), between(about_axis, other_about)))
    }

    /// The section with more mass per length on its axis, which has no inertia about it.
    pub fn with_mass_on_axis(self, mass_per_length: f64) -> Stiffness {
        if mass_per_length == 0.0 {
            return self;
        }
        let moments = self.moments_of_mass();
        let sum = self.mass_per_length + mass_per_length;
        self.with_mass(sum, moments)
    }

    /// The first and the second moment of the mass per length about the axis.
    fn moments_of_mass(&self) -> (Vec3, Mat3) {
        let [y, z] = self.mass_center;
        let c = Vec3::new(0.0, y, z);
        (self.mass_per_length * c, self.inertia_per_length - self.mass_per_length * skew(&c) * skew(&c))
    }

    /// The section with this mass per length, and these moments about the axis.
    fn with_mass(self, mass_per_length: f64, (first, about_axis): (Vec3, Mat3)) -> Stiffness {
        let c = if mass_per_length > 0.0 { first / mass_per_length } else { Vec3::zeros() };
        let inertia_per_length = about_axis + mass_per_length * skew(&c) * skew(&c);
        Stiffness { mass_per_length, mass_center: [c.y, c.z], inertia_per_length, ..self }
    }

    /// Vector from the axis to the centre of mass, global components, where the columns of `frame` are the section axes; `None` of a centred mass, or of none.
    pub fn mass_arm(&self, frame: &Mat3) -> Option<Vec3> {
        let [y, z] = self.mass_center;
        (self.mass_per_length > 0.0 && self.mass_center != [0.0; 2]).then(|| frame * Vec3::new(0.0, y, z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without shear a section keeps its torsion about the shear centre, which lies off the centroid.
    #[test]
    fn the_shear_centre_stays_where_it_is() {
        let section = Section {
            area: 2.0,
            Iy: 0.3,
            Iz: 0.2,
            Iyz: 0.05,
            torsion: 0.1,
            shear: [1.5, 1.2, 0.1],
            shear_center: [0.4, -0.3],
        };
        let rigid = Section { shear: section.shear.map(|area| RIGID_IN_SHEAR * area), ..section.clone() };
        let (made, exact) = (section.stiffness(2.0, 0.3, 1.0).without_shear(), rigid.stiffness(2.0, 0.3, 1.0));
        // Rounding of sums of four terms.
        for (made, exact) in [(made.N, exact.N), (made.M, exact.M), (made.NM, exact.NM)] {
            assert!((made - exact).norm() < 1e-14 * exact.norm(), "{made} {exact}");
        }
    }
}
