//! Forward and backward substitution, L y = b and Lᵀ x = y or D⁻¹ y, front by front. Subtrees of [`super::fronts`] run in parallel, and the
//! supernodes above them in sequence with large panels in halves ([`super::panel`]). Each reads L once, for one right-hand side or several,
//! and is bound by the speed of memory.

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
    /// x ← K⁻¹ x for R right-hand sides side by side, in the order of elimination. More than before take memory first.
    pub fn solve<const R: usize>(&mut self, L: Factored, x: &mut [[f64; R]]) {
        self.make_room_for_vectors(R);
        let Fronts { tree, subtrees, above, vectors, threads, done, .. } = self;
        let done = &mut done.as_chunks_mut().0[..x.len()];
        tree.forward_all(subtrees, L, x, 0, *threads);
        for &s in above.iter() {
            tree.forward(s, L, &mut x[tree.columns(s)], vectors, subtrees, *threads);
        }
        for &s in above.iter().rev() {
            let front = vectors.front();
            tree.gather(s, x, 0, &[], front);
            tree.backward(s, L, front, *threads);
            x[tree.columns(s)].copy_from_slice(&front[..tree.fronts[s].columns]);
        }
        done.copy_from_slice(x);
        tree.backward_all(subtrees, L, (x, 0), done, *threads);
    }
}

impl Tree {
    /// Forward substitution in subtrees; `x` begins at `base` of the whole vector.
    fn forward_all<const R: usize>(
        &self,
        of: &mut [Subtree],
        L: Factored,
        x: &mut [[f64; R]],
        base: usize,
        threads: bool,
    ) {
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
    fn forward<const R: usize>(
        &self,
        s: usize,
        L: Factored,
        x: &mut [[f64; R]],
        vectors: &mut Vectors,
        subtrees: &[Subtree],
        threads: bool,
    ) {
        let front = &self.fronts[s];
        let (f, own) = vectors.both();
        let f = &mut f[..front.height()];
        f[..front.columns].copy_from_slice(x);
        f[front.columns..].fill([0.0; R]);
        for child in self.children(s).map(|child| &self.fronts[child]) {
            let stack = match child.subtree {
                Some(t) if child.subtree != front.subtree => subtrees[t].vectors.stack(),
                _ => &*own,
            };
            let places = &self.places[child.place..child.place + child.rows];
            for (&place, u) in places.iter().zip(&stack[child.vector..]) {
                f[place as usize].iter_mut().zip(u).for_each(|(f, u)| *f += u);
            }
        }

        Panel::new(front, &L.values[self.panel(s)], !L.definite).forward(f, threads);
        x.copy_from_slice(&f[..front.columns]);
        own[front.vector..front.vector + front.rows].copy_from_slice(&f[front.columns..]);
    }

    /// Backward substitution in subtrees; `x` begins at `base` of the whole vector, and `done` holds the solution in rows outside
    /// the subtree.
    fn backward_all<const R: usize>(
        &self,
        of: &mut [Subtree],
        L: Factored,
        (x, base): (&mut [[f64; R]], usize),
        done: &[[f64; R]],
        threads: bool,
    ) {
        match of {
            [] => {}
            [Subtree { supernodes, vectors, .. }] => {
                let front = vectors.front();
                for s in supernodes.clone().rev() {
                    self.gather(s, x, base, done, front);
                    self.backward(s, L, front, false);
                    let columns = self.columns(s);
                    x[columns.start - base..columns.end - base].copy_from_slice(&front[..columns.len()]);
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

    /// Copies the rows of a front to `f`: from `x`, which starts at `base`, or from `done` for rows behind it.
    fn gather<const R: usize>(&self, s: usize, x: &[[f64; R]], base: usize, done: &[[f64; R]], f: &mut [[f64; R]]) {
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
    fn backward<const R: usize>(&self, s: usize, L: Factored, f: &mut [[f64; R]], threads: bool) {
        let front = &self.fronts[s];
        let panel = Panel::new(front, &L.values[self.panel(s)], !L.definite);
        panel.backward(&mut f[..panel.height], threads);
    }
}
