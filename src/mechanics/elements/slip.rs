//! The way that friction has slipped in a step, as what remembers it tells.

use base::math::Vec3;

/// A spring of friction over one step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Slip {
    /// The way of its anchor by slip, in axes that turn with what is touched.
    pub way: Vec3,
    /// The size of its force at the end of the step.
    pub pull: f64,
    /// The force per stretch.
    pub stiffness: f64,
    /// False where what rubs is apart at the end of the step.
    pub touches: bool,
}
