//! Curves of cubic polynomials through points in time: splines, with or without corners, and monotone ones.
//!
//! A spline has continuous second derivatives between its breaks. The curve breaks at jumps, and at corners that must stay. At an end the
//! slope is zero if the values settle smoothly, otherwise that of the cubic through the nearest four points. Before the first point and
//! after the last one the values hold.

/// How a curve goes through its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurveShape {
    /// One spline.
    Spline,
    /// Splines between corners of the polyline.
    SplineWithCorners,
    /// One spline whose second derivative is zero at both ends.
    Natural,
    /// One spline whose slope is zero at both ends.
    Clamped,
    /// No overshoot: extremes lie at points, slopes follow Fritsch and Carlson (1980); at rest at both ends.
    Monotone,
}

/// A curve through points (time, value), constant beyond its ends; equal times are a jump.
#[derive(Debug, Clone, PartialEq)]
pub struct CubicCurve {
    points: Vec<[f64; 2]>,
    /// Coefficients of the powers of the time since each point but the last; zero powers on a jump.
    cubics: Vec<[f64; 4]>,
    /// A first integral of the value and a first integral of that, at each point; zero at the first.
    integrals: Vec<[f64; 2]>,
    /// Indices of points with a possible jump of the second derivative.
    breaks: Vec<usize>,
    /// Times of slope jumps.
    corners: Vec<f64>,
}

/// How a curve passes a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Passage {
    /// With a continuous second derivative.
    Smooth,
    /// With the slope zero.
    Rest,
    /// Two slopes, one on each side.
    Corner,
    /// With the second derivative zero, at an end.
    Free,
}

/// A polyline has a corner if the change of slope exceeds this part of the slope range nearby. Eight samples of a period give 0.41, six
/// 0.5; next to a start from rest sixteen give 0.37, twelve 0.46.
const CORNER: f64 = 0.45;
/// The number of slopes on either side that are near by.
const NEAR: usize = 3;
/// Slopes that differ by less than this part of the largest are equal: samples have a limited number of digits.
const EQUAL: f64 = 1e-3;

impl CubicCurve {
    /// The curve through these points (time, value), whose times do not fall.
    pub fn new(points: Vec<[f64; 2]>, shape: CurveShape) -> CubicCurve {
        let chords = Chords::new(&points);
        let passages: Vec<Passage> = (0..points.len()).map(|k| chords.passage(k, shape)).collect();
        let slopes = match shape {
            CurveShape::Monotone => monotone_slopes(&points, &chords),
            _ => spline_slopes(&points, &chords, &passages, shape),
        };
        let cubics = points.windows(2).zip(&slopes).map(|(pair, slopes)| cubic(pair[0], pair[1], *slopes)).collect();
        let is_break = |&k: &usize| {
            passages[k] != Passage::Smooth || shape == CurveShape::Monotone || k == 0 || k + 1 == points.len()
        };
        let breaks = (0..points.len()).filter(is_break).collect();
        let corners = corners(&points, &slopes, chords.largest);
        let mut curve = CubicCurve { points, cubics, integrals: Vec::new(), breaks, corners };
        curve.integrate();
        curve
    }

    fn integrate(&mut self) {
        let mut sums = [0.0; 2];
        for k in 0..self.points.len() {
            if k > 0 {
                let h = self.points[k][0] - self.points[k - 1][0];
                sums = integrals_along(&self.cubics[k - 1], sums, h);
            }
            self.integrals.push(sums);
        }
    }

    /// The points (time, value), by time.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// This curve, shifted to later times.
    #[must_use]
    pub fn later(mut self, by: f64) -> CubicCurve {
        self.points.iter_mut().for_each(|point| point[0] += by);
        self.corners.iter_mut().for_each(|time| *time += by);
        self
    }

    /// Times with a possible jump of value, slope or second derivative.
    pub fn breaks(&self) -> impl Iterator<Item = f64> {
        self.breaks.iter().map(|&k| self.points[k][0])
    }

    /// Times of slope jumps, including the ends.
    pub fn corners(&self) -> &[f64] {
        &self.corners
    }

