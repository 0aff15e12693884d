//! Blocks of like elements, each with the part that it belongs to.

use mechanics::elements::contact::PairBlock;
use mechanics::elements::{ElementBlock, Wandering};
use mechanics::state::Configuration;
use model::{Model, Part, PartKind};
use std::ops::{Deref, DerefMut, Range};

/// Elements, or pairs that may touch.
pub enum GroupBlock {
    /// Elements.
    Elements(Box<dyn ElementBlock>),
    /// Pairs.
    Pairs(Box<dyn PairBlock>),
}

impl GroupBlock {
    /// The pairs; `None` for elements.
    pub fn pairs(&self) -> Option<&dyn PairBlock> {
        match self {
            GroupBlock::Elements(_) => None,
            GroupBlock::Pairs(block) => Some(&**block),
        }
    }
}

impl Deref for GroupBlock {
    type Target = dyn ElementBlock;

    fn deref(&self) -> &Self::Target {
        match self {
            GroupBlock::Elements(block) => &**block,
            GroupBlock::Pairs(block) => &**block,
        }
    }
}

impl DerefMut for GroupBlock {
    fn deref_mut(&mut self) -> &mut Self::Target {
        match self {
            GroupBlock::Elements(block) => &mut **block,
            GroupBlock::Pairs(block) => &mut **block,
        }
    }
}

/// A group of like elements of one part: all of them, or a contiguous range where they are many.
pub struct Group {
    /// The elements with their formulation.
    pub block: GroupBlock,
    /// The kind of the part, which determines the energy column of the elements.
    pub kind: PartKind,
    /// The part's index in [`model::Model::parts`]. Links share one group; it has the index of the first link.
    pub part: usize,
    /// Number, within the part, of the group's first element.
    pub first: usize,
    /// The group's range of [`mechanics::state::State::history`].
    pub history: Range<usize>,
    /// True for the superelement of a reduced part, whose own elements give the results.
    pub reduces: bool,
}

impl Group {
    /// The elements, if their nodes change.
    pub fn wandering(&self) -> Option<&dyn Wandering> {
        self.block.pairs()?.wandering()
    }

    /// Other nodes subject to forces of the elements, and all nodes that turn with them.
    pub fn further_nodes(&self) -> [&[usize]; 2] {
        self.wandering().map_or([&[], &[]], Wandering::further_nodes)
    }

    /// The configuration with this group's range of the history variables alone.
    #[inline]
    pub fn configuration<'a>(&self, now: &Configuration<'a>) -> Configuration<'a> {
        Configuration { history: &now.history[self.history.clone()], ..*now }
    }

    /// The part of element `e`. Springs share one group and bushings another, so a link is known by its ends.
    pub fn part_of<'m>(&self, e: usize, model: &'m Model) -> &'m Part {
        let parts = &model.parts[self.part..];
        let own = |part: &&Part| part.kind() == self.kind && self.block.nodes(e).starts_with(part.nodes(0));
        let first = &parts[0];
        if self.kind.is_deformable() || self.kind.is_unilateral() {
            first
        } else {
            parts.iter().find(own).unwrap_or(first)
        }
    }
}
