//! The forms that values of keys may have: how each is read, and its schema.

use super::values::Value;
use crate::diagnostic::At;
use crate::words::{Numbers, OneOrMany, Vector};
use serde::de::MapAccess;
use serde_json::{Value as Json, json};

/// A form of value that a key may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// A number.
    Number,
    /// A whole number of zero or more.
    Count,
    /// Two numbers in brackets.
    Pair,
    /// Three numbers in brackets.
    Vector,
    /// A number, or several in brackets.
    Numbers,
    /// A whole number of zero or more, or several in brackets.
    Counts,
    /// A list of vectors.
    Vectors,
    /// A list of pairs.
    Pairs,
    /// Six lists of six numbers: the rows of a matrix.
    SixRows,
}

impl Form {
    /// Reads the value of a key.
    pub(super) fn read<'de, A: MapAccess<'de>>(self, key: &'static str, map: &mut A) -> Result<Value, A::Error> {
        let whole = |count: &u64| *count as f64;
        let (numbers, span) = match self {
            Form::Number => {
                let At { value, span } = map.next_value::<At<f64>>()?;
                (vec![value], span)
            }
            Form::Count => {
                let At { value, span } = map.next_value::<At<u64>>()?;
                (vec![whole(&value)], span)
            }
            Form::Pair => {
                let At { value, span } = map.next_value::<At<Numbers<2>>>()?;
                (value.0.to_vec(), span)
            }
            Form::Vector => {
                let At { value, span } = map.next_value::<At<Vector>>()?;
                (value.0.to_vec(), span)
            }
            Form::Numbers => {
                let At { value, span } = map.next_value::<At<OneOrMany<f64>>>()?;
                (value.values.iter().map(|number| number.value).collect(), span)
            }
            Form::Counts => {
                let At { value, span } = map.next_value::<At<OneOrMany<u64>>>()?;
                (value.values.iter().map(|count| whole(&count.value)).collect(), span)
            }
            Form::Pairs => {
                let At { value, span } = map.next_value::<At<Vec<At<Numbers<2>>>>>()?;
                (value.iter().flat_map(|pair| pair.0).collect(), span)
            }
            Form::SixRows => {
                let At { value, span } = map.next_value::<At<[At<Numbers<6>>; 6]>>()?;
                (value.iter().flat_map(|row| row.value.0).collect(), span)
            }
            Form::Vectors => {
                let At { value, span } = map.next_value::<At<Vec<Vector>>>()?;
                (value.iter().flat_map(|vector| vector.0).collect(), span)
            }
        };
        Ok(Value { key, numbers, span })
    }

    /// The JSON Schema of the values of this form.
    pub(super) fn schema(self) -> Json {
        let list = |of: &str, count: Option<usize>| match count {
            Some(n) => json!({ "type": "array", "items": { "type": of }, "minItems": n, "maxItems": n }),
            None => json!({ "anyOf": [{ "type": of }, { "type": "array", "items": { "type": of } }] }),
        };
        match self {
            Form::Number => json!({ "type": "number" }),
            Form::Count => json!({ "type": "integer", "minimum": 0 }),
            Form::Pair => list("number", Some(2)),
            Form::Vector => list("number", Some(3)),
            Form::Numbers => list("number", None),
            Form::Counts => list("integer", None),
            Form::Pairs => json!({ "type": "array", "items": list("number", Some(2)) }),
            Form::Vectors => json!({ "type": "array", "items": list("number", Some(3)) }),
            Form::SixRows => {
                json!({ "type": "array", "items": list("number", Some(6)), "minItems": 6, "maxItems": 6 })
            }
        }
    }
}