    /// True where no coefficient overflows, as those of points next to each other may.
    pub fn is_finite(&self) -> bool {
        self.cubics.iter().flatten().chain(self.integrals.iter().flatten()).all(|number| number.is_finite())
    }

    /// True where all of it is straight lines.
    pub fn is_straight(&self) -> bool {
        let bend = |(pair, cubic): (&[[f64; 2]], &[f64; 4])| {
            let h = pair[1][0] - pair[0][0];
            let (slope, bend) = ((cubic[1] * h).abs(), (cubic[2] * h * h).abs() + (cubic[3] * h * h * h).abs());
            bend <= 1e-9 * slope
        };
        self.points.windows(2).zip(&self.cubics).all(bend)
    }

    /// The place between points: their index and the time since; `None` before the first and after the last. At a point the side decides.
    fn place(&self, t: f64, before: bool) -> Option<(usize, f64)> {
        let passed = self.points.partition_point(|point| if before { point[0] < t } else { point[0] <= t });
        let k = passed.checked_sub(1).filter(|&k| k < self.cubics.len())?;
        Some((k, t - self.points[k][0]))
    }

    /// The value at a time; at a jump that from later times.
    pub fn value(&self, t: f64) -> f64 {
        let held = |point: Option<&[f64; 2]>| point.map_or(0.0, |point| point[1]);
        match self.place(t, false) {
            Some((k, u)) => {
                let [a, b, c, d] = self.cubics[k];
                a + u * (b + u * (c + u * d))
            }
            None if self.points.first().is_some_and(|first| t < first[0]) => held(self.points.first()),
            None => held(self.points.last()),
        }
    }

    /// First and second derivative at a time, from earlier times where `before` says so.
    pub fn rates(&self, t: f64, before: bool) -> [f64; 2] {
        self.place(t, before).map_or([0.0; 2], |(k, u)| {
            let [_, b, c, d] = self.cubics[k];
            [b + u * (2.0 * c + u * 3.0 * d), 2.0 * c + 6.0 * u * d]
        })
    }

    /// A first integral of the value and a first integral of that, zero at the first point.
    pub fn primitives(&self, t: f64) -> [f64; 2] {
        let (Some(first), Some(last)) = (self.points.first(), self.points.last()) else { return [0.0; 2] };
        if t < first[0] {
            return integrals_along(&[first[1], 0.0, 0.0, 0.0], [0.0; 2], t - first[0]);
        }
        match self.place(t, true) {
            Some((k, u)) => integrals_along(&self.cubics[k], self.integrals[k], u),
            None if t <= first[0] => [0.0; 2],
            None => {
                let end = self.integrals[self.integrals.len() - 1];
                integrals_along(&[last[1], 0.0, 0.0, 0.0], end, t - last[0])
            }
        }
    }

    /// Times of the extrema within segments, in order.
    fn turns(&self) -> impl Iterator<Item = (usize, f64)> {
        let of = |k: usize| {
            let h = self.points[k + 1][0] - self.points[k][0];
            roots(self.cubics[k], h).into_iter().flatten().map(move |u| (k, u))
        };
        (0..self.cubics.len()).flat_map(of)
    }

    /// The first extremum after `from`.
    pub fn turn(&self, from: f64) -> Option<f64> {
        let inside = self.turns().map(|(k, u)| self.points[k][0] + u);
        let at_points = (1..self.cubics.len()).filter(|&k| {
            let t = self.points[k][0];
            self.rates(t, true)[0] * self.rates(t, false)[0] < 0.0
        });
        let mut all: Vec<f64> = inside.chain(at_points.map(|k| self.points[k][0])).filter(|&t| t > from).collect();
        all.sort_by(f64::total_cmp);
        all.first().copied()
    }

