//! Functions of time for loads and prescribed motions, with exact derivatives and integrals.
//!
//! Prescribed motion needs all of them: an amplitude may be a displacement, a velocity or an acceleration, and the other
//! two follow. At a kink or a jump derivatives have two limits; the impulse of a jump's derivative is left out.

use base::math::cubic_curve::CubicCurve;
use std::f64::consts::PI;

/// The side of a jump or a kink on which a value is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Limit from earlier times, for a step that ends there.
    Before,
    /// Limit from later times, for a step that starts there.
    After,
}

/// A factor over time. `start` and `end` bound where it acts; `end` may be infinite.
#[derive(Debug, Clone, PartialEq)]
pub enum Amplitude {
    /// Straight lines through (time, value), constant beyond the ends; times do not fall, and equal times are a jump.
    Table(StraightLines),
    /// Cubics through (time, value), constant beyond the ends; equal times are a jump.
    Curve(CubicCurve),
    /// sin(ω (t − start) + phase) from start to end, 0 outside.
    Sine {
        /// ω, in radians per time.
        angular_frequency: f64,
        /// The phase at the start, in radians.
        phase: f64,
        /// Start time.
        start: f64,
        /// End time.
        end: f64,
    },
    /// sin²(ω (t − start)) from start to end, 0 outside.
    SineSquared {
        /// ω, in radians per time.
        angular_frequency: f64,
        /// Start time.
        start: f64,
        /// End time.
        end: f64,
    },
    /// From 0 at start to 1 at end, then 1.
    Ramp {
        /// Start time.
        start: f64,
        /// Time of the value 1.
        end: f64,
    },
    /// 1 for start ≤ t < end, 0 outside.
    Step {
        /// Time of the jump to 1.
        start: f64,
        /// Time of the return to 0.
        end: f64,
    },
    /// 1.
    Constant,
    /// cos(ω t + phase) at each frequency ω of a frequency response; 0 over time, which has no such frequency.
    Harmonic {
        /// The phase, in radians.
        phase: f64,
    },
}

/// Straight lines through points, with their integrals up to each of them.
#[derive(Debug, Clone, PartialEq)]
pub struct StraightLines {
    points: Vec<[f64; 2]>,
    /// A first integral of the value and a first integral of that, at each point; zero at the first.
    integrals: Vec<[f64; 2]>,
}

impl StraightLines {
    /// The table of these points (time, value), whose times do not fall.
    pub fn new(points: Vec<[f64; 2]>) -> StraightLines {
        let mut integrals = Vec::with_capacity(points.len());
        let mut sums = [0.0; 2];
        for (k, point) in points.iter().enumerate() {
            if k > 0 {
                sums = integrals_along(points[k - 1], *point, sums, point[0]);
            }
            integrals.push(sums);
        }
        StraightLines { points, integrals }
    }

    /// The points (time, value), by time.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }
}

/// Both integrals at a time on the line from `a` to `b`, from those at `a`; unchanged on a jump.
fn integrals_along(a: [f64; 2], b: [f64; 2], [first, second]: [f64; 2], t: f64) -> [f64; 2] {
    if a[0] >= b[0] {
        return [first, second];
    }
    let (u, k) = (t - a[0], slope(a, b));
    [first + u * (a[1] + 0.5 * u * k), second + u * (first + u * (0.5 * a[1] + u * k / 6.0))]
}

/// Time of a jump of an amplitude, with the values on both sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// The time of the jump.
    pub time: f64,
    /// The limit of the value from earlier times.
    pub before: f64,
    /// The limit of the value from later times.
    pub after: f64,
}

impl Jump {
    /// True for a jump above rounding; a sine cut at its zero jumps by rounding only.
    fn is_felt(&self) -> bool {
        self.time.is_finite() && (self.after - self.before).abs() > 1e-12
    }
}

