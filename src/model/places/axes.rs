//! Axes of a frame, given by two vectors.

use crate::report::Report;
use base::diagnostic::At;
use base::math::{Mat3, Vec3};
use deck::words::{Numbers, kinds};

/// The frame with x along the first vector of `axes` and the second vector in its x-y plane.
pub fn axes(axes: &At<Vec<Numbers<3>>>, report: &mut Report) -> Option<Mat3> {
    let vectors: Vec<Vec3> = axes.iter().map(|vector| Vec3::from(vector.0)).collect();
    kinds::axes(&vectors).map_or_else(|wrong| report.error(&axes.span, wrong), Some)
}
