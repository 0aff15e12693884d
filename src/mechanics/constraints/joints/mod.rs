//! The kinds of joints: which constraint equations each sets up between its two ends, and from which axes. One more
//! kind is a file of its own and an entry of [`JOINTS`].

pub mod cylindrical;
pub mod distance;
pub mod fixed;
pub mod in_line;
pub mod in_plane;
pub mod kind;
pub mod planar;
pub mod prismatic;
pub mod revolute;
pub mod screw;
pub mod spherical;
pub mod universal;

pub use kind::JointKind;

/// All kinds of joints, in the order in which help lists them.
pub static JOINTS: &[&JointKind] = &[
    &spherical::KIND,
    &revolute::KIND,
    &prismatic::KIND,
    &cylindrical::KIND,
    &screw::KIND,
    &planar::KIND,
    &in_line::KIND,
    &in_plane::KIND,
    &universal::KIND,
    &fixed::KIND,
    &distance::KIND,
];
