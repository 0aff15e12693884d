//! The parts of a model in the equation of motion: a file for each kind, which implements [`Assembled`].

mod assembled;
mod bars;
pub mod beam_ends;
pub mod beam_sections;
pub mod beams;
mod contacts;
pub mod coordinate_springs;
pub mod links;
mod masses;
pub mod shell_shear;
pub mod shells;
mod superelements;

pub use assembled::{Assembled, NodeSpacing, NumberedBlock, Setting};
pub use masses::{LumpedElement, NodalMasses, NodalShare};

use model::{Part, PartKind};

/// A part as a contribution to the system.
pub fn assembled(part: &Part) -> &dyn Assembled {
    match part {
        Part::Beam(beam) => beam,
        Part::Bar(bar) => bar,
        Part::Shell(shell) => shell,
        Part::Link(link) => link,
        Part::Contact(contact) => contact,
        Part::Superelement(superelement) => superelement,
    }
}

/// The column of the energy table for the stored energy of a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// Elastic energy of deformable parts.
    Strain,
    /// Energy of links.
    Links,
    /// Energy of contacts.
    Contacts,
}

/// The energy column of a kind of part.
#[inline]
pub fn storage(kind: PartKind) -> Storage {
    match kind {
        PartKind::Beam | PartKind::Bar | PartKind::Shell | PartKind::Superelement => Storage::Strain,
        PartKind::Link => Storage::Links,
        PartKind::Contact => Storage::Contacts,
    }
}
