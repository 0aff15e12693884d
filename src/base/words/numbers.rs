//! Lists of a fixed number of numbers.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;

/// A list of exactly `N` numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numbers<const N: usize>(pub [f64; N]);

/// Three components of a position, a direction, a force or a moment.
pub type Vector = Numbers<3>;

impl<'de, const N: usize> Deserialize<'de> for Numbers<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<const N: usize>;
        impl<'de, const N: usize> Visitor<'de> for Reader<N> {
            type Value = Numbers<N>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                match N {
                    2 => f.write_str("two numbers, such as [0.0, 1.0]"),
                    3 => f.write_str("three numbers, such as [0.0, 0.0, 1.0]"),
                    _ => write!(f, "a list of {N} numbers"),
                }
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
                let mut numbers = Vec::new();
                while let Some(number) = list.next_element::<f64>()? {
                    numbers.push(number);
                }
                numbers.try_into().map(Numbers).map_err(|wrong: Vec<f64>| A::Error::invalid_length(wrong.len(), &self))
            }
        }
        deserializer.deserialize_tuple(N, Reader)
    }
}

impl<const N: usize> JsonSchema for Numbers<N> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Numbers{N}").into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "items": { "type": "number" }, "minItems": N, "maxItems": N })
    }
}
