//! A segment about which one of two solids is round, against the other: a capsule or a sphere against anything convex.
//!
//! At s on the segment the two overlap by p(s) = r − d(s), d the distance from the other's core. The depth is defined by the strip 0 ≤ z ≤
//! p(s) as for two polyhedra ([`super::volume`]): D = √(6 V), V the variance of z less its linear part. It is p/√2 for a segment along a
//! face and p/2 for one standing on its end. With four times the stiffness of a point, a lying capsule is thus as stiff as two spheres at
//! its ends, a standing one as one sphere. A sphere has p/2.
//!
//! Growth of p at a point changes V by ((z − z̄ − β(s − s̄))² − V)/A at z = p, with β the slope and A the strip's area. ∂D is therefore a
//! sum over the segment. d is convex in s and known in closed form: p > 0 in one interval, cut where another part of the core becomes the
//! nearest.

use super::depth::Depth;
use super::pose::{ConvexPose, LeastAxis};
use super::segment::{ITERATIONS, SegmentPlace, nearest_place};
use base::math::convex::ConvexShape;
use base::math::cylinder::RoundCylinder;
use base::math::quadrature::gauss;
use base::math::{Mat3, Vec3, Vec6, stack};

/// Points of the rule in each piece of the interval: d is analytic there.
const POINTS: usize = 6;
/// Most pieces; a box has eight, and of hulls with many small faces some pieces may hold more than one nearest part.
const PIECES: usize = 12;

/// The segment of one solid in the axes of the other's core.
pub(super) struct Swept<'a> {
    core: &'a ConvexShape,
    middle: Vec3,
    half: Vec3,
    /// The distance of the segment from the core at touching.
    radius: f64,
    /// Columns: the axes of the core, in those of the pose.
    axes: Mat3,
    /// The centre of the core there.
    origin: Vec3,
    /// The centre of the one.
    y: Vec3,
    /// 1 if the segment belongs to the one, −1 if to the other.
    side: f64,
}

/// A point of the rule: its weight, the height of the strip, and its place on the segment.
#[derive(Clone, Copy)]
struct Sample {
    weight: f64,
    p: f64,
    place: SegmentPlace,
}

impl<'a> Swept<'a> {
    /// `None` where neither solid is round about a segment. Of two the one's is taken, unless the other is a sphere.
    pub fn of(pose: &ConvexPose<'a>) -> Option<Self> {
        let (y, Q) = (pose.y, pose.Q);
        match (pose.own, pose.other) {
            (ConvexShape::Spherocylinder(_), ConvexShape::Spherocylinder(other)) if other.half == Vec3::zeros() => {
                Some(Swept::of_other(y, Q, other.half, other.radius, pose.own))
            }
            (ConvexShape::Spherocylinder(own), core) => {
                let radius = own.radius + core.rounding();
                let (axes, origin) = (Mat3::identity(), Vec3::zeros());
                Some(Swept { core, middle: y, half: Q * own.half, radius, axes, origin, y, side: 1.0 })
            }
            (core, ConvexShape::Spherocylinder(other)) => Some(Swept::of_other(y, Q, other.half, other.radius, core)),
            (
                ConvexShape::Polyhedron(_) | ConvexShape::Cylinder(_) | ConvexShape::HalfSpace(_),
                ConvexShape::Polyhedron(_) | ConvexShape::Cylinder(_) | ConvexShape::HalfSpace(_),
            ) => None,
        }
    }

    fn of_other(y: Vec3, Q: Mat3, half: Vec3, radius: f64, core: &'a ConvexShape) -> Self {
        let (middle, half) = (-Q.tr_mul(&y), Q.tr_mul(&half));
        Swept { core, middle, half, radius: radius + core.rounding(), axes: Q, origin: y, y, side: -1.0 }
    }

    fn at(&self, s: f64) -> SegmentPlace {
        let (d, n) = self.core.distance_from_core(&(self.middle + s * self.half));
        SegmentPlace { s, d, n }
    }

    /// The place that is nearest to the core, or lies deepest in it.
    fn nearest(&self) -> SegmentPlace {
        nearest_place(&self.half, |s| self.at(s))
    }

    /// The axis through the nearest place.
    pub fn least_axis(&self) -> LeastAxis {
        let nearest = self.nearest();
        LeastAxis { axis: self.side * (self.axes * nearest.n), gap: nearest.d - self.radius }
    }

    /// Where the segment comes within the radius of the core, from one of its ends toward the nearest place. Newton's method comes from
    /// outside and stays there, since the distance is convex.
    fn entry(&self, end: f64, nearest: &SegmentPlace) -> f64 {
        let mut place = self.at(end);
        for _ in 0..ITERATIONS {
            let (over, slope) = (place.d - self.radius, place.slope(&self.half));
            if over <= 0.0 || slope * end <= 0.0 {
                break;
            }
            let s = place.s - over / slope;
            if (s - nearest.s) * end <= 0.0 {
                return nearest.s;
            }
            let is_there = (s - place.s).abs() <= 1e-15;
            place = self.at(s);
            if is_there {
                break;
            }
        }
        place.s
    }

