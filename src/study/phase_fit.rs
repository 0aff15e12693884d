//! An error over time, split into phase and amplitude: the shift τ and the factor c by which c r(t − τ) comes nearest to a
//! history q(t), r the reference, by least squares; and what is left.
//!
//! Between samples the reference is a cubic spline. For each shift the best factor is a quotient; shifts are tried from a
//! quarter of the window back to a quarter on, and the best is refined by sections.

/// Shifts are tried half a sample apart, and where they are long by this part of them.
const APART: [f64; 2] = [0.5, 0.02];
/// The numbers of samples that the search and the refinement look at, evenly spread over more.
const LOOKED_AT: [usize; 2] = [2_000, 20_000];
/// Sections, each to 0.62 of the one before: 60 leave less than a double can tell.
const SECTIONS: usize = 60;
/// A reference that varies by less than this part of its size has no phase.
const FLAT: f64 = 1e-9;
/// The number of samples below which nothing is split.
const LEAST: usize = 8;

/// The parts of the error of a history. Errors are root mean squares over times, in the unit of the history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Split {
    /// The time by which the history is late; `None` where the reference does not vary.
    pub shift: Option<f64>,
    /// The factor on the reference; above 1 the history is larger.
    pub factor: f64,
    /// The error as it is.
    pub error: f64,
    /// The error that the shift alone makes.
    pub phase: f64,
    /// The error that the factor alone makes.
    pub amplitude: f64,
    /// The error that is left with both.
    pub rest: f64,
}

/// The second derivatives of the cubic spline through values one apart; at its ends they are differences of the values.
fn bend(r: &[f64]) -> Vec<f64> {
    let n = r.len();
    let (mut bend, mut upper) = (vec![0.0; n], vec![0.0; n]);
    let end = |a: f64, b: f64, c: f64, d: f64| 2.0 * a - 5.0 * b + 4.0 * c - d;
    (bend[0], bend[n - 1]) = (end(r[0], r[1], r[2], r[3]), end(r[n - 1], r[n - 2], r[n - 3], r[n - 4]));
    for i in 1..n - 1 {
        let pivot = 4.0 - upper[i - 1];
        upper[i] = 1.0 / pivot;
        bend[i] = (6.0 * (r[i + 1] - 2.0 * r[i] + r[i - 1]) - bend[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        bend[i] -= upper[i] * bend[i + 1];
    }
    bend
}

/// A reference between its samples.
struct Spline<'a> {
    r: &'a [f64],
    bend: Vec<f64>,
}

impl Spline<'_> {
    /// The value at a place in samples, from 0 to their number less one.
    fn at(&self, place: f64) -> f64 {
        let i = (place.floor().max(0.0) as usize).min(self.r.len() - 2);
        let (b, a) = (place - i as f64, 1.0 - (place - i as f64));
        let curved = (a * a * a - a) * self.bend[i] + (b * b * b - b) * self.bend[i + 1];
        a * self.r[i] + b * self.r[i + 1] + curved / 6.0
    }
}

/// The best factor at a shift in samples, and the mean square that is left, over samples `from` to `to`, `most` of them.
fn at_shift(q: &[f64], spline: &Spline, shift: f64, [from, to]: [usize; 2], most: usize) -> (f64, f64) {
    let samples = || (from..=to).step_by(1 + (to - from) / most);
    let (mut product, mut square) = (0.0, 0.0);
    for i in samples() {
        let r = spline.at(i as f64 - shift);
        product += q[i] * r;
        square += r * r;
    }
    let factor = if square > 0.0 { product / square } else { 1.0 };
    let rest: f64 = samples().map(|i| (q[i] - factor * spline.at(i as f64 - shift)).powi(2)).sum();
    (factor, rest / samples().count() as f64)
}

/// The samples whose place lies within the reference for all shifts between these two.
fn window(count: usize, low: f64, high: f64) -> [usize; 2] {
    let last = (count - 1) as f64;
    [high.max(0.0).ceil() as usize, (last + low.min(0.0)).floor() as usize]
}

/// The best of the shifts that are tried, up to a quarter of the window both ways, in samples.
fn best_try(q: &[f64], spline: &Spline, size: f64) -> f64 {
    let most = (q.len() / 4) as f64;
    let late = std::iter::successors(Some(0.0), |shift| Some(shift + APART[0].max(APART[1] * shift)));
    let tries = late.take_while(|shift| *shift <= most).flat_map(|shift| [shift, -shift]);
    let left = |shift: f64| match at_shift(q, spline, shift, window(q.len(), shift, shift), LOOKED_AT[0]) {
        // A negative factor is a shift of half a period in other words.
        (factor, rest) if factor > 0.0 => rest,
        _ => f64::MAX,
    };
    // Of shifts that leave the same, as over several periods, the least.
    let worth = |shift: f64| left(shift) + 1e-12 * size * size * shift.abs();
    tries.map(|shift| (worth(shift), shift)).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, shift)| shift)
}

