//! Directions and frames from vectors of the deck; lengths do not count.

use crate::math::{Mat3, Vec3};

/// The unit vector along a direction; `None` where it has none.
pub fn unit(v: &Vec3) -> Option<Vec3> {
    // A second attempt scales first: the square of a large component may overflow, that of a small one vanish.
    let unit = v.try_normalize(0.0).or_else(|| (v / v.amax()).try_normalize(0.0));
    unit.filter(|unit| unit.amax().is_finite())
}

/// The frame (columns: its axes) with x along the first vector and the second vector in the x-y plane.
///
/// # Errors
/// There are other than two vectors, or they are zero or parallel; the error says so in words.
pub fn axes(vectors: &[Vec3]) -> Result<Mat3, &'static str> {
    let [x, y] = vectors else {
        return Err("`axes` needs two vectors: x, and a vector in the x-y plane");
    };
    let (x, y) = (x.try_normalize(0.0), y.try_normalize(0.0));
    let z = x.zip(y).and_then(|(x, y)| x.cross(&y).try_normalize(1e-6));
    let (x, z) = x.zip(z).ok_or("the two vectors of `axes` must be neither zero nor parallel")?;
    Ok(Mat3::from_columns(&[x, z.cross(&x), z]))
}
