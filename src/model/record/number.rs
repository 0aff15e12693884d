//! Numbers as programs in Fortran write them: without a blank between two, with an exponent of `D` or without its letter.

use base::text_file::{TextLine, Word};

/// The numbers of a line between blanks, commas and semicolons, and those that a sign alone separates.
pub fn numbers<'t>(line: TextLine<'t>) -> impl Iterator<Item = Word<'t>> {
    line.words().flat_map(between_commas).flat_map(between_signs)
}

fn between_commas(word: Word<'_>) -> impl Iterator<Item = Word<'_>> {
    pieces(word, |bytes, at| matches!(bytes[at], b',' | b';'))
        .map(|piece| {
            let skip = usize::from(matches!(piece.bytes.first(), Some(b',' | b';')));
            Word { bytes: &piece.bytes[skip..], column: piece.column + skip, line: piece.line }
        })
        .filter(|piece| !piece.bytes.is_empty())
}

fn between_signs(word: Word<'_>) -> impl Iterator<Item = Word<'_>> {
    pieces(word, |bytes, at| at > 0 && matches!(bytes[at], b'+' | b'-') && begins_number(bytes, at))
}

/// True where the sign at a place does not belong to an exponent.
fn begins_number(bytes: &[u8], at: usize) -> bool {
    if !(bytes[at - 1].is_ascii_digit() || bytes[at - 1] == b'.') {
        return false;
    }
    let is_sign = |byte: &u8| matches!(byte, b'+' | b'-');
    let number = bytes[..at].iter().rposition(is_sign).map_or(0, |sign| sign);
    let end = bytes[at + 1..].iter().position(is_sign).map_or(bytes.len(), |length| at + 1 + length);
    // `1.5-05` is one number whose exponent has no letter, `1.5-0.5` and `15-05` are two.
    bytes[at..end].contains(&b'.') || !bytes[number..at].contains(&b'.')
}

/// Splits a word at the positions accepted by `begins`.
fn pieces<'t>(word: Word<'t>, begins: impl Fn(&[u8], usize) -> bool) -> impl Iterator<Item = Word<'t>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        if at >= word.bytes.len() {
            return None;
        }
        let start = at;
        at = (start + 1..word.bytes.len()).find(|&place| begins(word.bytes, place)).unwrap_or(word.bytes.len());
        Some(Word { bytes: &word.bytes[start..at], column: word.column + start, line: word.line })
    })
}

/// A finite number, whatever its exponent looks like.
pub fn number(word: &Word) -> Option<f64> {
    word.number().or_else(|| {
        let text = std::str::from_utf8(word.bytes).ok()?;
        let sign = text.rfind(['+', '-']).filter(|&place| place > 0 && text[..place].contains('.'))?;
        format!("{}e{}", &text[..sign], &text[sign..]).parse().ok().filter(|number: &f64| number.is_finite())
    })
}

/// A whole number, also with a point or an exponent.
pub fn whole(text: &str) -> Option<usize> {
    let number: f64 = text.replace('D', "E").parse().ok()?;
    (number.fract() == 0.0 && (0.0..1e15).contains(&number)).then_some(number as usize)
}

/// True for a line or a word that begins as a number does.
pub fn is_number_like(text: &str) -> bool {
    let digits = text.trim_start().trim_start_matches(['+', '-', '.']);
    digits.starts_with(|c: char| c.is_ascii_digit())
        || text.split_whitespace().next().is_some_and(|word| word.parse::<f64>().is_ok())
}

/// True for a line that begins as comments do.
pub fn is_comment(line: TextLine) -> bool {
    matches!(line.bytes.trim_ascii_start().first(), Some(b'#' | b'%' | b'!'))
}
