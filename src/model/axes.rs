//! Axes of a frame, given by two vectors.

use super::report::Report;
use crate::deck::words::Numbers;
use crate::diagnostic::{At, Span};
use crate::math::{Mat3, Vec3};

/// The frame whose x lies along the first vector of `axes` and whose x-y plane holds the second.
pub(super) fn axes(axes: &At<Vec<Numbers<3>>>, report: &mut Report) -> Option<Mat3> {
    let place: &Span = &axes.span;
    let [x, y] = axes.as_slice() else {
        return report.error_with(place, "`axes` takes two vectors", "x, and a vector in the x-y plane");
    };
    let unit = |v: &Numbers<3>| Vec3::from(v.0).try_normalize(0.0);
    let z = unit(x).zip(unit(y)).and_then(|(x, y)| x.cross(&y).try_normalize(1e-6));
    let Some((x, z)) = unit(x).zip(z) else {
        return report.error(place, "the two vectors of `axes` must be neither zero nor parallel");
    };
    Some(Mat3::from_columns(&[x, z.cross(&x), z]))
}
