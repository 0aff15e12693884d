//! Two cylinders: their separating axis, and the prism in place of one of them where the other touches it.
//!
//! Nineteen sides of the prism cover the zone of contact, narrow in its middle; the arcs differ from them by at most a hundredth of the
//! depth. Behind them the prism is a box. Where the two meet over more than a part of the round, as end on end, it has 32 sides. All sides
//! lie as far out as the arcs do on average.

use super::pose::LeastAxis;
use super::segment::{SegmentPlace, nearest_place_within};
use base::math::cylinder::RoundCylinder;
use base::math::{Mat3, Vec3, frame_along};
use std::f64::consts::{FRAC_PI_4, TAU};

/// Sides where the other cylinder comes.
const SIDES: usize = 19;
/// Sides all around.
const AROUND: usize = 32;
/// Half the angle of the contact zone, in radians, above which the prism has sides all around.
const WIDE: f64 = 0.8;
/// Iterations of the search for the nearest place; every second one halves the interval.
const SEARCH: usize = 40;
/// How much wider than that the sides are together.
const BEYOND: f64 = 1.2;

/// The one cylinder about its axes, and another.
pub(super) struct TwoCylinders<'a> {
    /// The one.
    pub one: &'a RoundCylinder,
    /// The other, replaced by a prism.
    pub other: &'a RoundCylinder,
    /// Centre of the other.
    pub y: Vec3,
    /// Columns: axes of the other, which lies along the third.
    pub Q: Mat3,
}

/// The line along the side of the other that comes nearest to the one, or lies deepest in it.
struct NearestLine {
    /// Its angle about the axis of the other.
    angle: f64,
    /// Its place.
    place: SegmentPlace,
    /// Where that is.
    x: Vec3,
}

/// A prism by the corners of its ends, counter-clockwise about its axis, and the normals of its sides from each to the next.
pub(super) struct PrismOutline {
    /// The corners, across the axis.
    pub corners: [Vec3; AROUND],
    /// The normal of the side that begins there.
    pub normals: [Vec3; AROUND],
    /// How many they are.
    pub count: usize,
    /// True where it is fixed to the cylinder and does not go along with the contact.
    pub is_fixed: bool,
}

