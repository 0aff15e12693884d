//! A growing set of long vectors with separate memory. Sums keep their order whatever the number of threads.

use rayon::prelude::*;
use std::array::from_fn;

/// Rows that are worked on together.
const CHUNK: usize = 4096;
/// Width of the partial sums of a scalar product.
const LANES: usize = 8;
/// Number of vectors read together, so that sums stay in registers. Sums are those of one after the other.
const TOGETHER: usize = 4;

/// Vectors of one length.
pub(super) struct Basis {
    length: usize,
    vectors: Vec<Vec<f64>>,
    threads: bool,
}

impl Basis {
    /// No vectors of this length.
    pub fn new(length: usize, threads: bool) -> Basis {
        Basis { length, vectors: Vec::new(), threads }
    }

    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.vectors.len()
    }

    /// The k-th vector.
    pub fn vector(&self, k: usize) -> &[f64] {
        &self.vectors[k]
    }

    /// Adds a vector, times a factor.
    pub fn push(&mut self, mut vector: Vec<f64>, factor: f64) {
        vector.iter_mut().for_each(|x| *x *= factor);
        self.vectors.push(vector);
    }

    /// The scalar product of every vector with `x`.
    pub fn products(&self, x: &[f64]) -> Vec<f64> {
        let mut products = vec![0.0; self.vectors.len()];
        let groups = |(products, vectors): (&mut [f64], &[Vec<f64>])| match <&[Vec<f64>; TOGETHER]>::try_from(vectors) {
            Ok(vectors) => products.copy_from_slice(&dots(vectors.each_ref().map(Vec::as_slice), x)),
            Err(_) => products.iter_mut().zip(vectors).for_each(|(product, vector)| *product = dot(vector, x)),
        };
        if self.threads {
            products.par_chunks_mut(TOGETHER).zip(self.vectors.par_chunks(TOGETHER)).for_each(groups);
        } else {
            products.chunks_mut(TOGETHER).zip(self.vectors.chunks(TOGETHER)).for_each(groups);
        }
        products
    }

    /// x ← x − Σ factor × vector.
    pub fn subtract(&self, factors: &[f64], x: &mut [f64]) {
        let negative: Vec<f64> = factors.iter().map(|factor| -factor).collect();
        self.add(&negative, x);
    }

    /// Σ factor × vector.
    pub fn combine(&self, factors: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.length];
        self.add(factors, &mut sum);
        sum
    }

    fn add(&self, factors: &[f64], x: &mut [f64]) {
        let rows = |(chunk, x): (usize, &mut [f64])| {
            let rows = chunk * CHUNK..chunk * CHUNK + x.len();
            add(factors, self.vectors.iter().map(|vector| &vector[rows.clone()]), x);
        };
        if self.threads {
            x.par_chunks_mut(CHUNK).enumerate().for_each(rows);
        } else {
            x.chunks_mut(CHUNK).enumerate().for_each(rows);
        }
    }

    /// Replaces the first vectors by at most as many combinations of them, given by factors. The vectors from `keep` on follow.
    pub fn replace(&mut self, combinations: &[Vec<f64>], keep: usize) {
        let kept = self.vectors.split_off(keep);
        // Rows are independent, so new vectors may overwrite the old ones.
        let first = combinations.first().map_or(0, Vec::len);
        let (mut old, mut new) = (vec![0.0; first * CHUNK], vec![0.0; combinations.len() * CHUNK]);
        for from in (0..self.length).step_by(CHUNK) {
            let rows = CHUNK.min(self.length - from);
            for (old, vector) in old.chunks_mut(rows).zip(&self.vectors[..first]) {
                old.copy_from_slice(&vector[from..from + rows]);
            }
            let old = &old;
            let combine = |(new, factors): (&mut [f64], &Vec<f64>)| {
                new.fill(0.0);
                add(factors, old.chunks(rows), new);
            };
            let new = &mut new[..combinations.len() * rows];
            if self.threads {
                new.par_chunks_mut(rows).zip(combinations).for_each(combine);
            } else {
                new.chunks_mut(rows).zip(combinations).for_each(combine);
            }
            for (new, vector) in new.chunks(rows).zip(&mut self.vectors) {
                vector[from..from + rows].copy_from_slice(new);
            }
        }
        self.vectors.truncate(combinations.len());
        self.vectors.extend(kept);
    }

    /// Hands over the first vectors, and forgets the others.
    pub fn take(&mut self, count: usize) -> impl Iterator<Item = Vec<f64>> {
        std::mem::take(&mut self.vectors).into_iter().take(count)
    }
}

/// x ← x + Σ factor × vector, summed in the order of the vectors.
fn add<'v>(factors: &[f64], mut vectors: impl Iterator<Item = &'v [f64]>, x: &mut [f64]) {
    let (groups, rest) = factors.as_chunks::<TOGETHER>();
    for f in groups {
        let v: [&[f64]; TOGETHER] = from_fn(|_| vectors.next().map_or(&[][..], |vector| &vector[..x.len()]));
        for (i, x) in x.iter_mut().enumerate() {
            *x = (((*x + f[0] * v[0][i]) + f[1] * v[1][i]) + f[2] * v[2][i]) + f[3] * v[3][i];
        }
    }
    for (factor, vector) in rest.iter().zip(vectors) {
        x.iter_mut().zip(vector).for_each(|(x, v)| *x += factor * v);
    }
}

/// The scalar products of some vectors with `x`: those of [`dot`].
fn dots(vectors: [&[f64]; TOGETHER], x: &[f64]) -> [f64; TOGETHER] {
    let mut sums = [[0.0; LANES]; TOGETHER];
    let (x, x_rest) = x.as_chunks::<LANES>();
    let v = vectors.map(|vector| &vector.as_chunks::<LANES>().0[..x.len()]);
    for (k, x) in x.iter().enumerate() {
        for (sums, v) in sums.iter_mut().zip(&v) {
            for i in 0..LANES {
                sums[i] += v[k][i] * x[i];
            }
        }
    }
    from_fn(|j| {
        let rest = vectors[j].as_chunks::<LANES>().1;
        sums[j].iter().sum::<f64>() + rest.iter().zip(x_rest).map(|(a, b)| a * b).sum::<f64>()
    })
}

/// The scalar product, summed in lanes of fixed width.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in a.iter().zip(b) {
        for i in 0..LANES {
            sums[i] += a[i] * b[i];
        }
    }
    sums.iter().sum::<f64>() + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f64>()
}

/// Numbers between −1 and 1, the same in every run.
pub(super) struct Noise(pub u64);

impl Noise {
    /// The next number.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
