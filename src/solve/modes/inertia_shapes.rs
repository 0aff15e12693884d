//! Static responses of a part with a fixed interface to the inertia loads of rigid motions: weight, turns and spins.
//!
//! Modes that stretch a beam or a plate have high frequencies, and a few modes have none of them. The part of each response that the modes
//! lack, x − φ φᵀ M x, becomes a shape beside them. So the shapes have the axial force of a spinning beam.

use super::pencil::Pencil;
use crate::tolerances::reduction::{LACKING, REPEATED, UNLOADED};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// The shapes that these modes lack, for loads on the unknowns: squares of frequencies, and motions orthogonal by mass and stiffness. K has factors.
pub fn inertia_shapes(
    pencil: &mut Pencil,
    mut loads: Vec<Vec<f64>>,
    modes: &[(f64, Vec<f64>)],
) -> Vec<(f64, Vec<f64>)> {
    let size = |load: &Vec<f64>| load.iter().map(|f| f * f).sum::<f64>().sqrt();
    let largest = loads.iter().map(size).fold(0.0, f64::max);
    loads.retain(|load| size(load) > UNLOADED * largest);
    let mut moved = loads.clone();
    pencil.solve_all(&mut moved);
    let unknowns = pencil.at.unknowns();
    let matrix = |columns: &[Vec<f64>]| DMatrix::from_fn(unknowns, columns.len(), |row, column| columns[column][row]);
    let (loads, mut moved) = (matrix(&loads), matrix(&moved));
    let all = loads.tr_mul(&moved);
    for (_, mode) in modes {
        let momentum = DVector::from_vec(pencil.mass.products(&[mode.as_slice()]).swap_remove(0));
        let mode = DVector::from_column_slice(mode);
        let parts = moved.tr_mul(&momentum) / momentum.dot(&mode);
        moved.ger(-1.0, &mode, &parts, 1.0);
    }
    // Bending has far more energy than stretching, so each load counts by its own.
    let own = DMatrix::from_diagonal(&all.diagonal().map(|energy| 1.0 / energy.sqrt()));
    let independent = &own * principal(&own * all * &own, REPEATED);
    let lacked = principal(independent.tr_mul(&(loads.tr_mul(&moved) * &independent)), LACKING);
    // Their energy is 1/2, and their mass the inverse of the squared frequency.
    let motions = moved * independent * lacked;
    if motions.is_empty() {
        return Vec::new();
    }
    let columns: Vec<&[f64]> = motions.as_slice().chunks_exact(unknowns).collect();
    let mass = motions.tr_mul(&matrix(&pencil.mass.products(&columns)));
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(mass);
    let shapes = motions * eigenvectors;
    let shape = |(mass, shape): (&f64, nalgebra::DVectorView<f64>)| (1.0 / mass, shape.iter().copied().collect());
    let mut shapes: Vec<(f64, Vec<f64>)> = eigenvalues.iter().zip(shapes.column_iter()).map(shape).collect();
    shapes.sort_by(|a, b| a.0.total_cmp(&b.0));
    shapes
}

/// The eigenvectors with eigenvalues above `least`, over the roots of these.
fn principal(of: DMatrix<f64>, least: f64) -> DMatrix<f64> {
    if of.is_empty() {
        return of;
    }
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(of);
    let columns = eigenvectors.column_iter().zip(&eigenvalues).filter(|(_, value)| **value > least);
    let columns: Vec<DVector<f64>> = columns.map(|(column, value)| column / value.sqrt()).collect();
    DMatrix::from_fn(eigenvectors.nrows(), columns.len(), |row, column| columns[column][row])
}