/// Splits the error of a history against a reference at the same times, `interval` apart. It is `None` where the reference is zero
/// throughout, or the samples are too few.
pub fn split(q: &[f64], r: &[f64], interval: f64) -> Option<Split> {
    let n = r.len();
    let rms = |of: &dyn Fn(usize) -> f64| ((0..n).map(|i| of(i).powi(2)).sum::<f64>() / n as f64).sqrt();
    let size = rms(&|i| r[i]);
    if n < LEAST || size == 0.0 || size.is_nan() {
        return None;
    }
    let error = rms(&|i| q[i] - r[i]);
    let mean = r.iter().sum::<f64>() / n as f64;
    let spline = Spline { r, bend: bend(r) };
    let all = [0, n - 1];
    if rms(&|i| r[i] - mean) < FLAT * size {
        let (factor, rest) = at_shift(q, &spline, 0.0, all, n);
        let amplitude = (factor - 1.0).abs() * size;
        return Some(Split { shift: None, factor, error, phase: 0.0, amplitude, rest: rest.sqrt() });
    }
    let best = best_try(q, &spline, size);
    let apart = APART[0].max(APART[1] * best.abs());
    let (mut low, mut high) = (best - apart, best + apart);
    // The same samples at all shifts: what is left must not jump.
    let samples = window(n, low, high);
    let left = |shift: f64| at_shift(q, &spline, shift, samples, LOOKED_AT[1]).1;
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - ratio * (high - low), low + ratio * (high - low));
    let (mut of_a, mut of_b) = (left(a), left(b));
    for _ in 0..SECTIONS {
        if of_a < of_b {
            (high, b, of_b) = (b, a, of_a);
            a = high - ratio * (high - low);
            of_a = left(a);
        } else {
            (low, a, of_a) = (a, b, of_b);
            b = low + ratio * (high - low);
            of_b = left(b);
        }
    }
    let shift = 0.5 * (low + high);
    let (factor, rest) = at_shift(q, &spline, shift, samples, LOOKED_AT[1]);
    let [from, to] = samples;
    let moved: f64 = (from..=to).map(|i| (spline.at(i as f64 - shift) - r[i]).powi(2)).sum();
    let phase = (moved / (to + 1 - from) as f64).sqrt();
    let amplitude = (factor - 1.0).abs() * size;
    Some(Split { shift: Some(shift * interval), factor, error, phase, amplitude, rest: rest.sqrt() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..=200).map(|k| of(0.01 * f64::from(k))).collect()
    }

    #[test]
    fn a_shift_and_a_factor_come_out_as_they_were_put_in() {
        // Two periods and a bit, of 90 samples each: the spline is off by some (2π/90)⁴/384 = 6e-8.
        let motion = |t: f64| (7.0 * t).sin() + 0.3 * (11.0 * t).cos();
        let r = history(motion);
        for (shift, factor) in [(0.0, 1.0), (0.013, 0.97), (-0.0021, 1.2), (0.1234, 1.0), (1e-6, 1.0 + 1e-6)] {
            let split = split(&history(|t| factor * motion(t - shift)), &r, 0.01).unwrap();
            assert!((split.shift.unwrap() - shift).abs() < 1e-6, "{shift}: {split:?}");
            assert!((split.factor - factor).abs() < 2e-6, "{factor}: {split:?}");
            assert!(split.rest < 2e-6, "{split:?}");
        }
    }

    #[test]
    fn parts_are_those_of_shift_and_factor_alone() {
        let r = history(|t| (7.0 * t).sin());
        let late = split(&history(|t| (7.0 * (t - 0.01)).sin()), &r, 0.01).unwrap();
        // Nearly all of the error is phase; sums go over a sample less at each end.
        assert!((late.phase / late.error - 1.0).abs() < 0.02 && late.amplitude < 1e-5, "{late:?}");
        let large = split(&history(|t| 1.01 * (7.0 * t).sin()), &r, 0.01).unwrap();
        assert!((large.amplitude / large.error - 1.0).abs() < 1e-3 && large.phase < 1e-5, "{large:?}");
        // What neither explains is left: a vibration of another frequency, 1e-3/√2 of it.
        let noisy = split(&history(|t| (7.0 * t).sin() + 1e-3 * (60.0 * t).sin()), &r, 0.01).unwrap();
        assert!((noisy.rest / (1e-3 / 2f64.sqrt()) - 1.0).abs() < 0.05, "{noisy:?}");
    }

    #[test]
    fn what_does_not_vary_has_no_phase() {
        let flat = split(&history(|_| 1.1), &history(|_| 1.0), 0.01).unwrap();
        assert!(flat.shift.is_none() && (flat.factor - 1.1).abs() < 1e-12 && flat.rest < 1e-12, "{flat:?}");
        assert_eq!(split(&history(|_| 1.0), &history(|_| 0.0), 0.01), None);
        assert_eq!(split(&[1.0; 4], &[1.0; 4], 0.01), None);
    }
}
