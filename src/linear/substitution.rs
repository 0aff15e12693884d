//! Forward and backward substitution, L y = b and Lᵀ x = y, front by front: up the assembly tree with the subtrees of
//! [`super::fronts`] side by side and the supernodes above them on one thread, and down again. Each reads L once and is bound
//! by the speed of memory.

use super::dense::join;
use super::fronts::{FrontWorkspace, Fronts, Tree};
use crate::math::fma;
use std::ops::Range;

/// Columns eliminated together: the rows below are then read and written once for all of them.
const COLUMNS: usize = 4;
/// Width of the partial sums of a scalar product.
const LANES: usize = 8;

impl Fronts {
    /// x ← K⁻¹ x, in the order of elimination.
    pub fn solve(&mut self, L: &[f64], x: &mut [f64]) {
        let Fronts { tree, subtrees, above: (above, workspace), threads, done } = self;
        tree.forward_all(subtrees, L, x, 0, *threads);
        for &s in above.iter() {
            let columns = tree.columns(s);
            tree.forward(s, L, &mut x[columns], workspace, subtrees);
        }
        for &s in above.iter().rev() {
            tree.gather(s, x, 0, &[], &mut workspace.front);
            tree.backward(s, L, &mut workspace.front);
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
                    self.forward(s, L, &mut x[columns.start - base..columns.end - base], workspace, &[]);
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

        let panel = &L[front.panel..self.fronts[s + 1].panel];
        let mut j = 0;
        while j < front.columns {
            let block = COLUMNS.min(front.columns - j);
            for k in j..j + block {
                let column = &panel[k * height..(k + 1) * height];
                f[k] /= column[k];
                for i in k + 1..j + block {
                    f[i] -= column[i] * f[k];
                }
            }
            let (y, rest) = f.split_at_mut(j + block);
            let column = |k: usize| &panel[(j + k) * height + j + block..(j + k + 1) * height];
            if let Ok(y) = <[f64; COLUMNS]>::try_from(&y[j..]) {
                let [a, b, c, d] = std::array::from_fn(column);
                for ((((r, a), b), c), d) in rest.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                    *r = fma(*d, -y[3], fma(*c, -y[2], fma(*b, -y[1], fma(*a, -y[0], *r))));
                }
            } else {
                for k in 0..block {
                    rest.iter_mut().zip(column(k)).for_each(|(r, l)| *r = fma(*l, -y[j + k], *r));
                }
            }
            j += block;
        }
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
                    self.backward(s, L, &mut workspace.front);
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
    fn backward(&self, s: usize, L: &[f64], f: &mut [f64]) {
        let front = &self.fronts[s];
        let height = front.columns + front.rows;
        let panel = &L[front.panel..self.fronts[s + 1].panel];
        let mut end = front.columns;
        while end > 0 {
            let j = end - if end.is_multiple_of(COLUMNS) { COLUMNS } else { end % COLUMNS };
            let (y, rest) = f[..height].split_at_mut(end);
            let column = |k: usize| &panel[(j + k) * height + end..(j + k + 1) * height];
            let taken: [f64; COLUMNS] = if end - j == COLUMNS {
                products(std::array::from_fn(column), rest)
            } else {
                std::array::from_fn(|k| if j + k < end { products([column(k)], rest)[0] } else { 0.0 })
            };
            for k in (j..end).rev() {
                let column = &panel[k * height..(k + 1) * height];
                let mut sum = y[k] - taken[k - j];
                for i in k + 1..end {
                    sum -= column[i] * y[i];
                }
                y[k] = sum / column[k];
            }
            end = j;
        }
    }
}

/// Scalar products of columns with `x`, each summed in lanes of fixed width.
#[inline(always)]
fn products<const C: usize>(columns: [&[f64]; C], x: &[f64]) -> [f64; C] {
    let mut sums = [[0.0; LANES]; C];
    let (whole, rest) = x.as_chunks::<LANES>();
    for (n, x) in whole.iter().enumerate() {
        for c in 0..C {
            let column = &columns[c][n * LANES..(n + 1) * LANES];
            for i in 0..LANES {
                sums[c][i] = fma(column[i], x[i], sums[c][i]);
            }
        }
    }
    let from = whole.len() * LANES;
    std::array::from_fn(|c| {
        let tail: f64 = columns[c][from..].iter().zip(rest).map(|(l, x)| l * x).sum();
        sums[c].iter().sum::<f64>() + tail
    })
}
