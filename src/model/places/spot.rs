//! A node named in the deck, with its name for messages.

use base::diagnostic::Span;
use std::fmt;

/// A node that a list of names covers.
#[derive(Debug, Clone, Copy)]
pub struct Spot<'d> {
    /// The node.
    pub node: usize,
    /// The name under which a list brought it in.
    pub name: Label<'d>,
    /// The place in the deck of the name that covers the node.
    pub span: &'d Span,
    /// True for a node that is named itself, and not as part of a set, a beam or everything.
    pub direct: bool,
}

/// A node in messages.
#[derive(Debug, Clone, Copy)]
pub enum Label<'d> {
    /// The deck's name of the node, or of the part that it belongs to.
    Name(&'d str),
    /// The number of a node of the mesh, as the deck would name it.
    Mesh(u64),
}

impl fmt::Display for Label<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Label::Name(name) => f.write_str(name),
            Label::Mesh(id) => write!(f, "mesh.{id}"),
        }
    }
}
