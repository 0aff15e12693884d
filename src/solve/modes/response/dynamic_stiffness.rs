//! The dynamic stiffness K + iωC − ω²M with the equations of joints, factorised at a frequency.
//!
//! A complex number a + ib stands as the real matrix [a −b; b a]. Real and imaginary parts of a group of unknowns form one group of the
//! solver, so either may be a pivot: at a resonance a real part may vanish. Groups are of three unknowns at most.

use super::excitation::C64;
use super::matrices::Matrices;
use crate::tolerances::dynamic_stiffness::{LEFT, MOST, NEGLIGIBLE, REFINEMENTS};
use linear::{Factorization, Solver, Sparse, Structure, TooLarge};

/// An entry of the matrices, with the slots of its real and imaginary part in the rows of both.
struct Entry {
    row: u32,
    column: u32,
    slots: [u32; 4],
    /// Stiffness with equations of joints, damping, mass.
    values: [f64; 3],
}

/// A solver for complex matrices of this structure, as real ones of twice the size.
///
/// # Errors
/// There is no memory.
pub fn complex_solver(structure: &Structure) -> Result<Solver, TooLarge> {
    Solver::new(&doubled(structure).0, Factorization::BlockLu, 1)
}

/// K + iωC − ω²M.
pub struct DynamicStiffness {
    solver: Solver,
    entries: Vec<Entry>,
    /// The rows of the real and the imaginary part of each unknown.
    places: Vec<[usize; 2]>,
    omega: f64,
    scratch: Vec<f64>,
}

impl DynamicStiffness {
    /// An empty matrix of the unknowns of a structure.
    ///
    /// # Errors
    /// There is no memory.
    pub fn new(structure: &Structure) -> Result<DynamicStiffness, TooLarge> {
        let places = doubled(structure).1;
        let scratch = vec![0.0; 2 * places.len()];
        Ok(DynamicStiffness { solver: complex_solver(structure)?, entries: Vec::new(), places, omega: 0.0, scratch })
    }

    /// Replaces the entries. The multipliers of `joints` come last: their rows, columns and penalties.
    pub fn set(&mut self, matrices: &Matrices, joints: &Sparse) {
        let of = [&matrices.K, &matrices.C, &matrices.M, joints];
        self.entries.clear();
        let mut row_of = std::collections::BTreeMap::new();
        for row in 0..self.places.len() {
            row_of.clear();
            for (k, matrix) in of.iter().enumerate().filter(|(_, matrix)| row < matrix.rows()) {
                for (column, value) in matrix.row(row) {
                    row_of.entry(column).or_insert([0.0; 3])[k % 3] += value;
                }
            }
            for (&column, &values) in &row_of {
                let (at, to) = (self.places[row], self.places[column]);
                let all = [[0, 0], [1, 1], [0, 1], [1, 0]].map(|[i, j]| self.solver.slot(at[i], to[j]));
                if let [Some(a), Some(b), Some(c), Some(d)] = all {
                    let slots = [a, b, c, d].map(|slot| slot as u32);
                    self.entries.push(Entry { row: row as u32, column: column as u32, slots, values });
                }
            }
        }
    }

    /// Factorises at an angular frequency; false where the matrix is singular.
    pub fn factor(&mut self, omega: f64) -> bool {
        self.omega = omega;
        let values = self.solver.values();
        values.fill(0.0);
        for entry in &self.entries {
            let [real, imaginary] = entry.at(omega);
            for (slot, value) in entry.slots.iter().zip([real, real, -imaginary, imaginary]) {
                values[*slot as usize] += value;
            }
        }
        self.solver.factor().is_ok()
    }

    /// Solves for the response to `f`, and returns the residual relative to the largest entry of `f`. It returns 0 if the residual is
    /// rounding of stiff terms, which hardly changes the solution.
    pub fn solve(&mut self, f: &[C64], x: &mut [C64]) -> f64 {
        let largest = f.iter().map(|f| f.norm()).fold(0.0, f64::max);
        x.fill(C64::new(0.0, 0.0));
        if largest == 0.0 {
            return 0.0;
        }
        let mut rest = f.to_vec();
        let (mut left, mut change) = (1.0, f64::INFINITY);
        for _ in 0..=REFINEMENTS {
            change = self.correct(&rest, x);
            rest.copy_from_slice(f);
            for entry in &self.entries {
                let [real, imaginary] = entry.at(self.omega);
                rest[entry.row as usize] -= C64::new(real, imaginary) * x[entry.column as usize];
            }
            let now = rest.iter().map(|r| r.norm()).fold(0.0, f64::max) / largest;
            let better = now < 0.1 * left;
            left = now;
            if left <= LEFT || !better {
                break;
            }
        }
        if change <= NEGLIGIBLE { 0.0 } else { left }
    }

    /// Adds the solution for `f` to `x`, and returns its change relative to its largest entry.
    fn correct(&mut self, f: &[C64], x: &mut [C64]) -> f64 {
        for ([real, imaginary], f) in self.places.iter().zip(f) {
            (self.scratch[*real], self.scratch[*imaginary]) = (f.re, f.im);
        }
        self.solver.solve(&mut self.scratch);
        let (mut change, mut largest) = (0.0f64, 0.0f64);
        for ([real, imaginary], x) in self.places.iter().zip(x) {
            let more = C64::new(self.scratch[*real], self.scratch[*imaginary]);
            *x += more;
            (change, largest) = (change.max(more.norm()), largest.max(x.norm()));
        }
        change / largest
    }
}

impl Entry {
    /// The real and the imaginary part at an angular frequency.
    fn at(&self, omega: f64) -> [f64; 2] {
        let [k, c, m] = self.values;
        [k - omega * omega * m, omega * c]
    }
}

/// The structure of the real matrix, and the rows of the real and the imaginary part of each unknown.
fn doubled(structure: &Structure) -> (Structure, Vec<[usize; 2]>) {
    let (mut sizes, mut places, mut parts) = (Vec::new(), Vec::new(), Vec::new());
    let mut multipliers = 0;
    let of_nodes = structure.sizes.len() - structure.multipliers;
    for (g, &size) in structure.sizes.iter().enumerate() {
        let mut own = Vec::new();
        for first in (0..size).step_by(MOST) {
            let count = MOST.min(size - first);
            let row = places.len() * 2;
            places.extend((0..count).map(|i| [row + i, row + count + i]));
            own.push(sizes.len());
            sizes.push(2 * count);
            multipliers += usize::from(g >= of_nodes);
        }
        parts.push(own);
    }
    // Multipliers of a joint couple with its nodes, and not with each other.
    let mut connectivity: Vec<Vec<usize>> = parts[..of_nodes].iter().filter(|own| own.len() > 1).cloned().collect();
    for list in &structure.connectivity {
        let of =
            |joints: bool| list.iter().filter(move |&&g| (g >= of_nodes) == joints).flat_map(|&g| parts[g].clone());
        let nodes: Vec<usize> = of(false).collect();
        connectivity.extend(of(true).map(|multipliers| nodes.iter().copied().chain([multipliers]).collect()));
        connectivity.push(nodes);
    }
    (Structure { sizes, connectivity, multipliers, positions: Vec::new() }, places)
}
