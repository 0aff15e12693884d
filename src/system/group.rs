//! Blocks of like elements, each with the part that it belongs to.

use crate::elements::ElementBlock;
use crate::model::PartKind;
use crate::state::Configuration;
use std::ops::Range;

/// A group of like elements, of one part: all of them, or some in a row where they are many.
pub struct Group {
    pub block: Box<dyn ElementBlock>,
    pub kind: PartKind,
    /// Place in [`crate::model::Model::parts`] of the part; of links, which share groups, that of the first.
    pub part: usize,
    /// The part's number of its first element.
    pub first: usize,
    /// Its share of [`crate::state::State::history`].
    pub history: Range<usize>,
}

impl Group {
    /// The configuration with this group's own history alone.
    #[inline]
    pub fn share<'a>(&self, now: &Configuration<'a>) -> Configuration<'a> {
        Configuration { history: &now.history[self.history.clone()], ..*now }
    }
}
