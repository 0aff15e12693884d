//! The links of a scene one by one, from which the results of links are computed.

use crate::elements::bushing::Bushing;
use crate::elements::link::Link;

/// A link as the deck lists it; the blocks that integrate links hold copies.
pub enum Watched {
    Line(Link),
    Bushing(Bushing),
}
