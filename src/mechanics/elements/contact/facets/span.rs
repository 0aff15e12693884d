//! A facet in the order of one coordinate.

/// The least and the largest coordinate of a facet along an axis, and its number.
pub type FacetSpan = (f64, f64, usize);
