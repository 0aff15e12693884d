//! Conditions on the matrices of a superelement: a rigid motion has no force, and the mass of a rigid body.

use base::math::{Vec3, skew};
use base::names::short;
use nalgebra::DMatrix;

/// Forces of rigid motions up to this part of the stiffness are rounding of the file, and removed. Files with six digits have 1e-6; a
/// spring to the ground that matters has more.
const ROUNDED: f64 = 1e-4;
/// Forces of rigid motions beyond this part are reported: matrices with all digits have less.
const EXACT: f64 = 1e-8;
/// Differences to symmetry, and to the mass of a rigid body, of files with six digits.
const DIGITS: f64 = 1e-5;

/// The matrices of a superelement in the order of its nodes, six degrees of freedom each, then amplitudes; global components.
pub struct SuperelementMatrices {
    /// Stiffness.
    pub stiffness: DMatrix<f64>,
    /// Mass; `None` for a part without.
    pub mass: Option<DMatrix<f64>>,
    /// Damping; `None` for a part without.
    pub damping: Option<DMatrix<f64>>,
}

/// The fault of a matrix.
pub struct WrongMatrix {
    /// The key of the deck.
    pub key: &'static str,
    /// What is wrong.
    pub message: String,
    /// The remedy.
    pub hint: &'static str,
}

fn wrong<T>(key: &'static str, message: String, hint: &'static str) -> Result<T, WrongMatrix> {
    Err(WrongMatrix { key, message, hint })
}

/// Makes the matrices symmetric and free of rigid motion, and scales amplitudes to the mass of the whole; `x` are the points. Returns them with
/// the mass, and with the removed part of the stiffness if it is beyond rounding.
///
/// # Errors
/// The matrices are not those of a free elastic body.
pub fn settle(
    made: SuperelementMatrices,
    x: &[Vec3],
    turns: bool,
) -> Result<(SuperelementMatrices, f64, Option<f64>), WrongMatrix> {
    let size = made.stiffness.nrows();
    let motions = rigid_motions(x, turns, size);
    let stiffness = symmetric("stiffness", made.stiffness)?;
    let (mut stiffness, left) = without_rigid(&stiffness, &motions);
    if left > ROUNDED {
        let message = format!("its stiffness resists rigid motion with forces of {} of the largest", short(left));
        let hint = "take out the springs to the ground and the supports, and give them in the deck; look at the order of \
                    `nodes`, at `unknowns` and `axes`, and at the places of the points";
        return wrong("stiffness", message, hint);
    }
    positive("stiffness", &stiffness)?;
    let mut damping = match made.damping {
        None => None,
        Some(damping) => {
            let (damping, left) = without_rigid(&symmetric("damping_matrix", damping)?, &motions);
            if left > ROUNDED {
                let message = format!("its damping resists rigid motion with forces of {} of the largest", short(left));
                return wrong("damping_matrix", message, "give dampers to the ground by `[damping]` or `[[links]]`");
            }
            positive("damping_matrix", &damping)?;
            Some(damping)
        }
    };
    let mut total = 0.0;
    let mut mass = match made.mass {
        None => None,
        Some(mass) => {
            let mass = symmetric("mass", mass)?;
            positive("mass", &mass)?;
            total = rigid_mass(&mass, &motions)?;
            Some(mass)
        }
    };
    if let Some(mass) = &mut mass {
        let placed = 6 * x.len();
        let scales: Vec<f64> = (0..size)
            .map(|k| if k < placed || mass[(k, k)] <= 0.0 { 1.0 } else { (total / mass[(k, k)]).sqrt() })
            .collect();
        for matrix in [Some(&mut stiffness), Some(mass), damping.as_mut()].into_iter().flatten() {
            matrix.iter_mut().enumerate().for_each(|(k, entry)| *entry *= scales[k % size] * scales[k / size]);
        }
    }
    Ok((SuperelementMatrices { stiffness, mass, damping }, total, (left > EXACT).then_some(left)))
}

