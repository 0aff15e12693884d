//! Texts of many cases that differ in their numbers alone, as one.

use std::collections::HashMap;

/// A reason or a warning, with the cases that have it or one like it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Alike<'t> {
    /// The text of the first of these cases.
    pub text: &'t str,
    /// The cases, counted from 0, each once.
    pub cases: Vec<usize>,
    /// True where later texts have other numbers.
    pub differ: bool,
}

/// Merges texts of cases that differ in numbers alone, in the order of their first cases.
pub fn alike<'t>(texts: impl Iterator<Item = (usize, &'t str)>) -> Vec<Alike<'t>> {
    let mut all: Vec<Alike> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    for (case, text) in texts {
        let place = *places.entry(without_numbers(text)).or_insert(all.len());
        if place == all.len() {
            all.push(Alike { text, cases: Vec::new(), differ: false });
        }
        let one = &mut all[place];
        one.differ |= one.text != text;
        if one.cases.last() != Some(&case) {
            one.cases.push(case);
        }
    }
    all
}

/// A text with `#` for each number outside of words, signs and exponents included.
fn without_numbers(text: &str) -> String {
    let is_number =
        |word: &str| word.starts_with(|c: char| c.is_ascii_digit() || c == '.') && word.parse::<f64>().is_ok();
    let is_end = |c: char| !(c.is_alphanumeric() || ['.', '_', '+', '-'].contains(&c));
    let parts = text.split_inclusive(is_end).map(|part| {
        let word = part.trim_end_matches(is_end).trim_start_matches(['+', '-']);
        let number = word.trim_end_matches('.');
        if is_number(number) { part.replacen(number, "#", 1).replace(['+', '-'], "") } else { part.to_owned() }
    });
    parts.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_that_differ_in_numbers_are_alike() {
        let texts = [
            (0, "dissipation: 14 % of it"),
            (0, "contact `blow2`, 1.075e6: 5e-5."),
            (1, "dissipation: 2.5 % of it"),
            (2, "contact `blow2`, 2e-6: -0.1."),
            (2, "contact `blow3`, 2e-6: 0.1."),
            (2, "dissipation: 3 % of it"),
            (2, "dissipation: 3 % of it"),
            (3, "contact `blow3`, 2e-6: 0.1."),
        ];
        let found = alike(texts.into_iter());
        let found: Vec<(&str, &[usize], bool)> =
            found.iter().map(|one| (one.text, &one.cases[..], one.differ)).collect();
        let wanted: [(&str, &[usize], bool); 3] = [
            ("dissipation: 14 % of it", &[0, 1, 2], true),
            ("contact `blow2`, 1.075e6: 5e-5.", &[0, 2], true),
            ("contact `blow3`, 2e-6: 0.1.", &[2, 3], false),
        ];
        assert_eq!(found, wanted);
    }
}