impl Amplitude {
    /// The points (time, value) of a table, by time; `None` for other functions.
    pub fn points(&self) -> Option<&[[f64; 2]]> {
        match self {
            Amplitude::Table(table) => Some(table.points()),
            Amplitude::Curve(curve) => Some(curve.points()),
            _ => None,
        }
    }

    /// Phase in radians of the excitation of a frequency response; `None` for functions of time.
    pub fn harmonic_phase(&self) -> Option<f64> {
        match self {
            Amplitude::Harmonic { phase } => Some(*phase),
            _ => None,
        }
    }

    /// Where the value jumps, in order of time.
    pub fn jumps(&self) -> Vec<Jump> {
        let at = |time: f64, before: f64, after: f64| Jump { time, before, after };
        if let Some(points) = self.points() {
            let pairs = points.windows(2).filter(|p| p[0][0] == p[1][0]);
            return pairs.map(|p| at(p[0][0], p[0][1], p[1][1])).filter(Jump::is_felt).collect();
        }
        let all = match *self {
            Amplitude::Sine { start, end, .. } | Amplitude::SineSquared { start, end, .. } => {
                vec![at(start, 0.0, self.value(start)), at(end, self.value(end), 0.0)]
            }
            Amplitude::Step { start, end } => vec![at(start, 0.0, 1.0), at(end, 1.0, 0.0)],
            Amplitude::Ramp { start, end } if start == end => vec![at(start, 0.0, 1.0)],
            _ => Vec::new(),
        };
        all.into_iter().filter(Jump::is_felt).collect()
    }

    /// This function shifted to later times.
    #[must_use]
    pub fn later(self, by: f64) -> Amplitude {
        match self {
            Amplitude::Table(table) => {
                let points = table.points.into_iter().map(|[time, value]| [time + by, value]).collect();
                Amplitude::Table(StraightLines::new(points))
            }
            Amplitude::Curve(curve) => Amplitude::Curve(curve.later(by)),
            Amplitude::Sine { angular_frequency, phase, start, end } => {
                Amplitude::Sine { angular_frequency, phase, start: start + by, end: end + by }
            }
            Amplitude::SineSquared { angular_frequency, start, end } => {
                Amplitude::SineSquared { angular_frequency, start: start + by, end: end + by }
            }
            Amplitude::Ramp { start, end } => Amplitude::Ramp { start: start + by, end: end + by },
            Amplitude::Step { start, end } => Amplitude::Step { start: start + by, end: end + by },
            Amplitude::Constant | Amplitude::Harmonic { .. } => self,
        }
    }

    /// Times of possible jumps of value or slope.
    pub fn kinks(&self) -> Vec<f64> {
        let all = match *self {
            Amplitude::Table(StraightLines { ref points, .. }) => points.iter().map(|point| point[0]).collect(),
            Amplitude::Curve(ref curve) => curve.breaks().collect(),
            Amplitude::Sine { start, end, .. }
            | Amplitude::SineSquared { start, end, .. }
            | Amplitude::Ramp { start, end }
            | Amplitude::Step { start, end } => vec![start, end],
            Amplitude::Constant | Amplitude::Harmonic { .. } => Vec::new(),
        };
        all.into_iter().filter(|time| time.is_finite()).collect()
    }

