//! Values of the keys of kinds, as written.

use crate::diagnostic::Span;

/// The values of those keys of a table that belong to kinds, in the order of the deck.
#[derive(Debug, Clone, Default)]
pub struct Values(pub(super) Vec<Value>);

/// The numbers behind a key: one, a few, or those of vectors one after the other.
#[derive(Debug, Clone)]
pub(super) struct Value {
    /// The key.
    pub key: &'static str,
    /// The numbers, flat.
    pub numbers: Vec<f64>,
    /// The place of the value in the deck.
    pub span: Span,
}

impl Values {
    /// The value of a key; `None` where it is not written.
    pub(super) fn get(&self, key: &str) -> Option<&Value> {
        self.0.iter().find(|value| value.key == key)
    }

    /// The numbers behind a key; empty where it is not written.
    pub fn numbers(&self, key: &str) -> &[f64] {
        self.get(key).map_or(&[], |value| &value.numbers)
    }

    /// Numbers at this part of the way to those of another table that gives the same keys, see [`Values::differs`]; `but` is left out.
    pub fn toward(&self, other: &Values, part: f64, but: &str) -> Values {
        let between = |value: &Value| {
            let to = other.numbers(value.key);
            let numbers = value.numbers.iter().zip(to).map(|(a, b)| a + part * (b - a)).collect();
            Value { numbers, ..value.clone() }
        };
        Values(self.0.iter().filter(|value| value.key != but).map(between).collect())
    }

    /// A key that another table does not give with as many numbers, or gives alone; `but` does not count.
    pub fn differs(&self, other: &Values, but: &str) -> Option<&'static str> {
        let mut all = self.0.iter().chain(&other.0).map(|value| value.key).filter(|key| *key != but);
        all.find(|key| {
            self.get(key).map(|value| value.numbers.len()) != other.get(key).map(|value| value.numbers.len())
        })
    }

    /// The place of a key's value in the deck; `None` where it is not written.
    pub fn place(&self, key: &str) -> Option<&Span> {
        self.get(key).map(|value| &value.span)
    }

    /// The places of all values in the deck.
    pub fn places(&self) -> impl Iterator<Item = &Span> {
        self.0.iter().map(|value| &value.span)
    }
}
