//! Text → deck, with everything that is wrong found in one go.
//!
//! Serde stops at the first error. So the entry it stumbles over is noted, taken out of the table, and reading starts
//! again until nothing is left to stumble over.

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::{Deck, Spoiled, aliases, hints, set, study};
use crate::diagnostic::{Diagnostic, Source, Span};
use crate::names::nearest;

/// Where the table of the top-level keys stands.
pub const ROOT: Span = 0..0;

/// Wrong entries looked for in one go.
const LIMIT: usize = 200;

/// Reads a deck with its `--set` arguments. What could not be read is left out of it and reported; if that is too
/// much, there is no deck.
pub fn read(source: &Source) -> (Option<Deck>, Vec<Diagnostic>) {
    let arguments: Vec<String> = source.sets.iter().map(|(offset, text)| set::padded(*offset, text)).collect();
    let (root, syntax) = DeTable::parse_recoverable(&source.text);
    let mut root = root.into_inner();
    let mut reader = Reader::default();
    for error in &syntax {
        reader.syntax(&source.text, error);
    }
    reader.problems.extend(aliases::unify(&mut root));
    for ((offset, text), argument) in source.sets.iter().zip(&arguments) {
        if let Err(problem) = set::merge(&mut root, argument, *offset, text) {
            reader.problems.push(problem);
        }
    }
    let words = study::words(&root);
    let mut root = root;
    reader.problems.extend(study::expand(&mut root, &words));
    reader.numbers(&mut root);
    let deck = reader.tables(root);
    let spoiled = reader.spoiled;
    (deck.map(|deck| Deck { spoiled, ..deck }), reader.problems)
}

#[derive(Default)]
struct Reader {
    problems: Vec<Diagnostic>,
    spoiled: Vec<Spoiled>,
    /// Lines that are no TOML, and what hangs on them: nothing more is said about these.
    broken: Vec<Span>,
}

impl Reader {
    fn syntax(&mut self, text: &str, error: &toml::de::Error) {
        let span = error.span().unwrap_or(text.len()..text.len());
        let at = span.start.min(text.len());
        let begin = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
        let end = text[at..].find('\n').map_or(text.len(), |newline| at + newline);
        if self.is_broken(at) {
            return;
        }
        // Names on a broken line are written, so they are not missing. Below a broken header all keys are astray.
        let line = &text[begin..end];
        let words =
            line.split('=').next().unwrap_or_default().split(|c: char| !(c.is_alphanumeric() || "_-".contains(c)));
        self.spoiled.extend(words.map(|word| Spoiled { table: None, key: word.to_owned() }));
        let next_header = || text[end..].find("\n[").map_or(text.len(), |next| end + next);
        self.broken.push(begin..if line.starts_with('[') { next_header() } else { end });
        let message = match error.message() {
            "duplicate key" => format!("`{}` is given twice", text.get(span.clone()).unwrap_or_default()),
            message => format!("this is not TOML: {message}"),
        };
        self.problems.push(Diagnostic::error(message).at(&span));
    }

    fn is_broken(&self, at: usize) -> bool {
        self.broken.iter().any(|region| (region.start..=region.end).contains(&at))
    }

    /// Takes out all numbers that are not finite.
    fn numbers(&mut self, root: &mut DeTable) {
        let mut wrong = Vec::new();
        for value in root.values() {
            not_finite(value, &mut wrong);
        }
        for span in wrong {
            let key = self.strike(root, &span).map_or_else(|| "this".to_owned(), |entry| format!("`{}`", entry.key));
            self.problems.push(Diagnostic::error(format!("{key} must be a finite number")).at(&span));
        }
    }

    fn tables(&mut self, mut root: DeTable) -> Option<Deck> {
        loop {
            let table = Spanned::new(ROOT, DeValue::Table(root.clone()));
            let error = match Deck::deserialize(ValueDeserializer::from(table)) {
                Ok(deck) => return Some(deck),
                Err(error) => error,
            };
            let span = error.span().unwrap_or_default();
            let Some(entry) = self.strike(&mut root, &span) else {
                self.problems.push(Diagnostic::error(error.message().to_owned()).at(&span));
                return None;
            };
            if !self.is_broken(span.start) {
                let problem = self.wrong(&entry, error.message());
                self.problems.push(problem.at(&span));
            }
            if self.problems.len() >= LIMIT {
                self.problems.push(Diagnostic::error("there may be more errors; correct these first"));
                return None;
            }
        }
    }

    /// Takes out the innermost entry that `span` belongs to.
    fn strike(&mut self, root: &mut DeTable, span: &Span) -> Option<Entry> {
        let entry = strike(root, &ROOT, span)?;
        self.spoiled.push(Spoiled { table: Some(entry.table.clone()), key: entry.key.clone() });
        Some(entry)
    }

    /// A key that its table does not have, with the one that may be meant.
    fn unknown_key(&mut self, entry: &Entry, known: &[&str]) -> Diagnostic {
        let key = entry.key.as_str();
        let diagnostic = Diagnostic::error(format!("there is no key `{key}` here"));
        // The key it was meant to be is then not missing.
        let mut spoil =
            |meant: &str| self.spoiled.push(Spoiled { table: Some(entry.table.clone()), key: meant.to_owned() });
        if let Some((sentence, meant)) = hints::note(key, known) {
            meant.into_iter().for_each(spoil);
            return diagnostic.hint(sentence);
        }
        if let Some(ours) = hints::key(key, known) {
            spoil(ours);
            return diagnostic.hint(format!("that is `{ours}` here"));
        }
        if let Some(hint) = hints::elsewhere(key) {
            return diagnostic.hint(hint);
        }
        match nearest(key, known.iter().copied()) {
            Some(near) => {
                spoil(near);
                diagnostic.hint(format!("did you mean `{near}`?"))
            }
            None => diagnostic.hint("not a key of this table").hint(format!("the keys are {}", known.join(", "))),
        }
    }

