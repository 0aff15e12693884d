//! The factorization of G M⁻¹ Gᵀ: dense for few constraint equations, sparse for many. Two equations are coupled only if their joints share
//! a body.

use base::math::lanes::LANES;
use linear::{Factorization, Solver, Structure};

/// The matrix and its factor.
pub enum SchurFactor {
    /// Few equations.
    Dense(DenseFactor),
    /// Many equations.
    Sparse(SparseFactor),
}

/// The matrix and its Cholesky factor, row-major.
pub struct DenseFactor {
    count: usize,
    S: Vec<f64>,
    L: Vec<f64>,
}

/// The entries of one triangle and a sparse factorization.
pub struct SparseFactor {
    /// Rows and columns of the entries, rows not below columns.
    pairs: Vec<[u32; 2]>,
    /// Their values.
    values: Vec<f64>,
    /// Their places in the solver's matrix, and those of their mirror images.
    slots: Vec<[usize; 2]>,
    solver: Solver,
}

impl SchurFactor {
    /// The largest number of constraint equations of a dense system.
    pub const MOST_DENSE: usize = 64;

    /// Room for the system of joints with so many constraint equations each, which move the nodes `rows`. `None` where there is no memory.
    pub fn new(sizes: &[usize], rows: &[&[Option<usize>]]) -> Option<SchurFactor> {
        let count = rows.len();
        if count > Self::MOST_DENSE {
            return SparseFactor::new(sizes, rows).map(SchurFactor::Sparse);
        }
        let square = vec![0.0; count * count];
        Some(SchurFactor::Dense(DenseFactor { count, S: square.clone(), L: square }))
    }

    /// True where the system is sparse.
    pub fn is_sparse(&self) -> bool {
        matches!(self, SchurFactor::Sparse(_))
    }

    /// Writes the entries, which `entry` gives by row and column, and factorizes. `inert` equations are decoupled; `raised` is added to the
    /// diagonal. Returns false where the matrix is singular.
    pub fn factor(&mut self, inert: &[bool], raised: &[f64], entry: impl Fn(usize, usize) -> f64) -> bool {
        match self {
            SchurFactor::Dense(factor) => factor.factor(inert, raised, entry),
            SchurFactor::Sparse(factor) => factor.factor(inert, raised, entry),
        }
    }

    /// Solves with the factor; `x` holds the right-hand side on entry.
    pub fn substitute(&mut self, x: &mut [f64]) {
        match self {
            SchurFactor::Dense(factor) => substitute(&factor.L, x),
            SchurFactor::Sparse(factor) => factor.solver.solve(x),
        }
    }

    /// Solves with one iterative refinement; `x` and `scratch` hold the right-hand side on entry.
    pub fn refine(&mut self, x: &mut [f64], scratch: &mut [f64]) {
        self.substitute(x);
        self.subtract_product(x, scratch);
        self.substitute(scratch);
        x.iter_mut().zip(&*scratch).for_each(|(x, more)| *x += more);
    }

    /// Subtracts the product of the matrix and `x`.
    pub fn subtract_product(&self, x: &[f64], from: &mut [f64]) {
        match self {
            SchurFactor::Dense(DenseFactor { count: n, S, .. }) => {
                for (k, from) in from.iter_mut().enumerate() {
                    let done: f64 = S[k * n..(k + 1) * n].iter().zip(x).map(|(s, x)| s * x).sum();
                    *from -= done;
                }
            }
            SchurFactor::Sparse(SparseFactor { pairs, values, .. }) => {
                for ([k, l], value) in pairs.iter().map(|pair| pair.map(|index| index as usize)).zip(values) {
                    from[k] -= value * x[l];
                    if k != l {
                        from[l] -= value * x[k];
                    }
                }
            }
        }
    }
}

impl DenseFactor {
    fn factor(&mut self, inert: &[bool], raised: &[f64], entry: impl Fn(usize, usize) -> f64) -> bool {
        let n = self.count;
        for k in 0..n {
            for l in 0..=k {
                let sum = if inert[k] || inert[l] { 0.0 } else { entry(k, l) };
                self.S[k * n + l] = sum;
                self.S[l * n + k] = sum;
            }
        }
        self.L.copy_from_slice(&self.S);
        let L = &mut self.L;
        for k in 0..n {
            L[k * n + k] += raised[k];
            for l in 0..k {
                let sum = scalar_product(&L[k * n..k * n + l], &L[l * n..l * n + l]);
                L[k * n + l] = (L[k * n + l] - sum) / L[l * n + l];
            }
            if inert[k] {
                L[k * n + k] = 1.0;
                continue;
            }
            let row = &L[k * n..k * n + k];
            let pivot = L[k * n + k] - scalar_product(row, row);
            if pivot <= 0.0 || pivot.is_nan() {
                return false;
            }
            L[k * n + k] = pivot.sqrt();
        }
        true
    }
}

