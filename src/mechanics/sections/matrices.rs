//! Stiffness and mass per length of a section by symmetric matrices of six rows; the mass also by numbers about the axis.
//!
//! A lamina has the mass μ, its centre at c = (0, c_y, c_z), and the inertia J about it. The acceleration a and the angular acceleration α of the
//! axis cause the force f = μ (a + α × c) and the moment m = c × f + J α. The matrix is [μ 1, −μ c~; μ c~, J − μ c~ c~].

use super::section::Stiffness;
use base::math::{Mat3, Mat6, Vec3, skew};
use base::names::short;
use base::words::kinds::Given;

/// Largest difference of two entries of a matrix that are meant to be equal, over the geometric mean of their diagonals: tables have four digits.
const SAME: f64 = 1e-4;

/// Largest negative moment of inertia that counts as rounding, over the sum of those about the axis.
const ROUNDING: f64 = 1e-9;

/// Why a matrix is refused, and what to do.
pub(super) type Refusal = [String; 2];

/// The mass per length of a section.
pub(super) struct LaminaMass {
    mass: f64,
    /// Centre of mass (y, z).
    center: [f64; 2],
    /// Inertia about it.
    inertia: Mat3,
}

impl LaminaMass {
    /// Reads `mass`, or `mass_per_length` and `inertia_per_length`; they may be left out where nothing needs them.
    pub fn read(given: &mut Given, needs_mass: bool) -> Option<LaminaMass> {
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
            return LaminaMass::of_matrix(given);
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
        Some(LaminaMass { mass, center: [0.0; 2], inertia: Mat3::from_diagonal(&inertia) })
    }

    /// Reads the matrix.
    fn of_matrix(given: &mut Given) -> Option<LaminaMass> {
        let rows = Mat6::from_row_slice(given.numbers("mass"));
        match LaminaMass::of_lamina(&rows) {
            Ok(masses) => Some(masses),
            Err([message, hint]) => given.error_with("mass", message, hint),
        }
    }

    /// Finds the lamina that has a matrix.
    pub fn of_lamina(rows: &Mat6) -> Result<LaminaMass, Refusal> {
        let M = symmetric("mass", rows)?;
        let mass = M[(0, 0)];
        if mass <= 0.0 {
            let hint = "it is the mass per length; for a beam without mass write `mass = \"none\"` in its table";
            return Err([format!("`mass` has {} in row 1, column 1", short(mass)), hint.to_owned()]);
        }
        let center = Vec3::new(0.0, M[(2, 3)] / mass, M[(0, 4)] / mass);
        let about_axis = M.fixed_view::<3, 3>(3, 3).into_owned();
        check_first_moments(&M, &matrix(mass, &center, &about_axis), &center)?;
        let arm = skew(&center);
        let inertia = if center == Vec3::zeros() { about_axis } else { about_axis + mass * arm * arm };
        let least = inertia.symmetric_eigenvalues().min();
        if least < -ROUNDING * about_axis.trace() {
            let message = format!(
                "`mass` is not positive: with its centre at y = {}, z = {} the moment of inertia {} about it remains",
                short(center.y),
                short(center.z),
                short(least)
            );
            let hint =
                "rows 4 to 6 of `mass` are moments about the axis: the mass times the square of the distance and more";
            return Err([message, hint.to_owned()]);
        }
        let inertia = if least < 0.0 { not_negative(&inertia) } else { inertia };
        Ok(LaminaMass { mass, center: [center.y, center.z], inertia })
    }

    /// The section with this mass.
    pub fn of(self, section: Stiffness) -> Stiffness {
        let LaminaMass { mass, center, inertia } = self;
        Stiffness { mass_per_length: mass, mass_center: center, inertia_per_length: inertia, ..section }
    }
}

/// The section with a matrix of stiffness, as yet without its mass.
pub(super) fn of_stiffness(rows: &Mat6) -> Result<Stiffness, Refusal> {
    let K = symmetric("stiffness", rows)?;
    if K.cholesky().is_none() {
        let hint = "a section has a positive energy in every strain: look at the order of rows, and at signs";
        return Err(["`stiffness` is not positive definite".to_owned(), hint.to_owned()]);
    }
    Ok(Stiffness::general(1.0, [1.0; 2], 1.0, [1.0; 2], 0.0, [0.0; 3]).with_matrix(&K))
}

/// The section with these matrices of stiffness and mass, by forces along x, y, z and moments about x, y, z.
///
/// # Errors
/// A matrix that is not symmetric or not positive, or a mass that is not that of a section.
pub fn from_matrices(stiffness: &Mat6, mass: &Mat6) -> Result<Stiffness, String> {
    let both = of_stiffness(stiffness).and_then(|section| Ok(LaminaMass::of_lamina(mass)?.of(section)));
    both.map_err(|[message, hint]| format!("{message}; {hint}"))
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

/// A tensor without the negative moments that rounding leaves.
fn not_negative(inertia: &Mat3) -> Mat3 {
    let found = inertia.symmetric_eigen();
    let moments = found.eigenvalues.map(|moment| moment.max(0.0));
    found.eigenvectors * Mat3::from_diagonal(&moments) * found.eigenvectors.transpose()
}

/// Refuses a matrix with another upper half than `of_lamina`.
fn check_first_moments(M: &Mat6, of_lamina: &Mat6, center: &Vec3) -> Result<(), Refusal> {
    let size = |i: usize, j: usize| (M[(i, i)] * M[(j, j)]).abs().sqrt();
    let differs = |&(i, j): &(usize, usize)| (M[(i, j)] - of_lamina[(i, j)]).abs() > SAME * size(i, j);
    let Some((i, j)) = (0..3).flat_map(|i| (i..6).map(move |j| (i, j))).find(differs) else { return Ok(()) };
    let message = format!(
        "`mass` is not that of a section: row {} has {} in column {}, and {} would belong to the mass {} with its centre at y = {}, z = {}",
        i + 1,
        short(M[(i, j)]),
        j + 1,
        short(of_lamina[(i, j)] + 0.0),
        short(M[(0, 0)]),
        short(center.y),
        short(center.z + 0.0),
    );
    let hint =
        "rows are m [1, 0, 0, 0, z, -y], m [0, 1, 0, -z, 0, 0], m [0, 0, 1, y, 0, 0], then the moments about x, y, z";
    Err([message, hint.to_owned()])
}

/// The symmetric part of a matrix that must be symmetric, by the key that gives it.
fn symmetric(key: &str, rows: &Mat6) -> Result<Mat6, Refusal> {
    let size = |i: usize, j: usize| (rows[(i, i)] * rows[(j, j)]).abs().sqrt();
    let differs = |&(i, j): &(usize, usize)| (rows[(i, j)] - rows[(j, i)]).abs() > SAME * size(i, j);
    let Some((i, j)) = (0..6).flat_map(|i| (0..i).map(move |j| (i, j))).find(differs) else {
        return Ok(0.5 * (rows + rows.transpose()));
    };
    let message = format!(
        "`{key}` is not symmetric: row {} has {} in column {}, and row {} has {} in column {}",
        i + 1,
        short(rows[(i, j)]),
        j + 1,
        j + 1,
        short(rows[(j, i)]),
        i + 1
    );
    Err([message, "give both the same value".to_owned()])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The energy of a moving lamina is ½ μ v² of its centre and ½ ω·Jω.
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
