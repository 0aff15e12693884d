//! Words of other programs, with the word of the deck for each. An error that names one of them recommends the deck's word.
//!
//! The words stand in `hints.toml`; those for schemes, sections and joints stand with these, see [`Kind`].

use super::tables;
use base::words::kinds::Kind;
use mechanics::constraints::joints::JOINTS;
use mechanics::elements::contact::surfaces::SURFACES;
use mechanics::integrators::SCHEMES;
use mechanics::materials::models::MATERIALS;
use mechanics::materials::overstress::OVERSTRESSES;
use mechanics::sections::SECTIONS;
use mechanics::solids::SOLIDS;
use serde::Deserialize;
use std::sync::LazyLock;

static HINTS: LazyLock<Hints> =
    LazyLock::new(|| toml::from_str(include_str!("hints.toml")).expect("the rows of hints are read by their tests"));

/// All kinds that words of the deck choose from, a list for each choice.
static KINDS: LazyLock<Vec<Vec<Kind<()>>>> = LazyLock::new(|| {
    let mut kinds = Vec::new();
    add(&mut kinds, SCHEMES);
    add(&mut kinds, JOINTS);
    add(&mut kinds, SURFACES);
    add(&mut kinds, SECTIONS);
    add(&mut kinds, MATERIALS);
    add(&mut kinds, OVERSTRESSES);
    add(&mut kinds, SOLIDS);
    kinds
});

fn add<M>(kinds: &mut Vec<Vec<Kind<()>>>, list: &[&Kind<M>]) {
    kinds.push(list.iter().map(|kind| kind.with(())).collect());
}

/// The words of the other kinds of a choice that take a key.
pub fn kinds_with<M>(kind: &Kind<M>, key: &str) -> Vec<&'static str> {
    let is_of = |list: &&Vec<Kind<()>>| list.iter().any(|one| one.word == kind.word && one.about == kind.about);
    let takers = KINDS.iter().filter(is_of).flatten().filter(|other| other.takes(key));
    takers.map(|other| other.word).collect()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Hints {
    keys: Vec<Hint>,
    values: Vec<Hint>,
    absent: Vec<Hint>,
    examples: Vec<Hint>,
    missing: Vec<Hint>,
}

/// A row of `hints.toml`, which explains its fields.
#[derive(Deserialize)]
#[cfg_attr(test, serde(deny_unknown_fields))]
struct Hint {
    guesses: Vec<String>,
    #[serde(default)]
    at: Vec<String>,
    #[serde(default)]
    ours: Vec<String>,
    say: Option<String>,
    #[cfg(test)]
    #[serde(default)]
    denies: Vec<String>,
}

impl Hint {
    /// Our word among those known here.
    fn word(&self, known: &[&str]) -> Option<&str> {
        self.ours.iter().map(String::as_str).find(|word| known.contains(word))
    }

    fn sentence(&self, known: &[&str]) -> String {
        self.say.clone().unwrap_or_else(|| that_is(self.word(known).unwrap_or_default()))
    }
}

fn that_is(word: &str) -> String {
    format!("that is `{word}` here")
}

/// The first row for a guess in the table with this path, among these known words.
fn find<'h>(rows: &'h [Hint], guess: &str, path: &[String], known: &[&str]) -> Option<&'h Hint> {
    rows.iter().find(|row| {
        row.guesses.iter().any(|word| word == guess)
            && (row.at.is_empty() || row.at.iter().any(|label| tables::is_label_of(label, path)))
            && (row.ours.is_empty() || row.word(known).is_some())
    })
}

/// The sentence on a guessed key in the table with this path, and the key that then counts as present.
pub fn key(guess: &str, path: &[String], known: &[&str]) -> Option<(String, Option<&'static str>)> {
    let row = find(&HINTS.keys, guess, path, known)?;
    Some((row.sentence(known), row.word(known)))
}

/// An example of the value of a key.
pub fn example(key: &str) -> Option<&'static str> {
    find(&HINTS.examples, key, &[], &[])?.say.as_deref()
}

/// The remedy for a missing key that has an example.
pub fn missing(key: &str) -> Option<String> {
    let example = find(&HINTS.missing, key, &[], &[])?.say.as_deref()?;
    Some(format!("add `{key}`, {example}"))
}

/// The sentence on a guessed value.
pub fn value(guess: &str, known: &[&str]) -> Option<String> {
    let row = |rows: &[Hint]| find(rows, guess, &[], known).map(|row| row.sentence(known));
    row(&HINTS.values).or_else(|| kind(guess, known).map(that_is)).or_else(|| row(&HINTS.absent))
}

/// The kind meant by a guessed word, by the guesses listed for each kind.
fn kind(guess: &str, known: &[&str]) -> Option<&'static str> {
    let meant = KINDS.iter().flatten().filter(|kind| kind.guesses.contains(&guess)).map(|kind| kind.word);
    meant.into_iter().find(|word| known.contains(word))
}

