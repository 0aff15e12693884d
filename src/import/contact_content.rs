//! The contacts of a file: laws and pairs of surfaces.

use crate::scopes::NamedTarget;

/// The law of contact under a name.
#[derive(Debug, Clone, Default)]
pub struct InteractionCard {
    /// Its name in small letters.
    pub name: String,
    /// Coefficients of friction: while it sticks, while it slips fast, and the decay between them by the speed; and their line.
    pub friction: Option<([f64; 3], usize)>,
}

/// Two surfaces in contact.
#[derive(Debug, Clone)]
pub struct ContactCard {
    /// Its line.
    pub line: usize,
    /// The name of its law in small letters.
    pub interaction: String,
    /// The surface whose nodes touch, and the one that they touch.
    pub surfaces: [NamedTarget; 2],
    /// True where Abaqus leaves out the thickness of shells: nodes touch a surface at finite sliding.
    pub is_thin: bool,
}

/// All contacts of a file.
#[derive(Debug, Default)]
pub struct ContactCards {
    /// The laws; the last one is still being read.
    pub interactions: Vec<InteractionCard>,
    /// The pairs.
    pub pairs: Vec<ContactCard>,
}
