//! Low-pass filters without phase: channel frequency classes of SAE J211, and Butterworth's.
//!
//! A filter runs forwards and backwards over values at even times, as cascade of sections of second order by the bilinear transform. Values
//! are continued beyond both ends by their odd reflection, and sections begin in the steady state of the first value.

use base::names::short;
use std::f64::consts::{PI, SQRT_2};
use std::str::FromStr;

/// Cutoff frequency of one pass over the number of a channel frequency class, in Hz (SAE J211-1, appendix C).
const CFC_CUTOFF: f64 = 2.0775;
/// Samples per second over the number of a class that SAE J211-1 asks for at least.
const CFC_RATE: f64 = 10.0;
/// The largest order.
const MOST_ORDER: usize = 10;
/// Periods of the cutoff frequency by which values are continued at both ends.
const CONTINUED: f64 = 3.0;
/// Differences of times below this part of the step are those of written digits.
const EVEN: f64 = 1e-6;
/// Samples at most, as a multiple of the rows, where rows are uneven.
const DENSER: usize = 8;

/// A low-pass filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LowPass {
    /// A channel frequency class, by its number.
    Cfc(f64),
    /// Butterworth's of one pass, which damps the cutoff frequency by √2; both passes by 2.
    Butterworth {
        /// The order of one pass.
        order: usize,
        /// Cycles per unit of time.
        cutoff: f64,
    },
}

impl FromStr for LowPass {
    type Err = String;

    fn from_str(word: &str) -> Result<LowPass, String> {
        let positive = |text: &str| text.parse::<f64>().ok().filter(|number| *number > 0.0 && number.is_finite());
        let lower = word.to_ascii_lowercase();
        let made = match lower.split(':').collect::<Vec<_>>()[..] {
            [class] => class.strip_prefix("cfc").and_then(positive).map(LowPass::Cfc),
            ["cfc", class] => positive(class).map(LowPass::Cfc),
            ["butterworth", cutoff] => positive(cutoff).map(|cutoff| LowPass::Butterworth { order: 2, cutoff }),
            ["butterworth", cutoff, order] => {
                let order = order.parse().ok().filter(|order| (1..=MOST_ORDER).contains(order));
                positive(cutoff).zip(order).map(|(cutoff, order)| LowPass::Butterworth { order, cutoff })
            }
            _ => None,
        };
        made.ok_or_else(|| {
            format!("write `cfc60`, `butterworth:100` or `butterworth:100:4`: cutoff frequency, and order up to {MOST_ORDER}")
        })
    }
}

/// A section of second order: y = b₀ x + b₁ x₋₁ + b₂ x₋₂ − a₁ y₋₁ − a₂ y₋₂, with y = x of a constant.
#[derive(Debug, Clone, Copy)]
struct Biquad {
    b: [f64; 3],
    a: [f64; 2],
}

impl Biquad {
    /// Filters values in place.
    fn run(&self, values: &mut [f64]) {
        let Biquad { b: [b0, b1, b2], a: [a1, a2] } = *self;
        let Some(&first) = values.first() else { return };
        let [mut z1, mut z2] = [(1.0 - b0) * first, (b2 - a2) * first];
        for value in values {
            let x = *value;
            let y = b0 * x + z1;
            z1 = b1 * x - a1 * y + z2;
            z2 = b2 * x - a2 * y;
            *value = y;
        }
    }
}

/// Even times at which values are filtered.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeSampling {
    begin: f64,
    /// The time between two samples.
    pub step: f64,
    count: usize,
    is_even: bool,
}

impl TimeSampling {
    /// The samples for rows at these times: the rows themselves where they are even, otherwise steps as long as their shortest.
    ///
    /// # Errors
    /// There are too few rows, or time does not grow, in words.
    pub fn of(times: &[f64]) -> Result<TimeSampling, String> {
        let (Some(first), Some(last)) = (times.first(), times.last()) else {
            return Err("there are no rows".to_owned());
        };
        let apart = || times.windows(2).map(|pair| pair[1] - pair[0]);
        if apart().any(|step| step < 0.0) {
            return Err("time falls in these rows, and a filter needs time that grows".to_owned());
        }
        if times.len() < 4 || last <= first {
            return Err(format!("there are {} rows, and a filter needs at least 4", times.len()));
        }
        let mean = (last - first) / (times.len() - 1) as f64;
        if apart().all(|step| (step - mean).abs() <= EVEN * mean) {
            return Ok(TimeSampling { begin: *first, step: mean, count: times.len(), is_even: true });
        }
        let least = apart().filter(|step| *step > EVEN * mean).fold(f64::INFINITY, f64::min);
        let count = 1 + (((last - first) / least).round() as usize).clamp(3, DENSER * times.len());
        Ok(TimeSampling { begin: *first, step: (last - first) / (count - 1) as f64, count, is_even: false })
    }

