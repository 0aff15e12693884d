//! The way out of a cylinder across its rim.

use base::math::Vec3;
use base::math::cylinder::RoundCylinder;

/// The shortest direction out of a cylinder across both its rim and an edge, which runs `along` through the inner point `x`. `None` if the
/// edge crosses the side or an end instead. In the axes of the cylinder.
pub(super) fn out_of_rim(cylinder: &RoundCylinder, x: &Vec3, along: &Vec3) -> Option<Vec3> {
    let e = along.normalize();
    let out = Vec3::new(x.x, x.y, 0.0).try_normalize(0.0)?;
    let end = Vec3::z() * 1f64.copysign(x.z);
    let (rise, away) = (end.dot(&e), out.dot(&e));
    if rise * away >= 0.0 {
        return None;
    }
    let mut n = ((rise * out - away * end) * rise.signum()).normalize();
    // Newton's method for the largest n · x less how far the cylinder reaches along n.
    for _ in 0..4 {
        let turned = e.cross(&n);
        let over = x - cylinder.farthest_in_axes(&n);
        let around = Vec3::new(-n.y, n.x, 0.0).dot(&turned);
        let bend = -over.dot(&n) - cylinder.radius() * around * around / n.x.hypot(n.y).powi(3);
        if bend.is_nan() || bend >= 0.0 {
            break;
        }
        let (sine, cosine) = (-over.dot(&turned) / bend).sin_cos();
        n = cosine * n + sine * turned;
    }
    Some(n)
}
