//! A table as the kind that was chosen reads it.

use super::frame::{axes, unit};
use super::kind::Kind;
use super::values::Values;
use crate::diagnostic::{Diagnostic, Span};
use crate::math::{Mat3, Vec3};
use crate::names::short;

/// The values of a table for the kind that reads them. It reads keys and collects all mistakes, so no mistake hides another. A function
/// that returns `None` has reported the reason, unless the key is optional.
pub struct Given<'t> {
    /// The table, for messages: "section `square`".
    what: &'t str,
    /// The place of the table in the deck.
    span: &'t Span,
    values: &'t Values,
    /// The keys that are written, but could not be read: these have been reported.
    unreadable: Vec<&'t str>,
    /// Mistakes found so far.
    pub problems: Vec<Diagnostic>,
}

impl<'t> Given<'t> {
    /// The values of the table at `span`, named `what` in messages; `unreadable` lists keys already reported.
    pub fn new(what: &'t str, span: &'t Span, values: &'t Values, unreadable: Vec<&'t str>) -> Self {
        Given { what, span, values, unreadable, problems: Vec::new() }
    }

    /// The table, for messages: "section `square`".
    pub fn what(&self) -> &'t str {
        self.what
    }

    /// All values of the table.
    pub fn values(&self) -> &'t Values {
        self.values
    }

    /// Reports keys that `kind` does not allow; `what` is an object of that kind, `takers` the words of the kinds that allow a key.
    pub fn reject_others<M>(&mut self, kind: &Kind<M>, what: &str, takers: impl Fn(&str) -> Vec<&'static str>) {
        for value in self.values.0.iter().filter(|value| !kind.takes(value.key)) {
            let message = format!("`{}` does not apply to {what}", value.key);
            let problem = Diagnostic::error(message).at(&value.span);
            let words: Vec<String> = takers(value.key).iter().map(|word| format!("\"{word}\"")).collect();
            self.problems.push(match words.is_empty() {
                true => problem,
                false => problem.hint(format!("remove it; it is a key of {}", words.join(", "))),
            });
        }
    }

    /// Whether a key is written, and could be read.
    pub fn has(&self, key: &str) -> bool {
        self.values.get(key).is_some()
    }

    /// Reports an error at the value of a key, or at the table where the key is not written. It returns `None`, for the caller to
    /// return in turn.
    pub fn error<T>(&mut self, key: &str, message: impl Into<String>) -> Option<T> {
        let place = self.values.place(key).unwrap_or(self.span);
        self.problems.push(Diagnostic::error(message).at(place));
        None
    }

    /// Reports an error like [`Given::error`], with a hint at the caret.
    pub fn error_with<T>(&mut self, key: &str, message: impl Into<String>, hint: impl Into<String>) -> Option<T> {
        let place = self.values.place(key).unwrap_or(self.span);
        self.problems.push(Diagnostic::error(message).at(place).hint(hint));
        None
    }

    /// Reports a warning at the value of a key, or at the table where the key is not written, with a hint at the caret.
    pub fn warn(&mut self, key: &str, message: impl Into<String>, hint: impl Into<String>) {
        let place = self.values.place(key).unwrap_or(self.span);
        self.problems.push(Diagnostic::warning(message).at(place).hint(hint));
    }

    /// The numbers behind a key that must be there.
    pub fn require(&mut self, key: &str) -> Option<&'t [f64]> {
        if let Some(value) = self.values.get(key) {
            return Some(&value.numbers);
        }
        if !self.unreadable.contains(&key) {
            let message = format!("{} needs `{key}`", self.what);
            self.error::<()>(key, message);
        }
        None
    }

    /// Reports that one of two missing keys is required.
    pub fn require_either<T>(&mut self, one: &str, other: &str) -> Option<T> {
        if self.is_unreadable(one) || self.is_unreadable(other) {
            return None;
        }
        let message = format!("{} needs `{one}` or `{other}`", self.what);
        self.error(one, message)
    }

    /// The number behind a key, which may be left out.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.values.numbers(key).first().copied()
    }

    /// The numbers behind a key; empty where it is not written.
    pub fn numbers(&self, key: &str) -> &'t [f64] {
        self.values.numbers(key)
    }

    /// A number above zero, where the key is written.
    pub fn positive(&mut self, key: &str) -> Option<f64> {
        match self.number(key)? {
            number if number > 0.0 => Some(number),
            _ => self.error(key, format!("`{key}` must be above zero")),
        }
    }

    /// A number above zero; the key must be there.
    pub fn require_positive(&mut self, key: &str) -> Option<f64> {
        self.require(key)?;
        self.positive(key)
    }

    /// Two numbers above zero; the key must be there.
    pub fn require_positive_pair(&mut self, key: &str) -> Option<[f64; 2]> {
        match *self.require(key)? {
            [a, b] if a > 0.0 && b > 0.0 => Some([a, b]),
            _ => self.error(key, format!("both values of `{key}` must be above zero")),
        }
    }

    /// A number of zero or more; `default` where it is not written.
    pub fn not_negative(&mut self, key: &str, default: f64) -> f64 {
        match self.number(key) {
            Some(number) if number < 0.0 => {
                self.error::<()>(key, format!("`{key}` must not be negative"));
                default
            }
            number => number.unwrap_or(default),
        }
    }

    /// A number within a range; `default` where it is not written or lies outside.
    pub fn between(&mut self, key: &str, [low, high]: [f64; 2], default: f64) -> f64 {
        match self.number(key) {
            Some(number) if !(low..=high).contains(&number) => {
                let range = format!("from {} to {}", short(low), short(high));
                self.error_with::<()>(key, format!("`{key}` lies out of its range"), range);
                default
            }
            number => number.unwrap_or(default),
        }
    }

    /// The vector behind a key that must be there.
    pub fn require_vector(&mut self, key: &str) -> Option<Vec3> {
        self.require(key).and_then(|numbers| numbers.try_into().ok()).map(|numbers: [f64; 3]| Vec3::from(numbers))
    }

    /// The vector behind a key, which may be left out.
    pub fn vector(&self, key: &str) -> Option<Vec3> {
        self.numbers(key).try_into().ok().map(|numbers: [f64; 3]| Vec3::from(numbers))
    }

    /// The unit vector along a vector, which must be there and not be zero.
    pub fn require_unit(&mut self, key: &str) -> Option<Vec3> {
        let v = self.require_vector(key)?;
        unit(&v).or_else(|| self.error(key, format!("`{key}` must not be zero")))
    }

    /// The frame with x along the first of two vectors and the second in the x-y plane; global axes if the key is missing.
    pub fn axes(&mut self, key: &str) -> Option<Mat3> {
        if self.is_unreadable(key) {
            return None;
        }
        let vectors: Vec<Vec3> = self.numbers(key).chunks_exact(3).map(Vec3::from_column_slice).collect();
        if !self.has(key) {
            return Some(Mat3::identity());
        }
        axes(&vectors).map_or_else(|wrong| self.error(key, wrong), Some)
    }

    /// Whether a key is written, but so that it could not be read.
    pub fn is_unreadable(&self, key: &str) -> bool {
        self.unreadable.contains(&key)
    }
}
