//! The parts of a scene that resist: beams, bars, shells, links and contacts. [`PartAnswers`] lists the questions to any part, answered by
//! each kind in one file. A further kind is one file and one variant; the compiler then finds the missing match arms.

use super::bar::Bar;
use super::beam::Beam;
use super::contact::Contact;
use super::link::Link;
use super::part_answers::PartAnswers;
use super::shell::Shell;
use super::superelement::Superelement;
use base::quantities::Column;
use deck::parts::PartKind;
use std::ops::{Deref, DerefMut};

/// A part of the scene; [`super::Model::parts`] lists them kind by kind in the order of the variants.
#[derive(Debug, Clone)]
pub enum Part {
    /// A line of elements that stretch, shear, bend and twist.
    Beam(Beam),
    /// Bars or cables: straight elements with an axial force only.
    Bar(Bar),
    /// A surface of elements that stretch, shear and bend; a shell of the deck with two shapes of elements makes two.
    Shell(Shell),
    /// A part by its matrices.
    Superelement(Superelement),
    /// A spring, damper or bushing between two nodes.
    Link(Link),
    /// Points, or boxes, against a surface.
    Contact(Contact),
}

impl Part {
    /// The kind of the part, independent of its data.
    pub fn kind(&self) -> PartKind {
        match self {
            Part::Beam(_) => PartKind::Beam,
            Part::Bar(_) => PartKind::Bar,
            Part::Shell(_) => PartKind::Shell,
            Part::Superelement(_) => PartKind::Superelement,
            Part::Link(_) => PartKind::Link,
            Part::Contact(_) => PartKind::Contact,
        }
    }

    /// True where the two are one part of the deck: a shell of triangles and one of quadrilaterals.
    pub fn is_one_with(&self, other: &Part) -> bool {
        self.kind() == other.kind() && self.name() == other.name()
    }

    /// The count of the part in the log and `check`: its elements, or 1 for links and contacts.
    pub fn counted(&self) -> usize {
        if self.kind().is_deformable() { self.elements() } else { 1 }
    }
}

/// A part gives access to the common interface of all kinds.
impl Deref for Part {
    type Target = dyn PartAnswers;

    fn deref(&self) -> &Self::Target {
        match self {
            Part::Beam(part) => part,
            Part::Bar(part) => part,
            Part::Shell(part) => part,
            Part::Superelement(part) => part,
            Part::Link(part) => part,
            Part::Contact(part) => part,
        }
    }
}

impl DerefMut for Part {
    fn deref_mut(&mut self) -> &mut Self::Target {
        match self {
            Part::Beam(part) => part,
            Part::Bar(part) => part,
            Part::Shell(part) => part,
            Part::Superelement(part) => part,
            Part::Link(part) => part,
            Part::Contact(part) => part,
        }
    }
}

/// The quantities for `[[expect]]` of a part of this kind; plastic strain only if its material yields.
pub fn quantities_of(kind: PartKind) -> Vec<Column> {
    let quantities = match kind {
        PartKind::Beam => Beam::QUANTITIES,
        PartKind::Bar => Bar::QUANTITIES,
        PartKind::Shell => Shell::QUANTITIES,
        PartKind::Superelement => Superelement::QUANTITIES,
        PartKind::Link => Link::QUANTITIES,
        PartKind::Contact => Contact::QUANTITIES,
    };
    quantities.concat()
}

/// One of the types that [`Part`] holds.
pub trait PartType: Into<Part> {
    /// The part as this type; `None` where it is of another kind.
    fn of(part: &Part) -> Option<&Self>;
    /// The part as this type, mutable.
    fn of_mut(part: &mut Part) -> Option<&mut Self>;
}

macro_rules! part_types {
    ($($Type:ident)*) => {$(
        impl From<$Type> for Part {
            fn from(part: $Type) -> Part {
                Part::$Type(part)
            }
        }

        impl PartType for $Type {
            fn of(part: &Part) -> Option<&$Type> {
                if let Part::$Type(part) = part { Some(part) } else { None }
            }

            fn of_mut(part: &mut Part) -> Option<&mut $Type> {
                if let Part::$Type(part) = part { Some(part) } else { None }
            }
        }
    )*};
}

part_types! { Beam Bar Shell Superelement Link Contact }