    /// First extremum between 0 and `end`. Jumps are left out.
    pub fn turn(&self, end: f64) -> Option<f64> {
        // First zero of the rate within the sine; a zero within rounding of an end does not count.
        let inside = |from: f64, to: f64, zero: &dyn Fn(f64) -> f64, spacing: f64| {
            let (low, high) = (from.max(0.0), to.min(end));
            let slack = 1e-9 * end;
            let k = ((low + slack - zero(0.0)) / spacing).ceil();
            let t = zero(k);
            (t.is_finite() && t < high - slack).then_some(t)
        };
        match *self {
            Amplitude::Table(StraightLines { ref points, .. }) => {
                let mut way = 0.0;
                points.windows(2).filter(|p| p[1][0] > 0.0 && p[0][0] < end && p[0][0] < p[1][0]).find_map(|p| {
                    let rise = p[1][1] - p[0][1];
                    let turned = rise * way < 0.0;
                    way = if rise == 0.0 { way } else { rise.signum() };
                    turned.then_some(p[0][0])
                })
            }
            Amplitude::Curve(ref curve) => curve.turn(0.0).filter(|turn| *turn < end),
            Amplitude::Sine { angular_frequency: w, phase, start, end } => {
                let side = w.signum();
                inside(start, end, &|k| start + ((k + 0.5) * PI - phase * side) / w.abs(), PI / w.abs())
            }
            Amplitude::SineSquared { angular_frequency: w, start, end } => {
                inside(start, end, &|k| start + 0.5 * k * PI / w.abs(), 0.5 * PI / w.abs())
            }
            Amplitude::Ramp { .. } | Amplitude::Step { .. } | Amplitude::Constant | Amplitude::Harmonic { .. } => None,
        }
    }

    /// Time from t = 0 during which the value is constant; infinite if always.
    pub fn rest(&self) -> f64 {
        if let Some(points) = self.points() {
            let change = points.windows(2).find(|p| p[1][0] > 0.0 && p[0][1] != p[1][1]);
            return change.map_or(f64::INFINITY, |p| p[0][0].max(0.0));
        }
        match *self {
            Amplitude::Sine { angular_frequency: w, start, end, .. }
            | Amplitude::SineSquared { angular_frequency: w, start, end }
                if w != 0.0 && end > 0.0 =>
            {
                start.max(0.0)
            }
            Amplitude::Ramp { start, end } | Amplitude::Step { start, end } if end > 0.0 => start.max(0.0),
            _ => f64::INFINITY,
        }
    }

    /// Where a table begins; others are given at all times.
    pub fn begin(&self) -> f64 {
        self.points().and_then(<[_]>::first).map_or(0.0, |point| point[0])
    }

    /// The factor at a time. At a jump it is the value from later times, except at the end of a sine.
    pub fn value(&self, t: f64) -> f64 {
        match *self {
            Amplitude::Table(StraightLines { ref points, .. }) => match around(points, t) {
                (Some(a), Some(b)) => a[1] + slope(a, b) * (t - a[0]),
                (Some(p), None) | (None, Some(p)) => p[1],
                (None, None) => 0.0,
            },
            Amplitude::Curve(ref curve) => curve.value(t),
            Amplitude::Sine { angular_frequency: w, phase, start, end } if start <= t && t <= end => {
                (w * (t - start) + phase).sin()
            }
            Amplitude::SineSquared { angular_frequency: w, start, end } if start <= t && t <= end => {
                (w * (t - start)).sin().powi(2)
            }
            Amplitude::Sine { .. } | Amplitude::SineSquared { .. } => 0.0,
            Amplitude::Ramp { start, end } if start <= t && t < end => (t - start) / (end - start),
            Amplitude::Ramp { end, .. } => f64::from(t >= end),
            Amplitude::Step { start, end } => f64::from(start <= t && t < end),
            Amplitude::Constant => 1.0,
            Amplitude::Harmonic { .. } => 0.0,
        }
    }

    /// First derivative; at a kink the limit of a side.
    pub fn rate(&self, t: f64, side: Side) -> f64 {
        match *self {
            Amplitude::Table(StraightLines { ref points, .. }) => match beside(points, t, side) {
                (Some(a), Some(b)) => slope(a, b),
                _ => 0.0,
            },
            Amplitude::Curve(ref curve) => curve.rates(t, side == Side::Before)[0],
            Amplitude::Sine { angular_frequency: w, phase, start, end } if lies_in([start, end], t, side) => {
                w * (w * (t - start) + phase).cos()
            }
            Amplitude::SineSquared { angular_frequency: w, start, end } if lies_in([start, end], t, side) => {
                w * (2.0 * w * (t - start)).sin()
            }
            Amplitude::Ramp { start, end } if lies_in([start, end], t, side) => 1.0 / (end - start),
            _ => 0.0,
        }
    }

