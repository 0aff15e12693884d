//! Everything there is to say about a deck. A [`Report`] collects it, table after table, and holds the checks common to all tables:
//! required keys, keys that do not apply, ranges of numbers. After an error the valid rest of a table is still read, so that one mistake
//! hides no other.

use base::diagnostic::{At, Diagnostic, Span};
use base::math::Vec3;
use base::names::{nearest, quoted};
use deck::Deck;
use deck::read::ROOT;
use deck::words::kinds::{Given, Kind, Values, unit};
use deck::words::{Maybe, Named, Numbers, Vector};

/// A table of the deck as messages name it, "beam `portal`", and where it stands.
pub(super) struct Owner<'d> {
    /// Words for the table, such as "beam `portal`".
    pub what: String,
    /// Its place in the deck.
    pub span: &'d Span,
}

impl<'d> Owner<'d> {
    /// The table at `span`, which messages call `what`.
    pub fn new(what: impl Into<String>, span: &'d Span) -> Self {
        Owner { what: what.into(), span }
    }
}

/// The errors and warnings of a deck during the build; it also reads keys with checks.
pub(super) struct Report<'d> {
    deck: &'d Deck,
    problems: Vec<Diagnostic>,
    /// False once something failed to say which nodes it connects. A point without a connection may then be connected by the unread table,
    /// and is no separate error.
    connections_known: bool,
    /// Names that may still be compared with misspelt ones.
    searches: usize,
}

/// Names that are compared with misspelt ones in all: of thousands of unknown names only some are shown.
const SEARCHES: usize = 1_000_000;

impl<'d> Report<'d> {
    /// A report without anything in it.
    pub fn new(deck: &'d Deck) -> Self {
        let is_table = |table: &Option<Span>| table.as_ref().is_none_or(|table| *table == ROOT);
        let connections_known = !deck.spoiled.iter().any(|entry| is_table(&entry.table));
        Report { deck, problems: Vec::new(), connections_known, searches: SEARCHES }
    }

    /// Reports an error and returns `None`, for `return report.error(…)`.
    pub fn error<T>(&mut self, place: &Span, message: impl Into<String>) -> Option<T> {
        self.push(Diagnostic::error(message).at(place));
        None
    }

    /// Reports an error with a hint at the caret; see [`Report::error`].
    pub fn error_with<T>(&mut self, place: &Span, message: impl Into<String>, hint: impl Into<String>) -> Option<T> {
        self.push(Diagnostic::error(message).at(place).hint(hint));
        None
    }

    /// Reports a warning with a hint at the caret.
    pub fn warn(&mut self, place: &Span, message: impl Into<String>, hint: impl Into<String>) {
        self.push(Diagnostic::warning(message).at(place).hint(hint));
    }

    /// Tells of something that is taken as it was most likely meant, with a hint at the caret.
    pub fn note(&mut self, place: &Span, message: impl Into<String>, hint: impl Into<String>) {
        self.push(Diagnostic::note(message).at(place).hint(hint));
    }

    /// Reports a problem.
    pub fn push(&mut self, problem: Diagnostic) {
        self.problems.push(problem);
    }

    /// True where an error was reported.
    pub fn has_errors(&self) -> bool {
        self.problems.iter().any(Diagnostic::is_error)
    }

    /// All diagnostics so far, in the order of reporting.
    pub fn into_problems(self) -> Vec<Diagnostic> {
        self.problems
    }

    /// The number of problems so far, for [`Report::is_clean_since`] and [`Report::forget_warnings_since`].
    pub fn mark(&self) -> usize {
        self.problems.len()
    }

    /// True where nothing was reported since [`Report::mark`].
    pub fn is_clean_since(&self, mark: usize) -> bool {
        self.problems.len() == mark
    }

    /// Drops the warnings reported since [`Report::mark`]; errors stay.
    pub fn forget_warnings_since(&mut self, mark: usize) {
        let later = self.problems.split_off(mark);
        self.problems.extend(later.into_iter().filter(Diagnostic::is_error));
    }

    /// Notes that the nodes of a connecting table are unknown.
    pub fn lose_connections(&mut self) {
        self.connections_known = false;
    }

    /// True if all connecting tables could be read so far.
    pub fn connections_known(&self) -> bool {
        self.connections_known
    }

    /// True for a key in the deck that could not be read; the error is already reported.
    pub fn is_spoiled(&self, table: &Span, key: &str) -> bool {
        let here = |entry: &Option<Span>| entry.as_ref().is_none_or(|span| span == table);
        self.deck.spoiled.iter().any(|entry| entry.key == key && here(&entry.table))
    }

    /// True where any key of a table could not be read.
    pub fn is_any_spoiled(&self, table: &Span) -> bool {
        self.deck.spoiled.iter().any(|entry| entry.table.as_ref() == Some(table))
    }

    /// The required name of the `index`-th table in a `list` ("links.2" without one), and its title for messages, with the `word` for its
    /// kind.
    pub fn named(
        &mut self,
        (word, list, index): (&str, &str, usize),
        name: Option<&'d At<String>>,
        span: &'d Span,
    ) -> (String, Owner<'d>) {
        let called = name.map_or_else(|| format!("{list}.{index}"), |name| name.value.clone());
        let owner = Owner::new(format!("{word} `{called}`"), span);
        if name.is_none() && !self.is_spoiled(span, "name") {
            self.error::<()>(span, format!("{} needs `name`", owner.what));
        }
        (called, owner)
    }

