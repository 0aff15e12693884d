//! Numbers that the program computes for `"auto"`.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;

/// A number, or the word `"auto"`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NumberOrAuto {
    /// The number that the deck gives.
    Number(f64),
    /// The program finds the number.
    Auto,
}

impl<'de> Deserialize<'de> for NumberOrAuto {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = NumberOrAuto;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number or \"auto\"")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<NumberOrAuto, E> {
                if word == "auto" { Ok(NumberOrAuto::Auto) } else { Err(E::unknown_variant(word, &["auto"])) }
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<NumberOrAuto, E> {
                Ok(NumberOrAuto::Number(number as f64))
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<NumberOrAuto, E> {
                Ok(NumberOrAuto::Number(number))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for NumberOrAuto {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "NumberOrAuto".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "number" }, { "const": "auto" }] })
    }
}