    /// Serde's message in the deck's words.
    fn wrong(&mut self, entry: &Entry, message: &str) -> Diagnostic {
        let key = &entry.key;
        let subject = if entry.whole { format!("`{key}`") } else { format!("an entry of `{key}`") };
        let (problem, expected) = message.split_once(", expected ").unwrap_or((message, ""));
        let words: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
        if problem.starts_with("unknown field") {
            return self.unknown_key(entry, &words);
        }
        if problem.starts_with("unknown variant") {
            let word = problem.split('`').nth(1).unwrap_or_default();
            let known = crate::names::quoted(words.iter().copied());
            let diagnostic = Diagnostic::error(format!("{subject} cannot be `{word}`"));
            if let Some(hint) = hints::value(word, &words) {
                return diagnostic.hint(hint);
            }
            return match nearest(word, words.iter().copied().chain(hints::aliases(&words))) {
                Some(near) => diagnostic.hint(format!("did you mean `{near}`?")),
                None => diagnostic.hint(format!("known: {known}")),
            };
        }
        if let Some(found) = problem.strip_prefix("invalid type: ").or(problem.strip_prefix("invalid value: ")) {
            if entry.table == ROOT && found == "map" && expected == "a sequence" {
                return Diagnostic::error(format!("`{key}` is a list of tables"))
                    .hint(format!("each begins with [[{key}]]"));
            }
            let message = format!("{subject} must be {}, not {}", wanted(expected), found_words(found));
            return with_example(Diagnostic::error(message), key, expected, found);
        }
        if let Some(length) = problem.strip_prefix("invalid length ") {
            return Diagnostic::error(format!("{subject} must be {}; there are {length}", wanted(expected)));
        }
        if problem.starts_with("wanted ") {
            return with_example(Diagnostic::error(format!("{subject} must be a word in quotes")), key, "", "");
        }
        Diagnostic::error(format!("{subject}: {message}"))
    }
}

/// An example of what may stand behind the key; of a number with its unit, that it has none.
fn with_example(problem: Diagnostic, key: &str, expected: &str, found: &str) -> Diagnostic {
    let with_unit =
        expected == "f64" && found.starts_with("string \"") && found[8..].starts_with(|c: char| c.is_ascii_digit());
    match hints::example(key) {
        _ if with_unit => problem.hint("numbers stand without quotes and units"),
        Some(example) => problem.hint(example),
        None => problem,
    }
}

/// What serde expects, in plain words with an example.
fn wanted(expected: &str) -> &str {
    match expected {
        "f64" => "a number, such as 2.5",
        "u64" | "usize" => "a whole number of 1 or more, such as 12",
        "a boolean" => "true or false",
        "a string" => "text in quotes, such as \"steel\"",
        "a sequence" => "a list in brackets, such as [1.0, 2.0, 3.0]",
        other => other,
    }
}

/// What serde found, in plain words.
fn found_words(found: &str) -> String {
    let quoted = found.split('`').nth(1).unwrap_or(found);
    match found.split_once(' ') {
        Some(("string", text)) => format!("the text {text}"),
        Some(("integer" | "floating", _)) => format!("the number {quoted}"),
        Some(("boolean", _)) => quoted.to_owned(),
        None if found == "map" => "a table".to_owned(),
        None if found == "sequence" => "a list".to_owned(),
        _ => found.to_owned(),
    }
}

/// An entry taken out.
struct Entry {
    table: Span,
    key: String,
    /// The error is about all of its value, not about a part of it.
    whole: bool,
}

/// Keys come before what is below them, and what is below before the value itself: a table's span is that of its
/// header, which also holds the keys above it.
fn strike(table: &mut DeTable, place: &Span, span: &Span) -> Option<Entry> {
    let entry = |key: &str, whole| Entry { table: place.clone(), key: key.to_owned(), whole };
    if let Some(key) = table.keys().find(|key| key.span() == *span).map(|key| key.get_ref().to_string()) {
        table.remove(key.as_str());
        return Some(entry(&key, true));
    }
    let below = table.iter_mut().find_map(|(_, value)| {
        let place = value.span();
        strike_below(value.get_mut(), &place, span)
    });
    if below.is_some() {
        return below;
    }
    let (key, value) = table.iter().find(|(_, value)| holds(value, span))?;
    let struck = entry(key.get_ref(), value.span() == *span);
    table.remove(struck.key.as_str());
    Some(struck)
}

fn strike_below(value: &mut DeValue, place: &Span, span: &Span) -> Option<Entry> {
    match value {
        DeValue::Table(table) => strike(table, place, span),
        DeValue::Array(list) => list.iter_mut().find_map(|item| {
            let place = item.span();
            strike_below(item.get_mut(), &place, span)
        }),
        _ => None,
    }
}

/// An item of a list of tables may stand outside the span of the list, which is its first header.
fn holds(value: &Spanned<DeValue>, span: &Span) -> bool {
    let items = value.get_ref().as_array();
    let within = value.span().start <= span.start && span.end <= value.span().end;
    within || items.is_some_and(|items| items.iter().any(|item| item.span() == *span))
}

fn not_finite(value: &Spanned<DeValue>, wrong: &mut Vec<Span>) {
    match value.get_ref() {
        DeValue::Float(number) if !number.as_str().parse().is_ok_and(f64::is_finite) => wrong.push(value.span()),
        DeValue::Array(list) => list.iter().for_each(|item| not_finite(item, wrong)),
        DeValue::Table(table) => table.values().for_each(|item| not_finite(item, wrong)),
        _ => {}
    }
}
