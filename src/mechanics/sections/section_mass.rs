//! The mass per length of a general section: by numbers about the axis, or by a symmetric matrix of six rows.
//!
//! A lamina of mass μ with its centre at c = (0, c_y, c_z) and the inertia J about it resists the acceleration a and the angular acceleration α of
//! the axis by f = μ (a + α × c) and m = c × f + J α. Its matrix is [μ 1, −μ c~; μ c~, J − μ c~ c~].

use super::section::Stiffness;
use base::math::{Mat3, Mat6, Vec3, skew};
use base::names::short;
use base::words::kinds::Given;

/// Largest difference of two entries of a matrix that are meant to be equal, over the geometric mean of their diagonals: tables have four digits.
const SAME: f64 = 1e-4;

/// The mass per length of a section.
pub(super) struct Masses {
    mass: f64,
    /// Centre of mass (y, z).
    center: [f64; 2],
    /// Inertia about it.
    inertia: Mat3,
}

impl Masses {
    /// Reads `mass`, or `mass_per_length` and `inertia_per_length`; they may be left out where nothing needs them.
    pub fn read(given: &mut Given, needs_mass: bool) -> Option<Masses> {
        if given.has("mass") {
            for key in
                ["mass_per_length", "inertia_per_length"].into_iter().filter(|key| given.has(key)).collect::<Vec<_>>()
            {
                given.error_with::<()>(
                    key,
                    format!("`{key}` does not apply beside `mass`"),
                    "remove it, or the matrix",
                );
            }
            return Masses::of_matrix(given);
        }
        if needs_mass {
            given.require("mass_per_length");
            given.require("inertia_per_length");
        }
        let mass = given.not_negative("mass_per_length", 0.0);
        let inertia = given.vector("inertia_per_length").unwrap_or_default();
        if inertia.iter().any(|&j| j < 0.0) {
            return given.error("inertia_per_length", "`inertia_per_length` must not be negative");
        }
        Some(Masses { mass, center: [0.0; 2], inertia: Mat3::from_diagonal(&inertia) })
    }

    /// Reads the matrix and finds the lamina that has it.
    fn of_matrix(given: &mut Given) -> Option<Masses> {
        let M = symmetric(given, "mass")?;
        let mass = M[(0, 0)];
        if mass <= 0.0 {
            let hint = "it is the mass per length; for a beam without mass write `mass = \"none\"` in its table";
            return given.error_with("mass", format!("`mass` has {} in row 1, column 1", short(mass)), hint);
        }
        let center = Vec3::new(0.0, M[(2, 3)] / mass, M[(0, 4)] / mass);
        let of_lamina = matrix(mass, &center, &M.fixed_view::<3, 3>(3, 3).into_owned());
        let size = |i: usize, j: usize| (M[(i, i)] * M[(j, j)]).abs().sqrt();
        let differs = |&(i, j): &(usize, usize)| (M[(i, j)] - of_lamina[(i, j)]).abs() > SAME * size(i, j);
        if let Some((i, j)) = (0..3).flat_map(|i| (i..6).map(move |j| (i, j))).find(differs) {
            let message = format!(
                "`mass` is not that of a section: row {} has {} in column {}, and {} would belong to the mass {} with its centre at y = {}, z = {}",
                i + 1,
                short(M[(i, j)]),
                j + 1,
                short(of_lamina[(i, j)] + 0.0),
                short(mass),
                short(center.y),
                short(center.z + 0.0),
            );
            let hint = "rows are m [1, 0, 0, 0, z, -y], m [0, 1, 0, -z, 0, 0], m [0, 0, 1, y, 0, 0], then the moments about x, y, z";
            return given.error_with("mass", message, hint);
        }
        let about_axis = M.fixed_view::<3, 3>(3, 3).into_owned();
        let is_centred = center == Vec3::zeros();
        let arm = skew(&center);
        let inertia = if is_centred { about_axis } else { about_axis + mass * arm * arm };
        let least = inertia.symmetric_eigenvalues().min();
        // Where tables round, a slender section may have slightly less than none about an axis.
        if least < -SAME * about_axis.trace() {
            let message = format!(
                "`mass` is not positive: with its centre at y = {}, z = {} the moment of inertia {} about it remains",
                short(center.y),
                short(center.z),
                short(least)
            );
            return given.error_with("mass", message, "moments in the last three rows are about the axis of the beam");
        }
        Some(Masses { mass, center: [center.y, center.z], inertia })
    }

    /// The section with this mass.
    pub fn of(self, section: Stiffness) -> Stiffness {
        let Masses { mass, center, inertia } = self;
        Stiffness { mass_per_length: mass, mass_center: center, inertia_per_length: inertia, ..section }
    }
}

/// The matrix of a mass with its centre at `c` and the inertia `about_axis` about the axis.
fn matrix(mass: f64, c: &Vec3, about_axis: &Mat3) -> Mat6 {
    let mut M = Mat6::identity() * mass;
    let s = mass * skew(c);
    M.fixed_view_mut::<3, 3>(0, 3).copy_from(&-s);
    M.fixed_view_mut::<3, 3>(3, 0).copy_from(&s);
    M.fixed_view_mut::<3, 3>(3, 3).copy_from(about_axis);
    M
}

/// Reads a matrix of six rows that must be symmetric; returns its symmetric part.
pub(super) fn symmetric(given: &mut Given, key: &str) -> Option<Mat6> {
    let rows = Mat6::from_row_slice(given.numbers(key));
    let size = |i: usize, j: usize| (rows[(i, i)] * rows[(j, j)]).abs().sqrt();
    let differs = |&(i, j): &(usize, usize)| (rows[(i, j)] - rows[(j, i)]).abs() > SAME * size(i, j);
    if let Some((i, j)) = (0..6).flat_map(|i| (0..i).map(move |j| (i, j))).find(differs) {
        let message = format!(
            "`{key}` is not symmetric: row {} has {} in column {}, and row {} has {} in column {}",
            i + 1,
            short(rows[(i, j)]),
            j + 1,
            j + 1,
            short(rows[(j, i)]),
            i + 1
        );
        return given.error_with(key, message, "give both the same value");
    }
    Some(0.5 * (rows + rows.transpose()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The energy of a lamina that moves is that of its centre and of its turning about it.
    #[test]
    fn the_matrix_has_the_energy_of_a_lamina() {
        let (mass, c, J) = (2.0, Vec3::new(0.0, 0.3, -0.2), Mat3::new(0.9, 0.0, 0.0, 0.0, 0.5, 0.1, 0.0, 0.1, 0.4));
        let arm = skew(&c);
        let M = matrix(mass, &c, &(J - mass * arm * arm));
        let (v, omega) = (Vec3::new(0.4, -1.0, 2.0), Vec3::new(0.7, 0.2, -0.5));
        let motion = base::math::stack(&v, &omega);
        let expected = mass * (v + omega.cross(&c)).norm_squared() + omega.dot(&(J * omega));
        assert!((motion.dot(&(M * motion)) - expected).abs() < 1e-14 * expected);
    }
}