    /// Second derivative; where it jumps the limit of a side.
    pub fn second_rate(&self, t: f64, side: Side) -> f64 {
        match *self {
            Amplitude::Curve(ref curve) => curve.rates(t, side == Side::Before)[1],
            Amplitude::Sine { angular_frequency: w, phase, start, end } if lies_in([start, end], t, side) => {
                -w * w * (w * (t - start) + phase).sin()
            }
            Amplitude::SineSquared { angular_frequency: w, start, end } if lies_in([start, end], t, side) => {
                2.0 * w * w * (2.0 * w * (t - start)).cos()
            }
            _ => 0.0,
        }
    }

    /// The nearest kink within `slack` of a time, or that time.
    pub fn snapped(&self, t: f64, slack: f64) -> f64 {
        let near = |kink: f64| (kink - t).abs() <= slack;
        if let Some(points) = self.points() {
            let (before, after) = around(points, t);
            return [before, after].into_iter().flatten().map(|point| point[0]).find(|&time| near(time)).unwrap_or(t);
        }
        let found = match *self {
            Amplitude::Sine { start, end, .. }
            | Amplitude::SineSquared { start, end, .. }
            | Amplitude::Ramp { start, end }
            | Amplitude::Step { start, end } => [start, end].into_iter().find(|&time| near(time)),
            _ => None,
        };
        found.unwrap_or(t)
    }

    /// Where the first derivative jumps, in order of time.
    pub fn slope_jumps(&self) -> Vec<f64> {
        if let Amplitude::Curve(curve) = self {
            return curve.corners().to_vec();
        }
        // A sine that ends with a whole wave has a slope of rounding there.
        let rounding = match self {
            Amplitude::Sine { angular_frequency, .. } | Amplitude::SineSquared { angular_frequency, .. } => {
                1e-9 * angular_frequency
            }
            _ => 0.0,
        };
        let jumps = |time: &f64| (self.rate(*time, Side::Before) - self.rate(*time, Side::After)).abs() > rounding;
        let mut all = self.kinks();
        all.dedup();
        all.retain(jumps);
        all
    }

    /// ∫₀ᵗ a(s) ds.
    pub fn integral(&self, t: f64) -> f64 {
        self.primitives(t).0 - self.primitives(0.0).0
    }

    /// ∫₀ᵗ ∫₀ˢ a(r) dr ds.
    pub fn double_integral(&self, t: f64) -> f64 {
        let (first, second) = self.primitives(0.0);
        self.primitives(t).1 - second - first * t
    }

    /// A first integral P of the value and a first integral of P, both zero where the amplitude begins.
    fn primitives(&self, t: f64) -> (f64, f64) {
        match *self {
            Amplitude::Table(ref table) => table_primitives(table, t),
            Amplitude::Curve(ref curve) => curve.primitives(t).into(),
            Amplitude::Sine { angular_frequency: w, phase, start, end } => over(start, end, t, |u| {
                // With z = ωu:  P = Im e^{iφ} (e^{iz} − 1)/(iω),  ∫P = Im e^{iφ} (e^{iz} − 1 − iz)/(iω)², free of 1/ω.
                let z = w * u;
                let half = sinc(0.5 * z);
                let first = u * half * (0.5 * z + phase).sin();
                (first, u * u * (phase.sin() * 0.5 * half * half + phase.cos() * sine_rest(z)))
            }),
            Amplitude::SineSquared { angular_frequency: w, start, end } => over(start, end, t, |u| {
                // sin² = ½ (1 − cos z′) with z′ = 2ωu.
                let z = 2.0 * w * u;
                (0.5 * u * z * sine_rest(z), 0.25 * u * u * (1.0 - sinc(0.5 * z).powi(2)))
            }),
            Amplitude::Ramp { start, end } => {
                let (u, length) = (t.min(end).max(start) - start, end - start);
                // Cubes are formed from the ratio so that an endless ramp stays 0 instead of ∞/∞.
                let ratio = if length > 0.0 { u / length } else { 0.0 };
                let after = (t - end).max(0.0);
                let first = 0.5 * u * ratio;
                (first + after, u * u * ratio / 6.0 + (first + 0.5 * after) * after)
            }
            Amplitude::Step { start, end } => over(start, end, t, |u| (u, 0.5 * u * u)),
            Amplitude::Constant => (t, 0.5 * t * t),
            Amplitude::Harmonic { .. } => (0.0, 0.0),
        }
    }
}

