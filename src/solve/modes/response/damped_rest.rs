//! Motions beside the modes found that dampers of these modes cause.
//!
//! Local dampers push motions that the modes found do not hold; left out, they stiffen too little and damp too little. The static responses
//! PSCφ to the damping forces of the modes join the modes with their stiffness, mass and damping (residual vectors; R. R. Craig & A. J.
//! Kurdila, Fundamentals of Structural Dynamics (2006), chapter 17). Damping in proportion to mass and stiffness causes none.

use super::super::pencil::Pencil;
use super::matrices::Matrices;
use crate::tolerances::damped_rest::{ALIKE, ROUNDS, SMALL};
use linear::Sparse;
use nalgebra::DMatrix;

/// A motion with its stiffness and its mass, which has no part of the modes found.
pub struct RestMotion {
    /// The motion of the unknowns of nodes.
    pub shape: Vec<f64>,
    /// φᵀ K φ.
    pub stiffness: f64,
    /// φᵀ M φ.
    pub mass: f64,
}

/// Residual vectors, uncoupled in stiffness and mass; `remove` projects the modes found out of a motion.
pub fn rest_motions(
    pencil: &mut Pencil,
    matrices: &Matrices,
    pairs: &[(f64, Vec<f64>)],
    remove: impl Fn(&Pencil, &mut Vec<f64>),
) -> Vec<RestMotion> {
    let shift = pencil.shift;
    let shifted = Sparse::sum(&[(1.0, &matrices.K), (-shift, &matrices.M)]);
    let mut found: Vec<Vec<f64>> = Vec::new();
    let mut next: Vec<Vec<f64>> = pairs.iter().map(|(_, phi)| phi.clone()).collect();
    for round in 0..ROUNDS {
        let first = found.len();
        for motion in &next {
            let force = times(&matrices.C, motion);
            let mut answer = force.clone();
            pencil.solve(&mut answer);
            remove(pencil, &mut answer);
            // For a mode of mass 1 this is a part of its stiffness, at its frequency.
            let size = dot(&answer, &times(&shifted, &answer));
            if size > SMALL || round > 0 {
                add(&mut found, answer, size, &shifted);
            }
        }
        if found.len() == first {
            break;
        }
        next = found[first..].to_vec();
    }
    uncoupled(found, &shifted, &matrices.M, shift)
}

/// Adds a motion, made orthogonal by stiffness to those before it and of stiffness 1, where enough of it is left.
fn add(found: &mut Vec<Vec<f64>>, mut motion: Vec<f64>, size: f64, shifted: &Sparse) {
    // Twice, for rounding.
    for _ in 0..2 {
        let product = times(shifted, &motion);
        for other in &*found {
            let part = dot(other, &product);
            motion.iter_mut().zip(other).for_each(|(x, other)| *x -= part * other);
        }
    }
    let left = dot(&motion, &times(shifted, &motion));
    if left > 0.0 && left > ALIKE * ALIKE * size {
        motion.iter_mut().for_each(|x| *x /= left.sqrt());
        found.push(motion);
    }
}

/// Motions that are uncoupled by mass too.
fn uncoupled(found: Vec<Vec<f64>>, shifted: &Sparse, M: &Sparse, shift: f64) -> Vec<RestMotion> {
    if found.is_empty() {
        return Vec::new();
    }
    let products: Vec<Vec<f64>> = found.iter().map(|motion| times(M, motion)).collect();
    let masses = DMatrix::from_fn(found.len(), found.len(), |i, j| dot(&found[i], &products[j]));
    let turned = masses.symmetric_eigen().eigenvectors;
    let motion = |column: usize| {
        let mut shape = vec![0.0; found[0].len()];
        for (row, part) in found.iter().enumerate() {
            shape.iter_mut().zip(part).for_each(|(x, part)| *x += turned[(row, column)] * part);
        }
        let mass = dot(&shape, &times(M, &shape));
        let stiffness = dot(&shape, &times(shifted, &shape)) + shift * mass;
        RestMotion { shape, stiffness, mass }
    };
    (0..found.len()).map(motion).collect()
}

fn times(matrix: &Sparse, x: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; x.len()];
    matrix.multiply(x, &mut product);
    product
}

/// The scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