/// Second words of the kinds that are known here: a slip of the pen may be meant for one of them.
pub fn aliases(known: &[&str]) -> Vec<&'static str> {
    KINDS.iter().flatten().filter(|kind| known.contains(&kind.word)).flat_map(|kind| kind.aliases).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::{DeckTable, TOP, tables};
    use std::collections::HashSet;

    /// The sets of words that values of the deck are chosen from.
    fn choices() -> Vec<HashSet<String>> {
        fn collect(value: &serde_json::Value, sets: &mut Vec<HashSet<String>>) {
            let words = |value: &serde_json::Value| -> Vec<String> {
                let listed = value["enum"].as_array().into_iter().flatten().chain([&value["const"]]);
                listed.filter_map(|word| word.as_str().map(str::to_owned)).collect()
            };
            let alternatives = ["oneOf", "anyOf"].iter().filter_map(|key| value[key].as_array()).flatten();
            sets.push(words(value).into_iter().chain(alternatives.flat_map(words)).collect());
            match value {
                serde_json::Value::Object(entries) => entries.values().for_each(|value| collect(value, sets)),
                serde_json::Value::Array(list) => list.iter().for_each(|value| collect(value, sets)),
                _ => {}
            }
        }
        let mut sets = Vec::new();
        collect(schemars::schema_for!(crate::Deck).as_value(), &mut sets);
        sets
    }

    fn has(table: &DeckTable, key: &str) -> bool {
        table.keys.iter().any(|known| known == key)
    }

    /// The keys that lead to a table.
    fn path(table: &DeckTable) -> Vec<String> {
        match table.label.as_str() {
            TOP => Vec::new(),
            label => label.trim_matches(['[', ']']).split('.').map(str::to_owned).collect(),
        }
    }

    /// The tables of a row.
    fn places(row: &Hint) -> Vec<&'static DeckTable> {
        let is_at = |table: &DeckTable| row.at.iter().any(|label| tables::is_label_of(label, &path(table)));
        tables().iter().filter(|table| row.at.is_empty() || is_at(table)).collect()
    }

    fn rows() -> impl Iterator<Item = &'static Hint> {
        let Hints { keys, values, absent, examples, missing } = &*HINTS;
        [keys, values, absent, examples, missing].into_iter().flatten()
    }

    /// Every guess is one: at some place where it is not a key, a key answers it.
    #[test]
    fn keys_answer_where_they_exist() {
        for row in &HINTS.keys {
            let places = places(row);
            for label in &row.at {
                let is_there = places.iter().any(|table| tables::is_label_of(label, &path(table)));
                assert!(is_there, "there is no table {label}");
            }
            for table in places.iter().filter(|_| !row.at.is_empty()) {
                let key = row.guesses.iter().find(|guess| has(table, guess));
                assert!(key.is_none(), "`{}` is a key of {} and so no guess", key.unwrap(), table.label);
                row.ours.iter().for_each(|key| assert!(has(table, key), "{} has no key `{key}`", table.label));
            }
            for guess in &row.guesses {
                let answers = |table: &&DeckTable| {
                    let known: Vec<&str> = table.keys.iter().map(String::as_str).collect();
                    !has(table, guess)
                        && find(&HINTS.keys, guess, &path(table), &known).is_some_and(|found| std::ptr::eq(found, row))
                };
                assert!(tables().iter().any(|table| answers(&table)), "no table answers `{guess}` by {:?}", row.ours);
            }
            for word in &row.ours {
                let is_first = |table: &DeckTable| row.ours.iter().find(|word| has(table, word)) == Some(word);
                assert!(places.iter().any(|table| is_first(table)), "no table answers by `{word}`");
            }
        }
    }

    /// Every recommended value is a word of its table, and no guess is one.
    #[test]
    fn values_answer_where_they_exist() {
        let choices = choices();
        for row in HINTS.values.iter().chain(&HINTS.absent) {
            for word in &row.ours {
                let is_guess = |set: &&HashSet<String>| row.guesses.iter().any(|guess| !set.contains(guess));
                assert!(choices.iter().filter(is_guess).any(|set| set.contains(word)), "there is no word `{word}`");
            }
            for guess in &row.guesses {
                let answers = |set: &HashSet<String>| {
                    !set.contains(guess) && (row.ours.is_empty() || row.ours.iter().any(|word| set.contains(word)))
                };
                assert!(choices.iter().any(answers), "no value answers `{guess}` by {:?}", row.ours);
            }
        }
    }

    /// The keys that a sentence recommends: in backticks, and before the equals signs of its tables.
    fn recommended(sentence: &str) -> Vec<&str> {
        let is_part = |c: char| c.is_ascii_alphanumeric() || "_-".contains(c);
        let quoted = sentence.split('`').skip(1).step_by(2).flat_map(|part| part.split(|c| !is_part(c)));
        let tables = sentence.split('{').skip(1).filter_map(|part| part.split('}').next());
        let mut words: Vec<&str> = quoted.filter(|word| word.starts_with(|c: char| c.is_alphabetic())).collect();
        for table in tables {
            let parts: Vec<&str> = table.split_whitespace().collect();
            words.extend(parts.windows(2).filter(|pair| ["=", "|"].contains(&pair[1])).map(|pair| pair[0]));
        }
        words
    }

    /// The tables that a sentence names, such as [damping] and [[stages]].
    fn named(sentence: &str) -> Vec<&'static DeckTable> {
        let mut named = Vec::new();
        for bracket in sentence.split_inclusive(']').filter_map(|part| part.rfind('[').map(|at| &part[at..])) {
            let name = bracket.trim_matches(['[', ']']);
            if !name.contains([',', ' ', '"']) && !name.is_empty() {
                let table = tables().iter().find(|table| table.label.trim_matches(['[', ']']) == name);
                named.push(table.unwrap_or_else(|| panic!("there is no table [{name}]: {sentence}")));
            }
        }
        named
    }

    /// A sentence recommends keys of its own tables and of the tables named in it.
    #[test]
    fn sentences_recommend_keys_that_exist() {
        let choices = choices();
        let mut seen = 0;
        for row in rows() {
            let Some(sentence) = &row.say else { continue };
            let begins = |keys: &[String]| places(row).iter().any(|place| keys.starts_with(&path(place)));
            let is_value = |table: &&DeckTable| row.guesses.iter().any(|key| path(table).last() == Some(key));
            let values = crate::tables::tables().iter().filter(is_value);
            let mut tables = named(sentence);
            if HINTS.examples.iter().any(|example| std::ptr::eq(example, row)) {
                tables.extend(values);
            }
            if tables.is_empty() || !row.at.is_empty() {
                tables.extend(crate::tables::tables().iter().filter(|table| begins(&path(table))));
            }
            for word in recommended(sentence) {
                seen += 1;
                let exists =
                    tables.iter().any(|table| has(table, word)) || choices.iter().any(|set| set.contains(word));
                assert!(exists, "there is no `{word}` in the tables of this sentence: {sentence}");
            }
        }
        assert!(seen > 40, "{seen}");
    }

    /// A sentence that denies something lists the words, and no key of its tables and no value is made of them.
    #[test]
    fn no_hint_denies_what_exists() {
        let choices = choices();
        for row in rows() {
            let sentence = row.say.as_deref().unwrap_or_default();
            let mut words = sentence.split(|c: char| !c.is_ascii_alphabetic());
            let denies = |word: &str| ["no", "not", "only", "nothing", "never", "none", "cannot"].contains(&word);
            assert!(!row.denies.is_empty() || !words.any(denies), "list what this sentence denies: {sentence}");
            for denied in &row.denies {
                let is_of = |known: &&String| known.split(['_', '-']).any(|part| part == denied);
                let keys = places(row).into_iter().flat_map(|table| &table.keys);
                let values = choices.iter().flatten().filter(|_| row.at.is_empty());
                let found = keys.chain(values).find(is_of);
                assert!(found.is_none(), "there is `{}`, which is denied: {sentence}", found.unwrap());
            }
        }
    }

    /// An example stands behind a key of the deck.
    #[test]
    fn examples_are_of_keys() {
        for key in HINTS.examples.iter().chain(&HINTS.missing).flat_map(|row| &row.guesses) {
            assert!(tables().iter().any(|table| has(table, key)), "there is no key `{key}`");
        }
    }

    #[test]
    fn a_guess_is_answered_where_our_word_is_known() {
        let at = |path: &[&str]| path.iter().map(|part| (*part).to_owned()).collect::<Vec<_>>();
        let meant = |guess, path: &[&str], known: &[&str]| key(guess, &at(path), known)?.1;
        assert_eq!(meant("torque", &["loads"], &["force", "moment"]), Some("moment"));
        assert_eq!(meant("torque", &["loads"], &["axis"]), None);
        assert_eq!(meant("dt", &["analysis"], &["end_time", "time_step"]), Some("time_step"));
        assert_eq!(meant("vecxz", &["beams"], &["orientation"]), Some("orientation"));
        assert!(meant("vecxz", &["links"], &["orientation"]).is_none());
        assert!(key("extends", &at(&[]), &[]).unwrap().0.contains("--set"));
        assert!(tables::is_label_of(TOP, &[]));
        assert_eq!(value("encastre", &["all", "translations"]).unwrap(), "that is `all` here");
        assert_eq!(value("verlet", &["newmark", "central-difference"]).unwrap(), "that is `central-difference` here");
        assert!(value("cowper-symonds", &["power", "linear"]).unwrap().contains("exponent = q"));
        assert!(value("hex", &["quadrilateral"]).unwrap().contains("no solid elements"));
    }
}
