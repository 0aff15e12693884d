//! Destinations of local matrices in the system's: found once, before the first of them is added.

use super::block_scatter::BlockScatter;
use super::dependents::{Arms, Followers, Projection};
use super::dofs::DofMap;
use super::equations::System;
use base::math::Mat6;
use linear::Solver;

/// The destination of a local matrix.
pub struct Destination {
    /// The preceding projection; `None` if no node is dependent.
    pub projection: Option<Projection>,
    pub entries: Entries,
    /// A range of [`BlockScatter`] in place of entries, where the matrix is scattered by blocks.
    blocks: [u32; 2],
}

impl Destination {
    /// True where no entry of the local matrix is wanted.
    pub fn is_empty(&self) -> bool {
        self.entries.from == self.entries.to && self.blocks[0] == self.blocks[1]
    }
}

/// The entries of a local matrix that reach the system's: ranges of [`Scatter`].
#[derive(Clone, Copy)]
pub struct Entries {
    from: usize,
    /// Start of the entries that meet their transposes in one slot of a symmetric matrix: each adds half.
    halves: usize,
    to: usize,
}

/// Pairs of a position in the local matrix and a slot of the system's.
pub struct Scatter(Vec<[u32; 2]>);

impl Scatter {
    /// Adds the slots of a local matrix; `entry(k)` gives the row and the column of its k-th number, where both are
    /// unknowns.
    fn push(&mut self, solver: &Solver, length: usize, entry: impl Fn(usize) -> Option<(usize, usize)>) -> Entries {
        let from = self.0.len();
        let mut add = |half: bool| {
            for k in 0..length {
                let Some((i, j)) = entry(k) else { continue };
                if (solver.is_symmetric() && i != j) != half {
                    continue;
                }
                if let Some(slot) = solver.slot(i, j) {
                    self.0.push([k as u32, slot as u32]);
                }
            }
            self.0.len()
        };
        let halves = add(false);
        let to = add(true);
        Entries { from, halves, to }
    }

    /// Adds a local matrix to the values of the system's.
    #[inline]
    pub fn add(&self, local: &[f64], entries: Entries, values: &mut [f64]) {
        for &[k, slot] in &self.0[entries.from..entries.halves] {
            values[slot as usize] += local[k as usize];
        }
        for &[k, slot] in &self.0[entries.halves..entries.to] {
            values[slot as usize] += 0.5 * local[k as usize];
        }
    }
}

/// Finds the destinations of local matrices, one after the other.
pub struct Destinations<'a> {
    dofs: &'a DofMap,
    solver: &'a Solver,
    followers: &'a Followers,
    pub scatter: Scatter,
    pub blocks: BlockScatter,
    pub arms: Arms,
    /// Largest number of entries of a matrix that is projected.
    pub most: usize,
}

impl<'a> Destinations<'a> {
    /// Finds them for these unknowns in the matrix of the solver.
    pub fn new(dofs: &'a DofMap, solver: &'a Solver, followers: &'a Followers) -> Self {
        let (scatter, blocks, arms) = (Scatter(Vec::new()), BlockScatter::new(), Arms::default());
        Destinations { dofs, solver, followers, scatter, blocks, arms, most: 0 }
    }

    /// The destination of a matrix with `d` degrees of freedom a node, row-major.
    pub fn local(&mut self, of: &[usize], d: usize) -> Destination {
        self.square(of, d, |k, size| (k / size, k % size))
    }

    /// The destination of a square matrix; `place(k, rows)` is the row and column of its k-th entry.
    fn square(&mut self, of: &[usize], d: usize, place: fn(usize, usize) -> (usize, usize)) -> Destination {
        let dofs = self.dofs;
        let (projection, rows) = if of.iter().all(|&n| self.followers.is_independent(n)) {
            (None, of.iter().flat_map(|&n| (0..d).map(move |i| (n, i))).collect())
        } else {
            let (projection, rows) = self.arms.push(self.followers, dofs, of, d);
            self.most = self.most.max(rows.len().pow(2));
            (Some(projection), rows)
        };
        if let Some(blocks) = self.whole_blocks(&rows) {
            return Destination { projection, entries: Entries { from: 0, halves: 0, to: 0 }, blocks };
        }
        let row = |i: usize| dofs.row(rows[i].0, rows[i].1);
        // Around supports few rows are unknowns.
        let size = if (0..rows.len()).any(|i| row(i).is_some()) { rows.len() } else { 0 };
        let entry = |k: usize| {
            let (i, j) = place(k, size);
            row(i).zip(row(j))
        };
        let entries = self.scatter.push(self.solver, size * size, entry);
        Destination { projection, entries, blocks: [0; 2] }
    }

