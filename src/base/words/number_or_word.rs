//! Numbers that a deck may replace by one word, such as `"auto"`.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// A number, or the word of `W`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NumberOr<W> {
    /// The number that the deck gives.
    Number(f64),
    /// The word.
    Word(W),
}

/// A word that may replace a number.
pub trait LoneWord: Default {
    /// The word as the deck has it.
    const WORD: &'static str;
}

/// The program finds the number.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Auto;

impl LoneWord for Auto {
    const WORD: &'static str = "auto";
}

/// The number is that at the end.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AtEnd;

impl LoneWord for AtEnd {
    const WORD: &'static str = "end";
}

/// A number, or "auto".
pub type NumberOrAuto = NumberOr<Auto>;
/// A time, or "end".
pub type TimeOrEnd = NumberOr<AtEnd>;

impl<'de, W: LoneWord> Deserialize<'de> for NumberOr<W> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<W>(PhantomData<W>);
        impl<W: LoneWord> Visitor<'_> for Reader<W> {
            type Value = NumberOr<W>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a number or \"{}\"", W::WORD)
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<NumberOr<W>, E> {
                if word == W::WORD {
                    Ok(NumberOr::Word(W::default()))
                } else {
                    Err(E::unknown_variant(word, const { &[W::WORD] }))
                }
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<NumberOr<W>, E> {
                Ok(NumberOr::Number(number as f64))
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<NumberOr<W>, E> {
                Ok(NumberOr::Number(number))
            }
        }
        deserializer.deserialize_any(Reader(PhantomData))
    }
}

impl<W: LoneWord> JsonSchema for NumberOr<W> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("NumberOr_{}", W::WORD).into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "number" }, { "const": W::WORD }] })
    }
}