/// Integrals of a function that acts from start to end only: `inside` gives them after the start. Beyond the end the first stays constant
/// and the second grows linearly.
fn over(start: f64, end: f64, t: f64, inside: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
    if t <= start || end <= start {
        return (0.0, 0.0);
    }
    let (first, second) = inside(t.min(end) - start);
    (first, second + first * (t - end).max(0.0))
}

/// True between two times, or at the end from the matching side.
fn lies_in([start, end]: [f64; 2], t: f64, side: Side) -> bool {
    match side {
        Side::Before => start < t && t <= end,
        Side::After => start <= t && t < end,
    }
}

/// Neighbouring points of a table on the given side of `t`.
fn beside(points: &[[f64; 2]], t: f64, side: Side) -> (Option<[f64; 2]>, Option<[f64; 2]>) {
    if side == Side::After {
        return around(points, t);
    }
    let after = points.partition_point(|p| p[0] < t);
    (after.checked_sub(1).map(|before| points[before]), points.get(after).copied())
}

/// The points at or before `t` and after it.
fn around(points: &[[f64; 2]], t: f64) -> (Option<[f64; 2]>, Option<[f64; 2]>) {
    let after = points.partition_point(|p| p[0] <= t);
    (after.checked_sub(1).map(|before| points[before]), points.get(after).copied())
}

fn slope(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[1] - a[1]) / (b[0] - a[0])
}

/// Primitives that are zero at the first point.
fn table_primitives(StraightLines { points, integrals }: &StraightLines, t: f64) -> (f64, f64) {
    let Some(&start) = points.first() else { return (0.0, 0.0) };
    let Some(before) = points.partition_point(|point| point[0] < t).checked_sub(1) else {
        let u = t - start[0];
        return (start[1] * u, 0.5 * start[1] * u * u);
    };
    let (a, sums) = (points[before], integrals[before]);
    // The last value holds after the table.
    let b = points.get(before + 1).copied().unwrap_or([t.max(a[0]) + 1.0, a[1]]);
    let [first, second] = integrals_along(a, b, sums, t);
    (first, second)
}

/// sin z / z.
fn sinc(z: f64) -> f64 {
    if z == 0.0 { 1.0 } else { z.sin() / z }
}

