//! Explains numbers and comments written as in other languages and programs, which TOML does not read.

use base::diagnostic::Diagnostic;
use std::borrow::Cow;

/// Characters that editors put in place of those of TOML, with their names and what to write.
const LOOKALIKES: [(char, &str, &str); 9] = [
    ('\u{2212}', "the minus sign of mathematics", "-"),
    ('\u{2013}', "a dash", "-"),
    ('\u{2014}', "a dash", "-"),
    ('\u{2010}', "a hyphen of typography", "-"),
    ('\u{201c}', "a quotation mark of typography", "\""),
    ('\u{201d}', "a quotation mark of typography", "\""),
    ('\u{201e}', "a quotation mark of typography", "\""),
    ('\u{00a0}', "a blank that breaks no line", "a blank"),
    ('\u{feff}', "a byte order mark", "nothing"),
];

/// A text whose lines of comments of another language are comments of TOML, byte for byte in the same place, and the fault of the first. The
/// parser would skip the tables below such a line, and report them as missing.
pub fn without_foreign_comments(text: &str) -> (Cow<'_, str>, Option<Diagnostic>) {
    const MARK: &str = "//";
    let is_comment = |line: &&str| line.trim_start().starts_with(MARK);
    let count = text.lines().filter(is_comment).count();
    // Within a text of several lines such a line may be meant.
    if count == 0 || text.contains("\"\"\"") || text.contains("'''") {
        return (Cow::Borrowed(text), None);
    }
    let lines = text.split_inclusive('\n');
    let mended: String =
        lines.map(|line| if is_comment(&line) { line.replacen(MARK, "# ", 1) } else { line.to_owned() }).collect();
    let at = text.find(MARK).unwrap_or_default();
    let begin = text.lines().find(is_comment).map_or(at, |line| line.as_ptr() as usize - text.as_ptr() as usize);
    let place = begin + text[begin..].find(MARK).unwrap_or_default();
    let fault = Diagnostic::error(format!("`{MARK}` begins no comment in TOML")).at(&(place..place + MARK.len()));
    let fault = fault.hint("a comment begins with #");
    let fault = if count > 1 { fault.hint(format!("the same goes for {} more lines", count - 1)) } else { fault };
    (Cow::Owned(mended), Some(fault))
}

/// Fault of the mark or the number at byte `at` of a text, and its correction; `None` if none stands there.
pub fn explain(text: &str, at: usize) -> Option<(String, String)> {
    of_mark(text, at).or_else(|| of_number(text, at))
}

/// A comment of another language, or a character that looks like one of TOML.
fn of_mark(text: &str, at: usize) -> Option<(String, String)> {
    let (before, after) = text.split_at_checked(at)?;
    let begin = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[begin..].lines().next().unwrap_or_default();
    let outside = |place: usize| !line[..place].contains('#') && line[..place].matches('"').count().is_multiple_of(2);
    for mark in ["//", "/*"] {
        if line.find(mark).is_some_and(outside) {
            return Some((format!("`{mark}` begins no comment in TOML"), "a comment begins with #".to_owned()));
        }
    }
    let near = [before.chars().next_back(), after.chars().next()];
    let (mark, name, meant) = LOOKALIKES.into_iter().find(|(mark, ..)| near.contains(&Some(*mark)))?;
    let code = format!("U+{:04X}", u32::from(mark));
    Some((format!("`{mark}` ({code}) is {name}, which TOML does not know"), format!("write {meant}")))
}

fn of_number(text: &str, at: usize) -> Option<(String, String)> {
    let (before, after) = text.split_at_checked(at)?;
    let is_part = |c: char| c.is_ascii_alphanumeric() || "+-._".contains(c);
    let begin = before.trim_end_matches(is_part).len();
    let end = at + after.find(|c: char| !is_part(c)).unwrap_or(after.len());
    let (before, word, after) = (&text[..begin], &text[begin..end], &text[end..]);
    if let Some(meant) = meant(word) {
        return Some((format!("`{word}` is not a number in TOML"), format!("write {meant}")));
    }
    if let Some(number) = with_comma(before, word, after) {
        let (message, hint) = (format!("`{number}` is not a number in TOML"), number.replace(',', "."));
        return Some((message, format!("the decimal mark is a point: {hint}")));
    }
    let unit = word.trim_start_matches(|c: char| c.is_ascii_digit() || "+-._".contains(c));
    let has_unit = !unit.is_empty() || after.trim_start_matches(' ').starts_with(char::is_alphabetic);
    (word.starts_with(|c: char| c.is_ascii_digit()) && has_unit).then(|| {
        ("this is not TOML".to_owned(), "a number stands alone, without a unit and without arithmetic".to_owned())
    })
}

