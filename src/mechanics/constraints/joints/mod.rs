//! Kinds of joints, with their constraint equations and axes. A new kind needs a file and an entry of [`JOINTS`].

pub mod actuator;
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

/// All kinds of joints, in the order of the help text.
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
    &actuator::KIND,
];