    /// The times of the samples.
    pub fn times(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.count).map(|k| self.begin + self.step * k as f64)
    }

    /// Values at the samples, linear between rows; of rows at one time the last counts.
    fn sampled(&self, times: &[f64], values: &[f64]) -> Vec<f64> {
        if self.is_even {
            return values.to_vec();
        }
        self.times().map(|time| between(times, values, time)).collect()
    }

    /// Values at the times of rows, linear between samples.
    pub fn at_rows(&self, samples: &[f64], times: &[f64]) -> Vec<f64> {
        if self.is_even {
            return samples.to_vec();
        }
        let own: Vec<f64> = self.times().collect();
        times.iter().map(|time| between(&own, samples, *time)).collect()
    }
}

/// The value at a time, linear between rows.
fn between(times: &[f64], values: &[f64], time: f64) -> f64 {
    let next = times.partition_point(|other| *other <= time).clamp(1, times.len() - 1);
    let (a, b) = (times[next - 1], times[next]);
    let part = if b > a { ((time - a) / (b - a)).clamp(0.0, 1.0) } else { 1.0 };
    values[next - 1] + part * (values[next] - values[next - 1])
}

impl LowPass {
    /// The name in words: "CFC 60".
    pub fn name(&self) -> String {
        match self {
            LowPass::Cfc(class) => format!("CFC {}", short(*class)),
            LowPass::Butterworth { order, cutoff } => {
                format!("Butterworth of order {order}, cutoff frequency {}, forwards and backwards", short(*cutoff))
            }
        }
    }

    /// The order and the cutoff frequency of one pass, of times in units of so many seconds.
    fn pass(&self, second: f64) -> (usize, f64) {
        match *self {
            LowPass::Cfc(class) => (2, CFC_CUTOFF * class * second),
            LowPass::Butterworth { order, cutoff } => (order, cutoff),
        }
    }

    /// Says of samples that lie too far apart for the class.
    pub fn doubt(&self, step: f64, second: f64) -> Option<String> {
        let LowPass::Cfc(class) = *self else { return None };
        let most = 1.0 / (CFC_RATE * class * second);
        (step > most * (1.0 + EVEN)).then(|| {
            format!(
                "rows are {} apart, and SAE J211 asks for {} or less with CFC {}",
                short(step),
                short(most),
                short(class)
            )
        })
    }

    /// Filters values at the times of rows, of which `sampling` has been made; the unit of time is so many seconds. Returns the values at
    /// its samples.
    ///
    /// # Errors
    /// The rows do not hold frequencies as high as the cutoff, in words.
    pub fn apply(
        &self,
        sampling: &TimeSampling,
        second: f64,
        times: &[f64],
        values: &[f64],
    ) -> Result<Vec<f64>, String> {
        let (order, cutoff) = self.pass(second);
        let nyquist = 0.5 / sampling.step;
        if cutoff >= nyquist {
            return Err(format!(
                "rows are {} apart and hold frequencies up to {}, below the cutoff frequency {}: let `[output]` write more rows",
                short(sampling.step),
                short(nyquist),
                short(cutoff)
            ));
        }
        let sections = sections(order, (PI * cutoff * sampling.step).tan());
        let values = sampling.sampled(times, values);
        let beyond = ((CONTINUED / (cutoff * sampling.step)).ceil() as usize).min(values.len() - 1);
        Ok(both_ways(&sections, &values, beyond))
    }
}

/// The sections of Butterworth's filter, with k = tan(π f Δt).
fn sections(order: usize, k: f64) -> Vec<Biquad> {
    let pair = |index: usize| {
        // Twice the sine is √2 of the second order.
        let damping = if order == 2 { SQRT_2 } else { 2.0 * (PI * (2 * index + 1) as f64 / (2 * order) as f64).sin() };
        let norm = 1.0 / (1.0 + damping * k + k * k);
        let b = k * k * norm;
        Biquad { b: [b, 2.0 * b, b], a: [2.0 * (k * k - 1.0) * norm, (1.0 - damping * k + k * k) * norm] }
    };
    let single = Biquad { b: [k / (1.0 + k), k / (1.0 + k), 0.0], a: [(k - 1.0) / (k + 1.0), 0.0] };
    (0..order / 2).map(pair).chain((order % 2 == 1).then_some(single)).collect()
}