    /// Where the pieces of the interval end, in ascending order: at most [`PIECES`] of them.
    fn cuts(&self, [from, to]: [f64; 2], nearest: f64) -> ([f64; PIECES + 1], usize) {
        let (mut cuts, mut count) = ([to; PIECES + 1], 1);
        cuts[0] = from;
        let mut cut = |s: f64| {
            if from < s && s < to && count < PIECES {
                cuts[count] = s;
                count += 1;
            }
        };
        // Beside an edge or a corner the distance bends most at the nearest place: two short pieces have more digits than a long one.
        cut(nearest);
        match self.core {
            ConvexShape::Polyhedron(shape) => match shape.half() {
                Some(half) => {
                    for k in 0..3 {
                        cut((-half[k] - self.middle[k]) / self.half[k]);
                        cut((half[k] - self.middle[k]) / self.half[k]);
                    }
                }
                None => shape.region_changes(&self.middle, &self.half, &mut cut),
            },
            ConvexShape::Spherocylinder(shape) => {
                let (along, rate) = (shape.half.dot(&self.middle), shape.half.dot(&self.half));
                let end = shape.half.norm_squared();
                cut((-end - along) / rate);
                cut((end - along) / rate);
            }
            ConvexShape::Cylinder(shape) => self.cut_by_cylinder(shape, &mut cut),
            ConvexShape::HalfSpace(_) => {}
        }
        cuts[..count].sort_unstable_by(f64::total_cmp);
        cuts[count] = to;
        (cuts, count)
    }

    /// Where the segment crosses the planes of the ends of a cylinder, and its side.
    fn cut_by_cylinder(&self, shape: &RoundCylinder, cut: &mut impl FnMut(f64)) {
        let (middle, half) = (shape.axes().tr_mul(&self.middle), shape.axes().tr_mul(&self.half));
        cut((-shape.half() - middle.z) / half.z);
        cut((shape.half() - middle.z) / half.z);
        let squared = half.x * half.x + half.y * half.y;
        let along = -(middle.x * half.x + middle.y * half.y) / squared;
        let over = (middle.x * half.y - middle.y * half.x).powi(2) / squared;
        let chord = ((shape.radius() * shape.radius() - over) / squared).sqrt();
        cut(along - chord);
        cut(along + chord);
    }

    /// The depth; `None` where the two do not overlap.
    pub fn depth(&self) -> Option<Depth> {
        let nearest = self.nearest();
        if nearest.d >= self.radius {
            return None;
        }
        if self.half == Vec3::zeros() {
            return Some(self.depth_of_sphere(&nearest));
        }
        let interval = [self.entry(-1.0, &nearest), self.entry(1.0, &nearest)];
        let (cuts, count) = self.cuts(interval, nearest.s);
        let empty = Sample { weight: 0.0, p: 0.0, place: nearest };
        let (mut samples, mut taken) = ([empty; PIECES * POINTS], 0);
        let (points, weights) = gauss(POINTS);
        for piece in cuts[..=count].windows(2) {
            let (middle, half) = (0.5 * (piece[0] + piece[1]), 0.5 * (piece[1] - piece[0]));
            for (x, weight) in points.iter().zip(weights) {
                let place = self.at(middle + half * x);
                samples[taken] = Sample { weight: half * weight, p: (self.radius - place.d).max(0.0), place };
                taken += 1;
            }
        }
        self.of_strip(&samples[..taken], 0.5 * (interval[0] + interval[1]))
    }

    /// The depth by the moments of the strip; `about` is near its middle.
    fn of_strip(&self, samples: &[Sample], about: f64) -> Option<Depth> {
        let sum = |f: &dyn Fn(&Sample) -> f64| samples.iter().map(|at| at.weight * at.p * f(at)).sum::<f64>();
        let s = |at: &Sample| at.place.s - about;
        let area = sum(&|_| 1.0);
        let (s_mean, z_mean) = (sum(&s) / area, 0.5 * sum(&|at| at.p) / area);
        let ss = sum(&|at| (s(at) - s_mean).powi(2)) / area;
        let zz = sum(&|at| at.p * at.p) / (3.0 * area) - z_mean * z_mean;
        let sz = sum(&|at| (s(at) - s_mean) * (0.5 * at.p - z_mean)) / area;
        let slope = if ss > 0.0 { sz / ss } else { 0.0 };
        let V = zz - slope * sz;
        let D = (6.0 * V).sqrt();
        if !(D > 0.0 && D.is_finite()) {
            return None;
        }
        let (mut g, mut c) = (Vec6::zeros(), Vec3::zeros());
        for at in samples {
            let height = at.p - z_mean - slope * (s(at) - s_mean);
            let q = 3.0 / (D * area) * (height * height - V);
            g += at.weight * q * self.way(&at.place);
            c += at.weight * at.p / area * self.middle_of_overlap(&at.place);
        }
        // Under a uniform pressure along a line, the mean distance from the middle is half of its half length; the variance is a third of
        // its square.
        let lever = (0.75 * ss).sqrt() * self.half.norm();
        Some(Depth { D, g, c, lever })
    }

    fn depth_of_sphere(&self, at: &SegmentPlace) -> Depth {
        Depth { D: 0.5 * (self.radius - at.d), g: 0.5 * self.way(at), c: self.middle_of_overlap(at), lever: 0.0 }
    }

    /// The growth of p at a place by a displacement of the one and a rotation about its centre.
    fn way(&self, at: &SegmentPlace) -> Vec6 {
        let n = -self.side * (self.axes * at.n);
        stack(&n, &(self.x(at) - self.y).cross(&n))
    }

    /// The place in the axes of the pose.
    fn x(&self, at: &SegmentPlace) -> Vec3 {
        self.origin + self.axes * (self.middle + at.s * self.half)
    }

    /// The middle between the surfaces of the two.
    fn middle_of_overlap(&self, at: &SegmentPlace) -> Vec3 {
        let rounding = self.core.rounding();
        let away = 0.5 * (at.d - rounding + self.radius - rounding);
        self.x(at) - self.axes * at.n * away
    }
}