    /// The value of a key that must be there.
    pub fn require<T>(&mut self, owner: &Owner, key: &str, value: &'d Maybe<T>) -> Option<&'d At<T>> {
        if value.is_none() && !self.is_spoiled(owner.span, key) {
            let message = format!("{} needs `{key}`", owner.what);
            match deck::remedy_of_missing(key) {
                Some(remedy) => self.error_with::<()>(owner.span, message, remedy),
                None => self.error::<()>(owner.span, message),
            };
        }
        value.as_ref()
    }

    /// [`Report::require`] for a key with the nodes connected by its table.
    pub fn require_nodes<T>(&mut self, owner: &Owner, key: &str, value: &'d Maybe<T>) -> Option<&'d At<T>> {
        if value.is_none() {
            self.lose_connections();
        }
        self.require(owner, key, value)
    }

    /// A number above zero, if it is there.
    pub fn positive(&mut self, key: &str, value: &Maybe<f64>) -> Option<f64> {
        let value = value.as_ref()?;
        if value.value > 0.0 {
            Some(value.value)
        } else {
            self.error(&value.span, format!("`{key}` must be above zero"))
        }
    }

    /// A number above zero, which must be there.
    pub fn require_positive(&mut self, owner: &Owner, key: &str, value: &'d Maybe<f64>) -> Option<f64> {
        self.require(owner, key, value)?;
        self.positive(key, value)
    }

    /// A number of zero or more, or `default` if it is not there.
    pub fn not_negative(&mut self, key: &str, value: &Maybe<f64>, default: f64) -> f64 {
        match value {
            Some(value) if value.value < 0.0 => {
                self.error::<()>(&value.span, format!("`{key}` must not be negative"));
                default
            }
            Some(value) => value.value,
            None => default,
        }
    }

    /// A whole number of at least one, or `default` if it is not there.
    pub fn count(&mut self, key: &str, value: &Maybe<u64>, default: usize) -> usize {
        match value {
            Some(value) if value.value == 0 => {
                self.error::<()>(&value.span, format!("`{key}` must be at least 1"));
                default
            }
            Some(value) => usize::try_from(value.value).unwrap_or(usize::MAX),
            None => default,
        }
    }

    /// The unit vector along a direction, which must not be zero.
    pub fn unit(&mut self, key: &str, value: &At<Vector>) -> Option<Vec3> {
        unit(&Vec3::from(value.0)).or_else(|| self.error(&value.span, format!("`{key}` must not be zero")))
    }

    /// The table `key` of two points or more whose first numbers, of the quantity `what`, increase.
    pub fn rising(&mut self, key: &str, what: &str, points: &At<Vec<At<Numbers<2>>>>) -> Option<Vec<[f64; 2]>> {
        if points.len() < 2 {
            return self.error(&points.span, format!("`{key}` must have two points or more"));
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1].0[0] <= pair[0].0[0]) {
            let message = format!("`{key}` must increase in {what}");
            return self.error_with(&pair[1].span, message, format!("the one before is at {}", pair[0].0[0]));
        }
        Some(points.iter().map(|point| point.0).collect())
    }

    /// Reports keys that do not apply to `what`, given with their places.
    pub fn reject_unused(&mut self, what: &str, keys: &[(&str, Option<&Span>)]) {
        for (key, place) in keys {
            if let Some(place) = place {
                self.error::<()>(place, format!("`{key}` does not apply to {what}"));
            }
        }
    }

    /// Reads a table of one of several kinds with `read`, and reports its errors. Keys that do not apply to `what`, a thing of that kind,
    /// are an error.
    pub fn read<M, T>(
        &mut self,
        owner: &Owner<'d>,
        what: &str,
        values: &'d Values,
        kind: &Kind<M>,
        read: impl FnOnce(&mut Given) -> T,
    ) -> T {
        let spoiled = &self.deck.spoiled;
        let here = |table: &Option<Span>| table.as_ref().is_none_or(|table| table == owner.span);
        let unreadable = spoiled.iter().filter(|entry| here(&entry.table)).map(|entry| entry.key.as_str());
        let mut given = Given::new(&owner.what, owner.span, values, unreadable.collect());
        given.reject_others(kind, what, |key| deck::kinds_with(kind, key));
        let value = read(&mut given);
        self.problems.extend(given.problems);
        value
    }

    /// The entry of a table of names; `what` is one of them, in singular.
    pub fn find<T>(&mut self, what: &str, table: &'d Named<T>, name: &At<String>) -> Option<(usize, &'d At<T>)> {
        match table.position(name) {
            Some(index) => Some((index, &table.0[index].1)),
            None => self.unknown(what, name, table.names()),
        }
    }

    /// Whether another unknown name is compared with those that are known.
    pub fn may_search(&self) -> bool {
        self.searches > 0
    }

    /// Reports an unknown name, with the nearest known one. If a table could not be read, it may have this name, so there is no error.
    pub fn unknown<'n, T>(
        &mut self,
        what: &str,
        name: &At<String>,
        known: impl Iterator<Item = &'n str> + Clone,
    ) -> Option<T> {
        if !self.may_search() {
            return self.error_with(&name.span, format!("no {what} is named `{}`", name.value), "check its spelling");
        }
        let count = known.clone().count();
        self.searches = self.searches.saturating_sub(count);
        if self.deck.spoiled.iter().any(|entry| entry.key == name.value) {
            return None;
        }
        let message = format!("no {what} is named `{}`", name.value);
        match nearest(name, known.clone()) {
            Some(near) => self.error_with(&name.span, message, format!("did you mean `{near}`?")),
            None if count == 0 => self.error_with(&name.span, message, "the deck has none"),
            None if count <= 8 => self.error_with(&name.span, message, format!("known: {}", quoted(known))),
            None => self.error_with(&name.span, message, "check its spelling"),
        }
    }
}