impl TwoCylinders<'_> {
    /// The unit vector across the axis of the other at an angle, in its axes.
    fn out(angle: f64) -> Vec3 {
        let (sine, cosine) = angle.sin_cos();
        Vec3::new(cosine, sine, 0.0)
    }

    /// The line of an angle, and how the distance of its nearest place grows with that.
    fn line(&self, angle: f64) -> (NearestLine, f64) {
        let out = Self::out(angle);
        let half = self.Q.column(2) * self.other.half();
        let middle = self.y + self.Q * (self.other.radius() * out);
        // The axis of the largest gap is found from here, to more digits.
        let place = nearest_place_within(SEARCH, &half, |s| {
            let (d, n) = self.one.distance_in_axes(&(middle + s * half));
            SegmentPlace { s, d, n }
        });
        let around = self.Q * Vec3::new(-out.y, out.x, 0.0);
        (NearestLine { angle, place, x: middle + place.s * half }, place.n.dot(&around))
    }

    /// The nearest of all lines: from the best of eight the slope leads to it.
    fn nearest_line(&self) -> NearestLine {
        let toward = -self.Q.tr_mul(&self.y);
        let start = toward.y.atan2(toward.x);
        let (mut best, mut slope) = self.line(start);
        for k in 1..8 {
            let (line, of_line) = self.line(start + FRAC_PI_4 * f64::from(k));
            if line.place.d < best.place.d {
                (best, slope) = (line, of_line);
            }
        }
        let side = -slope.signum();
        let (mut near, mut near_slope) = (best, slope);
        let (far, mut far_slope) = self.line(near.angle + side * FRAC_PI_4);
        let mut end = far.angle;
        for k in 0..SEARCH {
            if near_slope * far_slope >= 0.0 || (end - near.angle).abs() <= 1e-12 {
                break;
            }
            let angle = match k % 2 {
                0 => near.angle - near_slope * (end - near.angle) / (far_slope - near_slope),
                _ => 0.5 * (near.angle + end),
            };
            let (line, slope) = self.line(angle);
            if slope * near_slope > 0.0 || slope == 0.0 {
                (near, near_slope) = (line, slope);
            } else {
                (end, far_slope) = (angle, slope);
            }
        }
        near
    }

    /// The gap along an axis toward the one, negative where they overlap, and its gradient by the axis.
    fn gap(&self, axis: &Vec3) -> (f64, Vec3) {
        let of_other = self.Q.tr_mul(axis);
        let gap = -self.one.reach_along(axis) - axis.dot(&self.y) - self.other.reach_along(&of_other);
        let reach = self.one.farthest_in_axes(axis) + self.y + self.Q * self.other.farthest_in_axes(&of_other);
        (gap, -reach)
    }

    /// The axis of the largest gap in the plane of two orthogonal unit vectors: the best of 16, refined by its slope.
    fn best_of_plane(&self, e: &Vec3, f: &Vec3) -> Vec3 {
        const SOME: usize = 16;
        let axis = |angle: f64| angle.cos() * e + angle.sin() * f;
        let slope = |angle: f64| self.gap(&axis(angle)).1.dot(&(angle.cos() * f - angle.sin() * e));
        let step = TAU / SOME as f64;
        let mut best = (f64::NEG_INFINITY, 0.0);
        for k in 0..SOME {
            let angle = step * k as f64;
            let gap = self.gap(&axis(angle)).0;
            if gap > best.0 {
                best = (gap, angle);
            }
        }
        let (mut low, mut high) = (best.1 - step, best.1 + step);
        let (mut rise, mut fall) = (slope(low), slope(high));
        for k in 0..120 {
            if rise <= 0.0 || fall >= 0.0 || high - low <= 1e-15 {
                break;
            }
            // By turns the chord and the middle: where a side or an end lies flat the slope jumps.
            let angle = match k % 2 {
                0 => low + rise * (high - low) / (rise - fall),
                _ => 0.5 * (low + high),
            };
            match slope(angle) {
                at if at > 0.0 => (low, rise) = (angle, at),
                at if at < 0.0 => (high, fall) = (angle, at),
                _ => return axis(angle),
            }
        }
        if self.gap(&axis(low)).0 > self.gap(&axis(high)).0 { axis(low) } else { axis(high) }
    }

    /// The axis out of the rims of both, from the place where a line of the other is deepest in the one; `None` without two rims.
    fn out_of_rims(&self, line: &NearestLine) -> Option<Vec3> {
        let tangent = Vec3::new(-line.x.y, line.x.x, 0.0).try_normalize(0.0)?;
        let of_other = self.Q * Vec3::new(-line.angle.sin(), line.angle.cos(), 0.0);
        let mut axis = tangent.cross(&of_other).try_normalize(1e-3)?;
        if self.gap(&-axis).0 > self.gap(&axis).0 {
            axis = -axis;
        }
        // Newton's method on the sphere. The gap is homogeneous of degree one in the axis; its curvature on the sphere therefore includes
        // the gap.
        for _ in 0..6 {
            let (gap, gradient) = self.gap(&axis);
            let T = frame_along(&axis);
            let (e, f) = (T.column(0).into_owned(), T.column(1).into_owned());
            let bend = |cylinder: &RoundCylinder, axis: Vec3, e: Vec3, f: Vec3| {
                let around = Vec3::new(-axis.y, axis.x, 0.0);
                let (of_e, of_f) = (around.dot(&e), around.dot(&f));
                let scale = cylinder.radius() / axis.x.hypot(axis.y).powi(3);
                Vec3::new(of_e * of_e, of_e * of_f, of_f * of_f) * scale
            };
            let back = self.Q.transpose();
            let all = bend(self.one, axis, e, f) + bend(self.other, back * axis, back * e, back * f);
            let (a, b, c) = (all.x + gap, all.y, all.z + gap);
            let (of_e, of_f, determinant) = (gradient.dot(&e), gradient.dot(&f), a * c - b * b);
            // No maximum: rounding, or a flat that is better found in a plane.
            if determinant.is_nan() || determinant <= 0.0 || a <= 0.0 {
                break;
            }
            let step = ((c * of_e - b * of_f) * e + (a * of_f - b * of_e) * f) / determinant;
            axis = (axis + step / step.norm().max(1.0)).normalize();
        }
        Some(axis)
    }

    /// Candidate separating axes, toward the one: along either, across the side of either, out of both rims, or between nearest points. The
    /// last two count only where the sides do not meet within their lengths.
    fn axes(&self) -> impl Iterator<Item = Vec3> {
        let [across, toward, along] = [0, 1, 2].map(|k| self.Q.column(k).into_owned());
        let sides = [self.best_of_plane(&across, &toward), self.best_of_plane(&Vec3::x(), &Vec3::y())];
        let ends = [along, -along, Vec3::z(), -Vec3::z()];
        let highest = |axes: &[Vec3]| axes.iter().map(|axis| self.gap(axis).0).fold(f64::NEG_INFINITY, f64::max);
        let side_on_side = self.meets_within(&sides[0]) && self.gap(&sides[0]).0 >= highest(&ends).max(highest(&sides));
        let line = (!side_on_side).then(|| self.nearest_line());
        let rims = line.as_ref().and_then(|line| self.out_of_rims(line));
        ends.into_iter().chain(sides).chain(line.map(|line| -line.place.n)).chain(rims)
    }

    /// True for an axis across the other.
    fn is_across(&self, axis: &Vec3) -> bool {
        /// Cosines below this are rounding.
        const LEVEL: f64 = 1e-12;
        self.Q.column(2).dot(axis).abs() < LEVEL
    }

    /// True where an axis across the side of the other meets it within its length.
    fn meets_within(&self, axis: &Vec3) -> bool {
        let place = self.one.farthest_in_axes(axis) + self.y;
        self.Q.column(2).dot(&place).abs() <= self.other.half()
    }

    /// The axis of the largest gap, toward the one.
    pub fn least_axis(&self) -> LeastAxis {
        let size = self.one.reach() + self.other.reach();
        let mut best = LeastAxis { axis: Vec3::z(), gap: f64::NEG_INFINITY };
        for axis in self.axes() {
            let gap = self.gap(&axis).0;
            // Rounding does not choose between axes that are as good.
            if gap > best.gap + 1e-9 * size {
                best = LeastAxis { axis, gap };
            }
        }
        best
    }

    /// The prism, in the axes of the other, where the two overlap along an axis.
    pub fn outline(&self, along: &Vec3) -> PrismOutline {
        let radius = self.other.radius();
        let (mut least, mut angle) = (f64::INFINITY, 0.0);
        let mut look = |axis: Vec3| {
            // The one solid lies beyond the plane normal to the axis. The round side crosses that plane only within this part of the angle
            // around the axis.
            let out = self.Q.tr_mul(&axis);
            let part = -0.5 * self.gap(&axis).0 / (radius * out.x.hypot(out.y));
            if part < least {
                (least, angle) = (part, out.y.atan2(out.x));
            }
        };
        // For sides that meet within their lengths this axis suffices.
        match self.is_across(along) && self.meets_within(along) {
            true => look(*along),
            false => self.axes().for_each(look),
        }
        let half = 2.0 * least.clamp(0.0, 1.0).sqrt().asin();
        // In a wide zone the round side only bounds the common solid.
        if half > WIDE { PrismOutline::around(radius) } else { PrismOutline::of_zone(radius, angle, half) }
    }
}

