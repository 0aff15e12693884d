//! Sums and products of vectors whose length is known at run time.

use base::math::Vec3;

/// Three entries of a vector.
#[inline]
pub fn three(of: &[f64], at: usize) -> Vec3 {
    Vec3::new(of[at], of[at + 1], of[at + 2])
}

/// Sets three entries of a vector.
#[inline]
pub fn set_three(of: &mut [f64], at: usize, values: &Vec3) {
    of[at..at + 3].copy_from_slice(values.as_slice());
}

/// Adds to three entries of a vector.
#[inline]
pub fn add_three(of: &mut [f64], at: usize, values: &Vec3) {
    of[at..at + 3].iter_mut().zip(values.iter()).for_each(|(entry, value)| *entry += value);
}

/// The product of a square row-major matrix and a vector.
#[inline]
pub fn multiply(A: &[f64], x: &[f64], product: &mut [f64]) {
    for (entry, row) in product.iter_mut().zip(A.chunks(x.len())) {
        *entry = dot(row, x);
    }
}

/// The product of two vectors, whose sums by sixteen run side by side.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 16];
    let (mut left, mut right) = (a.chunks_exact(16), b.chunks_exact(16));
    for (a, b) in left.by_ref().zip(right.by_ref()) {
        for i in 0..16 {
            sums[i] += a[i] * b[i];
        }
    }
    let rest: f64 = left.remainder().iter().zip(right.remainder()).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// Adds a multiple of a vector to another.
#[inline]
pub fn add_multiple(of: &mut [f64], factor: f64, values: &[f64]) {
    of.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
}