/// Runs forwards, then backwards, over values that are continued by so many at both ends.
fn both_ways(sections: &[Biquad], values: &[f64], beyond: usize) -> Vec<f64> {
    let last = values.len() - 1;
    let before = (1..=beyond).rev().map(|k| 2.0 * values[0] - values[k]);
    let after = (1..=beyond).map(|k| 2.0 * values[last] - values[last - k]);
    let mut all: Vec<f64> = before.chain(values.iter().copied()).chain(after).collect();
    for _ in 0..2 {
        sections.iter().for_each(|section| section.run(&mut all));
        all.reverse();
    }
    all.drain(..beyond);
    all.truncate(values.len());
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const STEP: f64 = 1e-3;

    /// Two oscillations and a jump.
    fn signal() -> [Vec<f64>; 2] {
        let times: Vec<f64> = (0..60).map(|k| k as f64 * STEP).collect();
        let jump = |k: usize| if k > 30 { 1.0 } else { 0.0 };
        let value = |(k, t): (usize, &f64)| (TAU * 20.0 * t).sin() + 0.5 * (TAU * 180.0 * t).cos() + jump(k);
        let values = times.iter().enumerate().map(value).collect();
        [times, values]
    }

    /// Values of scipy.signal.sosfiltfilt(butter(order, f, fs=1000, output="sos"), x, padtype="odd", padlen=ceil(3/(f dt))) of SciPy 1.17.
    #[test]
    fn filters_are_those_of_scipy() {
        let places = [0, 7, 29, 31, 45, 59];
        let known: [(&str, [f64; 6]); 3] = [
            (
                "cfc60",
                [
                    0.49999984685535104,
                    0.7651465146645327,
                    -0.3208711277591704,
                    -0.11897286828915099,
                    0.4742936255837683,
                    1.5403424438651587,
                ],
            ),
            (
                "butterworth:100",
                [
                    0.4999997189083481,
                    0.7476082044287762,
                    -0.27208037647880656,
                    -0.10463188044445143,
                    0.43774135641257533,
                    1.5403425097020127,
                ],
            ),
            (
                "butterworth:80:5",
                [
                    0.4998173219853196,
                    0.6910579097612488,
                    -0.21662535757144816,
                    -0.10684400731277678,
                    0.3750897772597743,
                    1.5403363523536686,
                ],
            ),
        ];
        let [times, values] = signal();
        let sampling = TimeSampling::of(&times).unwrap();
        for (word, expected) in known {
            let filtered = word.parse::<LowPass>().unwrap().apply(&sampling, 1.0, &times, &values).unwrap();
            for (place, expected) in places.into_iter().zip(expected) {
                // Both sum some hundred terms of size 1.
                assert!((filtered[place] - expected).abs() < 1e-12, "{word} {place}: {}", filtered[place]);
            }
        }
    }

    /// The coefficients of SAE J211-1, appendix C, for CFC 60 at 1000 samples a second, by its own formulas.
    #[test]
    fn coefficients_of_a_class_are_those_of_the_standard() {
        let wd = TAU * 60.0 * 2.0775;
        let wa = (wd * STEP / 2.0).sin() / (wd * STEP / 2.0).cos();
        let norm = 1.0 + 2.0_f64.sqrt() * wa + wa * wa;
        let (a0, b1) = (wa * wa / norm, -2.0 * (wa * wa - 1.0) / norm);
        let b2 = (-1.0 + 2.0_f64.sqrt() * wa - wa * wa) / norm;
        let (order, cutoff) = LowPass::Cfc(60.0).pass(1.0);
        let [Biquad { b, a }] = sections(order, (PI * cutoff * STEP).tan())[..] else { panic!("one section") };
        for (own, known) in b.into_iter().chain(a).zip([a0, 2.0 * a0, a0, -b1, -b2]) {
            assert!((own - known).abs() < 1e-15, "{own} {known}");
        }
        // In milliseconds the same filter has a cutoff a thousand times smaller.
        assert_eq!(LowPass::Cfc(60.0).pass(1e-3).1, 1e-3 * cutoff);
    }

    /// A constant passes unchanged at uneven times, and rows that are too far apart are refused or doubted.
    #[test]
    fn constants_pass_and_coarse_rows_do_not() {
        let times = [0.0, 0.001, 0.002, 0.0025, 0.004, 0.004, 0.005];
        let values = times.map(|_| 3.0);
        let sampling = TimeSampling::of(&times).unwrap();
        let filtered = LowPass::Cfc(60.0).apply(&sampling, 1.0, &times, &values).unwrap();
        assert!(filtered.len() == 11 && filtered.iter().all(|value| (value - 3.0).abs() < 1e-12), "{filtered:?}");
        assert!(sampling.at_rows(&filtered, &times).iter().zip(&values).all(|(a, b)| (a - b).abs() < 1e-12));
        let coarse: Vec<f64> = (0..10).map(|k| 0.01 * k as f64).collect();
        let refused = LowPass::Cfc(60.0).apply(&TimeSampling::of(&coarse).unwrap(), 1.0, &coarse, &coarse);
        assert!(refused.unwrap_err().contains("hold frequencies up to 50"));
        assert!(LowPass::Cfc(60.0).doubt(0.01, 1.0).unwrap().contains("0.001667"));
        assert!(LowPass::Cfc(60.0).doubt(1.6e-3, 1.0).is_none());
        assert!(TimeSampling::of(&[0.0, 1.0, 0.5, 2.0]).unwrap_err().contains("falls"));
        for word in ["cfc", "cfc0", "butterworth", "butterworth:5:0", "butterworth:5:11", "bessel:5"] {
            assert!(word.parse::<LowPass>().is_err(), "{word}");
        }
    }
}