impl SparseFactor {
    /// The structure of the system of these joints. `None` where there is no memory.
    pub fn new(sizes: &[usize], rows: &[&[Option<usize>]]) -> Option<SparseFactor> {
        let sizes: Vec<usize> = sizes.iter().copied().filter(|&equations| equations > 0).collect();
        let firsts: Vec<usize> =
            sizes.iter().scan(0, |next, size| Some(std::mem::replace(next, *next + size))).collect();
        let mut of_node: Vec<Vec<usize>> = Vec::new();
        for (joint, &first) in firsts.iter().enumerate() {
            for &node in rows[first].iter().flatten() {
                if of_node.len() <= node {
                    of_node.resize(node + 1, Vec::new());
                }
                of_node[node].push(joint);
            }
        }
        // A joint between points of one body meets it twice.
        of_node.iter_mut().for_each(|joints| joints.dedup());
        let alone = (0..sizes.len()).map(|joint| vec![joint]);
        let connectivity: Vec<Vec<usize>> =
            of_node.into_iter().filter(|joints| joints.len() > 1).chain(alone).collect();
        let mut pairs: Vec<[u32; 2]> = Vec::new();
        for joints in &connectivity {
            for &a in joints {
                for &b in joints.iter().filter(|&&b| b <= a) {
                    for k in firsts[a]..firsts[a] + sizes[a] {
                        let last = if a == b { k + 1 } else { firsts[b] + sizes[b] };
                        pairs.extend((firsts[b]..last).map(|l| [k as u32, l as u32]));
                    }
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let structure = Structure { sizes, connectivity, multipliers: 0, positions: Vec::new() };
        let solver = Solver::new(&structure, Factorization::choose(&structure), 1).ok()?;
        let place = |row: u32, col: u32| solver.slot(row as usize, col as usize).unwrap_or(solver.spare());
        let slots = pairs
            .iter()
            .map(|&[k, l]| match solver.is_symmetric() || k == l {
                true => [place(k, l), solver.spare()],
                false => [place(k, l), place(l, k)],
            })
            .collect();
        Some(SparseFactor { values: vec![0.0; pairs.len()], pairs, slots, solver })
    }

    fn factor(&mut self, inert: &[bool], raised: &[f64], entry: impl Fn(usize, usize) -> f64) -> bool {
        let matrix = self.solver.values();
        matrix.fill(0.0);
        for ((&[k, l], value), [slot, mirror]) in self.pairs.iter().zip(&mut self.values).zip(&self.slots) {
            let (k, l) = (k as usize, l as usize);
            *value = if inert[k] || inert[l] { 0.0 } else { entry(k, l) };
            let entry = match (k == l, inert[k]) {
                (true, true) => 1.0,
                (true, false) => *value + raised[k],
                _ => *value,
            };
            matrix[*slot] += entry;
            matrix[*mirror] += entry;
        }
        self.solver.factor().is_ok() && self.solver.negative_eigenvalues() == 0
    }
}

/// Solves L Lᵀ x = b; `x` holds b on entry.
fn substitute(L: &[f64], x: &mut [f64]) {
    let n = x.len();
    for k in 0..n {
        let sum = scalar_product(&L[k * n..k * n + k], &x[..k]);
        x[k] = (x[k] - sum) / L[k * n + k];
    }
    for k in (0..n).rev() {
        let (above, rest) = x.split_at_mut(k);
        rest[0] /= L[k * n + k];
        above.iter_mut().zip(&L[k * n..k * n + k]).for_each(|(x, l)| *x -= l * rest[0]);
    }
}

/// Σ aᵢ bᵢ in eight separate sums, because a single sum would wait for each product.
#[inline]
fn scalar_product(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for i in 0..LANES {
            sums[i] += a[i] * b[i];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}
