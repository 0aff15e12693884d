//! The modes that an analysis looks for.

/// Modes about the state in which loads hold the scene.
#[derive(Debug, Clone)]
pub struct ModesAsked {
    /// Natural modes or those of buckling.
    pub kind: ModeKind,
    /// The number of modes.
    pub extent: ModeExtent,
    /// True for complex modes, with damping and gyroscopic moments.
    pub damped: bool,
}

/// The kinds of modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ModeKind {
    /// Natural modes.
    #[default]
    Natural,
    /// Modes of buckling.
    Buckling,
}

/// The modes that are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModeExtent {
    /// So many, the lowest.
    Count(usize),
    /// All up to a frequency.
    UpTo(f64),
}
