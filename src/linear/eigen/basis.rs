//! A growing set of long vectors, each with memory of its own. Sums keep their order whatever the number of threads.

use rayon::prelude::*;

/// Rows that are worked on together.
const CHUNK: usize = 4096;
/// Width of the partial sums of a scalar product.
const LANES: usize = 8;

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
        if self.threads {
            return self.vectors.par_iter().map(|vector| dot(vector, x)).collect();
        }
        self.vectors.iter().map(|vector| dot(vector, x)).collect()
    }

    /// x ← x − Σ factor × vector.
    pub fn subtract(&self, factors: &[f64], x: &mut [f64]) {
        let rows = |(chunk, x): (usize, &mut [f64])| {
            for (factor, vector) in factors.iter().zip(&self.vectors) {
                let vector = &vector[chunk * CHUNK..][..x.len()];
                x.iter_mut().zip(vector).for_each(|(x, v)| *x -= factor * v);
            }
        };
        if self.threads {
            x.par_chunks_mut(CHUNK).enumerate().for_each(rows);
        } else {
            x.chunks_mut(CHUNK).enumerate().for_each(rows);
        }
    }

    /// Σ factor × vector.
    pub fn combine(&self, factors: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.length];
        let negative: Vec<f64> = factors.iter().map(|factor| -factor).collect();
        self.subtract(&negative, &mut sum);
        sum
    }

    /// Replaces the vectors by combinations of the first of them, not more of these than there are, each given by its factors, followed by
    /// the vectors from `keep` on.
    pub fn replace(&mut self, combinations: &[Vec<f64>], keep: usize) {
        let kept = self.vectors.split_off(keep);
        // Rows are independent of each other, so that the new vectors may stand where the old ones did.
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
                for (factor, old) in factors.iter().zip(old.chunks(rows)) {
                    new.iter_mut().zip(old).for_each(|(new, old)| *new += factor * old);
                }
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
