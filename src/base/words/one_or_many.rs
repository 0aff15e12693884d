//! Keys that take one value or a list of values.

use crate::diagnostic::At;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{F64Deserializer, I64Deserializer, StrDeserializer};
use serde::de::{Error, IntoDeserializer, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// One value or a list of them.
#[derive(Debug, Clone)]
pub struct OneOrMany<T> {
    /// The values in the order of the deck, each with its place.
    pub values: Vec<At<T>>,
    /// True for a single value without brackets; its place is then that of the key's value.
    pub single: bool,
}

/// One name or a list of names.
pub type Names = OneOrMany<String>;

/// A type whose values may stand in a [`OneOrMany`].
pub trait Item {
    /// Description of the expected value for messages, with an example.
    const EXPECTED: &'static str;
}

impl Item for String {
    const EXPECTED: &'static str = "a name in quotes or a list of names, such as [\"knee\", \"foot\"]";
}

impl Item for u64 {
    const EXPECTED: &'static str = "a whole number or a list of whole numbers, such as 12 or [12, 6]";
}

impl Item for f64 {
    const EXPECTED: &'static str = "a number or a list of numbers, such as 0.01 or [0.01, 0.02]";
}

impl<'de, T: Item + Deserialize<'de>> Deserialize<'de> for OneOrMany<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<T>(PhantomData<T>);
        impl<'de, T: Item + Deserialize<'de>> Reader<T> {
            /// Reads a single value; the error reports `found` instead of the expected value.
            fn one<E: Error>(
                &self,
                value: impl IntoDeserializer<'de, E>,
                found: Unexpected,
            ) -> Result<(Vec<At<T>>, bool), E> {
                let value = T::deserialize(value.into_deserializer()).map_err(|_: E| E::invalid_type(found, self))?;
                Ok((vec![At { value, span: 0..0 }], true))
            }
        }
        impl<'de, T: Item + Deserialize<'de>> Visitor<'de> for Reader<T> {
            type Value = (Vec<At<T>>, bool);

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(T::EXPECTED)
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
                self.one(StrDeserializer::<E>::new(text), Unexpected::Str(text))
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<Self::Value, E> {
                self.one(I64Deserializer::<E>::new(number), Unexpected::Signed(number))
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<Self::Value, E> {
                self.one(F64Deserializer::<E>::new(number), Unexpected::Float(number))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = list.next_element()? {
                    values.push(value);
                }
                Ok((values, false))
            }
        }

        struct Inner<T>((Vec<At<T>>, bool));
        impl<'de, T: Item + Deserialize<'de>> Deserialize<'de> for Inner<T> {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(Reader(PhantomData)).map(Inner)
            }
        }

        let At { value: Inner((mut values, single)), span } = At::deserialize(deserializer)?;
        if single {
            values.iter_mut().for_each(|value| value.span = span.clone());
        }
        Ok(OneOrMany { values, single })
    }
}

impl<T: JsonSchema> JsonSchema for OneOrMany<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("OneOrMany_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<T>();
        json_schema!({ "anyOf": [one, { "type": "array", "items": one }] })
    }
}
