//! The softest mode of a matrix by inverse iteration, and the place where it moves most.

use crate::system::DofMap;
use crate::tolerances::mode::{EQUAL, ITERATIONS, ROTATIONAL};
use base::math::Vec6;
use linear::{Solver, Sparse};

/// A mode by unknown, multipliers included; its largest translation, or rotation times the model's length, is 1.
pub struct Mode {
    values: Vec<f64>,
}

impl Mode {
    /// The mode of the last factorized matrix whose stiffness is nearest to zero; `None` if the iteration overflows. `length` weighs
    /// rotations against translations.
    pub fn softest(solver: &mut Solver, dofs: &DofMap, length: f64) -> Option<Mode> {
        Mode::scattered(dofs).softened(solver, dofs, length, ITERATIONS)
    }

    /// A motion that follows no mode of a structure, and is the same in every run.
    pub fn scattered(dofs: &DofMap) -> Mode {
        // Multiples of the golden ratio, modulo 1.
        let scattered = |i: usize| (0.618_033_988_749_895 * (i + 1) as f64).fract() - 0.5;
        Mode { values: (0..dofs.unknowns()).map(scattered).collect() }
    }

    /// The motion after so many inverse iterations; `None` if one overflows.
    pub fn softened(self, solver: &mut Solver, dofs: &DofMap, length: f64, iterations: usize) -> Option<Mode> {
        let mut values = self.values;
        let weight = |dof: usize| if dof < 3 { 1.0 } else { length };
        for _ in 0..iterations {
            for (value, &(_, dof)) in values.iter_mut().zip(dofs.nodal_dofs()) {
                *value *= weight(dof) * weight(dof);
            }
            values[dofs.nodal_dofs().len()..].fill(0.0);
            solver.solve(&mut values);
            let sizes = values.iter().zip(dofs.nodal_dofs()).map(|(value, &(_, dof))| weight(dof) * value.abs());
            let size = sizes.fold(0.0, f64::max);
            if !(size > 0.0 && size.is_finite()) || values.iter().any(|value| value.is_nan()) {
                return None;
            }
            values.iter_mut().for_each(|value| *value /= size);
        }
        Some(Mode { values })
    }

    /// Twice its energy in the matrix of nodal unknowns, and the sum of the magnitudes of the terms of that.
    pub fn energy(&self, K: &Sparse) -> [f64; 2] {
        K.entries().fold([0.0, 0.0], |[energy, terms], (i, j, k)| {
            let term = self.values[i] * k * self.values[j];
            [energy + term, terms + term.abs()]
        })
    }

    /// The motion of each node; nodes that follow others stand still.
    pub fn motions(&self, dofs: &DofMap) -> Vec<Vec6> {
        dofs.each_node().iter().map(|rows| rows.gather(&self.values)).collect()
    }

    /// Node and degree of freedom of the largest translation, or of the largest rotation where hardly anything moves but turns.
    pub fn largest(&self, dofs: &DofMap) -> Option<(usize, usize)> {
        let largest = |from: usize, to: usize| {
            let entries = self.values.iter().zip(dofs.nodal_dofs()).filter(|(_, (_, dof))| (from..to).contains(dof));
            // The first of equals, so that rounding of symmetric modes does not choose.
            entries.fold((0.0, None), |(size, at), (value, &place)| match value.abs() > size * (1.0 + EQUAL) {
                true => (value.abs(), Some(place)),
                false => (size, at),
            })
        };
        let (translation, place) = largest(0, 3);
        if translation >= ROTATIONAL { place } else { largest(3, 6).1.or(place) }
    }
}
