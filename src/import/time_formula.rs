//! Functions of time by formula: DEFINITION=PERIODIC, DECAY and MODULATED of `*AMPLITUDE`.

use std::f64::consts::TAU;

/// The least number of points of a table.
const POINTS: f64 = 200.0;
/// Points in a period: a chord then misses a sine by (2π/100)²/8, 5e-4 of its size.
const POINTS_OF_PERIOD: f64 = 100.0;
/// The most periods of a table.
const MOST_PERIODS: f64 = 40.0;
/// The times of decay after which less than 1e-13 is left.
const LAST_DECAY: f64 = 30.0;
/// A value jumps within this part of a step.
const JUMP: f64 = 1e-9;

/// A formula that begins at a time; before it only its constant part holds.
#[derive(Debug, Clone)]
pub struct TimeFormula {
    /// The constant part.
    constant: f64,
    /// The time when the rest begins.
    start: f64,
    rest: VaryingPart,
}

#[derive(Debug, Clone)]
enum VaryingPart {
    /// Angular frequency of the first term, and factors of the cosine and sine of each.
    Fourier(f64, Vec<[f64; 2]>),
    /// Value at the start, and the time in which it falls to its part 1/e.
    Decay(f64, f64),
    /// The product of two sines: factor, and both angular frequencies.
    Modulated(f64, [f64; 2]),
}

/// Reads the numbers of a formula; `None` where they make none.
type ReadFormula = fn(&[f64]) -> Option<TimeFormula>;

impl TimeFormula {
    /// What reads the numbers of a DEFINITION; `None` for one that is no formula.
    pub fn reader(kind: &str) -> Option<ReadFormula> {
        match kind {
            "PERIODIC" => Some(TimeFormula::periodic),
            "DECAY" => Some(TimeFormula::decay),
            "MODULATED" => Some(TimeFormula::modulated),
            _ => None,
        }
    }

    /// N, ω, t₀, A₀, then A and B of N terms.
    fn periodic(values: &[f64]) -> Option<TimeFormula> {
        let [count, omega, start, constant, terms @ ..] = values else { return None };
        let is_whole = *omega > 0.0 && terms.len() as f64 == 2.0 * count && !terms.is_empty();
        let terms = terms.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        let rest = VaryingPart::Fourier(*omega, terms);
        is_whole.then_some(TimeFormula { constant: *constant, start: *start, rest })
    }

    /// A₀, A, t₀ and the time of decay.
    fn decay(values: &[f64]) -> Option<TimeFormula> {
        let &[constant, factor, start, time] = values else { return None };
        (time > 0.0).then_some(TimeFormula { constant, start, rest: VaryingPart::Decay(factor, time) })
    }

    /// A₀, A, t₀, ω₁ and ω₂.
    fn modulated(values: &[f64]) -> Option<TimeFormula> {
        let &[constant, factor, start, a, b] = values else { return None };
        Some(TimeFormula { constant, start, rest: VaryingPart::Modulated(factor, [a, b]) })
    }

    /// The value at a time.
    pub fn at(&self, t: f64) -> f64 {
        let t = t - self.start;
        if t < 0.0 {
            return self.constant;
        }
        let of_term = |(n, [a, b]): (usize, &[f64; 2]), omega: f64| {
            let (sin, cos) = ((n + 1) as f64 * omega * t).sin_cos();
            a * cos + b * sin
        };
        self.constant
            + match &self.rest {
                VaryingPart::Fourier(omega, terms) => {
                    terms.iter().enumerate().map(|term| of_term(term, *omega)).sum::<f64>()
                }
                VaryingPart::Decay(factor, time) => factor * (-t / time).exp(),
                VaryingPart::Modulated(factor, [a, b]) => factor * (a * t).sin() * (b * t).sin(),
            }
    }

    /// The same with times from here on.
    pub fn seen_from(&self, now: f64) -> TimeFormula {
        TimeFormula { start: self.start - now, ..self.clone() }
    }

    /// True where a table over this time would have too many points.
    pub fn has_many_periods(&self, duration: f64) -> bool {
        self.frequency() * (duration - self.start.max(0.0)) > MOST_PERIODS
    }

    /// The times of a table over a time: the start and the time before it, then points by the curvature.
    pub fn times(&self, duration: f64) -> Vec<f64> {
        let from = self.start.max(0.0);
        let span = duration - from;
        if span <= 0.0 {
            return Vec::new();
        }
        let before = [from - JUMP * duration, from];
        let periods = (self.frequency() * span).min(MOST_PERIODS);
        let count = POINTS.max((POINTS_OF_PERIOD * periods).ceil());
        let parts = (1..count as u32).map(|k| f64::from(k) / count);
        // Chords miss an exponential alike where points lie as dense as the root of its second derivative.
        let at = |part: f64| match self.rest {
            VaryingPart::Decay(_, time) => {
                let least = (-0.5 * (span / time).min(LAST_DECAY)).exp();
                -2.0 * time * (1.0 - part * (1.0 - least)).ln()
            }
            _ => part * span,
        };
        let last = match self.rest {
            VaryingPart::Decay(_, time) => LAST_DECAY * time,
            _ => span,
        };
        before.into_iter().chain(parts.map(|part| from + at(part))).chain([from + last]).collect()
    }

    /// The highest frequency in it; a decay has none.
    fn frequency(&self) -> f64 {
        match &self.rest {
            VaryingPart::Fourier(omega, terms) => terms.len() as f64 * omega / TAU,
            VaryingPart::Decay(..) => 0.0,
            VaryingPart::Modulated(_, [a, b]) => (a.abs() + b.abs()) / TAU,
        }
    }

    /// Frequency, phase, scale and start of a single sine, which the deck has as it is: A cos + B sin with a phase.
    pub fn sine(&self) -> Option<[f64; 4]> {
        match &self.rest {
            VaryingPart::Fourier(omega, terms) if self.constant == 0.0 && terms.len() == 1 => {
                let [a, b] = terms[0];
                Some([omega / TAU, a.atan2(b), a.hypot(b), self.start])
            }
            _ => None,
        }
    }
}
