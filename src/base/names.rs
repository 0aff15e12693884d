//! Suggestions for misspelled names.

/// The candidate nearest to `word`, if it is a likely misspelling: one edit in three letters, or two if there are no more.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let (lower, length) = (word.to_lowercase(), word.chars().count());
    let edits = |candidate: &str| strsim::damerau_levenshtein(&lower, &candidate.to_lowercase());
    let distance = |candidate: &str| {
        let letters = candidate.chars().count();
        let most = match length.max(letters) {
            0 | 1 => return None,
            2 => 1,
            letters => letters / 3,
        };
        // Each letter more is an edit.
        let edits = (length.abs_diff(letters) <= most).then(|| edits(candidate)).filter(|edits| *edits <= most)?;
        Some(edits)
    };
    let others = candidates.into_iter().filter(|candidate| *candidate != word);
    let near = others.filter_map(|candidate| distance(candidate).map(|edits| (edits, candidate)));
    near.min_by_key(|(edits, _)| *edits).map(|(_, candidate)| candidate)
}

/// "`a`, `b`, `c`".
pub fn quoted<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = words.into_iter().map(|word| format!("`{word}`")).collect();
    quoted.join(", ")
}

/// "a, b and c".
pub fn joined(words: &[&str]) -> String {
    match words.split_last() {
        Some((last, [])) => (*last).to_owned(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
        None => String::new(),
    }
}

/// A number of bytes with its unit, to two or three digits.
pub fn amount(bytes: f64) -> String {
    match bytes {
        1e9.. => format!("{:.1} GB", bytes / 1e9),
        9.95e6.. => format!("{:.0} MB", bytes / 1e6),
        0.95e6.. => format!("{:.1} MB", bytes / 1e6),
        0.95e4.. => format!("{:.0} kB", bytes / 1e3),
        _ => format!("{:.1} kB", bytes / 1e3),
    }
}

/// A number to four digits, for messages.
pub fn short(number: f64) -> String {
    to_digits(number, 4)
}

/// A time to nine digits for messages, without trailing rounding.
pub fn instant(time: f64) -> String {
    to_digits(time, 9)
}

/// A number to so many digits, without zeros at its end; very large and very small ones with an exponent.
pub fn to_digits(number: f64, digits: usize) -> String {
    let rounded: f64 = format!("{number:.*e}", digits.saturating_sub(1)).parse().unwrap_or(number);
    match rounded.abs() {
        size if size == 0.0 || (1e-4..1e6).contains(&size) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_found_and_another_word_is_not() {
        let names = ["steel", "aluminium", "E"];
        assert_eq!(nearest("steal", names), Some("steel"));
        assert_eq!(nearest("alumnium", names), Some("aluminium"));
        assert_eq!(nearest("Steel", names), Some("steel"));
        assert_eq!(nearest("copper", names), None);
        assert_eq!(nearest("F", names), None);
        assert_eq!(nearest("yy", ["ux", "uy"]), Some("uy"));
        assert_eq!(nearest("steel", ["steel"]), None);
    }

    #[test]
    fn words_are_listed_as_prose() {
        assert_eq!(quoted(["a", "b"]), "`a`, `b`");
        assert_eq!(joined(&["ux", "uy", "rz"]), "ux, uy and rz");
        assert_eq!(joined(&["ux"]), "ux");
        assert_eq!([-10.0, 0.123456, 2.1e17].map(short), ["-10", "0.1235", "2.1e17"]);
        assert_eq!([0.31925000000000003, 1.0 / 3.0].map(instant), ["0.31925", "0.333333333"]);
    }
}
