//! A growing set of long vectors, one after the other in memory. Sums keep their order whatever the number of threads.

use rayon::prelude::*;

/// Rows that are worked on together.
const CHUNK: usize = 4096;
/// Width of the partial sums of a scalar product.
const LANES: usize = 8;

/// Vectors of one length.
pub(super) struct Basis {
    length: usize,
    vectors: Vec<f64>,
    threads: bool,
}

impl Basis {
    /// No vectors of this length, with room for some.
    pub fn new(length: usize, room: usize, threads: bool) -> Basis {
        Basis { length, vectors: Vec::with_capacity(length * room), threads }
    }

    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.vectors.len() / self.length.max(1)
    }

    /// The k-th vector.
    pub fn vector(&self, k: usize) -> &[f64] {
        &self.vectors[k * self.length..(k + 1) * self.length]
    }

    /// Adds a vector, times a factor.
    pub fn push(&mut self, vector: &[f64], factor: f64) {
        self.vectors.extend(vector.iter().map(|x| factor * x));
    }

    /// The scalar product of every vector with `x`.
    pub fn products(&self, x: &[f64]) -> Vec<f64> {
        if self.threads {
            return self.vectors.par_chunks(self.length.max(1)).map(|vector| dot(vector, x)).collect();
        }
        self.vectors.chunks(self.length.max(1)).map(|vector| dot(vector, x)).collect()
    }

    /// x ← x − Σ factor × vector.
    pub fn subtract(&self, factors: &[f64], x: &mut [f64]) {
        let rows = |(chunk, x): (usize, &mut [f64])| {
            for (k, factor) in factors.iter().enumerate() {
                let from = k * self.length + chunk * CHUNK;
                let vector = &self.vectors[from..from + x.len()];
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

    /// Replaces the vectors by combinations of the first of them, each given by its factors, followed by the vectors from
    /// `keep` on.
    pub fn replace(&mut self, combinations: &[Vec<f64>], keep: usize) {
        let (length, count) = (self.length, combinations.len());
        let kept = self.vectors.split_off(keep * length);
        // Rows are independent of each other, so that the new vectors may stand where the old ones did.
        let first = combinations.first().map_or(0, Vec::len);
        let (mut old, mut new) = (vec![0.0; first * CHUNK], vec![0.0; count * CHUNK]);
        for from in (0..length).step_by(CHUNK) {
            let rows = CHUNK.min(length - from);
            for k in 0..first {
                let at = k * length + from;
                old[k * rows..(k + 1) * rows].copy_from_slice(&self.vectors[at..at + rows]);
            }
            let old = &old;
            let combine = |(new, factors): (&mut [f64], &Vec<f64>)| {
                new.fill(0.0);
                for (factor, old) in factors.iter().zip(old.chunks(rows)) {
                    new.iter_mut().zip(old).for_each(|(new, old)| *new += factor * old);
                }
            };
            let new = &mut new[..count * rows];
            if self.threads {
                new.par_chunks_mut(rows).zip(combinations).for_each(combine);
            } else {
                new.chunks_mut(rows).zip(combinations).for_each(combine);
            }
            for (k, new) in new.chunks(rows).enumerate() {
                let at = k * length + from;
                self.vectors[at..at + rows].copy_from_slice(new);
            }
        }
        self.vectors.truncate(count * length);
        self.vectors.extend(kept);
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
