//! Places on a segment beside a convex core, and the nearest of them.

use base::math::Vec3;

/// Iterations of the searches along a segment, which double their digits or halve the interval.
pub(super) const ITERATIONS: usize = 80;

/// A place on a segment.
#[derive(Clone, Copy)]
pub(super) struct SegmentPlace {
    /// −1 to 1.
    pub s: f64,
    /// Distance from the core.
    pub d: f64,
    /// Its gradient.
    pub n: Vec3,
}

impl SegmentPlace {
    /// The slope of the distance along a segment of half vector `half`.
    pub fn slope(&self, half: &Vec3) -> f64 {
        self.n.dot(half)
    }
}

/// The place of a segment (half vector `half`) nearest to the core or deepest in it; `at` evaluates a place. The slope of a convex function
/// grows, and is zero there.
pub(super) fn nearest_place(half: &Vec3, at: impl Fn(f64) -> SegmentPlace) -> SegmentPlace {
    nearest_place_within(ITERATIONS, half, at)
}

/// Like [`nearest_place`], with a given number of iterations; every second one halves the interval.
pub(super) fn nearest_place_within(iterations: usize, half: &Vec3, at: impl Fn(f64) -> SegmentPlace) -> SegmentPlace {
    let (mut low, mut high) = (at(-1.0), at(1.0));
    if low.slope(half) >= 0.0 {
        return low;
    }
    if high.slope(half) <= 0.0 {
        return high;
    }
    let size = half.norm();
    for k in 0..iterations {
        let (a, b) = (low.slope(half), high.slope(half));
        // Alternates between the chord, exact for a linear slope, and the middle.
        let s = match k % 2 {
            0 => low.s - a * (high.s - low.s) / (b - a),
            _ => 0.5 * (low.s + high.s),
        };
        let between = at(s);
        match between.slope(half) {
            slope if slope.abs() <= 1e-13 * size => return between,
            slope if slope < 0.0 => low = between,
            _ => high = between,
        }
    }
    if low.d < high.d { low } else { high }
}
