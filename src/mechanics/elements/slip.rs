//! Slip of friction in a step, from the history of the springs that remember it.

use base::math::Vec3;

/// A spring of friction over one step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Slip {
    /// The displacement of the anchor by slip, in axes turning with the touched body.
    pub way: Vec3,
    /// The size of its force at the end of the step.
    pub pull: f64,
    /// The force per stretch.
    pub stiffness: f64,
    /// False if the two are apart at the end of the step.
    pub touches: bool,
    /// The way along each other in a step that ends apart.
    pub apart: f64,
    /// The approach speed at both ends of the step, negative in separation; infinite at the start if unknown.
    pub approach: [f64; 2],
}

/// A group of elements with springs of friction whose slip is known.
pub trait Sliding {
    /// True if element `e` has friction.
    fn has_friction(&self, e: usize) -> bool;

    /// Slip of element `e` in a step of length `dt` between two histories of the group.
    fn slip(&self, e: usize, histories: [&[f64]; 2], dt: f64) -> Slip;
}