    /// The blocks of a matrix whose rows belong to different nodes with six unknowns each.
    fn whole_blocks(&mut self, rows: &[(usize, usize)]) -> Option<[u32; 2]> {
        let is_whole = |six: &[(usize, usize)]| (0..6).all(|i| six.get(i) == Some(&(six[0].0, i)));
        if !rows.chunks(6).all(is_whole) {
            return None;
        }
        let firsts: Option<Vec<usize>> = rows.chunks(6).map(|six| self.dofs.of(six[0].0).first_of_six()).collect();
        let firsts = firsts?;
        if (1..firsts.len()).any(|k| firsts[..k].contains(&firsts[k])) {
            return None;
        }
        let from = self.blocks.len() as u32;
        self.blocks.push(self.solver, &firsts).then(|| [from, self.blocks.len() as u32])
    }

    /// The destination of a consistent mass matrix: its scalar entries, used for each translation, or the matrix of translations built from
    /// them.
    pub fn mass(&mut self, of: &[usize]) -> Destination {
        if of.iter().any(|&n| !self.followers.is_independent(n)) {
            return self.local(of, 3);
        }
        let (n, dofs) = (of.len(), self.dofs);
        let entry = |k: usize| {
            let (pair, axis) = (k / 3, k % 3);
            dofs.row(of[pair / n], axis).zip(dofs.row(of[pair % n], axis))
        };
        let entries = self.scatter.push(self.solver, 3 * n * n, entry);
        self.scatter.0[entries.from..entries.to].iter_mut().for_each(|[k, _]| *k /= 3);
        self.most = self.most.max(n * n);
        Destination { projection: None, entries, blocks: [0; 2] }
    }

    /// The destinations of the matrices of nodes, which inertia, nodal damping, follower and centrifugal loads and arms have.
    /// Inertia and damping couple neither translations with one another nor with rotations; the others do.
    pub fn nodal(&mut self, system: &System) -> Vec<(usize, Destination)> {
        let nodes = self.followers.independent_nodes.len();
        let (mut has_own, mut is_full) = (vec![false; nodes], vec![false; nodes]);
        system.inertias.iter().for_each(|i| has_own[i.node] = true);
        system.nodal_damping.iter().for_each(|d| has_own[d.node] = true);
        system.loads.iter().filter(|l| l.follower).for_each(|l| is_full[l.node] = true);
        let turning = system.centrifugal().iter().flat_map(|load| &load.inertias);
        turning.for_each(|inertia| is_full[inertia.node] = true);
        system.rigid_links.iter().for_each(|r| is_full[r.master] = true);
        let with_own = (0..nodes).filter(|&n| has_own[n] || is_full[n]);
        with_own.map(|n| (n, self.node(n, is_full[n]))).collect()
    }

    /// The destination of the matrix of a node, column-major.
    fn node(&mut self, node: usize, is_full: bool) -> Destination {
        if is_full || !self.followers.is_independent(node) {
            return self.square(&[node], 6, |k, size| (k % size, k / size));
        }
        let dofs = self.dofs;
        let couples = |i: usize, j: usize| i == j || (i > 2 && j > 2);
        let entry = |k: usize| {
            let (i, j) = (k % 6, k / 6);
            if couples(i, j) { dofs.row(node, i).zip(dofs.row(node, j)) } else { None }
        };
        let entries = self.scatter.push(self.solver, 36, entry);
        Destination { projection: None, entries, blocks: [0; 2] }
    }
}
/// The places of local matrices in the system's.
pub struct Places<'a> {
    pub scatter: &'a Scatter,
    pub blocks: &'a BlockScatter,
    pub arms: &'a Arms,
    pub projections: &'a [Vec<Mat6>],
}

impl Places<'_> {
    /// Adds a local matrix of this number of rows, row-major. It is used up where it has dependent nodes.
    #[inline]
    pub fn add(
        &self,
        (K, width): (&mut [f64], usize),
        destination: &Destination,
        projected: &mut [f64],
        values: &mut [f64],
    ) {
        let (K, width) = match &destination.projection {
            None => (&*K, width),
            Some(projection) => {
                (self.arms.project(projection, self.projections, (K, width), projected), projection.width())
            }
        };
        match destination.blocks {
            [from, to] if from < to => self.blocks.add(K, width, from as usize..to as usize, values),
            _ => self.scatter.add(K, destination.entries, values),
        }
    }
}
