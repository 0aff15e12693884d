//! Text → deck, with everything that is wrong found in one go.
//!
//! Serde stops at the first error. So the entry it stumbles over is noted, taken out of the table, and reading starts again until nothing
//! is left to stumble over. Faults arrive as a [`Wrong`]; this file writes their messages.

use serde::Deserialize;
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::value::{Problem, Value, Wanted, Wrong};
use super::{Deck, Spoiled, actuators, aliases, hints, lengths, number_slips, profiles, set, study, tables};
use base::diagnostic::{Diagnostic, Source, Span};
use base::names::{nearest, quoted};
use base::text_file::foreign;

/// Where the table of the top-level keys stands.
pub const ROOT: Span = 0..0;

/// Wrong entries looked for in one go.
const LIMIT: usize = 200;

/// Reads a deck with its `--set` arguments. Unreadable entries are left out and reported; with too many of them there is no deck.
pub fn read(source: &Source) -> DeckRead {
    let plain = number_slips::without_foreign_comments(&source.text);
    ParsedText::new(&source.text, &plain).into_deck(source)
}

/// A deck, and the faults of its text.
pub type DeckRead = (Option<Deck>, Vec<Diagnostic>);

/// The text of a deck as TOML, before `--set` arguments change its entries.
#[derive(Clone)]
pub struct ParsedText<'t> {
    root: DeTable<'t>,
    reader: Reader,
}

impl<'t> ParsedText<'t> {
    /// Parses a text, given also as [`number_slips::without_foreign_comments`] returns it.
    pub fn new(text: &str, (plain, slip): &'t (Cow<str>, Option<Diagnostic>)) -> Self {
        let mut reader = Reader::default();
        reader.problems.extend(slip.clone());
        let (root, syntax) = DeTable::parse_recoverable(plain);
        let mut root = root.into_inner();
        if let Some((kind, hint)) = foreign::recognized(text) {
            reader.broken.push(0..text.len());
            let first = text.lines().next().map_or(0, str::len);
            let message = format!("this is {kind}, and no deck");
            reader.problems.push(Diagnostic::error(message).at(&(0..first)).hint(hint));
        }
        for error in &syntax {
            reader.syntax(text, error);
        }
        reader.problems.extend(aliases::unify(&mut root));
        ParsedText { root, reader }
    }

    /// The deck of a source with this text.
    pub fn into_deck(self, source: &Source) -> DeckRead {
        let arguments: Vec<String> = source.sets.iter().map(|(_, text)| set::toml(text)).collect();
        let ParsedText { mut root, mut reader } = self;
        for ((offset, text), argument) in source.sets.iter().zip(&arguments) {
            if let Err(problem) = set::merge(&mut root, argument, *offset, text) {
                reader.problems.push(problem);
            }
        }
        let words = study::words(&root);
        reader.problems.extend(study::expand(&mut root, &words));
        reader.problems.extend(actuators::move_to_joints(&mut root));
        let profiles = profiles::words(&root);
        let (problems, spoiled) = profiles::expand(&mut root, &profiles);
        reader.problems.extend(problems);
        reader.spoiled.extend(spoiled);
        reader.texts(&mut root);
        reader.numbers(&mut root);
        reader.lengths(&mut root);
        let is_deck = reader.broken.first().is_none_or(|broken| broken.len() < source.text.len());
        let deck = if is_deck { reader.tables(root) } else { None };
        let spoiled = reader.spoiled;
        (deck.map(|deck| Deck { spoiled, ..deck }), reader.problems)
    }
}

