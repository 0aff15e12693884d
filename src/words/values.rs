//! The sorts of values that several tables share. Each says in its `expecting` what a user should have written.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{F64Deserializer, I64Deserializer, MapAccessDeserializer, StrDeserializer};
use serde::de::{Error, IntoDeserializer, MapAccess, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};

use crate::diagnostic::At;

/// A key that may be left out.
pub type Maybe<T> = Option<At<T>>;

/// A table, and nothing else: serde would also fill a struct from a list, by position.
#[derive(Debug, Clone)]
pub struct Table<T>(T);

impl<T> Deref for Table<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Table<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Reader<T> {
            type Value = Table<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a table, such as { key = value }")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(Table)
            }
        }
        deserializer.deserialize_map(Reader(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for Table<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// Exactly `N` numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numbers<const N: usize>(pub [f64; N]);

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

/// A number, or what the program finds by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NumberOrAuto {
    Number(f64),
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

/// One value or a list of them.
#[derive(Debug, Clone)]
pub struct OneOrMany<T> {
    pub values: Vec<At<T>>,
    /// Written without brackets; the value's span is then that of the key's value.
    pub single: bool,
}

pub type Names = OneOrMany<String>;

/// What may stand in a [`OneOrMany`].
pub trait Item {
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
            /// A single value, or that it is `found`, which is not what is expected.
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

/// Tables or values by name, in the order of the deck.
#[derive(Debug, Clone)]
pub struct Named<T>(pub Vec<(At<String>, At<T>)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Named(Vec::new())
    }
}

impl<T> Named<T> {
    pub fn names(&self) -> impl Iterator<Item = &str> + Clone {
        self.0.iter().map(|(name, _)| name.as_str())
    }

    pub fn position(&self, name: &str) -> Option<usize> {
        self.names().position(|known| known == name)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Reader<T> {
            type Value = Named<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a table with one entry per name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Named(entries))
            }
        }
        deserializer.deserialize_map(Reader(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for Named<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Named_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let value = generator.subschema_for::<T>();
        json_schema!({ "type": "object", "additionalProperties": value })
    }
}

/// "all", "translations", "rotations", one direction, or a list of directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Directions(pub [bool; 6]);

impl Directions {
    pub const ALL: Directions = Directions([true; 6]);
}

/// The words for several directions, and those for one.
const WORDS: [&str; 9] = ["all", "translations", "rotations", "ux", "uy", "uz", "rx", "ry", "rz"];

#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum Direction {
    Ux,
    Uy,
    Uz,
    Rx,
    Ry,
    Rz,
}

impl<'de> Deserialize<'de> for Directions {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Directions;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("\"all\", \"translations\", \"rotations\" or a list, such as [\"ux\", \"ry\"]")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Directions, E> {
                match word {
                    "all" => Ok(Directions::ALL),
                    "translations" => Ok(Directions([true, true, true, false, false, false])),
                    "rotations" => Ok(Directions([false, false, false, true, true, true])),
                    _ => {
                        let one = WORDS[3..].iter().position(|direction| *direction == word);
                        let one = one.ok_or_else(|| E::unknown_variant(word, &WORDS))?;
                        Ok(Directions(std::array::from_fn(|direction| direction == one)))
                    }
                }
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Directions, A::Error> {
                let mut directions = [false; 6];
                while let Some(direction) = list.next_element::<Direction>()? {
                    directions[direction as usize] = true;
                }
                Ok(Directions(directions))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for Directions {
    fn schema_name() -> Cow<'static, str> {
        "Directions".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let direction = generator.subschema_for::<Direction>();
        json_schema!({ "anyOf": [
            { "enum": ["all", "translations", "rotations"] },
            direction,
            { "type": "array", "items": direction },
        ] })
    }
}