    /// The largest overshoot beyond the values of a segment, as a part of the range of values, with the times of its ends.
    pub fn overshoot(&self) -> Option<(f64, [f64; 2])> {
        let values = self.points.iter().map(|point| point[1]);
        let range = values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min);
        let beyond = |(k, u): (usize, f64)| {
            let [a, b, c, d] = self.cubics[k];
            let (value, ends) = (a + u * (b + u * (c + u * d)), [self.points[k], self.points[k + 1]]);
            let [low, high] = [ends[0][1].min(ends[1][1]), ends[0][1].max(ends[1][1])];
            ((value - high).max(low - value) / range, ends.map(|end| end[0]))
        };
        self.turns().map(beyond).filter(|(part, _)| *part > 1e-9).max_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// Slopes of the straight lines between points; `None` on a jump.
struct Chords {
    slopes: Vec<Option<f64>>,
    largest: f64,
}

impl Chords {
    fn new(points: &[[f64; 2]]) -> Chords {
        let slope = |pair: &[[f64; 2]]| {
            (pair[1][0] > pair[0][0]).then(|| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]))
        };
        let slopes: Vec<Option<f64>> = points.windows(2).map(slope).collect();
        let largest = slopes.iter().flatten().fold(0.0, |most: f64, slope| most.max(slope.abs()));
        Chords { slopes, largest }
    }

    /// Slopes near a point on one side, from the point on; the values hold beyond the ends.
    fn near(&self, k: usize, later: bool) -> impl Iterator<Item = f64> {
        let at = move |i: usize| if later { Some(k + i) } else { k.checked_sub(i + 1) };
        let slope = move |i: usize| match at(i).map(|index| self.slopes.get(index)) {
            Some(Some(slope)) => *slope,
            _ => Some(0.0),
        };
        (0..NEAR).map_while(slope)
    }

    fn is_corner(&self, k: usize) -> bool {
        let (Some(before), Some(after)) = (self.near(k, false).next(), self.near(k, true).next()) else { return true };
        let all = || self.near(k, false).chain(self.near(k, true));
        let range = all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min);
        let change = (after - before).abs();
        change > EQUAL * self.largest && change > CORNER * range
    }

    /// True where a point lies on two constant segments or more, those beyond the ends among them.
    fn is_rest(&self, k: usize) -> bool {
        let run = |later: bool| self.near(k, later).take_while(|slope| *slope == 0.0).count();
        run(false) + run(true) >= 2
    }

    fn passage(&self, k: usize, shape: CurveShape) -> Passage {
        let is_end = k == 0 || k == self.slopes.len();
        let jumps = |k: Option<usize>| k.and_then(|k| self.slopes.get(k)).is_some_and(Option::is_none);
        if jumps(k.checked_sub(1)) || jumps(Some(k)) {
            return Passage::Corner;
        }
        let is_corner = self.is_corner(k);
        match shape {
            CurveShape::Natural if is_end => Passage::Free,
            CurveShape::Clamped if is_end => Passage::Rest,
            CurveShape::Natural | CurveShape::Clamped => Passage::Smooth,
            CurveShape::Monotone => {
                if is_end {
                    Passage::Rest
                } else {
                    Passage::Smooth
                }
            }
            _ if is_end => {
                if is_corner {
                    Passage::Corner
                } else {
                    Passage::Rest
                }
            }
            CurveShape::SplineWithCorners if is_corner => Passage::Corner,
            _ if self.is_rest(k) => Passage::Rest,
            _ => Passage::Smooth,
        }
    }
}

/// The slopes at both ends of each segment, of splines between those points that are not passed smoothly.
fn spline_slopes(points: &[[f64; 2]], chords: &Chords, passages: &[Passage], shape: CurveShape) -> Vec<[f64; 2]> {
    let mut slopes = vec![[0.0; 2]; points.len().saturating_sub(1)];
    let mut from = 0;
    for to in 1..points.len() {
        if passages[to] == Passage::Smooth {
            continue;
        }
        if let Some(chord) = chords.slopes[from].filter(|_| to == from + 1 && shape == CurveShape::SplineWithCorners) {
            // Two points alone are drawn, not sampled.
            slopes[from] = [chord; 2];
        } else if chords.slopes[from].is_some() {
            spline(&points[from..=to], [passages[from], passages[to]], &mut slopes[from..to]);
        }
        from = to;
    }
    slopes
}

