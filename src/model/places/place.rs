//! The meanings of a name in the deck.

use crate::group_names::GroupPlace;
use deck::parts::PartIndex;

/// The meaning of a name in the deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Place {
    /// A point by its node.
    Point(usize),
    // The others stand by their index in the deck, which is their index in a sound model.
    Body(usize),
    Set(usize),
    Joint(usize),
    Drift(usize),
    Part(PartIndex),
    /// An edge of a surface, counted from 0.
    Edge(PartIndex, usize),
    /// Groups of the mesh of one name.
    Group(GroupPlace),
}

impl Place {
    /// "a shell", "an edge of a shell".
    pub fn kind(self) -> String {
        let noun = self.noun();
        format!("{} {noun}", if noun.starts_with('e') { "an" } else { "a" })
    }

    /// The noun for it in messages.
    pub fn noun(self) -> &'static str {
        match self {
            Place::Point(_) => "point",
            Place::Body(_) => "body",
            Place::Set(_) => "set",
            Place::Joint(_) => "joint",
            Place::Drift(_) => "drift",
            Place::Part(part) => part.kind.word(),
            Place::Edge(..) => "edge of a shell",
            Place::Group(_) => "group of the mesh",
        }
    }

    /// False for joints, links, contacts and drifts, which only connect existing nodes.
    pub fn has_nodes(self) -> bool {
        match self {
            Place::Part(part) => part.kind.is_deformable(),
            Place::Joint(_) | Place::Drift(_) => false,
            Place::Point(_) | Place::Body(_) | Place::Set(_) | Place::Edge(..) | Place::Group(_) => true,
        }
    }
}