/// (z − sin z)/z², by its series where the difference would cancel; the first term left out is below 1e-17 there.
fn sine_rest(z: f64) -> f64 {
    let z2 = z * z;
    if z2 < 1.0 {
        z / 6.0
            * (1.0
                - z2 / 20.0
                    * (1.0
                        - z2 / 42.0 * (1.0 - z2 / 72.0 * (1.0 - z2 / 110.0 * (1.0 - z2 / 156.0 * (1.0 - z2 / 210.0))))))
    } else {
        (z - z.sin()) / z2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::cubic_curve::CurveShape;
    use base::math::quadrature::gauss;
    use rand::{RngExt, SeedableRng, rngs::SmallRng};

    fn all() -> Vec<Amplitude> {
        let points = vec![[0.3, -1.0], [0.5, 2.0], [1.25, 2.0], [2.0, 0.5]];
        let gentle = vec![[-0.3, -1.0], [0.5, 0.6], [1.25, 1.5], [2.0, 0.5]];
        vec![
            Amplitude::Table(StraightLines::new(points.clone())),
            Amplitude::Table(StraightLines::new(points.iter().map(|p| [p[0] - 0.6, p[1]]).collect())),
            Amplitude::Table(StraightLines::new(vec![[1.0, 3.0]])),
            Amplitude::Table(StraightLines::new(vec![[0.5, 1.0], [1.0, 1.0], [1.0, -2.0], [1.5, 0.0]])),
            Amplitude::Curve(CubicCurve::new(gentle.clone(), CurveShape::Spline)),
            Amplitude::Curve(CubicCurve::new(gentle, CurveShape::Monotone).later(-0.6)),
            Amplitude::Sine { angular_frequency: 7.0, phase: 0.4, start: 0.25, end: 1.6 },
            Amplitude::Sine { angular_frequency: 0.0, phase: 0.4, start: 0.25, end: f64::INFINITY },
            Amplitude::Sine { angular_frequency: 1e-3, phase: -0.4, start: -0.25, end: 2.0 },
            Amplitude::SineSquared { angular_frequency: 3.0, start: 0.0, end: 1.0 },
            Amplitude::SineSquared { angular_frequency: 1e-4, start: 0.5, end: f64::INFINITY },
            Amplitude::Ramp { start: 0.2, end: 1.1 },
            Amplitude::Ramp { start: 0.7, end: 0.7 },
            Amplitude::Ramp { start: 0.2, end: f64::INFINITY },
            Amplitude::Step { start: 0.2, end: 1.1 },
            Amplitude::Step { start: -0.2, end: f64::INFINITY },
            Amplitude::Constant,
        ]
    }

    /// Kinks and jumps of the functions above: differences and quadrature must not straddle them.
    const KINKS: [f64; 18] =
        [-0.3, -0.25, -0.2, -0.1, 0.0, 0.2, 0.25, 0.3, 0.5, 0.65, 0.7, 1.0, 1.1, 1.25, 1.4, 1.5, 1.6, 2.0];

    fn smooth(t: f64, h: f64) -> bool {
        KINKS.iter().all(|kink| (t - kink).abs() > h)
    }

    /// Central differences of step h err by h²/6 of the third derivative, here below 343: 6e-7 at h = 1e-4.
    #[test]
    fn rates_are_the_derivatives() {
        let mut random = SmallRng::seed_from_u64(1);
        let h = 1e-4;
        for a in all() {
            for _ in 0..200 {
                let t = random.random_range(-0.5..1.95);
                if smooth(t, h) {
                    let rate = (a.value(t + h) - a.value(t - h)) / (2.0 * h);
                    let second = (a.rate(t + h, Side::After) - a.rate(t - h, Side::After)) / (2.0 * h);
                    assert!(
                        (a.rate(t, Side::After) - rate).abs() < 1e-6,
                        "{a:?} at {t}: {} for {rate}",
                        a.rate(t, Side::After)
                    );
                    assert!(
                        (a.second_rate(t, Side::Before) - second).abs() < 1e-5,
                        "{a:?} at {t}: {} for {second}",
                        a.second_rate(t, Side::Before)
                    );
                }
            }
        }
    }

    /// Composite Gauss quadrature between the kinks; 5 points on intervals of at most 0.25 leave (ωh)^10 / 1e10 < 1e-8.
    fn quadrature(f: impl Fn(f64) -> f64, t: f64) -> f64 {
        let (low, high) = (t.min(0.0), t.max(0.0));
        let mut ends: Vec<f64> = KINKS.iter().copied().filter(|k| low < *k && *k < high).collect();
        ends.extend([low, high, 0.5 * (low + high)]);
        ends.sort_by(f64::total_cmp);
        let sum: f64 = ends
            .windows(2)
            .flat_map(|e| {
                let (half, middle) = (0.5 * (e[1] - e[0]), 0.5 * (e[0] + e[1]));
                let (points, weights) = gauss(5);
                points.iter().zip(weights).map(move |(x, w)| (half * w, middle + half * x))
            })
            .map(|(w, x)| w * f(x))
            .sum();
        if t < 0.0 { -sum } else { sum }
    }

    #[test]
    fn integrals_are_the_integrals() {
        let mut random = SmallRng::seed_from_u64(2);
        for a in all() {
            for _ in 0..200 {
                let t = random.random_range(-0.5..2.5);
                let first = quadrature(|s| a.value(s), t);
                let second = quadrature(|s| a.integral(s), t);
                assert!((a.integral(t) - first).abs() < 1e-8, "{a:?} to {t}: {} for {first}", a.integral(t));
                assert!(
                    (a.double_integral(t) - second).abs() < 1e-8,
                    "{a:?} to {t}: {} for {second}",
                    a.double_integral(t)
                );
            }
        }
    }

    #[test]
    fn turns_lie_inside() {
        let sine = |phase: f64, end: f64| Amplitude::Sine { angular_frequency: PI, phase, start: 0.0, end };
        let squared = |w: f64, start: f64| Amplitude::SineSquared { angular_frequency: w, start, end: f64::INFINITY };
        let table = |points: &[[f64; 2]]| Amplitude::Table(StraightLines::new(points.to_vec()));
        let none = [
            sine(0.0, 0.5),
            sine(0.5 * PI, 1.0),
            squared(0.5 * PI, 0.0),
            squared(PI, 0.5),
            squared(0.0, 0.0),
            table(&[[-1.0, 3.0], [0.0, 0.0], [0.5, 1.0], [0.6, 1.0], [1.0, 2.0], [2.0, 0.0]]),
            Amplitude::Ramp { start: 0.2, end: 0.3 },
            Amplitude::Constant,
        ];
        none.iter().for_each(|a| assert_eq!(a.turn(1.0), None, "{a:?}"));
        let some = [
            (sine(0.0, 1.0), 0.5),
            (sine(-0.25 * PI, 1.0), 0.75),
            (Amplitude::Sine { angular_frequency: -PI, phase: 0.25 * PI, start: 0.0, end: 1.0 }, 0.75),
            (squared(PI, 0.25), 0.75),
            (table(&[[0.0, 0.0], [0.5, 1.0], [0.75, 1.0], [1.0, 0.0]]), 0.75),
        ];
        some.iter().for_each(|(a, t)| assert!((a.turn(1.0).unwrap() - t).abs() < 1e-15, "{a:?} {:?}", a.turn(1.0)));
    }

    #[test]
    fn edges_belong_to_the_right_side() {
        let step = Amplitude::Step { start: 1.0, end: 2.0 };
        assert_eq!([0.999, 1.0, 1.999, 2.0].map(|t| step.value(t)), [0.0, 1.0, 1.0, 0.0]);
        let ramp = Amplitude::Ramp { start: 1.0, end: 3.0 };
        assert_eq!([0.0, 1.0, 2.0, 3.0, 4.0].map(|t| ramp.value(t)), [0.0, 0.0, 0.5, 1.0, 1.0]);
        assert_eq!([0.0, 1.0, 3.0].map(|t| ramp.rate(t, Side::After)), [0.0, 0.5, 0.0]);
        let jump = Amplitude::Table(StraightLines::new(vec![[0.0, 1.0], [1.0, 1.0], [1.0, 5.0], [2.0, 5.0]]));
        assert_eq!([0.5, 1.0, 3.0].map(|t| jump.value(t)), [1.0, 5.0, 5.0]);
        assert_eq!(Amplitude::Table(StraightLines::new(vec![])).value(1.0), 0.0);
    }

    /// A long sine keeps its drift: ∫∫ sin(ωt) = t/ω − sin(ωt)/ω², to a few units in the last place.
    #[test]
    fn drift_is_exact_after_many_periods() {
        let a = Amplitude::Sine { angular_frequency: 50.0, phase: 0.0, start: 0.0, end: f64::INFINITY };
        let t: f64 = 1000.0;
        let exact = t / 50.0 - (50.0 * t).sin() / 2500.0;
        assert!((a.double_integral(t) - exact).abs() < 1e-13 * exact);
    }
}