/// The six rigid motions as columns, rotations about the mean of the points and scaled to displacements of their reach.
fn rigid_motions(x: &[Vec3], turns: bool, size: usize) -> DMatrix<f64> {
    let mean = x.iter().sum::<Vec3>() / x.len() as f64;
    let reach = x.iter().map(|x| (x - mean).norm()).fold(0.0, f64::max);
    let turn = if reach > 0.0 { 1.0 / reach } else { 1.0 };
    let mut motions = DMatrix::zeros(size, 6);
    for (i, x) in x.iter().enumerate() {
        let arms = -skew(&(x - mean)) * turn;
        for axis in 0..3 {
            motions[(6 * i + axis, axis)] = 1.0;
            for k in 0..3 {
                motions[(6 * i + k, 3 + axis)] = arms[(k, axis)];
            }
            if turns {
                motions[(6 * i + 3 + axis, 3 + axis)] = turn;
            }
        }
    }
    motions
}

fn symmetric(key: &'static str, matrix: DMatrix<f64>) -> Result<DMatrix<f64>, WrongMatrix> {
    let other = matrix.transpose();
    if (&matrix - &other).amax() > DIGITS * matrix.amax() {
        let message = format!("`{key}` is not symmetric");
        return wrong(key, message, "rotating parts whose matrices are not symmetric are links with `matrices`");
    }
    Ok(0.5 * (matrix + other))
}

/// PᵀAP, where P takes rigid motions out of a motion, and the largest force of a rigid motion relative to the largest of others. Both
/// are measured by the matrix with its diagonal scaled to 1, so that forces and moments compare.
fn without_rigid(A: &DMatrix<f64>, motions: &DMatrix<f64>) -> (DMatrix<f64>, f64) {
    let size = A.nrows();
    let scale: Vec<f64> = (0..size).map(|k| if A[(k, k)] > 0.0 { A[(k, k)].sqrt() } else { 1.0 }).collect();
    let forces = A * motions;
    let mut left: f64 = 0.0;
    for column in 0..6 {
        let largest = (0..size).map(|k| (scale[k] * motions[(k, column)]).abs()).fold(0.0, f64::max);
        let force = (0..size).map(|k| (forces[(k, column)] / scale[k]).abs()).fold(0.0, f64::max);
        left = left.max(if largest > 0.0 { force / largest } else { 0.0 });
    }
    let Some(inverse) = motions.tr_mul(motions).pseudo_inverse(1e-12).ok() else { return (A.clone(), left) };
    let P = DMatrix::identity(size, size) - motions * inverse * motions.transpose();
    (P.tr_mul(A) * P, left)
}

/// Refuses a matrix with negative energy of a deformation.
fn positive(key: &'static str, matrix: &DMatrix<f64>) -> Result<(), WrongMatrix> {
    let size = matrix.nrows();
    let scale = |k: usize| if matrix[(k, k)] > 0.0 { matrix[(k, k)].sqrt() } else { 1.0 };
    let scaled = DMatrix::from_fn(size, size, |i, j| matrix[(i, j)] / (scale(i) * scale(j)));
    if !scaled.iter().all(|entry| entry.is_finite()) {
        return wrong(key, format!("`{key}` has numbers beyond the range"), "look at the units of the file");
    }
    let least = scaled.symmetric_eigenvalues().min();
    if least < -ROUNDED {
        let message = format!("`{key}` is not positive: it has the scaled eigenvalue {}", short(least));
        return wrong(key, message, "look at the order of `nodes` and of `unknowns`, and at the digits of the file");
    }
    Ok(())
}

/// The mass of the whole, where the matrix moves like a rigid body in rigid motion.
fn rigid_mass(mass: &DMatrix<f64>, motions: &DMatrix<f64>) -> Result<f64, WrongMatrix> {
    let rigid = motions.tr_mul(&(mass * motions));
    let total = (rigid[(0, 0)] + rigid[(1, 1)] + rigid[(2, 2)]) / 3.0;
    if total <= 0.0 {
        return wrong(
            "mass",
            "the sum of its masses is not above 0".to_owned(),
            "leave `mass` out for a part without mass",
        );
    }
    let mut off: f64 = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            off = off.max((rigid[(i, j)] - if i == j { total } else { 0.0 }).abs());
            // A rotation about the mean moves the centre across its axis.
            off = off.max((rigid[(i, 3 + j)] + rigid[(j, 3 + i)]).abs());
        }
    }
    if off > DIGITS * total {
        let message = format!(
            "its mass depends on the direction by {} of {}, so that it is not the mass of a body",
            short(off),
            short(total)
        );
        let hint = "look at the order of `nodes`, at `unknowns` and `axes`, and at the places of the points; added mass of a \
                    fluid is not taken";
        return wrong("mass", message, hint);
    }
    Ok(total)
}
