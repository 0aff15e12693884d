//! The contacts of a file: laws and pairs of surfaces, and which of them come and go.

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

/// A line of `*MODEL CHANGE`, or a contact pair of a later step.
#[derive(Debug, Clone)]
pub struct ModelChange {
    /// Its line.
    pub line: usize,
    /// Elements, or the two surfaces of a contact pair.
    pub targets: Vec<NamedTarget>,
    /// True for a contact pair.
    pub is_pair: bool,
    /// True for an added one, false for a removed one.
    pub is_added: bool,
    /// True where added elements strain from the start of the file on.
    pub has_strain: bool,
}

impl ModelChange {
    /// A contact pair that comes or goes.
    pub fn of_pair(line: usize, surfaces: Vec<NamedTarget>, is_added: bool) -> Self {
        ModelChange { line, targets: surfaces, is_pair: true, is_added, has_strain: true }
    }

    /// True for this contact pair.
    pub fn is_of_pair(&self, pair: &[NamedTarget; 2]) -> bool {
        let same = |(a, b): (&NamedTarget, &NamedTarget)| a.name.eq_ignore_ascii_case(&b.name);
        self.is_pair && self.targets.len() == 2 && self.targets.iter().zip(pair).all(same)
    }
}

/// All contacts of a file.
#[derive(Debug, Default)]
pub struct ContactCards {
    /// The laws; the last one is still being read.
    pub interactions: Vec<InteractionCard>,
    /// The pairs.
    pub pairs: Vec<ContactCard>,
}
