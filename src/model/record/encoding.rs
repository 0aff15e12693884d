//! Text as other programs and countries write it, made plain: UTF-8, decimals behind a point.

use base::text_file::{Text, TextLine};
use std::borrow::Cow;

/// The text in UTF-8 with points for decimal commas, line by line as it was.
pub fn plain(bytes: &[u8]) -> Cow<'_, [u8]> {
    let text = match bytes {
        [0xff, 0xfe, units @ ..] => Cow::Owned(from_utf16(units, u16::from_le_bytes)),
        [0xfe, 0xff, units @ ..] => Cow::Owned(from_utf16(units, u16::from_be_bytes)),
        _ => Cow::Borrowed(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)),
    };
    match has_decimal_commas(&text) {
        true => Cow::Owned(with_points(&text)),
        false => text,
    }
}

fn from_utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Vec<u8> {
    let units: Vec<u16> = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
    String::from_utf16_lossy(&units).into_bytes()
}

/// True if commas can only be decimal signs: some line says so, and none contradicts.
fn has_decimal_commas(bytes: &[u8]) -> bool {
    let mut text = Text::new("", bytes);
    let mut is_certain = false;
    while let Some(line) = text.line() {
        match commas_are_decimal(line) {
            Some(false) => return false,
            Some(true) => is_certain = true,
            None => {}
        }
    }
    is_certain
}

/// Whether the commas of several numbers between blanks, tabs or semicolons are decimal signs; `None` if the line does not say it.
fn commas_are_decimal(line: TextLine) -> Option<bool> {
    if !is_of_numbers(line) {
        return None;
    }
    let parts: Vec<&[u8]> = line.bytes.split(|byte| b" \t;".contains(byte)).filter(|part| !part.is_empty()).collect();
    // The digits on both sides of a comma.
    let sides = |part: &'_ [u8]| -> Option<(usize, usize)> {
        let place = part.iter().position(|byte| *byte == b',')?;
        let whole = part[..place].iter().filter(|byte| (b'1'..=b'9').contains(*byte)).count();
        Some((whole, part[place + 1..].iter().take_while(|byte| byte.is_ascii_digit()).count()))
    };
    let is_other = |part: &&[u8]| {
        part.contains(&b'.')
            || part.iter().filter(|byte| **byte == b',').count() > 1
            || sides(part).is_some_and(|(_, digits)| digits == 0)
    };
    if parts.iter().any(is_other) {
        return Some(false);
    }
    // `1,234` may be a thousand, and `1,2` alone two columns.
    let is_decimal = |part: &&[u8]| sides(part).is_some_and(|(whole, digits)| whole == 0 || digits != 3);
    (parts.len() > 1 && parts.iter().any(is_decimal)).then_some(true)
}

/// True for a line of digits, signs, exponents and what separates them.
fn is_of_numbers(line: TextLine) -> bool {
    line.bytes.iter().all(|byte| byte.is_ascii_digit() || b" \t;,.+-eEdD\"".contains(byte))
}

/// The text with points for the commas in lines of numbers.
fn with_points(bytes: &[u8]) -> Vec<u8> {
    let mut plain = bytes.to_vec();
    for line in plain.split_mut(|byte| *byte == b'\n') {
        if is_of_numbers(TextLine { bytes: line.trim_ascii_end(), number: 0 }) {
            line.iter_mut().filter(|byte| **byte == b',').for_each(|byte| *byte = b'.');
        }
    }
    plain
}