#[derive(Clone, Default)]
struct Reader {
    problems: Vec<Diagnostic>,
    spoiled: Vec<Spoiled>,
    /// Lines that are no TOML, and entries that depend on them; they get no further messages.
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
        let problem = match (error.message(), number_slips::explain(text, at)) {
            ("duplicate key", _) => {
                Diagnostic::error(format!("`{}` is given twice", text.get(span.clone()).unwrap_or_default()))
            }
            (_, Some((message, hint))) => Diagnostic::error(message).hint(hint),
            (message, None) => Diagnostic::error(format!("this is not TOML: {message}"))
                .hint("write KEY = VALUE, with text in quotes and brackets in pairs"),
        };
        self.problems.push(problem.at(&span));
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
            if self.is_broken(span.start) {
                continue;
            }
            self.problems.push(Diagnostic::error(format!("{key} must be a finite number")).at(&span));
        }
    }

    /// Takes out all texts that hold characters for the control of a terminal.
    fn texts(&mut self, root: &mut DeTable) {
        let mut wrong = Vec::new();
        with_control(root, &mut wrong);
        for span in wrong {
            self.strike(root, &span);
            let problem = Diagnostic::error("this text holds a control character");
            self.problems.push(problem.at(&span).hint("names and titles are of letters, digits, signs and spaces"));
        }
    }

    /// Takes out lengths that no computation can hold.
    fn lengths(&mut self, root: &mut DeTable) {
        for (span, problem) in lengths::check(root) {
            self.strike(root, &span);
            self.problems.push(problem.at(&span));
        }
    }

    fn tables(&mut self, root: DeTable) -> Option<Deck> {
        let mut root = Spanned::new(ROOT, DeValue::Table(root));
        loop {
            let wrong = match Deck::deserialize(Value(&root)) {
                Ok(deck) => return Some(deck),
                Err(wrong) => wrong,
            };
            let span = wrong.place.clone().unwrap_or_default();
            let entry = match root.get_mut() {
                DeValue::Table(table) => self.strike(table, &span),
                _ => None,
            };
            let Some(entry) = entry else {
                self.problems.push(Diagnostic::error(wrong.to_string()).at(&span));
                return None;
            };
            if !self.is_broken(span.start) {
                let problem = self.explain(&entry, &wrong);
                self.problems.push(problem.at(&span));
            }
            if self.problems.len() >= LIMIT {
                let message =
                    format!("rdsolve stopped reading after {LIMIT} errors; correct these first, there may be more");
                self.problems.push(Diagnostic::note(message));
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

    /// A key unknown to its table, with the nearest known key.
    fn unknown_key(&mut self, entry: &Entry, known: &[&str]) -> Diagnostic {
        let key = entry.key.as_str();
        let diagnostic = Diagnostic::error(format!("there is no key `{key}` here"));
        // The key it was meant to be is then not missing.
        let mut spoil =
            |meant: &str| self.spoiled.push(Spoiled { table: Some(entry.table.clone()), key: meant.to_owned() });
        if let Some((sentence, meant)) = hints::key(key, &entry.path, known) {
            meant.into_iter().for_each(spoil);
            return diagnostic.hint(sentence);
        }
        let place = tables::place_of(key);
        match nearest(key, known.iter().copied()) {
            Some(near) => {
                spoil(near);
                place.into_iter().fold(diagnostic.hint(format!("did you mean `{near}`?")), Diagnostic::hint)
            }
            None => {
                let place = place.unwrap_or_else(|| "not a key of this table".to_owned());
                diagnostic.hint(place).hint(format!("the keys are {}", known.join(", ")))
            }
        }
    }

    /// Message about a fault in the words of the deck.
    fn explain(&mut self, entry: &Entry, wrong: &Wrong) -> Diagnostic {
        let (key, found) = (&entry.key, &wrong.found);
        let subject = if entry.whole { format!("`{key}`") } else { format!("an entry of `{key}`") };
        match &wrong.problem {
            Problem::UnknownKey { known } => self.unknown_key(entry, known),
            Problem::UnknownWord { word, known } => unknown_word(&subject, word, known),
            Problem::Type(Wanted::ListOfTables) if entry.table == ROOT => {
                Diagnostic::error(format!("`{key}` is a list of tables")).hint(format!("each begins with [[{key}]]"))
            }
            Problem::Type(wanted) => {
                let problem = Diagnostic::error(format!("{subject} must be {wanted}, not {found}"));
                match hints::example(key) {
                    _ if *wanted == Wanted::NumberWithoutQuotes => {
                        problem.hint("numbers stand without quotes and units")
                    }
                    Some(example) => problem.hint(example),
                    None => problem,
                }
            }
            Problem::Length { length, expected } => {
                Diagnostic::error(format!("{subject} must be {expected}; there are {length}"))
            }
            Problem::Other(message) => Diagnostic::error(format!("{subject}: {message}")),
        }
    }
}

/// An unknown word, with the nearest known word.
fn unknown_word(subject: &str, word: &str, known: &[&str]) -> Diagnostic {
    let problem = Diagnostic::error(format!("{subject} cannot be `{word}`"));
    if let Some(hint) = hints::value(word, known) {
        return problem.hint(hint);
    }
    if word.parse::<f64>().is_ok() {
        return problem.hint(format!("a number stands without quotes: {word}"));
    }
    match nearest(word, known.iter().copied().chain(hints::aliases(known))) {
        Some(near) => problem.hint(format!("did you mean `{near}`?")),
        None if word.parse::<f64>().is_ok() => problem.hint(format!("numbers stand without quotes: {word}")),
        None => problem.hint(format!("known: {}", quoted(known.iter().copied()))),
    }
}

/// An entry taken out.
struct Entry {
    table: Span,
    /// The keys that lead from the top of the deck to its table.
    path: Vec<String>,
    key: String,
    /// The error is about all of its value, not about a part of it.
    whole: bool,
}

/// Keys come before nested entries, and nested entries before the value: the span of a table is that of its header, which also holds the
/// keys above it.
fn strike(table: &mut DeTable, place: &Span, span: &Span) -> Option<Entry> {
    let entry = |key: &str, whole| Entry { table: place.clone(), path: Vec::new(), key: key.to_owned(), whole };
    if let Some(key) = table.keys().find(|key| key.span() == *span).map(|key| key.get_ref().to_string()) {
        table.remove(key.as_str());
        return Some(entry(&key, true));
    }
    let below = table.iter_mut().find_map(|(key, value)| {
        let place = value.span();
        let mut struck = strike_below(value.get_mut(), &place, span)?;
        struck.path.insert(0, key.get_ref().to_string());
        Some(struck)
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

/// Keys and texts with terminal control characters, which tables and messages would pass on.
fn with_control(root: &DeTable, wrong: &mut Vec<Span>) {
    let controls = |text: &str| text.contains(|c: char| c.is_control() && !"\n\r\t".contains(c));
    for (key, value) in root {
        if controls(key.get_ref()) {
            wrong.push(key.span());
        }
        with_control_below(value, &controls, wrong);
    }
}

fn with_control_below(value: &Spanned<DeValue>, controls: &dyn Fn(&str) -> bool, wrong: &mut Vec<Span>) {
    match value.get_ref() {
        DeValue::String(text) if controls(text) => wrong.push(value.span()),
        DeValue::Array(list) => list.iter().for_each(|item| with_control_below(item, controls, wrong)),
        DeValue::Table(table) => with_control(table, wrong),
        _ => {}
    }
}

fn not_finite(value: &Spanned<DeValue>, wrong: &mut Vec<Span>) {
    match value.get_ref() {
        DeValue::Float(number) if !number.as_str().parse().is_ok_and(f64::is_finite) => wrong.push(value.span()),
        DeValue::Array(list) => list.iter().for_each(|item| not_finite(item, wrong)),
        DeValue::Table(table) => table.values().for_each(|item| not_finite(item, wrong)),
        _ => {}
    }
}
