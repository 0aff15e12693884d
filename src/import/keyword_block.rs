//! A keyword with its lines of data.

use crate::element_types::ElementType;
use base::text_file::Text;
use base::text_file::cards::{Card, Cards, Data, Keyword};

/// Parameters without a value. After a comma they may stand on the next line.
const FLAGS: &[&str] = &[
    "GENERATE",
    "INTERNAL",
    "UNSORTED",
    "NLGEOM",
    "PERTURBATION",
    "DIRECT",
    "NONLINEAR",
    "RIKS",
    "EXPLICIT",
    "WRITE",
    "STABILIZE",
    "NOCOMPRESSION",
    "FOLLOWER",
    "FIXED",
    "COMPOSITE",
];

/// A keyword and its lines of data.
pub struct KeywordBlock<'t> {
    /// The keyword.
    pub keyword: Keyword<'t>,
    /// Its lines of data. Lines of one element are one.
    pub data: Vec<Data<'t>>,
}

/// All keywords of a text.
pub fn blocks<'t>(text: &mut Text<'t>) -> Vec<KeywordBlock<'t>> {
    let mut cards = Cards::new(text, FLAGS);
    let mut blocks: Vec<KeywordBlock<'t>> = Vec::new();
    let mut fields = 0;
    while let Some(card) = cards.card() {
        match card {
            Card::Keyword(keyword) => {
                let kind = keyword.value("TYPE").filter(|_| keyword.key() == "ELEMENT").map(ElementType::new);
                fields = kind.map_or(0, |kind| 1 + kind.nodes);
                blocks.push(KeywordBlock { keyword, data: Vec::new() });
            }
            Card::Data(mut data) => {
                cards.complete(&mut data, fields);
                // Lines before the first keyword belong to nothing.
                if let Some(block) = blocks.last_mut() {
                    block.data.push(data);
                }
            }
        }
    }
    blocks
}
