//! Forward and backward substitution, L y = b and Lᵀ x = y, front by front: up the assembly tree with the subtrees of
//! [`super::fronts`] side by side and the supernodes above them one by one, the large panels of each in halves
//! ([`super::panel`]), and down again. Each reads L once and is bound by the speed of memory.

use super::dense::join;
use super::fronts::{FrontWorkspace, Fronts, Tree};
use super::panel::Panel;
use std::ops::Range;

impl Fronts {
    /// x ← K⁻¹ x, in the order of elimination.
    pub fn solve(&mut self, L: &[f64], x: &mut [f64]) {
        let Fronts { tree, subtrees, above: (above, workspace), threads, done } = self;
        tree.forward_all(subtrees, L, x, 0, *threads);
        for &s in above.iter() {
            let columns = tree.columns(s);
            tree.forward(s, L, &mut x[columns], workspace, subtrees, *threads);
        }
        for &s in above.iter().rev() {
            tree.gather(s, x, 0, &[], &mut workspace.front);
            tree.backward(s, L, &mut workspace.front, *threads);
            x[tree.columns(s)].copy_from_slice(&workspace.front[..tree.fronts[s].columns]);
        }
        done.copy_from_slice(x);
        tree.backward_all(subtrees, L, (x, 0), done, *threads);
    }
}

impl Tree {
    /// The columns of supernode `s`, by position.
    fn columns(&self, s: usize) -> Range<usize> {
        self.fronts[s].begin..self.fronts[s + 1].begin
    }

    /// Forward substitution in subtrees; `x` begins at `base` of the whole vector.
    fn forward_all(
        &self,
        of: &mut [(Range<usize>, FrontWorkspace)],
        L: &[f64],
        x: &mut [f64],
        base: usize,
        threads: bool,
    ) {
        match of {
            [] => {}
            [(supernodes, workspace)] => {
                for s in supernodes.clone() {
                    let columns = self.columns(s);
                    self.forward(s, L, &mut x[columns.start - base..columns.end - base], workspace, &[], false);
                }
            }
            _ => {
                let (left, right) = of.split_at_mut(of.len() / 2);
                let middle = self.fronts[right[0].0.start].begin;
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
        L: &[f64],
        x: &mut [f64],
        workspace: &mut FrontWorkspace,
        subtrees: &[(Range<usize>, FrontWorkspace)],
        threads: bool,
    ) {
        let front = &self.fronts[s];
        let height = front.columns + front.rows;
        let f = &mut workspace.front[..height];
        f[..front.columns].copy_from_slice(x);
        f[front.columns..].fill(0.0);
        for child in self.children(s).map(|child| &self.fronts[child]) {
            let stack = match child.subtree {
                Some(t) if child.subtree != front.subtree => &subtrees[t].1.vectors,
                _ => &workspace.vectors,
            };
            let places = &self.places[child.place..child.place + child.rows];
            places.iter().zip(&stack[child.vector..]).for_each(|(&place, u)| f[place as usize] += u);
        }

        Panel::new(front, &L[front.panel..self.fronts[s + 1].panel]).forward(f, threads);
        x.copy_from_slice(&f[..front.columns]);
        workspace.vectors[front.vector..front.vector + front.rows].copy_from_slice(&f[front.columns..]);
    }

    /// Backward substitution in subtrees; `x` begins at `base` of the whole vector, and `done` holds the solution in rows outside
    /// the subtree.
    fn backward_all(
        &self,
        of: &mut [(Range<usize>, FrontWorkspace)],
        L: &[f64],
        (x, base): (&mut [f64], usize),
        done: &[f64],
        threads: bool,
    ) {
        match of {
            [] => {}
            [(supernodes, workspace)] => {
                for s in supernodes.clone().rev() {
                    self.gather(s, x, base, done, &mut workspace.front);
                    self.backward(s, L, &mut workspace.front, false);
                    let columns = self.columns(s);
                    x[columns.start - base..columns.end - base].copy_from_slice(&workspace.front[..columns.len()]);
                }
            }
            _ => {
                let (left, right) = of.split_at_mut(of.len() / 2);
                let middle = self.fronts[right[0].0.start].begin;
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
    fn backward(&self, s: usize, L: &[f64], f: &mut [f64], threads: bool) {
        let front = &self.fronts[s];
        let panel = Panel::new(front, &L[front.panel..self.fronts[s + 1].panel]);
        panel.backward(&mut f[..panel.height], threads);
    }
}
