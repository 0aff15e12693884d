//! Links one by one, for results.

use crate::elements::bushing::Bushing;
use crate::elements::link::Link;

/// A link as the deck lists it, apart from the blocks that integrate it.
pub enum Watched {
    Line(Link),
    Bushing(Bushing),
}