impl PrismOutline {
    const EMPTY: PrismOutline = {
        let nothing = [Vec3::new(0.0, 0.0, 0.0); AROUND];
        PrismOutline { corners: nothing, normals: nothing, count: 0, is_fixed: false }
    };

    fn push(&mut self, corner: Vec3, normal: Vec3) {
        (self.corners[self.count], self.normals[self.count]) = (corner, normal);
        self.count += 1;
    }

    /// A regular one, fixed to its cylinder.
    fn around(radius: f64) -> PrismOutline {
        let width = TAU / AROUND as f64;
        let corner = radius * (1.0 - width * width / 24.0) / (0.5 * width).cos();
        let mut outline = PrismOutline { is_fixed: true, ..PrismOutline::EMPTY };
        for k in 0..AROUND {
            let middle = width * k as f64;
            outline.push(corner * TwoCylinders::out(middle - 0.5 * width), TwoCylinders::out(middle));
        }
        outline
    }

    /// One with sides about an angle, over so much on either side of it, and a box behind them. They are narrow in the middle, where the
    /// contact always is, and wider outward by a ratio.
    fn of_zone(radius: f64, angle: f64, half: f64) -> PrismOutline {
        const RATIO: f64 = 1.25;
        const OUTER: usize = SIDES / 2;
        let wider = |k: usize| RATIO.powi(k.abs_diff(OUTER) as i32);
        let all: f64 = (0..SIDES).map(wider).sum();
        let scale = 2.0 * BEYOND * half.max(1e-6) / all;
        let width = |k: usize| scale * wider(k);
        let away = |k: usize| radius * (1.0 - width(k) * width(k) / 24.0);
        // From the middle outward, so that both halves are alike to rounding.
        let middle = |k: usize| {
            let steps: f64 = (1..=k.abs_diff(OUTER)).map(|j| 0.5 * (width(OUTER + j - 1) + width(OUTER + j))).sum();
            if k < OUTER { angle - steps } else { angle + steps }
        };
        let along = |angle: f64| Vec3::new(-angle.sin(), angle.cos(), 0.0);
        let mut outline = PrismOutline::EMPTY;
        let (first, last) = (middle(0), middle(SIDES - 1));
        // The outer sides go on until they are beyond all that is round.
        let begin = away(0) * TwoCylinders::out(first) - 3.0 * radius * along(first);
        outline.push(begin, TwoCylinders::out(first));
        for k in 1..SIDES {
            let (from, to) = (middle(k - 1), middle(k));
            let turn = 0.25 * (width(k - 1) + width(k));
            let between = 0.5 * (from + to);
            let farther = radius * (width(k - 1) * width(k - 1) - width(k) * width(k)) / 24.0;
            let corner = 0.5 * (away(k - 1) + away(k)) / turn.cos() * TwoCylinders::out(between)
                + 0.5 * farther / turn.sin() * along(between);
            outline.push(corner, TwoCylinders::out(to));
        }
        let end = away(SIDES - 1) * TwoCylinders::out(last) + 3.0 * radius * along(last);
        let (out, across) = (TwoCylinders::out(angle), along(angle));
        outline.push(end, across);
        outline.push(end - (end.dot(&out) + 4.0 * radius) * out, -out);
        outline.push(begin - (begin.dot(&out) + 4.0 * radius) * out, -across);
        outline
    }
}
