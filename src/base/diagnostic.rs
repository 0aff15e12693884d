//! Messages about a deck: text, place and hints.
//!
//! A [`Source`] holds the text of the deck followed by the `--set` arguments. Each has its own offsets, so one byte range identifies the
//! text and the position.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::ops::{Deref, Range};

use annotate_snippets::renderer::Renderer;
use annotate_snippets::{AnnotationKind, Group, Level, Snippet};
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use unicode_normalization::{IsNormalized, UnicodeNormalization, is_nfc_quick};

/// Bytes in a [`Source`].
pub type Span = Range<usize>;

/// The name under which [`At`] asks the deck's deserializer for a value with its place: beginning, end, value.
pub const PLACED: &str = "a value and its place";

/// A value of the deck and where it stands.
#[derive(Debug, Clone, Default)]
pub struct At<T> {
    /// The value.
    pub value: T,
    /// Its place, as bytes of the deck or of a `--set` argument.
    pub span: Span,
}

impl<T> Deref for At<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for At<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Reader<T> {
            type Value = At<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a value and its place")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<At<T>, A::Error> {
                let missing = || A::Error::invalid_length(0, &"a value and its place");
                let start = parts.next_element()?.ok_or_else(missing)?;
                let end = parts.next_element()?.ok_or_else(missing)?;
                let value = parts.next_element()?.ok_or_else(missing)?;
                Ok(At { value, span: start..end })
            }
        }
        deserializer.deserialize_tuple_struct(PLACED, 3, Reader(PhantomData))
    }
}

/// Gives a wrapper the schema of its content, so the wrapper does not appear in the schema.
#[macro_export]
macro_rules! schema_of_inner {
    ($Wrapper:ident) => {
        impl<T: schemars::JsonSchema> schemars::JsonSchema for $Wrapper<T> {
            fn inline_schema() -> bool {
                T::inline_schema()
            }

            fn schema_name() -> std::borrow::Cow<'static, str> {
                T::schema_name()
            }

            fn schema_id() -> std::borrow::Cow<'static, str> {
                T::schema_id()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                T::json_schema(generator)
            }
        }
    };
}
pub use schema_of_inner;

schema_of_inner! { At }

/// The weight of a diagnostic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Severity {
    /// The deck cannot be run.
    Error,
    /// The deck can be run, but perhaps not as it was meant.
    Warning,
    /// The deck can be run, and something is taken as it was most likely meant.
    Note,
}

/// A line of a file that the deck names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Excerpt {
    /// The path of the file, as the deck names it.
    pub path: String,
    /// The number of the line, counted from 1.
    pub line: usize,
    /// The text of the line from its start, at most [`WIDEST`] bytes of it.
    pub text: String,
    /// The bytes of the text that are meant.
    pub columns: Range<usize>,
}

/// The number of bytes of a line that are shown at most.
const WIDEST: usize = 160;

impl Excerpt {
    /// `columns` of the bytes of a line, which may be of any length and no text.
    pub fn new(path: String, line: usize, bytes: &[u8], columns: Range<usize>) -> Self {
        let lossy = |bytes: &[u8]| plain(&String::from_utf8_lossy(bytes)).replace('\n', "\u{fffd}");
        let end = columns.end.min(bytes.len()).min(WIDEST);
        let start = columns.start.min(end);
        // Bytes that are no text grow when they are replaced.
        let (before, meant) = (lossy(&bytes[..start]), lossy(&bytes[start..end]));
        let columns = before.len()..before.len() + meant.len();
        let rest = lossy(&bytes[end..bytes.len().min(end.max(WIDEST))]);
        Excerpt { path, line, text: before + &meant + &rest, columns }
    }
}

/// Makes a text safe for a terminal: control characters and characters that change the writing direction become U+FFFD. Line ends and tabs
/// stay.
pub fn plain(text: &str) -> Cow<'_, str> {
    let is_command = |c: char| {
        (c.is_control() && c != '\n' && c != '\t') || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    if text.contains(is_command) { Cow::Owned(text.replace(is_command, "\u{fffd}")) } else { Cow::Borrowed(text) }
}

/// A text with every accent in the same letter as its character, Unicode's form NFC: `é` may be one character or two, and looks the same.
pub fn composed(text: &str) -> Cow<'_, str> {
    match is_nfc_quick(text.chars()) {
        IsNormalized::Yes => Cow::Borrowed(text),
        _ => Cow::Owned(text.nfc().collect()),
    }
}

