//! What a name of the deck can stand for.

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Place {
    /// A point by its node.
    Point(usize),
    // The others stand by their index in the deck, which is their index in a sound model.
    Body(usize),
    Set(usize),
    Beam(usize),
    Bar(usize),
    Shell(usize),
    /// An edge of a shell, counted from 0.
    Edge(usize, usize),
    Link(usize),
    Joint(usize),
    Contact(usize),
    /// A group of the mesh.
    Group(usize),
}

impl Place {
    /// "a shell", "an edge of a shell".
    pub fn kind(self) -> String {
        let noun = self.noun();
        format!("{} {noun}", if noun.starts_with('e') { "an" } else { "a" })
    }

    pub fn noun(self) -> &'static str {
        match self {
            Place::Point(_) => "point",
            Place::Body(_) => "body",
            Place::Set(_) => "set",
            Place::Beam(_) => "beam",
            Place::Bar(_) => "bar",
            Place::Shell(_) => "shell",
            Place::Edge(..) => "edge of a shell",
            Place::Link(_) => "link",
            Place::Joint(_) => "joint",
            Place::Contact(_) => "contact",
            Place::Group(_) => "group of the mesh",
        }
    }
}
