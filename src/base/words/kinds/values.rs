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

    /// Numbers at this part of the way to those of another table; `None` where the two do not give the same keys with as many numbers.
    pub fn toward(&self, other: &Values, part: f64) -> Option<Values> {
        if self.0.len() != other.0.len() {
            return None;
        }
        let between = |value: &Value| {
            let to = &other.get(value.key)?.numbers;
            let numbers = value.numbers.iter().zip(to).map(|(a, b)| a + part * (b - a)).collect();
            (value.numbers.len() == to.len()).then(|| Value { numbers, ..value.clone() })
        };
        self.0.iter().map(between).collect::<Option<Vec<_>>>().map(Values)
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
