//! Structures and random matrices for the tests and the bench of `linear`.
#![allow(dead_code)] // each program uses its part

use rdsolve::linear::{Solver, Structure};

/// Elements of two nodes in a row.
pub fn chain(groups: usize, size: usize) -> Structure {
    Structure {
        sizes: vec![size; groups],
        connectivity: (1..groups).map(|g| vec![g - 1, g]).collect(),
        multipliers: 0,
        positions: Vec::new(),
    }
}

/// Elements of three nodes in a row, numbered end, middle, end, middle, end.
pub fn quadratic_chain(elements: usize, size: usize) -> Structure {
    let connectivity = (0..elements).map(|e| vec![2 * e, 2 * e + 1, 2 * e + 2]).collect();
    Structure { sizes: vec![size; 2 * elements + 1], connectivity, multipliers: 0, positions: Vec::new() }
}

/// Each node hangs on a random earlier one.
pub fn tree(groups: usize, random: &mut Random) -> Structure {
    let sizes = (0..groups).map(|_| 1 + random.below(6)).collect();
    Structure {
        sizes,
        connectivity: (1..groups).map(|g| vec![g, random.below(g)]).collect(),
        multipliers: 0,
        positions: Vec::new(),
    }
}

/// A sheet of four-node elements.
pub fn sheet(nx: usize, ny: usize, size: usize) -> Structure {
    let node = |i, j| i * ny + j;
    let connectivity = (1..nx)
        .flat_map(|i| (1..ny).map(move |j| vec![node(i - 1, j - 1), node(i, j - 1), node(i, j), node(i - 1, j)]))
        .collect();
    Structure { sizes: vec![size; nx * ny], connectivity, multipliers: 0, positions: Vec::new() }
}

/// A space frame of one beam per member: storeys of nx × ny columns.
pub fn frame(storeys: usize, nx: usize, ny: usize, size: usize) -> Structure {
    let node = |s, i, j| (s * nx + i) * ny + j;
    let mut connectivity = Vec::new();
    for s in 0..storeys {
        for i in 0..nx {
            for j in 0..ny {
                let here = node(s, i, j);
                connectivity.extend((s > 0).then(|| vec![node(s - 1, i, j), here]));
                connectivity.extend((i > 0).then(|| vec![node(s, i - 1, j), here]));
                connectivity.extend((j > 0).then(|| vec![node(s, i, j - 1), here]));
            }
        }
    }
    Structure { sizes: vec![size; storeys * nx * ny], connectivity, multipliers: 0, positions: Vec::new() }
}

/// Random couplings of up to five groups of mixed sizes; some groups may stand alone.
pub fn connectivity(groups: usize, random: &mut Random) -> Structure {
    let sizes = (0..groups).map(|_| 1 + random.below(6)).collect();
    let coupled = |random: &mut Random| (0..2 + random.below(4)).map(|_| random.below(groups)).collect();
    Structure {
        sizes,
        connectivity: (0..groups).map(|_| coupled(random)).collect(),
        multipliers: 0,
        positions: Vec::new(),
    }
}

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// Uniform on (−1, 1).
    pub fn number(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Values {
    Unsymmetric,
    Definite,
    /// Symmetric, the diagonals of every third group negative.
    Indefinite,
}

/// Entries (row, col, value) to be added, both triangles: a random full matrix per coupling, and on the diagonal what
/// keeps it away from singularity.
pub fn entries(structure: &Structure, values: Values, random: &mut Random) -> Vec<(usize, usize, f64)> {
    let mut first = vec![0];
    for &size in &structure.sizes {
        first.push(first[first.len() - 1] + size);
    }
    let rows = |g: usize| first[g]..first[g + 1];
    let mut entries = Vec::new();
    let mut sums = vec![0.0; first[first.len() - 1]];
    let alone = (0..structure.sizes.len()).map(|g| vec![g]);
    for coupled in structure.connectivity.iter().cloned().chain(alone) {
        let mut coupled = coupled;
        coupled.sort();
        coupled.dedup();
        let rows: Vec<usize> = coupled.iter().flat_map(|&g| rows(g)).collect();
        for (n, &i) in rows.iter().enumerate() {
            for &j in &rows[..n] {
                let (lower, upper) = (random.number(), random.number());
                let upper = if values == Values::Unsymmetric { upper } else { lower };
                entries.extend([(i, j, lower), (j, i, upper)]);
                sums[i] += lower.abs();
                sums[j] += upper.abs();
            }
        }
    }
    for (g, _) in structure.sizes.iter().enumerate() {
        let sign = if values == Values::Indefinite && g % 3 == 1 { -1.0 } else { 1.0 };
        entries.extend(rows(g).map(|i| (i, i, sign * (1.0 + 1.05 * sums[i]))));
    }
    entries
}

/// The slot and value of each entry that the solver stores.
pub fn slots(solver: &Solver, entries: &[(usize, usize, f64)]) -> Vec<(usize, f64)> {
    let stored = entries.iter().filter(|(i, j, _)| !solver.is_symmetric() || i >= j);
    stored.map(|&(i, j, value)| (solver.slot(i, j).expect("inside the structure"), value)).collect()
}

pub fn fill(solver: &mut Solver, slots: &[(usize, f64)]) {
    let values = solver.values();
    values.fill(0.0);
    for &(slot, value) in slots {
        values[slot] += value;
    }
}
