//! Units, by what pre-processors remark in a file.

use base::text_file::Text;

/// Remarks on units, and the word of the deck for them.
const REMARKS: [(&str, &str); 6] = [
    ("Unit system: M_KG_S", "SI"),
    ("Unit system: MM_TON_S", "mm-t-s"),
    ("Unit system: MM_KG_S", "mm-kg-s"),
    ("Mass: t", "mm-t-s"),
    ("Mass: kg; Length: m;", "SI"),
    ("Mass: kg; Length: mm;", "mm-kg-s"),
];

/// The deck's word for the units that a remark near the beginning of the file names.
pub fn units(text: &Text) -> Option<&'static str> {
    let head = String::from_utf8_lossy(&text.bytes[..text.bytes.len().min(1 << 16)]);
    let found = head.lines().filter_map(|line| REMARKS.iter().find(|(remark, _)| line.contains(remark)));
    found.map(|(_, word)| *word).next()
}
