//! The modes that an analysis looks for.

/// Natural modes about the state under the loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModesAsked {
    /// The number of modes.
    pub extent: ModeExtent,
    /// True for complex modes, with damping and gyroscopic moments.
    pub damped: bool,
}

/// The modes that are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModeExtent {
    /// So many, the lowest.
    Count(usize),
    /// All up to a frequency.
    UpTo(f64),
}
