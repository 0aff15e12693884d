//! The modes that an analysis looks for.

use super::response::{ResponseAsked, ResponseMethod};

/// Modes about the state in which loads hold the scene.
#[derive(Debug, Clone)]
pub struct ModesAsked {
    /// Natural modes or those of buckling.
    pub kind: ModeKind,
    /// The number of modes.
    pub extent: ModeExtent,
    /// True for complex modes, with damping and gyroscopic moments.
    pub damped: bool,
    /// The frequency response that is computed instead; its modes are natural ones.
    pub response: Option<ResponseAsked>,
}

impl ModesAsked {
    /// True where modes are found, and listed.
    pub fn lists_modes(&self) -> bool {
        self.response.as_ref().is_none_or(|response| response.method == ResponseMethod::Modal)
    }
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
