//! Where two segments are nearest to each other.

use base::math::Vec3;

/// Two lines count as parallel below this square of the sine of their angle.
pub(super) const PARALLEL: f64 = 1e-12;

/// The shares of the second ends in the nearest points of the lines from `a` to `a + u` and from `b` to `b + v`, with `r` = a − b. For
/// parallel lines, the middle of the common part (after C. Ericson, Real-Time Collision Detection, 2005, 5.1.9).
pub(super) fn nearest(r: &Vec3, u: &Vec3, v: &Vec3) -> [f64; 2] {
    let (uu, vv, uv) = (u.norm_squared(), v.norm_squared(), u.dot(v));
    let (c, f) = (u.dot(r), v.dot(r));
    if uu == 0.0 || vv == 0.0 {
        let on = |along: f64, square: f64| if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
        return if uu == 0.0 { [0.0, on(f, vv)] } else { [on(-c, uu), 0.0] };
    }
    let determinant = uu * vv - uv * uv;
    if determinant <= PARALLEL * uu * vv {
        // Where the ends of the other lie along this one.
        let (first, last) = (-c / uu, (uv - c) / uu);
        let (low, high) = (first.min(last).max(0.0), first.max(last).min(1.0));
        let s = if low <= high { 0.5 * (low + high) } else { (0.5 * (low + high)).clamp(0.0, 1.0) };
        return [s, ((f + s * uv) / vv).clamp(0.0, 1.0)];
    }
    let s = ((uv * f - c * vv) / determinant).clamp(0.0, 1.0);
    let t = (f + s * uv) / vv;
    match t {
        _ if t < 0.0 => [(-c / uu).clamp(0.0, 1.0), 0.0],
        _ if t > 1.0 => [((uv - c) / uu).clamp(0.0, 1.0), 1.0],
        _ => [s, t],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn the_nearest_points_are_the_nearest_of_all() {
        let mut rng = StdRng::seed_from_u64(5);
        let mut vector = || Vec3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        for round in 0..600 {
            let (a, b, u) = (vector(), 0.5 * vector(), vector());
            // Some are parallel.
            let v = if round % 3 == 0 { -0.7 * u } else { vector() };
            let [s, t] = nearest(&(a - b), &u, &v);
            let distance = (a + s * u - b - t * v).norm();
            let mut least = f64::INFINITY;
            for i in 0..=100 {
                for j in 0..=100 {
                    let (s, t) = (f64::from(i) / 100.0, f64::from(j) / 100.0);
                    least = least.min((a + s * u - b - t * v).norm());
                }
            }
            // Samples stand up to 1/100 of lengths up to 1.7 apart.
            assert!(distance <= least + 1e-12 && least < distance + 0.02, "{distance} {least}");
        }
    }
}
