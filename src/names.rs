//! Words of the deck: the names of directions, and what the user may have meant.

/// Translations along and rotations about the global axes.
pub const DIRECTIONS: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];

/// The candidate nearest to `word`, if it is near enough to be a slip of the pen: one edit in three letters.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = word.to_lowercase();
    let edits = |candidate: &str| strsim::damerau_levenshtein(&lower, &candidate.to_lowercase());
    let near = |candidate: &str| edits(candidate) <= (word.chars().count().max(candidate.chars().count()) / 3).max(1);
    candidates.into_iter().filter(|c| *c != word && near(c)).min_by_key(|c| edits(c))
}

/// "`a`, `b` or `c`".
pub fn listed<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = words.into_iter().map(|word| format!("`{word}`")).collect();
    match quoted.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
        None => String::new(),
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
        assert_eq!(nearest("steel", ["steel"]), None);
    }

    #[test]
    fn words_are_listed_as_prose() {
        assert_eq!(listed(["a", "b", "c"]), "`a`, `b` or `c`");
        assert_eq!(listed(["a"]), "`a`");
    }
}
