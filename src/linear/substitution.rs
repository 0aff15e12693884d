//! Forward and backward substitution, L y = b and Lᵀ x = y or D⁻¹ y, front by front: up the assembly tree with the subtrees of
//! [`super::fronts`] side by side and the supernodes above them one by one, the large panels of each in halves
//! ([`super::panel`]), and down again. Each reads L once and is bound by the speed of memory.

use super::dense::join;
use super::fronts::{Fronts, Subtree, Vectors};
use super::panel::Panel;
use super::tree::Tree;

/// A factor of a matrix.
#[derive(Clone, Copy)]
pub(super) struct Factored<'a> {
    pub values: &'a [f64],
    /// L of L Lᵀ, not L with D on its diagonal.
    pub definite: bool,
}

impl Fronts {
    /// x ← K⁻¹ x, in the order of elimination.
    pub fn solve(&mut self, L: Factored, x: &mut [f64]) {
        let Fronts { tree, subtrees, above, vectors, threads, done, .. } = self;
        tree.forward_all(subtrees, L, x, 0, *threads);
        for &s in above.iter() {
            tree.forward(s, L, &mut x[tree.columns(s)], vectors, subtrees, *threads);
        }
        for &s in above.iter().rev() {
            tree.gather(s, x, 0, &[], &mut vectors.front);
            tree.backward(s, L, &mut vectors.front, *threads);
            x[tree.columns(s)].copy_from_slice(&vectors.front[..tree.fronts[s].columns]);
        }
        done.copy_from_slice(x);
        tree.backward_all(subtrees, L, (x, 0), done, *threads);
    }
}

impl Tree {
    /// Forward substitution in subtrees; `x` begins at `base` of the whole vector.
    fn forward_all(&self, of: &mut [Subtree], L: Factored, x: &mut [f64], base: usize, threads: bool) {
        match of {
            [] => {}
            [Subtree { supernodes, vectors, .. }] => {
                for s in supernodes.clone() {
                    let columns = self.columns(s);
                    self.forward(s, L, &mut x[columns.start - base..columns.end - base], vectors, &[], false);
                }
            }
            _ => {
                let (left, right) = of.split_at_mut(of.len() / 2);
                let middle = self.fronts[right[0].supernodes.start].begin;
                let (head, tail) = x.split_at_mut(middle - base);
                join(
                    threads,
                    || self.forward_all(left, L, head, base, threads),
                    || self.forward_all(right, L, tail, middle, threads),
                );
            }
        }
    }

    /// Forward substitution in supernode `s`, whose columns `x` holds. Its update vector, which changes the rows below, comes
    /// onto the stack in place of those of its children.
    fn forward(
        &self,
        s: usize,
        L: Factored,
        x: &mut [f64],
        vectors: &mut Vectors,
        subtrees: &[Subtree],
        threads: bool,
    ) {
        let front = &self.fronts[s];
        let f = &mut vectors.front[..front.height()];
        f[..front.columns].copy_from_slice(x);
        f[front.columns..].fill(0.0);
        for child in self.children(s).map(|child| &self.fronts[child]) {
            let stack = match child.subtree {
                Some(t) if child.subtree != front.subtree => &subtrees[t].vectors.stack,
                _ => &vectors.stack,
            };
            let places = &self.places[child.place..child.place + child.rows];
            places.iter().zip(&stack[child.vector..]).for_each(|(&place, u)| f[place as usize] += u);
        }

        Panel::new(front, &L.values[self.panel(s)], !L.definite).forward(f, threads);
        x.copy_from_slice(&f[..front.columns]);
        vectors.stack[front.vector..front.vector + front.rows].copy_from_slice(&f[front.columns..]);
    }

    /// Backward substitution in subtrees; `x` begins at `base` of the whole vector, and `done` holds the solution in rows outside
    /// the subtree.
    fn backward_all(
        &self,
        of: &mut [Subtree],
        L: Factored,
        (x, base): (&mut [f64], usize),
        done: &[f64],
        threads: bool,
    ) {
        match of {
            [] => {}
            [Subtree { supernodes, vectors, .. }] => {
                for s in supernodes.clone().rev() {
                    self.gather(s, x, base, done, &mut vectors.front);
                    self.backward(s, L, &mut vectors.front, false);
                    let columns = self.columns(s);
                    x[columns.start - base..columns.end - base].copy_from_slice(&vectors.front[..columns.len()]);
                }
            }
            _ => {
                let (left, right) = of.split_at_mut(of.len() / 2);
                let middle = self.fronts[right[0].supernodes.start].begin;
                let (head, tail) = x.split_at_mut(middle - base);
                join(
                    threads,
                    || self.backward_all(left, L, (head, base), done, threads),
                    || self.backward_all(right, L, (tail, middle), done, threads),
                );
            }
        }
    }

    /// Copies the rows of a front to `f`: from `x`, which begins at `base`, or from `done` where they lie behind it.
    fn gather(&self, s: usize, x: &[f64], base: usize, done: &[f64], f: &mut [f64]) {
        let (front, columns) = (&self.fronts[s], self.columns(s));
        f[..front.columns].copy_from_slice(&x[columns.start - base..columns.end - base]);
        let rows = &self.rows[front.place..front.place + front.rows];
        for (f, &row) in f[front.columns..].iter_mut().zip(rows) {
            *f = match x.get(row as usize - base) {
                Some(x) => *x,
                None => done[row as usize],
            };
        }
    }

    /// Backward substitution in supernode `s`: `f` holds its columns, which are solved for, and the solution in the rows below.
    fn backward(&self, s: usize, L: Factored, f: &mut [f64], threads: bool) {
        let front = &self.fronts[s];
        let panel = Panel::new(front, &L.values[self.panel(s)], !L.definite);
        panel.backward(&mut f[..panel.height], threads);
    }
}