/// Like [`plain`], for a text with marked places: each character keeps its length in bytes. The renderer shows those of one byte as
/// pictures.
fn in_place(text: &str) -> Cow<'_, str> {
    let is_command = |c: char| matches!(c, '\u{80}'..='\u{9f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    if !text.contains(is_command) {
        return Cow::Borrowed(text);
    }
    let shown = |c: char| match c {
        c if !is_command(c) => c,
        c if c.len_utf8() == 2 => '\u{bf}',
        _ => '\u{fffd}',
    };
    Cow::Owned(text.chars().map(shown).collect())
}

/// One thing to say about a deck.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    /// Severity of the message.
    pub severity: Severity,
    /// The message: one sentence without a full stop that names the thing.
    pub message: String,
    /// The place in the deck; `None` where the deck as a whole is meant.
    pub place: Option<Span>,
    /// The line of another file that is meant. The excerpt replaces the place, which then is only the deck entry with the name of the file.
    pub excerpt: Option<Box<Excerpt>>,
    /// The remedies: the first one stands at the caret, the others below the line.
    pub hints: Vec<String>,
}

/// The remedy of an error about a key that is missing, superfluous, repeated or empty, from the form of its message.
fn implied_remedy(message: &str) -> Option<String> {
    /// Forms, and what each implies.
    const FORMS: [(&str, &str); 7] = [
        ("does not apply to", "remove it"),
        (", not both", "remove one of them"),
        (" twice", "remove one of them"),
        ("is listed in two", "remove one of them"),
        ("two stages have the name", "rename one of them"),
        ("is empty", "add an entry, or remove it"),
        ("has no nodes", "add a node, or remove it"),
    ];
    let form = FORMS.iter().find(|(form, _)| message.contains(form)).map(|(_, remedy)| (*remedy).to_owned());
    form.or_else(|| {
        let key = message.split(" needs `").nth(1)?.split('`').next()?;
        Some(format!("add `{key}`"))
    })
}

impl Diagnostic {
    /// An error, as yet without a place.
    pub fn error(message: impl Into<String>) -> Self {
        Diagnostic { severity: Severity::Error, message: message.into(), place: None, excerpt: None, hints: Vec::new() }
    }

    /// A warning, as yet without a place.
    pub fn warning(message: impl Into<String>) -> Self {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(message) }
    }

    /// A note, as yet without a place.
    pub fn note(message: impl Into<String>) -> Self {
        Diagnostic { severity: Severity::Note, ..Diagnostic::error(message) }
    }

    /// Returns the message with a place in the deck.
    pub fn at(mut self, place: &Span) -> Self {
        self.place = Some(place.clone());
        self
    }

    /// Returns the message with a line of another file.
    pub fn of(mut self, excerpt: Excerpt) -> Self {
        self.excerpt = Some(Box::new(excerpt));
        self
    }

    /// Returns the message with one more hint.
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hints.push(hint.into());
        self
    }

    /// The remedies as shown: an error without hints has the one that its form implies. Requirements such as "must be above zero" imply
    /// none, because they already say what to write.
    pub fn remedies(&self) -> Vec<String> {
        if !self.is_error() || !self.hints.is_empty() {
            return self.hints.clone();
        }
        let of_file = || self.excerpt.is_some().then(|| "correct this line, or write the file anew".to_owned());
        implied_remedy(&self.message).or_else(of_file).into_iter().collect()
    }

    /// True where the deck cannot be run.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }

    /// True where the deck can be run, but perhaps not as it was meant.
    pub fn is_warning(&self) -> bool {
        self.severity == Severity::Warning
    }

    /// The diagnostic as text: message, file:line:column, the line, the caret; with colours where `styled`.
    pub fn draw(&self, source: &Source, styled: bool) -> String {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
            Severity::Note => Level::NOTE,
        };
        let title = level.primary_title(plain(&self.message));
        let remedies = self.remedies();
        let mut hints = remedies.iter().map(|hint| plain(hint));
        let mut group = Group::with_title(title);
        if let Some(Excerpt { path, line, text, columns }) = self.excerpt.as_deref() {
            let mark = AnnotationKind::Primary.span(columns.clone()).label(hints.next());
            let snippet = Snippet::source(text.as_str()).path(plain(path)).line_start(*line);
            group = group.element(snippet.annotation(mark));
        } else if let Some(place) = &self.place {
            let (name, text, range) = source.locate(place);
            let (line, text, range) = lines(text, range);
            let mark = AnnotationKind::Primary.span(range).label(hints.next());
            group = group.element(Snippet::source(in_place(text)).path(plain(name)).line_start(line).annotation(mark));
        }
        let group = group.elements(hints.map(|hint| Level::HELP.message(hint)));
        let renderer = if styled { Renderer::styled() } else { Renderer::plain() };
        renderer.render(&[group]).to_string()
    }
}