/// One spline through at least two points: end slopes are zero, those of the neighbouring points, or without curvature; the inner slopes make the
/// second derivative continuous.
fn spline(points: &[[f64; 2]], ends: [Passage; 2], out: &mut [[f64; 2]]) {
    let n = points.len();
    let backwards: Vec<[f64; 2]> = points.iter().rev().take(4).copied().collect();
    let end = |passage: Passage, points: &[[f64; 2]]| if passage == Passage::Rest { 0.0 } else { end_slope(points) };
    let (first, last) = (end(ends[0], &points[..n.min(4)]), end(ends[1], &backwards));
    // Elimination of a tridiagonal system whose diagonal dominates.
    let chord = |k: usize| (points[k + 1][1] - points[k][1]) / (points[k + 1][0] - points[k][0]);
    let mut rows: Vec<[f64; 2]> = vec![if ends[0] == Passage::Free { [0.5, 1.5 * chord(0)] } else { [0.0, first] }];
    for k in 1..n - 1 {
        let [before, after] = [k - 1, k].map(|i| (points[i + 1][0] - points[i][0]).recip());
        let [rise, fall] = [k - 1, k].map(|i| points[i + 1][1] - points[i][1]);
        let [above, of_above] = rows[k - 1];
        let diagonal = 2.0 * (before + after) - before * above;
        let right = 3.0 * (rise * before * before + fall * after * after) - before * of_above;
        rows.push([after / diagonal, right / diagonal]);
    }
    let [above, of_above] = rows[n - 2];
    let mut next = if ends[1] == Passage::Free { (3.0 * chord(n - 2) - of_above) / (2.0 - above) } else { last };
    for k in (0..n - 1).rev() {
        let own = rows[k][1] - rows[k][0] * next;
        out[k] = [own, next];
        next = own;
    }
}

/// The slope at the first of some points of the polynomial through all of them.
fn end_slope(points: &[[f64; 2]]) -> f64 {
    let mut differences: Vec<f64> = points.iter().map(|point| point[1]).collect();
    let (mut slope, mut product) = (0.0, 1.0);
    for order in 1..points.len() {
        for k in 0..points.len() - order {
            differences[k] = (differences[k + 1] - differences[k]) / (points[k + order][0] - points[k][0]);
        }
        slope += differences[0] * product;
        product *= points[0][0] - points[order][0];
    }
    slope
}

/// Slopes that keep each segment between the values at its ends: the weighted harmonic mean of the chords, zero at extremes and ends.
fn monotone_slopes(points: &[[f64; 2]], chords: &Chords) -> Vec<[f64; 2]> {
    let at = |k: usize| -> f64 {
        let pair =
            k.checked_sub(1).and_then(|before| chords.slopes[before]).zip(chords.slopes.get(k).copied().flatten());
        let Some((before, after)) = pair.filter(|(before, after)| before * after > 0.0) else { return 0.0 };
        let [h, next] = [k - 1, k].map(|i| points[i + 1][0] - points[i][0]);
        let [a, b] = [2.0 * next + h, next + 2.0 * h];
        (a + b) / (a / before + b / after)
    };
    (0..points.len().saturating_sub(1)).map(|k| [at(k), at(k + 1)]).collect()
}

/// Coefficients of the cubic from `a` to `b` with these slopes at both.
fn cubic(a: [f64; 2], b: [f64; 2], [start, end]: [f64; 2]) -> [f64; 4] {
    let h = b[0] - a[0];
    if h <= 0.0 {
        return [a[1], 0.0, 0.0, 0.0];
    }
    let chord = (b[1] - a[1]) / h;
    [a[1], start, (3.0 * chord - 2.0 * start - end) / h, (start + end - 2.0 * chord) / (h * h)]
}

/// Times of points with a slope jump; beyond the ends the slope is zero.
fn corners(points: &[[f64; 2]], slopes: &[[f64; 2]], largest: f64) -> Vec<f64> {
    let side = |k: Option<usize>, end: usize| k.and_then(|k| slopes.get(k)).map_or(0.0, |slopes| slopes[end]);
    let jumps = |&k: &usize| (side(Some(k), 0) - side(k.checked_sub(1), 1)).abs() > EQUAL * largest;
    let mut times: Vec<f64> = (0..points.len()).filter(jumps).map(|k| points[k][0]).collect();
    times.dedup();
    times
}