/// The number with a decimal comma, one side of which is `word`; `None` if there is none. It is all of a value: in an array a comma stands
/// between two numbers.
fn with_comma(before: &str, word: &str, after: &str) -> Option<String> {
    let is_whole = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    let is_other = |c: char| !c.is_ascii_alphanumeric() && !"+-._".contains(c);
    let (rest, whole, decimals) = match (before.strip_suffix(','), after.strip_prefix(',')) {
        (Some(before), _) => {
            let whole = before.rsplit(is_other).next()?;
            (&before[..before.len() - whole.len()], whole, word)
        }
        (None, Some(after)) => (before, word, after.split(is_other).next()?),
        _ => return None,
    };
    let is_number = is_whole(whole) && is_whole(decimals) && rest.trim_end().ends_with('=');
    is_number.then(|| format!("{whole},{decimals}"))
}

/// The number that a word represents, in TOML: digits on both sides of the point, no leading zeros, and `e` before the exponent. `None`
/// where it is one already, or none at all.
fn meant(word: &str) -> Option<String> {
    let digits = word.trim_start_matches(['+', '-']);
    let sign = &word[..word.len() - digits.len()];
    if sign.len() > 1 {
        return None;
    }
    let (mantissa, exponent) = match digits.find(|c| "eEdD".contains(c)) {
        Some(at) => (&digits[..at], Some(&digits[at + 1..])),
        None => (digits, None),
    };
    let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let all_digits = |text: &str| text.chars().all(|c| c.is_ascii_digit() || c == '_');
    // A word that begins with the letter of an exponent is a name.
    if !all_digits(whole) || !all_digits(decimals) || whole.is_empty() && decimals.is_empty() {
        return None;
    }
    let or_zero = |text: &str| if text.is_empty() { "0".to_owned() } else { text.to_owned() };
    let mut meant = format!("{sign}{}", or_zero(whole.trim_start_matches('0')));
    if mantissa.contains('.') {
        meant += &format!(".{}", or_zero(decimals));
    }
    if let Some(exponent) = exponent {
        exponent.parse::<i32>().ok()?;
        meant += &format!("e{exponent}");
    }
    (meant != word).then_some(meant)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_other_programs_are_known() {
        for (word, wanted) in [
            ("900.", "900.0"),
            (".5", "0.5"),
            ("-.5e-3", "-0.5e-3"),
            ("1.e3", "1.0e3"),
            ("1d3", "1e3"),
            ("1.5D-3", "1.5e-3"),
            ("007", "7"),
            ("00.5", "0.5"),
        ] {
            assert_eq!(meant(word).as_deref(), Some(wanted), "{word}");
            assert!(toml::from_str::<toml::Table>(&format!("x = {wanted}")).is_ok(), "{wanted}");
        }
        for word in ["1.0", "1e5", "-2", "", "e3", ".", "1.2.3", "a1", "1ee3", "--1", "0x10"] {
            assert_eq!(meant(word), None, "{word}");
        }
    }

    #[test]
    fn comments_and_lookalikes_are_named() {
        for text in ["x = 1 // half", "// x", "x = [1, /* two */ 2]"] {
            for at in 0..text.len() {
                assert_eq!(explain(text, at).unwrap().1, "a comment begins with #", "{text} {at}");
            }
        }
        let (message, hint) = explain("x = \u{2212}5.0", 4).unwrap();
        assert!(message.contains("U+2212") && message.contains("minus sign"), "{message}");
        assert_eq!(hint, "write -");
        assert!(explain("x = \u{201c}steel\u{201d}", 4).unwrap().1.contains('"'));
        for text in ["x = 1/2", "x = \"a//b\" y", "x = 1 y # // z"] {
            assert!(explain(text, 5).is_none_or(|(_, hint)| hint != "a comment begins with #"), "{text}");
        }
    }

    #[test]
    fn the_place_may_be_anywhere_in_the_number() {
        let said = |text: &str, at: &str| explain(text, text.find(at).expect("the place")).map(|(_, hint)| hint);
        assert_eq!(said("x = 900., y", ", y").as_deref(), Some("write 900.0"));
        assert_eq!(said("x = [.5]", ".").as_deref(), Some("write 0.5"));
        for at in ["0", ",", "5"] {
            assert_eq!(said("x = 0,5", at).as_deref(), Some("the decimal mark is a point: 0.5"), "{at}");
        }
        // An array that is not closed.
        assert_eq!(explain("x = [4,4", 8), None);
        for at in ["1", ",", "2"] {
            assert_eq!(said("x = 1.0,2.0", at), None, "{at}");
        }
        assert_eq!(
            said("x = 5 mm", "5").as_deref(),
            Some("a number stands alone, without a unit and without arithmetic")
        );
        assert_eq!(
            said("x = 5mm", "5").as_deref(),
            Some("a number stands alone, without a unit and without arithmetic")
        );
        for text in ["x = steel", "x = ", "x = \"a", "é = 1"] {
            for at in 0..=text.len() {
                assert_eq!(explain(text, at).filter(|_| !text.contains('1')), None, "{text} {at}");
            }
        }
    }
}