impl Diagnostic {
    /// The file of the diagnostic; `None` for the deck as a whole.
    pub fn file<'s>(&'s self, source: &'s Source) -> Option<&'s str> {
        let place = || Some(source.locate(self.place.as_ref()?).0);
        self.excerpt.as_ref().map(|excerpt| excerpt.path.as_str()).or_else(place)
    }

    /// The file of the diagnostic, the number of its line from 1, and its bytes in the line; `None` for the deck as a whole.
    pub fn position<'s>(&'s self, source: &'s Source) -> Option<(&'s str, usize, Range<usize>)> {
        match (self.excerpt.as_deref(), &self.place) {
            (Some(Excerpt { path, line, columns, .. }), _) => Some((path.as_str(), *line, columns.clone())),
            (None, Some(place)) => {
                let (name, text, range) = source.locate(place);
                let start = range.start.min(text.len());
                let begin = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
                let line = text.as_bytes()[..begin].iter().filter(|&&byte| byte == b'\n').count() + 1;
                Some((name, line, start - begin..range.end.max(start) - begin))
            }
            (None, None) => None,
        }
    }

    /// The diagnostic as one line of JSON: severity, message, hints and, where it has a place, file, line and column from 1 and the length
    /// in bytes.
    pub fn json(&self, source: &Source) -> String {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        let mut json = serde_json::json!({ "severity": severity, "message": self.message, "hints": self.remedies() });
        if let Some((file, line, columns)) = self.position(source) {
            json["file"] = file.into();
            json["line"] = line.into();
            json["column"] = (columns.start + 1).into();
            json["length"] = columns.len().into();
        }
        json.to_string()
    }
}

/// Longer texts are cut to an excerpt, length in bytes.
const SHORT: usize = 1 << 14;

/// The lines of a range and the number of the first: a renderer that gets a long text goes through all of it, every time.
fn lines(text: &str, range: Range<usize>) -> (usize, &str, Range<usize>) {
    if text.len() <= SHORT || range.start >= text.len() {
        return (1, text, range);
    }
    let begin = text[..range.start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[range.end..].find('\n').map_or(text.len(), |newline| range.end + newline + 1);
    let line = text.as_bytes()[..begin].iter().filter(|&&byte| byte == b'\n').count() + 1;
    (line, &text[begin..end], range.start - begin..range.end - begin)
}

/// The deck's text and the `--set` arguments.
#[derive(Debug, Clone)]
pub struct Source {
    /// The path of the deck, as it was given.
    pub path: String,
    /// The text of the deck, whose spans begin at 0.
    pub text: String,
    /// Arguments, each with the offset of its spans.
    pub sets: Vec<(usize, String)>,
    /// Options that produced the last arguments.
    pub options: Vec<String>,
}

/// The room after each text: for a place behind its end, and for the quotes that [`deck::set`] adds to a bare word.
const GAP: usize = 4;

impl Source {
    /// The texts of a run: the path and the text of a deck, and its `--set` arguments.
    pub fn new(path: impl Into<String>, text: impl Into<String>, sets: &[String]) -> Self {
        // All names of a deck and of its overrides are compared in one form.
        let text = composed(&text.into()).into_owned();
        let mut offset = text.len() + GAP;
        let place = |argument: &String| {
            let (begin, argument) = (offset, composed(argument).into_owned());
            offset += argument.len() + GAP;
            (begin, argument)
        };
        Source { path: path.into(), sets: sets.iter().map(place).collect(), text, options: Vec::new() }
    }

    /// Returns the source with the options that produced the last of the `--set` arguments.
    pub fn with_options(self, options: Vec<String>) -> Self {
        Source { options, ..self }
    }

    /// Whether something stands in such an option.
    pub fn is_option(&self, place: &Span) -> bool {
        let first = self.sets.len().saturating_sub(self.options.len());
        self.sets.get(first).is_some_and(|(offset, _)| *offset <= place.start)
    }

    /// Name and text of the file or argument of `span`, and the range within it.
    fn locate(&self, span: &Span) -> (&str, &str, Range<usize>) {
        let argument = self.sets.iter().enumerate().rev().find(|(_, (offset, _))| *offset <= span.start);
        let (name, text, offset) = match argument {
            Some((index, (offset, text))) => {
                let option = (index + self.options.len()).checked_sub(self.sets.len());
                let name = option.and_then(|option| self.options.get(option)).map_or("--set", String::as_str);
                (name, text.as_str(), *offset)
            }
            None => (self.path.as_str(), self.text.as_str(), 0),
        };
        let inside = |byte: usize| {
            let byte = byte.saturating_sub(offset).min(text.len());
            (0..=byte).rev().find(|&b| text.is_char_boundary(b)).unwrap_or(0)
        };
        (name, text, inside(span.start)..inside(span.end.max(span.start)))
    }
}