/// Both integrals after the time `u` along a cubic, from those at its start.
fn integrals_along(&[a, b, c, d]: &[f64; 4], [first, second]: [f64; 2], u: f64) -> [f64; 2] {
    let value = u * (a + u * (b / 2.0 + u * (c / 3.0 + u * d / 4.0)));
    [first + value, second + u * (first + u * (a / 2.0 + u * (b / 6.0 + u * (c / 12.0 + u * d / 20.0))))]
}

/// Where the slope of a cubic changes its sign inside a segment of this length.
fn roots([_, b, c, d]: [f64; 4], h: f64) -> [Option<f64>; 2] {
    let inside = |u: f64| (u > 1e-9 * h && u < (1.0 - 1e-9) * h).then_some(u);
    let discriminant = c * c - 3.0 * b * d;
    if discriminant <= 0.0 {
        return [None; 2];
    }
    // The larger root in magnitude comes without cancellation, the other one from their product.
    let large = -(c + discriminant.sqrt().copysign(c));
    let [mut first, mut second] = [b / large, large / (3.0 * d)];
    if second < first {
        std::mem::swap(&mut first, &mut second);
    }
    [inside(first), inside(second)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn sampled(f: impl Fn(f64) -> f64, end: f64, pieces: usize) -> Vec<[f64; 2]> {
        (0..=pieces).map(|k| end * k as f64 / pieces as f64).map(|t| [t, f(t)]).collect()
    }

    /// A spline through samples of a smooth function errs by h⁴ in the value and h² in the second derivative. Halving the distance
    /// therefore divides by 16 and 4, also at the ends.
    #[test]
    fn samples_converge_to_their_function() {
        let f = |t: f64| 1.0 - (TAU * t).cos();
        let second = |t: f64| TAU * TAU * (TAU * t).cos();
        let errors = |pieces: usize| {
            let curve = CubicCurve::new(sampled(f, 1.0, pieces), CurveShape::SplineWithCorners);
            assert!(curve.corners().is_empty() && curve.breaks().count() == 2, "{:?}", curve.corners());
            (0..1000).map(|k| (k as f64 + 0.5) / 1000.0).fold([0.0; 2], |most: [f64; 2], t| {
                let of = [(curve.value(t) - f(t)).abs(), (curve.rates(t, false)[1] - second(t)).abs()];
                [most[0].max(of[0]), most[1].max(of[1])]
            })
        };
        let [coarse, fine] = [errors(16), errors(32)];
        assert!(coarse[0] / fine[0] > 13.0 && coarse[1] / fine[1] > 3.5, "{coarse:?} {fine:?}");
        // ω⁴h²/8 ≈ 0.38 for 32 samples.
        assert!(fine[1] < 0.4, "{fine:?}");
    }

    /// Values and the integral of scipy.interpolate.CubicSpline with `bc_type` "natural" and "clamped" (SciPy 1.17).
    #[test]
    fn natural_and_clamped_splines_are_those_of_scipy() {
        let points = vec![[0.0, 1.0], [0.5, -0.5], [0.7, 2.0], [1.6, 2.0], [2.0, 0.3], [3.1, 1.7]];
        let known = [
            (
                CurveShape::Natural,
                [-0.6138609811262612, 0.6737796226352796, 3.9737089309528226, 1.0129354084846527, 1.0683575457852303],
                3.8016231852438516,
            ),
            (
                CurveShape::Clamped,
                [0.1097243257587393, 0.6195039386024945, 4.079174988477493, 0.9719989105993101, 1.5157124753231348],
                4.445216919929049,
            ),
        ];
        for (shape, values, integral) in known {
            let curve = CubicCurve::new(points.clone(), shape);
            for (t, value) in [0.2, 0.6, 1.0, 1.8, 2.9].into_iter().zip(values) {
                assert!((curve.value(t) - value).abs() < 1e-13, "{shape:?} {t}: {}", curve.value(t));
            }
            assert!((curve.primitives(3.1)[0] - integral).abs() < 1e-13);
            let end = if shape == CurveShape::Natural { 1 } else { 0 };
            // Derivatives are differences of values of size 1 over 0.2.
            assert!(curve.rates(0.0, false)[end].abs() < 1e-11 && curve.rates(3.1, true)[end].abs() < 1e-11);
        }
        // Two points alone have one straight line.
        let line = CubicCurve::new(vec![[0.0, 1.0], [2.0, 5.0]], CurveShape::Natural);
        assert!((line.value(0.5) - 2.0).abs() < 1e-15 && line.is_straight());
    }

    /// A cubic is its own spline, and its slope at the ends is found from four points.
    #[test]
    fn a_cubic_is_met_exactly() {
        let f = |t: f64| 2.0 + t * (1.0 + t * (-1.5 + t));
        let curve = CubicCurve::new(sampled(f, 2.0, 9), CurveShape::Spline);
        for t in [0.01, 0.5, 1.3, 1.99] {
            assert!((curve.value(t) - f(t)).abs() < 1e-13, "{t}");
            assert!((curve.rates(t, true)[1] - (6.0 * t - 3.0)).abs() < 1e-11, "{t}");
            let first = t * (2.0 + t * (0.5 + t * (-0.5 + t / 4.0)));
            let second = t * t * (1.0 + t * (1.0 / 6.0 + t * (-0.125 + t / 20.0)));
            assert!((curve.primitives(t)[0] - first).abs() < 1e-13 && (curve.primitives(t)[1] - second).abs() < 1e-13);
        }
        assert_eq!(curve.corners(), [0.0, 2.0]);
    }

    /// A curve of a few points keeps its corners and does not overshoot.
    #[test]
    fn drawings_keep_their_corners() {
        let straight: [&[[f64; 2]]; 6] = [
            &[[0.0, 0.0], [1.0, 1.0]],
            &[[0.0, 0.0], [1.0, 1.0], [2.0, 1.0]],
            &[[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [3.0, 0.0]],
            &[[0.0, 0.0], [1.0, 1.0], [2.0, -1.0], [3.0, 0.0]],
            &[[0.0, 0.0], [0.1, 0.05], [0.2, 0.1], [0.3, 0.15], [0.4, 0.15], [0.5, 0.15], [0.6, 0.15]],
            &[[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [2.0, 2.0]],
        ];
        for points in straight {
            let curve = CubicCurve::new(points.to_vec(), CurveShape::SplineWithCorners);
            assert!(curve.is_straight(), "{points:?}: {:?}", curve.cubics);
        }
        // A smooth start from rest, a smooth stop: a rest on either side does not ring.
        let rise = |t: f64| {
            if t < 0.2 {
                0.0
            } else if t > 0.8 {
                1.0
            } else {
                0.5 - 0.5 * (TAU * (t - 0.2) / 1.2).cos()
            }
        };
        let curve = CubicCurve::new(sampled(rise, 1.0, 50), CurveShape::SplineWithCorners);
        assert!(curve.corners().is_empty(), "{:?}", curve.corners());
        assert_eq!([curve.value(0.11), curve.value(0.93)], [0.0, 1.0]);
        assert_eq!(curve.overshoot(), None);
    }

    #[test]
    fn monotone_curves_do_not_overshoot() {
        let points = vec![[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [3.0, 0.2], [3.5, 0.1], [5.0, -1.0]];
        let spline = CubicCurve::new(points.clone(), CurveShape::Spline);
        assert!(spline.overshoot().is_some_and(|(part, _)| part > 0.05), "{:?}", spline.overshoot());
        let curve = CubicCurve::new(points, CurveShape::Monotone);
        assert_eq!((curve.overshoot(), curve.corners()), (None, &[][..]));
        assert_eq!(curve.value(1.5), 1.0);
        // Two points are a smooth step, 3t² − 2t³.
        let step = CubicCurve::new(vec![[0.0, 0.0], [1.0, 1.0]], CurveShape::Monotone);
        assert!((step.value(0.25) - 0.15625).abs() < 1e-15);
    }
}
