//! The program that a file is written for, by its signs.

use crate::keyword_block::KeywordBlock;
use base::text_file::Text;

/// A program whose input a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    /// Abaqus.
    Abaqus,
    /// CalculiX.
    Calculix,
}

/// Keywords that only one of the programs knows.
const OF_ABAQUS: [&str; 6] = ["PART", "INSTANCE", "ASSEMBLY", "PREPRINT", "CONNECTORSECTION", "CONNECTORBEHAVIOR"];
const OF_CALCULIX: [&str; 1] = ["PHYSICALCONSTANTS"];

impl Dialect {
    /// The program of a file; `None` where nothing tells. Signs of Abaqus come first, for CalculiX knows parts too where
    /// Abaqus/CAE has written them.
    pub fn of(text: &Text, blocks: &[KeywordBlock]) -> Option<Dialect> {
        let has = |words: &[&str]| blocks.iter().any(|block| words.contains(&block.keyword.key().as_str()));
        let of_calculix = |block: &KeywordBlock| {
            let keyword = &block.keyword;
            let kind = keyword.value("TYPE").unwrap_or_default().to_ascii_uppercase();
            let output = keyword.value("OUTPUT").unwrap_or_default().to_ascii_uppercase();
            keyword.has("ROTNODE") || ["2D", "3D"].contains(&output.as_str()) || ["U1", "US3"].contains(&kind.as_str())
        };
        let comment = |word: &str| {
            let head = &text.bytes[..text.bytes.len().min(4096)];
            head.windows(word.len()).any(|part| part.eq_ignore_ascii_case(word.as_bytes()))
        };
        let output_field = |block: &KeywordBlock| block.keyword.key() == "OUTPUT" && block.keyword.has("FIELD");
        match () {
            () if blocks.iter().any(of_calculix) || comment("FreeCAD") || comment("Hash:") => Some(Dialect::Calculix),
            () if has(&OF_ABAQUS) || blocks.iter().any(output_field) => Some(Dialect::Abaqus),
            () if has(&OF_CALCULIX) => Some(Dialect::Calculix),
            () => None,
        }
    }
}
