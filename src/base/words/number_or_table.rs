//! Keys with a number, or a table with details.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// A number, or a table.
#[derive(Debug, Clone)]
pub enum NumberOrTable<T> {
    /// The number that the deck gives.
    Number(f64),
    /// The table.
    Table(T),
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for NumberOrTable<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Reader<T> {
            type Value = NumberOrTable<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number or a table, such as { key = value }")
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<NumberOrTable<T>, E> {
                Ok(NumberOrTable::Number(number as f64))
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<NumberOrTable<T>, E> {
                Ok(NumberOrTable::Number(number))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<NumberOrTable<T>, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(NumberOrTable::Table)
            }
        }
        deserializer.deserialize_any(Reader(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for NumberOrTable<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("NumberOr{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let table = generator.subschema_for::<T>();
        json_schema!({ "anyOf": [{ "type": "number" }, table] })
    }
}
