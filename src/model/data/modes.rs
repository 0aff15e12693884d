//! The modes that an analysis looks for.

/// Natural modes about the state under the loads.
#[derive(Debug, Clone, PartialEq)]
pub struct ModesAsked {
    /// The number of modes.
    pub extent: ModeExtent,
    /// True for complex modes, with damping and gyroscopic moments.
    pub damped: bool,
    /// Speeds of rotation over which complex modes are found, ascending; none for the modes of the state alone.
    pub speeds: Vec<f64>,
}

/// The modes that are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModeExtent {
    /// So many, the lowest.
    Count(usize),
    /// All up to a frequency.
    UpTo(f64),
}
